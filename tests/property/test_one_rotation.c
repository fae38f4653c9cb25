/* SPDX-License-Identifier: MIT */
/*
 * q, −q and every multiple of q are one rotation: sums, meshes, files, live meshes, maps and answers are the same,
 * whichever is given and whatever led there. At poses with ties, which the perturbation of the quaternion settles.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/baseline.h>
#include <pirouette/cgm.h>
#include <pirouette/live_mesh.h>
#include <pirouette/pair.h>
#include <pirouette/query.h>

#include "dymsum/file/sum_file.h"
#include "dymsum/relative.h"
#include "support/answers.h"
#include "support/bodies.h"
#include "support/meshes.h"
#include "support/sum_bytes.h"

static const pir_quat identity = {0, 0, 0, 1};

static pir_quat times(pir_quat q, double s) {
    return (pir_quat){s * q.x, s * q.y, s * q.z, s * q.w};
}

/* Factors by which quaternions of small integers are multiplied exactly; the first are powers of two. */
#define FACTORS 8
#define POWERS  5
static const double factors[FACTORS] = {-1, 2, -0.5, 0x1p100, -0x1p-300, 3, -7, 1e9};

/* Two bodies whose facets and edges line up. */
static void aligned_bodies(test_random *random, pir_polytope **ret_p, pir_polytope **ret_q) {
    static const test_body bodies[] = {TEST_BOX,   TEST_BOX,  TEST_OCTAHEDRON, TEST_PRISM,
                                       TEST_PRISM, TEST_GRID, TEST_POLYGON,    TEST_SEGMENT};
    *ret_p = test_random_polytope(random, bodies[test_random_below(random, 8)], 10);
    *ret_q = test_random_below(random, 3) ? test_random_polytope(random, bodies[test_random_below(random, 8)], 10)
                                          : pir_polytope_retain(*ret_p);
}

static pir_sum *new_sum(pir_polytope *p, pir_polytope *q, pir_quat rotation, int difference) {
    pir_sum_options options = pir_sum_options_default();
    options.difference = difference;
    pir_sum *sum = NULL;
    assert_int_equal(pir_sum_create(p, q, rotation, &options, &sum), PIR_OK);
    return sum;
}

/* --- comparing --- */

/* Whether two files of sums differ in nothing but the quaternion as it was given, and the checksum. */
static bool same_file(const pir_sum *a, const pir_sum *b) {
    test_bytes x = test_bytes_of(a), y = test_bytes_of(b);
    const pir_quat given[2] = {pir_sum_rotation(a), pir_sum_rotation(b)};
    bool same = x.data && y.data && x.size == y.size;
    size_t at = PIR_SUM_HEADER_SIZE;
    while (same && at + sizeof *given <= x.size && memcmp(x.data + at, given, sizeof *given) != 0)
        at++;
    same = same && at + sizeof *given <= x.size && memcmp(x.data, y.data, PIR_SUM_CHECKSUM_AT) == 0 &&
           memcmp(y.data + at, given + 1, sizeof *given) == 0;
    for (size_t i = PIR_SUM_HEADER_SIZE; same && i < x.size; i++)
        same = x.data[i] == y.data[i] || (i >= at && i < at + sizeof *given);
    free(y.data);
    free(x.data);
    return same;
}

/* Whether two meshes have the same facets of the same vertices, whatever the last bits of those. */
static bool same_facets(const pir_mesh *a, const pir_mesh *b) {
    bool same =
        pir_mesh_vertex_count(a) == pir_mesh_vertex_count(b) && pir_mesh_facet_count(a) == pir_mesh_facet_count(b);
    for (uint32_t v = 0; same && v < pir_mesh_vertex_count(a); v++) {
        uint32_t pair[2][2];
        pir_mesh_pair(a, v, pair[0]);
        pir_mesh_pair(b, v, pair[1]);
        same = memcmp(pair[0], pair[1], sizeof *pair) == 0;
    }
    for (uint32_t f = 0; same && f < pir_mesh_facet_count(a); f++) {
        uint32_t count[2];
        const uint32_t *of_a = pir_mesh_facet(a, f, &count[0]), *of_b = pir_mesh_facet(b, f, &count[1]);
        same = count[0] == count[1] && memcmp(of_a, of_b, count[0] * sizeof *of_a) == 0;
    }
    return same;
}

static bool same_mesh(pir_sum *a, pir_sum *b, bool bits) {
    pir_mesh *of_a = NULL, *of_b = NULL;
    assert_int_equal(pir_sum_mesh(a, PIR_DOUBLE, &of_a), PIR_OK);
    assert_int_equal(pir_sum_mesh(b, PIR_DOUBLE, &of_b), PIR_OK);
    bool same = bits ? pir_mesh_equal(of_a, of_b) && test_hash_mesh(0, of_a) == test_hash_mesh(0, of_b)
                     : same_facets(of_a, of_b);
    pir_mesh_destroy(of_b);
    pir_mesh_destroy(of_a);
    return same;
}

/* NULL, or in what two sums differ. bits: the lengths of their quaternions are a power of two apart. */
static const char *compare(pir_sum *a, pir_sum *b, bool bits) {
    if (test_hash_pairing(0, a) != test_hash_pairing(0, b))
        return "pairings differ";
    if (!pir_sum_same_pairing(a, b))
        return "pairings are told apart";
    if (pir_sum_serialised_size(a) != pir_sum_serialised_size(b))
        return "sizes of files differ";
    if (!same_mesh(a, b, bits))
        return "meshes differ";
    return bits && !same_file(a, b) ? "files differ" : NULL;
}

/* --- sums --- */

/* A sum that came from elsewhere by one of the methods, or by brute force. */
static pir_sum *led_sum(test_random *random, pir_polytope *p, pir_polytope *q, pir_quat rotation, int difference) {
    uint32_t way = test_random_below(random, 5);
    pir_sum *sum = new_sum(p, q, test_integer_rotation(random), difference);
    if (way == 4)
        assert_int_equal(pir_sum_rotate_brute_force(sum, rotation), PIR_OK);
    else
        assert_int_equal(pir_sum_rotate(sum, rotation, (pir_method)way), PIR_OK);
    return sum;
}

static void multiples_of_a_quaternion_have_one_sum(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 1500; i++) {
        test_random random = test_random_case("one rotation", i);
        pir_polytope *p, *q;
        aligned_bodies(&random, &p, &q);
        pir_quat rotation = test_integer_rotation(&random);
        int difference = (int)(i % 2);
        pir_sum *sum = new_sum(p, q, rotation, difference);
        for (int k = 0; k < FACTORS; k++) {
            pir_quat given = times(rotation, factors[k]);
            pir_sum *made = new_sum(p, q, given, difference), *led = led_sum(&random, p, q, given, difference);
            const char *wrong = compare(sum, made, k < POWERS);
            if (!wrong)
                wrong = compare(sum, led, k < POWERS);
            expect(!wrong, "case %llu, factor %g: %s", (unsigned long long)i, factors[k], wrong);
            pir_sum_destroy(led);
            pir_sum_destroy(made);
        }
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

/* Denormal and huge quaternions, and such of mixed magnitude, have negatives too. */
static void negative_of_a_hard_quaternion_has_one_sum(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 40 * TEST_HARD_ROTATIONS; i++) {
        test_random random = test_random_case("one hard rotation", i);
        pir_polytope *p, *q;
        aligned_bodies(&random, &p, &q);
        pir_quat rotation = test_hard_rotation((uint32_t)i);
        pir_sum *sum = new_sum(p, q, rotation, 0), *other = led_sum(&random, p, q, times(rotation, -1), 0);
        const char *wrong = compare(sum, other, true);
        expect(!wrong, "case %llu: %s", (unsigned long long)i, wrong);
        pir_sum_destroy(other);
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

/* A pose in the world turns both bodies: the relative rotation takes the sign of the product. */
static void relative_rotation_has_one_sum(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 600; i++) {
        test_random random = test_random_case("one relative rotation", i);
        pir_polytope *p, *q;
        aligned_bodies(&random, &p, &q);
        pir_quat of_p = test_integer_rotation(&random), of_q = test_integer_rotation(&random);
        pir_quat inverse = {-of_q.x, -of_q.y, -of_q.z, of_q.w};
        pir_sum *sum = new_sum(p, q, test_compose(inverse, of_p, 0), 0), *relative = new_sum(p, q, identity, 0);
        for (int k = 0; k < FACTORS; k++) {
            double of_both = factors[test_random_below(&random, FACTORS)];
            assert_int_equal(pir_sum_turn_relative(relative, times(of_q, factors[k]), times(of_p, of_both)), PIR_OK);
            expect(test_hash_pairing(0, sum) == test_hash_pairing(0, relative), "case %llu, factors %g and %g",
                   (unsigned long long)i, factors[k], of_both);
        }
        pir_sum_destroy(relative);
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

/* --- what stands on sums --- */

static bool same_list(const pir_sum_pair *a, uint32_t count_a, const pir_sum_pair *b, uint32_t count_b) {
    bool same = count_a == count_b;
    for (uint32_t i = 0; same && i < count_a; i++)
        same = a[i].kind == b[i].kind && a[i].p == b[i].p && a[i].q == b[i].q;
    return same;
}

/* Whether two live meshes tell the same of a refresh, and have the same vertices and planes to the bit. */
static bool same_live(pir_live_mesh *a, pir_live_mesh *b) {
    uint32_t count[4], slots = pir_live_mesh_facet_slots(a), vertices = pir_live_mesh_vertex_slots(a);
    const pir_sum_pair *came[2] = {pir_live_mesh_appeared(a, &count[0]), pir_live_mesh_appeared(b, &count[1])};
    const pir_sum_pair *left[2] = {pir_live_mesh_disappeared(a, &count[2]), pir_live_mesh_disappeared(b, &count[3])};
    bool same = same_list(came[0], count[0], came[1], count[1]) && same_list(left[0], count[2], left[1], count[3]) &&
                slots == pir_live_mesh_facet_slots(b) && vertices == pir_live_mesh_vertex_slots(b);
    if (!same)
        return false;
    pir_plane_equation *plane = calloc(2 * (size_t)slots + 1, sizeof *plane);
    pir_vec3 *vertex = calloc(2 * (size_t)vertices + 1, sizeof *vertex);
    assert_true(plane && vertex);
    pir_live_mesh_planes(a, plane);
    pir_live_mesh_planes(b, plane + slots);
    pir_live_mesh_vertices(a, vertex);
    pir_live_mesh_vertices(b, vertex + vertices);
    same = memcmp(plane, plane + slots, slots * sizeof *plane) == 0 &&
           memcmp(vertex, vertex + vertices, vertices * sizeof *vertex) == 0;
    free(vertex);
    free(plane);
    return same;
}

/* A region and a live mesh follow two sums, of which one is given the quaternions and the other their negatives. */
static void regions_and_live_meshes_follow_either_sign(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 300; i++) {
        test_random random = test_random_case("one rotation, live", i);
        pir_polytope *p, *q;
        aligned_bodies(&random, &p, &q);
        pir_sum *sum[2];
        pir_live_mesh *live[2];
        pir_vec3 axis = test_random_direction(&random);
        for (int k = 0; k < 2; k++) {
            sum[k] = new_sum(p, q, times(identity, k ? -1 : 1), 0);
            assert_int_equal(pir_live_mesh_create(sum[k], &live[k]), PIR_OK);
            if (i % 3 == 0)
                assert_int_equal(pir_sum_set_region(sum[k], axis, 0.7), PIR_OK);
        }
        for (int frame = 0; frame < 30; frame++) {
            pir_quat at = test_integer_rotation(&random);
            pir_method method = (pir_method)test_random_below(&random, 4);
            for (int k = 0; k < 2; k++) {
                assert_int_equal(pir_sum_rotate(sum[k], times(at, k ? -1 : 1), method), PIR_OK);
                assert_int_equal(pir_live_mesh_refresh(live[k]), PIR_OK);
            }
            const char *wrong = compare(sum[0], sum[1], true);
            expect(!wrong, "case %llu, frame %d: %s", (unsigned long long)i, frame, wrong);
            expect(same_live(live[0], live[1]), "case %llu, frame %d", (unsigned long long)i, frame);
        }
        for (int k = 0; k < 2; k++) {
            pir_live_mesh_destroy(live[k]);
            pir_sum_destroy(sum[k]);
        }
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

static void maps_have_one_rotation(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 200; i++) {
        test_random random = test_random_case("one rotation, maps", i);
        pir_polytope *p, *q;
        aligned_bodies(&random, &p, &q);
        pir_quat rotation = test_integer_rotation(&random);
        uint64_t hash[2];
        for (int k = 0; k < 2; k++) {
            pir_cgm *map = NULL;
            pir_mesh *mesh = NULL;
            pir_quat given = times(rotation, k ? factors[i % POWERS] : 1);
            assert_int_equal(pir_cgm_create(p, &given, NULL, &map), PIR_OK);
            assert_int_equal(pir_cgm_mesh(map, PIR_DOUBLE, &mesh), PIR_OK);
            hash[k] = test_hash_mesh(pir_cgm_total_counts(map).halfedges, mesh);
            pir_mesh_destroy(mesh);
            pir_cgm_release(map);
        }
        expect(hash[0] == hash[1], "case %llu", (unsigned long long)i);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

/* --- answers --- */

#define CONTACTS 32

/* The signed distance and the contacts of a new pair. */
static pir_query_result ask_pair(pir_polytope *p, pir_polytope *q, const pir_pair_input *input, pir_contact *contacts,
                                 size_t *ret_count) {
    pir_workspace *workspace = NULL;
    pir_pair *pair = NULL;
    pir_query_result result = {0};
    memset(contacts, 0, CONTACTS * sizeof *contacts);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, q, NULL, &pair), PIR_OK);
    assert_int_equal(pir_pair_signed_distance(pair, workspace, input, &result), PIR_OK);
    assert_int_equal(pir_pair_manifold(pair, workspace, input, &result, CONTACTS, contacts, ret_count), PIR_OK);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    return result;
}

static bool same_contacts(const pir_contact *a, size_t count_a, const pir_contact *b, size_t count_b) {
    bool same = count_a == count_b;
    for (size_t i = 0; same && i < count_a && i < CONTACTS; i++)
        same = memcmp(&a[i].point_p, &b[i].point_p, sizeof a[i].point_p) == 0 &&
               memcmp(&a[i].point_q, &b[i].point_q, sizeof a[i].point_q) == 0;
    return same;
}

/* Poses of small integers, at which bodies touch, and pairs whose Q is turned by any quaternion of the identity. */
static void pairs_answer_either_sign_alike(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 2000; i++) {
        test_random random = test_random_case("one rotation, pairs", i);
        pir_polytope *p, *q;
        aligned_bodies(&random, &p, &q);
        pir_pair_input input = pir_pair_input_default();
        pir_contact contacts[2][CONTACTS];
        size_t count[2];
        input.margin = 0.25;
        input.pose_p.rotation = test_integer_rotation(&random);
        if (i % 3)
            input.pose_q.rotation = test_integer_rotation(&random);
        input.pose_p.translation = (pir_vec3){test_random_between(&random, -3, 3), test_random_between(&random, -3, 3),
                                              test_random_between(&random, -3, 3)};
        pir_query_result one = ask_pair(p, q, &input, contacts[0], &count[0]);
        double of_p = factors[test_random_below(&random, POWERS)], of_q = factors[test_random_below(&random, POWERS)];
        input.pose_p.rotation = times(input.pose_p.rotation, of_p);
        input.pose_q.rotation = times(input.pose_q.rotation, of_q);
        pir_query_result other = ask_pair(p, q, &input, contacts[1], &count[1]);
        expect(test_same_result(&one, &other), "case %llu, factors %g and %g", (unsigned long long)i, of_p, of_q);
        expect(same_contacts(contacts[0], count[0], contacts[1], count[1]), "case %llu, factors %g and %g",
               (unsigned long long)i, of_p, of_q);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

static void queries_answer_either_sign_alike(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 1000; i++) {
        test_random random = test_random_case("one rotation, queries", i);
        pir_polytope *p, *q;
        aligned_bodies(&random, &p, &q);
        pir_quat rotation = test_integer_rotation(&random);
        pir_query_input input = pir_query_input_default();
        pir_query_result result[2];
        input.translation = (pir_vec3){test_random_between(&random, -3, 3), test_random_between(&random, -3, 3),
                                       test_random_between(&random, -3, 3)};
        for (int k = 0; k < 2; k++) {
            pir_sum *sum = new_sum(p, q, times(rotation, k ? factors[i % POWERS] : 1), 1);
            pir_query *query = NULL;
            assert_int_equal(pir_query_create(sum, &query), PIR_OK);
            assert_int_equal(pir_query_signed_distance(query, &input, NULL, &result[k]), PIR_OK);
            pir_query_destroy(query);
            pir_sum_destroy(sum);
        }
        expect(test_same_result(&result[0], &result[1]), "case %llu", (unsigned long long)i);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

/* --- motions --- */

/* Divides a quaternion of integers by their greatest common divisor. */
static pir_quat primitive(pir_quat q) {
    const double c[4] = {q.x, q.y, q.z, q.w};
    long long divisor = 0;
    for (int k = 0; k < 4; k++)
        for (long long rest = llabs((long long)c[k]); rest != 0;) {
            long long next = divisor % rest;
            divisor = rest;
            rest = next;
        }
    return (pir_quat){q.x / (double)divisor, q.y / (double)divisor, q.z / (double)divisor, q.w / (double)divisor};
}

/* By quarter, third and half turns, of quaternions that only grow; a new sum is given the least of them. */
static void body_led_by_quarter_turns_is_a_new_one(void **state) {
    (void)state;
    static const pir_quat turns[] = {{1, 0, 0, 1}, {0, 1, 0, 1},  {0, 0, 1, 1}, {0, 0, -1, 1},
                                     {1, 1, 1, 1}, {-1, 1, 1, 1}, {1, 0, 0, 0}, {0, 1, 1, 0}};
    for (uint64_t i = 0; i < 300; i++) {
        test_random random = test_random_case("quarter turns", i);
        pir_polytope *p, *q;
        aligned_bodies(&random, &p, &q);
        pir_sum *led = new_sum(p, q, identity, 0);
        pir_quat r = identity;
        for (int frame = 0; frame < 30; frame++) {
            r = test_compose(turns[i % 4 == 0 ? i / 4 % 8 : test_random_below(&random, 8)], r, 0);
            assert_int_equal(pir_sum_rotate(led, r, frame % 5 ? PIR_METHOD_UPDATE : PIR_METHOD_AUTO), PIR_OK);
            pir_sum *new = new_sum(p, q, times(primitive(r), test_random_below(&random, 2) ? 1 : -1), 0);
            const char *wrong = compare(led, new, false);
            expect(!wrong, "case %llu, frame %d: %s", (unsigned long long)i, frame, wrong);
            pir_sum_destroy(new);
        }
        pir_sum_destroy(led);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

/* Four quarter turns end at a negative multiple of the first quaternion; so does a motion to (0, 0, 0, −1). */
static void cube_led_to_the_negative_identity_is_a_new_one(void **state) {
    (void)state;
    static const pir_quat quarters[] = {{0, 0, 1, 1}, {1, 0, 0, 1}, {0, -1, 0, 1}};
    static const test_points cube = {
        8, {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 1, 1}, {1, 0, 0}, {1, 0, 1}, {1, 1, 0}, {1, 1, 1}}};
    pir_polytope *p = test_polytope(&cube);
    pir_sum *new = new_sum(p, p, identity, 0);
    for (size_t k = 0; k < sizeof quarters / sizeof *quarters; k++) {
        pir_sum *led = new_sum(p, p, identity, 0);
        pir_quat r = identity;
        for (int frame = 0; frame < 4; frame++) {
            r = test_compose(quarters[k], r, 0);
            assert_int_equal(pir_sum_rotate(led, r, PIR_METHOD_UPDATE), PIR_OK);
        }
        assert_true(r.x == 0 && r.y == 0 && r.z == 0 && r.w == -4);
        const char *wrong = compare(new, led, true);
        expect(!wrong, "axis %zu: %s", k, wrong);
        assert_int_equal(pir_sum_rotate(led, (pir_quat){0, 0, 0, -1}, PIR_METHOD_UPDATE), PIR_OK);
        wrong = compare(new, led, true);
        expect(!wrong, "axis %zu: %s", k, wrong);
        pir_sum_destroy(led);
    }
    pir_sum_destroy(new);
    pir_polytope_release(p);
}

/* Motions that go through the half turns, where the sign of the quaternion changes, about an axis of symmetry. */
struct passage {
    int axis;          /* of the motion */
    double step, part; /* an angle, and how far before the half turn the motion begins, in steps */
    pir_quat from;     /* the rotation before it */
    bool sideways;     /* the half turns themselves go round, about x, y and back to −x: w stays 0 */
};

static pir_quat passage_at(const struct passage *passage, int frame) {
    double angle = 1.5707963267948966 + passage->step * (frame - passage->part), c = cos(angle), s = sin(angle);
    if (frame == passage->part) {
        c = 0;
        s = 1;
    }
    double v[3] = {0, 0, 0}, w = passage->sideways ? 0 : c;
    v[passage->axis] = s;
    if (passage->sideways)
        v[(passage->axis + 1) % 3] = c;
    return test_compose((pir_quat){v[0], v[1], v[2], w}, passage->from, 0);
}

/*
 * Facets across the axis tie in every frame, and their perturbed signs change with that of the quaternion. One sum is
 * given the quaternions, a second any of their signs, and a third has a region.
 */
static void ties_that_last_are_tracked_through_a_half_turn(void **state) {
    (void)state;
    static const double steps[] = {0.15, 0.02, 1e-3, 1e-7, 1e-12};
    for (uint64_t i = 0; i < 400; i++) {
        test_random random = test_random_case("half turns", i);
        pir_polytope *p, *q;
        aligned_bodies(&random, &p, &q);
        struct passage passage = {.axis = (int)test_random_below(&random, 3),
                                  .step = steps[test_random_below(&random, 5)],
                                  .part = test_random_between(&random, 3, 15) - (i % 2 ? 0.5 : 0),
                                  .from = i % 3 ? test_integer_rotation(&random) : identity,
                                  .sideways = i % 4 == 1};
        pir_vec3 axis = test_random_direction(&random);
        pir_sum *sums[3];
        for (int k = 0; k < 3; k++)
            sums[k] = new_sum(p, q, passage_at(&passage, 0), 0);
        assert_int_equal(pir_sum_set_region(sums[2], axis, 1), PIR_OK);
        for (int frame = 1; frame < 30; frame++) {
            // to and fro across the half turn, now and then
            int at = i % 5 == 0 && frame % 7 > 3 ? 20 - frame : frame;
            pir_quat r = passage_at(&passage, at);
            pir_sum *new = new_sum(p, q, r, 0);
            assert_int_equal(pir_sum_rotate(sums[0], r, PIR_METHOD_UPDATE), PIR_OK);
            assert_int_equal(pir_sum_rotate(sums[1], times(r, test_random_below(&random, 2) ? 1 : -1),
                                            test_random_below(&random, 4) ? PIR_METHOD_UPDATE : PIR_METHOD_WALK),
                             PIR_OK);
            assert_int_equal(pir_sum_rotate(sums[2], r, PIR_METHOD_UPDATE), PIR_OK);
            for (int k = 0; k < 2; k++) {
                const char *wrong = compare(new, sums[k], true);
                expect(!wrong, "case %llu, sum %d, frame %d: %s", (unsigned long long)i, k, frame, wrong);
            }
            expect(pir_sum_is_valid(sums[2]) && pir_sum_same_pairing(sums[2], new), "case %llu, frame %d",
                   (unsigned long long)i, frame);
            pir_sum_destroy(new);
        }
        for (int k = 0; k < 3; k++)
            pir_sum_destroy(sums[k]);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(multiples_of_a_quaternion_have_one_sum),
        cmocka_unit_test(negative_of_a_hard_quaternion_has_one_sum),
        cmocka_unit_test(relative_rotation_has_one_sum),
        cmocka_unit_test(regions_and_live_meshes_follow_either_sign),
        cmocka_unit_test(maps_have_one_rotation),
        cmocka_unit_test(pairs_answer_either_sign_alike),
        cmocka_unit_test(queries_answer_either_sign_alike),
        cmocka_unit_test(body_led_by_quarter_turns_is_a_new_one),
        cmocka_unit_test(cube_led_to_the_negative_identity_is_a_new_one),
        cmocka_unit_test(ties_that_last_are_tracked_through_a_half_turn),
    };
    test_print_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
