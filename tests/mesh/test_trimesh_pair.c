/* SPDX-License-Identifier: MIT */
/*
 * Pairs of meshes against all pairs of triangles in rationals (oracle/triangles.h): state, the nearest two, the
 * farthest, and all within a distance; at poses in general, touching, coplanar and an ulp off, along motions and
 * after jumps. And meshes that contain each other, hostile ones, memory that runs out, threads that share a mesh.
 */
#include "support/test.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/trimesh_pair.h>

#include "mesh/mesh_models.h"
#include "mesh/pair/node_bounds.h"
#include "oracle/triangles.h"
#include "support/memory.h"

#define MOST 64

/* A small mesh, and its triangles at a pose in rationals. */
typedef struct body {
    pir_trimesh *mesh;
    uint32_t count, number[MOST];
    pir_vec3 corner[MOST][3];
    oracle_triangle exact[MOST];
} body;

static bool has_area(const pir_vec3 c[3]) {
    // exact where coordinates are small whole numbers or halves; elsewhere triangles are far from flat
    pir_vec3 u = {c[1].x - c[0].x, c[1].y - c[0].y, c[1].z - c[0].z};
    pir_vec3 v = {c[2].x - c[0].x, c[2].y - c[0].y, c[2].z - c[0].z};
    return u.y * v.z != u.z * v.y || u.z * v.x != u.x * v.z || u.x * v.y != u.y * v.x;
}

static void body_init(body *b, const mesh_arrays *arrays) {
    b->mesh = mesh_of(arrays, NULL);
    b->count = 0;
    for (uint32_t t = 0; t < arrays->triangles && b->count < MOST; t++) {
        pir_vec3 *c = b->corner[b->count];
        for (int k = 0; k < 3; k++)
            c[k] = arrays->vertex[arrays->triangle[t][k]];
        if (!has_area(c))
            continue;
        oracle_triangle_init(&b->exact[b->count]);
        b->number[b->count++] = t;
    }
}

static void body_place(body *b, pir_pose pose) {
    for (uint32_t i = 0; i < b->count; i++)
        oracle_triangle_place(&b->exact[i], b->corner[i], pose);
}

static void body_clear(body *b) {
    for (uint32_t i = 0; i < b->count; i++)
        oracle_triangle_clear(&b->exact[i]);
    pir_trimesh_release(b->mesh);
}

/* One of a few kinds of small meshes; whole numbers make ties, touching and coplanar triangles. */
static void some_body(test_random *random, uint64_t number, body *b) {
    mesh_arrays arrays;
    switch (number % 4) {
    case 0:
        arrays = mesh_soup(random, 1 + test_random_below(random, 6), 2, true);
        break;
    case 1:
        arrays = mesh_soup(random, 1 + test_random_below(random, 6), 2, false);
        break;
    case 2:
        arrays = mesh_bumpy_sphere(0, 0);
        break;
    default:
        arrays = mesh_plane(1 + (uint32_t)(number / 4 % 2));
    }
    // at least one triangle has an area
    arrays.vertex[0] = (pir_vec3){0, 0, 0};
    arrays.vertex[1] = (pir_vec3){1, 0, 0};
    arrays.vertex[2] = (pir_vec3){0, 1, number % 2 ? 0 : 1};
    body_init(b, &arrays);
    mesh_arrays_clear(&arrays);
}

static double off_by_an_ulp(test_random *random, double x) {
    switch (test_random_below(random, 4)) {
    case 0:
        return nextafter(x, 10);
    case 1:
        return nextafter(x, -10);
    default:
        return x;
    }
}

/* A pose in general; by whole numbers and quarter turns; the same an ulp off; or a step from the one before. */
static pir_pose some_pose(test_random *random, pir_pose before) {
    static const pir_quat turns[5] = {{0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}, {1, 1, 1, 1}, {0, 0, 3, 4}};
    pir_pose pose = before;
    uint32_t way = test_random_below(random, 4);
    if (way == 3) {
        pose.rotation.x += 0.02 * test_random_unit(random);
        pose.translation.y += 0.02 * test_random_unit(random);
    } else if (way == 0) {
        pir_vec3 d = test_random_direction(random);
        pose.rotation = (pir_quat){d.x, d.y, d.z, test_random_unit(random)};
        pose.translation =
            (pir_vec3){3 * test_random_unit(random), 3 * test_random_unit(random), 3 * test_random_unit(random)};
    } else {
        double t[3];
        pose.rotation = turns[test_random_below(random, 5)];
        for (int k = 0; k < 3; k++) {
            t[k] = 0.5 * test_random_between(random, -6, 6);
            t[k] = way == 2 ? off_by_an_ulp(random, t[k]) : t[k];
        }
        pose.translation = (pir_vec3){t[0], t[1], t[2]};
    }
    return pose;
}

/* --- one pose --- */

typedef struct truth {
    mpq_t least, most, square;
    uint32_t least_p, least_q, most_p, most_q;
} truth;

static void find_truth(truth *t, body *p, body *q) {
    bool any = false;
    for (uint32_t i = 0; i < p->count; i++)
        for (uint32_t j = 0; j < q->count; j++) {
            oracle_triangles_least(t->square, &p->exact[i], &q->exact[j]);
            if (!any || mpq_cmp(t->square, t->least) < 0) {
                mpq_set(t->least, t->square);
                t->least_p = p->number[i];
                t->least_q = q->number[j];
            }
            oracle_triangles_most(t->square, &p->exact[i], &q->exact[j]);
            if (!any || mpq_cmp(t->square, t->most) > 0) {
                mpq_set(t->most, t->square);
                t->most_p = p->number[i];
                t->most_q = q->number[j];
            }
            any = true;
        }
}

static void check_within(truth *t, pir_trimesh_pair *pair, body *p, body *q, const pir_within_input *input,
                         uint64_t number) {
    pir_triangle_pair pairs[MOST * MOST];
    size_t count, at = 0;
    assert_int_equal(pir_trimesh_pair_within(pair, input, MOST * MOST, pairs, &count), PIR_OK);
    mpq_t most;
    mpq_init(most);
    mpq_set_d(most, input->distance);
    mpq_mul(most, most, most);
    for (uint32_t i = 0; i < p->count; i++)
        for (uint32_t j = 0; j < q->count; j++) {
            oracle_triangles_least(t->square, &p->exact[i], &q->exact[j]);
            bool told = at < count && pairs[at].p == p->number[i] && pairs[at].q == q->number[j];
            expect(told == (mpq_cmp(t->square, most) <= 0), "pose %llu: triangles %u and %u within %.17g",
                   (unsigned long long)number, p->number[i], q->number[j], input->distance);
            at += told;
        }
    assert_int_equal(at, count);
    mpq_clear(most);
}

static double distance_of(pir_vec3 a, pir_vec3 b) {
    return sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

static void check_pose(truth *t, pir_trimesh_pair *pair, body *p, body *q, const pir_pose pose[2], uint64_t number) {
    body_place(p, pose[0]);
    body_place(q, pose[1]);
    find_truth(t, p, q);
    pir_trimesh_distance near, far;
    assert_int_equal(pir_trimesh_pair_nearest(pair, pose[0], pose[1], &near), PIR_OK);
    assert_int_equal(pir_trimesh_pair_farthest(pair, pose[0], pose[1], &far), PIR_OK);
    double least = sqrt(mpq_get_d(t->least)), most = sqrt(mpq_get_d(t->most));
    expect((near.state == PIR_TRIMESH_MEET) == (mpq_sgn(t->least) == 0) && near.triangle_p == t->least_p &&
               near.triangle_q == t->least_q,
           "pose %llu: state %d, triangles %u and %u at %.17g, not %u and %u at %.17g", (unsigned long long)number,
           near.state, near.triangle_p, near.triangle_q, near.distance, t->least_p, t->least_q, least);
    expect(fabs(near.distance - least) < 1e-13 && fabs(distance_of(near.point_p, near.point_q) - least) < 1e-12,
           "pose %llu: %.17g, points %.17g apart, not %.17g", (unsigned long long)number, near.distance,
           distance_of(near.point_p, near.point_q), least);
    expect(far.triangle_p == t->most_p && far.triangle_q == t->most_q && fabs(far.distance - most) < 1e-13,
           "pose %llu: farthest %u and %u at %.17g, not %u and %u at %.17g", (unsigned long long)number, far.triangle_p,
           far.triangle_q, far.distance, t->most_p, t->most_q, most);
    if (number % 4 == 0) {
        // what is exactly the distance is within it; a hair less is not
        pir_within_input input = {pose[0], pose[1], number % 8 == 0 ? least : 1.25 * least};
        check_within(t, pair, p, q, &input, number);
    }
}

static uint64_t count_of(const char *name, uint64_t usual) {
    const char *text = getenv(name);
    return text ? strtoull(text, NULL, 10) : usual;
}

/* Each pair of meshes is asked at several poses, so that fronts and warm starts are held to the truth too. */
static void NearestAndFarthestTrianglesAreExact(void **state) {
    (void)state;
    uint64_t poses = count_of("PIR_TEST_POSES", 300), first = count_of("PIR_TEST_FIRST", 0);
    truth t;
    mpq_inits(t.least, t.most, t.square, NULL);
    for (uint64_t number = first; number < first + poses;) {
        test_random random = test_random_case("mesh pairs", number);
        body p, q;
        some_body(&random, test_random_below(&random, 8), &p);
        some_body(&random, test_random_below(&random, 8), &q);
        pir_trimesh_pair *pair;
        assert_int_equal(pir_trimesh_pair_create(p.mesh, q.mesh, NULL, &pair), PIR_OK);
        pir_pose pose[2] = {pir_pose_identity(), pir_pose_identity()};
        for (int i = 0; i < 6; i++, number++) {
            pose[0] = some_pose(&random, pose[0]);
            pose[1] = i % 3 == 0 ? some_pose(&random, pose[1]) : pose[1];
            check_pose(&t, pair, &p, &q, pose, number);
        }
        pir_trimesh_pair_destroy(pair);
        body_clear(&p);
        body_clear(&q);
    }
    mpq_clears(t.least, t.most, t.square, NULL);
}

/* --- large meshes --- */

static pir_pose turned(double angle, double x) {
    return (pir_pose){{0.36 * sin(angle / 2), 0.48 * sin(angle / 2), 0.8 * sin(angle / 2), cos(angle / 2)},
                      {x, 0.1, 0}};
}

static bool same_bits(const pir_trimesh_distance *a, const pir_trimesh_distance *b) {
    return a->state == b->state && a->triangle_p == b->triangle_p && a->triangle_q == b->triangle_q &&
           memcmp(&a->distance, &b->distance, sizeof a->distance) == 0 &&
           memcmp(&a->point_p, &b->point_p, sizeof a->point_p) == 0 &&
           memcmp(&a->point_q, &b->point_q, sizeof a->point_q) == 0;
}

/* A pair that followed a motion, of steps small and large, apart and through each other, has the bits of a new one. */
static void AnswersDoNotDependOnHistory(void **state) {
    (void)state;
    mesh_arrays ball = mesh_bumpy_sphere(3, 0.15);
    pir_trimesh *mesh = mesh_of(&ball, NULL);
    pir_trimesh_pair *pair;
    assert_int_equal(pir_trimesh_pair_create(mesh, mesh, NULL, &pair), PIR_OK);
    double angle = 0, x = 2.6;
    bool met = false;
    for (int frame = 0; frame < 400; frame++) {
        angle += frame % 97 == 0 ? 1.3 : frame % 7 == 0 ? 0.1 : 0.003;
        x += frame < 200 ? -0.004 : frame % 50 == 0 ? 0.5 : 0.002;
        pir_trimesh_distance kept, fresh, kept_far, fresh_far;
        pir_trimesh_pair *other;
        assert_int_equal(pir_trimesh_pair_create(mesh, mesh, NULL, &other), PIR_OK);
        pir_pose p = turned(angle, x), q = turned(-0.3 * angle, 0);
        assert_int_equal(pir_trimesh_pair_nearest(pair, p, q, &kept), PIR_OK);
        assert_int_equal(pir_trimesh_pair_nearest(other, p, q, &fresh), PIR_OK);
        expect(same_bits(&kept, &fresh), "frame %d: %d %u %u %.17g, anew %d %u %u %.17g", frame, kept.state,
               kept.triangle_p, kept.triangle_q, kept.distance, fresh.state, fresh.triangle_p, fresh.triangle_q,
               fresh.distance);
        assert_int_equal(pir_trimesh_pair_farthest(pair, p, q, &kept_far), PIR_OK);
        assert_int_equal(pir_trimesh_pair_farthest(other, p, q, &fresh_far), PIR_OK);
        assert_true(same_bits(&kept_far, &fresh_far));
        met = met || kept.state == PIR_TRIMESH_MEET;
        pir_trimesh_pair_destroy(other);
    }
    assert_true(met);
    pir_trimesh_pair_destroy(pair);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&ball);
}

/* Whether lane `i` of some lanes is lane `j` of others, bit for bit. */
static bool same_lane(const pir_node_lanes *a, int i, const pir_node_lanes *b, int j) {
    bool same = a->inverse[i] == b->inverse[j] && a->low[i] == b->low[j] && a->high[i] == b->high[j];
    for (int k = 0; k < 3; k++)
        same = same && a->middle[k][i] == b->middle[k][j] && a->half[k][i] == b->half[k][j] &&
               a->normal[k][i] == b->normal[k][j];
    return same;
}

/* Children of nodes by all ways of reading them, and the box and slab that the node has, number by number. */
static void ItemsAreReadAlikeByAllWays(void **state) {
    (void)state;
    test_random random = test_random_case("items", 1);
    mesh_arrays ball = mesh_bumpy_sphere(3, 0.2);
    pir_trimesh *mesh = mesh_of(&ball, NULL);
    pir_mesh_item item[PIR_NODE_LANES] = {0, 0, 0, 0};
    for (uint32_t n = 0; n < mesh->tree.node_count; n++) {
        const pir_mesh_node *node = &mesh->tree.node[n];
        pir_node_lanes all, four, one;
        pir_node_lanes_set_node(&all, mesh, n);
        for (int i = 0; i < node->count; i++) {
            const int lane = (int)test_random_below(&random, PIR_NODE_LANES);
            item[lane] = n * PIR_MESH_WIDTH + (uint32_t)i; // others are of nodes before
            pir_node_lanes_set(&four, mesh, item);
            pir_node_lanes_set_one(&one, mesh, item[lane]);
            assert_true(same_lane(&four, lane, &one, 0) && same_lane(&one, 0, &one, 3) && same_lane(&all, i, &one, 0));
            assert_true(pir_item_size(mesh, item[lane]) == pir_lanes_size(&one)[0]);
            for (int k = 0; k < 3; k++) {
                const double low = (double)pir_mesh_bound(node, k, node->low[k][i]),
                             high = (double)pir_mesh_bound(node, k, node->high[k][i]), near = 0x1p-22;
                assert_true(fabs((double)one.middle[k][0] - (double)one.half[k][0] - low) < near);
                assert_true(fabs((double)one.middle[k][0] + (double)one.half[k][0] - high) < near);
                assert_true(one.normal[k][0] == (float)node->normal[k][i]);
            }
            assert_true(one.low[0] == node->slab_low[i] && one.high[0] == node->slab_high[i]);
        }
        for (int i = node->count; i < PIR_NODE_LANES; i++)
            assert_true(same_lane(&all, i, &all, 0));
    }
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&ball);
}

/* --- within each other --- */

static mesh_arrays scaled(mesh_arrays arrays, double by) {
    for (uint32_t v = 0; v < arrays.vertices; v++)
        arrays.vertex[v] = (pir_vec3){by * arrays.vertex[v].x, by * arrays.vertex[v].y, by * arrays.vertex[v].z};
    return arrays;
}

/* A small ball in a large one, whichever is P; beside it; straight above a vertex, an edge and within a plane. */
static void WhatIsWithinIsTold(void **state) {
    (void)state;
    mesh_arrays arrays[3] = {scaled(mesh_bumpy_sphere(2, 0), 3), scaled(mesh_bumpy_sphere(0, 0), 0.25), mesh_plane(1)};
    pir_trimesh *mesh[3];
    for (int i = 0; i < 3; i++)
        mesh[i] = mesh_of(&arrays[i], NULL);
    static const pir_vec3 at[6] = {{0, 0, 0}, {0.5, 0.5, 0}, {0.25, 0, 0}, {1, 1, 1}, {0, 0, 4}, {0.25, 0, -4}};
    for (int order = 0; order < 2; order++)
        for (int i = 0; i < 6; i++)
            for (int turn = 0; turn < 2; turn++) {
                pir_trimesh_pair *pair;
                assert_int_equal(pir_trimesh_pair_create(mesh[order], mesh[1 - order], NULL, &pair), PIR_OK);
                pir_pose small = {{0, 0, turn, 1}, at[i]}, large = pir_pose_identity();
                pir_trimesh_distance answer;
                assert_int_equal(pir_trimesh_pair_nearest(pair, order ? small : large, order ? large : small, &answer),
                                 PIR_OK);
                pir_trimesh_state inside = order ? PIR_TRIMESH_P_INSIDE : PIR_TRIMESH_Q_INSIDE;
                expect(answer.state == (i < 4 ? inside : PIR_TRIMESH_APART), "order %d, place %d: state %d", order, i,
                       answer.state);
                pir_trimesh_pair_destroy(pair);
            }
    // an open mesh is within nothing, and holds nothing
    pir_trimesh_pair *pair;
    pir_trimesh_distance answer;
    assert_int_equal(pir_trimesh_pair_create(mesh[2], mesh[0], NULL, &pair), PIR_OK);
    assert_int_equal(pir_trimesh_pair_nearest(pair, pir_pose_identity(), pir_pose_identity(), &answer), PIR_OK);
    assert_int_equal(answer.state, PIR_TRIMESH_APART);
    pir_trimesh_pair_destroy(pair);
    for (int i = 0; i < 3; i++) {
        pir_trimesh_release(mesh[i]);
        mesh_arrays_clear(&arrays[i]);
    }
}

/* --- hostile meshes, bad input, memory --- */

/* Fans whose points touch, and planes that lie on each other: very many pairs meet, and the lowest is found at once. */
static void MeshesThatMeetEverywhereAreAnsweredAtOnce(void **state) {
    (void)state;
    mesh_arrays arrays[2] = {mesh_fan(20000), mesh_plane(60)};
    for (int i = 0; i < 2; i++) {
        pir_trimesh *mesh = mesh_of(&arrays[i], NULL);
        pir_trimesh_pair *pair;
        assert_int_equal(pir_trimesh_pair_create(mesh, mesh, NULL, &pair), PIR_OK);
        pir_trimesh_distance answer;
        pir_pose mirrored = {{1, 0, 0, 0}, {0, 0, 0}};
        assert_int_equal(
            pir_trimesh_pair_nearest(pair, i == 0 ? mirrored : pir_pose_identity(), pir_pose_identity(), &answer),
            PIR_OK);
        assert_true(answer.state == PIR_TRIMESH_MEET && answer.triangle_p == 0 && answer.triangle_q == 0);
        assert_true(pir_trimesh_pair_get_statistics(pair).triangles < 10000);
        pir_trimesh_pair_destroy(pair);
        pir_trimesh_release(mesh);
        mesh_arrays_clear(&arrays[i]);
    }
}

static void WrongPosesAreRefused(void **state) {
    (void)state;
    mesh_arrays ball = mesh_bumpy_sphere(1, 0);
    pir_trimesh *mesh = mesh_of(&ball, NULL);
    pir_trimesh_pair *pair = NULL;
    assert_int_equal(pir_trimesh_pair_create(NULL, mesh, NULL, &pair), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_trimesh_pair_create(mesh, mesh, NULL, &pair), PIR_OK);
    pir_pose fine = pir_pose_identity(), zero = fine, nan = fine, far = fine;
    zero.rotation.w = 0;
    nan.translation.x = NAN;
    far.translation.z = 0x1p61;
    pir_trimesh_distance answer = {.triangle_p = 77};
    assert_int_equal(pir_trimesh_pair_nearest(pair, zero, fine, &answer), PIR_ERR_ZERO_QUATERNION);
    assert_int_equal(pir_trimesh_pair_nearest(pair, fine, nan, &answer), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_trimesh_pair_farthest(pair, far, fine, &answer), PIR_ERR_LIMIT);
    assert_int_equal(pir_trimesh_pair_nearest(pair, fine, fine, NULL), PIR_ERR_ARGUMENT);
    pir_within_input input = pir_within_input_default();
    size_t count = 9;
    input.distance = -1;
    assert_int_equal(pir_trimesh_pair_within(pair, &input, 0, NULL, &count), PIR_ERR_ARGUMENT);
    input.distance = NAN;
    assert_int_equal(pir_trimesh_pair_within(pair, &input, 0, NULL, &count), PIR_ERR_NOT_FINITE);
    input.distance = 1;
    assert_int_equal(pir_trimesh_pair_within(pair, &input, 1, NULL, &count), PIR_ERR_ARGUMENT);
    assert_true(answer.triangle_p == 77 && count == 9);
    input.distance = HUGE_VAL;
    assert_int_equal(pir_trimesh_pair_within(pair, &input, 0, NULL, &count), PIR_OK);
    assert_int_equal(count, 32 * 32);
    pir_trimesh_pair_destroy(pair);
    pir_trimesh_pair_destroy(NULL);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&ball);
}

/* Each request fails in turn; afterwards the pair answers as a new one. When it is warm nothing is requested. */
static void MemoryMayRunOutAtEveryRequest(void **state) {
    (void)state;
    mesh_arrays ball = mesh_bumpy_sphere(3, 0.1);
    pir_trimesh *mesh = mesh_of(&ball, NULL);
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_trimesh_pair_options options = pir_trimesh_pair_options_default();
    options.allocator = &allocator;
    pir_trimesh_distance want, got;
    for (uint64_t at = 1;; at++) {
        memory.requests = 0;
        memory.fail_at = at;
        pir_trimesh_pair *pair = NULL;
        pir_status status = pir_trimesh_pair_create(mesh, mesh, &options, &pair);
        if (status == PIR_OK)
            status = pir_trimesh_pair_nearest(pair, turned(0.1, 2.5), pir_pose_identity(), &got);
        bool failed = status == PIR_ERR_MEMORY;
        memory.fail_at = 0;
        if (pair) {
            assert_int_equal(pir_trimesh_pair_nearest(pair, turned(0.1, 2.5), pir_pose_identity(), &want), PIR_OK);
            assert_true(failed || same_bits(&want, &got));
        }
        pir_trimesh_pair_destroy(pair);
        assert_true(memory.blocks == 0 && !memory.wrong_size && !memory.overrun);
        if (!failed)
            break;
        assert_true(at < 100);
    }
    pir_trimesh_pair *pair;
    assert_int_equal(pir_trimesh_pair_create(mesh, mesh, &options, &pair), PIR_OK);
    for (int round = 0; round < 2; round++) {
        memory.requests = 0;
        for (int i = 0; i < 300; i++)
            assert_int_equal(pir_trimesh_pair_nearest(pair, turned(0.02 * i, 2.5), turned(0.013 * i, 0), &got), PIR_OK);
    }
    assert_int_equal(memory.requests, 0);
    pir_trimesh_pair_destroy(pair);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&ball);
}

/* --- threads --- */

typedef struct share {
    pir_trimesh *mesh;
    pir_trimesh_distance answer[60];
    pir_ray_hit hit[60];
} share;

static void *work(void *context) {
    share *s = context;
    pir_trimesh_pair *pair;
    if (pir_trimesh_pair_create(s->mesh, s->mesh, NULL, &pair) != PIR_OK)
        return NULL;
    for (int i = 0; i < 60; i++) {
        pir_surface_ray ray = {{3, 0.01 * i, 0.02 * i}, {-6, 0, 0}, PIR_RAY_BOTH};
        (void)pir_trimesh_pair_nearest(pair, turned(0.05 * i, 2.4), pir_pose_identity(), &s->answer[i]);
        (void)pir_surface_ray_nearest((pir_surface_ref){.mesh = s->mesh}, &ray, &s->hit[i]);
    }
    pir_trimesh_pair_destroy(pair);
    return s;
}

static void ThreadsThatShareAMeshGetTheSameBits(void **state) {
    (void)state;
    mesh_arrays ball = mesh_bumpy_sphere(3, 0.1);
    pir_trimesh *mesh = mesh_of(&ball, NULL);
    static share shares[7];
    uint32_t used = 0;
    for (uint32_t threads = 1; threads <= 4; threads *= 2) {
        pthread_t thread[4];
        for (uint32_t i = 0; i < threads; i++) {
            shares[used + i].mesh = mesh;
            assert_int_equal(pthread_create(&thread[i], NULL, work, &shares[used + i]), 0);
        }
        for (uint32_t i = 0; i < threads; i++) {
            void *done;
            pthread_join(thread[i], &done);
            assert_non_null(done);
        }
        used += threads;
    }
    for (uint32_t i = 1; i < used; i++)
        for (int k = 0; k < 60; k++)
            assert_true(same_bits(&shares[0].answer[k], &shares[i].answer[k]) &&
                        shares[0].hit[k].triangle == shares[i].hit[k].triangle);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&ball);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(NearestAndFarthestTrianglesAreExact),
        cmocka_unit_test(AnswersDoNotDependOnHistory),
        cmocka_unit_test(ItemsAreReadAlikeByAllWays),
        cmocka_unit_test(WhatIsWithinIsTold),
        cmocka_unit_test(MeshesThatMeetEverywhereAreAnsweredAtOnce),
        cmocka_unit_test(WrongPosesAreRefused),
        cmocka_unit_test(MemoryMayRunOutAtEveryRequest),
        cmocka_unit_test(ThreadsThatShareAMeshGetTheSameBits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
