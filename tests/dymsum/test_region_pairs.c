/* SPDX-License-Identifier: MIT */
/*
 * Regions against an oracle that knows none: every pair whose normal lies in the cone is in the sum, and no other pair
 * than those of the whole sum. The pairs are found by trying all vertices and all edges, in integers. A third of the
 * bodies have arcs of half a turn or nearly so: knife edges, plates, polygons, segments.
 *
 * PIR_TEST_REGIONS in the environment says how many regions are tried.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/sum.h>

#include "dymsum/region/cover.h"
#include "oracle/perturbed.h"
#include "support/bodies.h"
#include "support/vectors.h"

/* Regions tried on one pose, of which each starts from nothing or from the one before. */
#define AT_A_POSE 10

/* A normal is in the cone or out of it by more than this in the cosine, or the case is left open. */
#define MARGIN 1e-9

/* Two operands, and the pairs of their sum at one rotation. */
struct pairs {
    pir_polytope *p, *q;
    const pir_polytope *of_p; /* as the sum has it: reflected in a difference */
    oracle_pairing all;
    pir_vec3 *normal_p; /* of the facets of P, turned */
    uint32_t *listed;   /* per pair of edges: 1 + its number in `all`, or 0 */
    uint32_t *seen;     /* per pair of `all`: the last region that had it */
    uint32_t regions, partial;
};

static pir_vec3 unit(pir_vec3 v) {
    return test_add(test_zero, v, 1 / test_length(v));
}

static uint32_t *new_numbers(size_t count) {
    uint32_t *numbers = calloc(count + 1, sizeof *numbers);
    assert_non_null(numbers);
    return numbers;
}

static void pairs_init(struct pairs *pairs, const pir_sum *sum, pir_quat rotation) {
    const pir_polytope *p = pairs->of_p = pir_sum_p(sum);
    uint32_t edges_q = pir_polytope_edge_count(pairs->q), facets = pir_polytope_facet_count(p);
    oracle_pairing_init(&pairs->all, p, pairs->q, rotation);
    pairs->listed = new_numbers((size_t)pir_polytope_edge_count(p) * edges_q);
    pairs->seen = new_numbers(pairs->all.count);
    pairs->normal_p = calloc((size_t)facets + 1, sizeof *pairs->normal_p);
    assert_non_null(pairs->normal_p);
    for (uint32_t i = 0; i < pairs->all.count; i++)
        pairs->listed[(size_t)pairs->all.ee[i].p * edges_q + pairs->all.ee[i].q] = i + 1;
    for (uint32_t f = 0; f < facets; f++)
        pairs->normal_p[f] = test_turn(rotation, pir_polytope_normal(p, f), 1);
}

static void pairs_clear(struct pairs *pairs) {
    free(pairs->normal_p);
    free(pairs->seen);
    free(pairs->listed);
    oracle_pairing_clear(&pairs->all);
}

/* --- the check --- */

static const char *check_cells(const uint32_t *cell, const uint32_t *all, uint32_t count, const pir_vec3 *normal,
                               pir_vec3 axis, double half_angle) {
    for (uint32_t i = 0; i < count; i++) {
        if (cell[i] != PIR_NO_PAIR && cell[i] != all[i])
            return "a facet with a wrong vertex";
        if (cell[i] == PIR_NO_PAIR && test_dot(axis, normal[i]) > cos(half_angle) + MARGIN)
            return "a facet in the cone without a vertex";
    }
    return NULL;
}

static const char *check_edges(struct pairs *pairs, const pir_sum *sum, pir_vec3 axis, double half_angle) {
    uint32_t count = pir_sum_ee_count(sum), edges_q = pir_polytope_edge_count(pairs->q);
    uint32_t(*ee)[2] = calloc((size_t)count + 1, sizeof *ee);
    const char *wrong = NULL;
    assert_non_null(ee);
    pir_sum_ee(sum, ee);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = pairs->listed[(size_t)ee[i][0] * edges_q + ee[i][1]];
        if (at == 0 || pairs->seen[at - 1] == pairs->regions)
            wrong = "a pair of edges that is none, or is there twice";
        else
            pairs->seen[at - 1] = pairs->regions;
    }
    pairs->partial += count < pairs->all.count;
    for (uint32_t i = 0; i < pairs->all.count; i++) {
        const pir_vec3 n = pairs->all.ee[i].normal;
        double length = test_length(n);
        if (length > 0 && test_dot(axis, n) > (cos(half_angle) + MARGIN) * length && pairs->seen[i] != pairs->regions)
            wrong = "a pair of edges in the cone is missing";
    }
    free(ee);
    return wrong;
}

/* Whether the sum with this region has all pairs of the cone, and none that is no pair. */
static const char *check_pairs(struct pairs *pairs, pir_sum *sum, pir_vec3 axis, double half_angle) {
    uint32_t of_q = pir_polytope_facet_count(pairs->q);
    pir_vec3 *normal_q = calloc((size_t)of_q + 1, sizeof *normal_q);
    assert_non_null(normal_q);
    for (uint32_t g = 0; g < of_q; g++)
        normal_q[g] = pir_polytope_normal(pairs->q, g);
    pairs->regions++;
    const char *wrong = check_cells(pir_sum_fv(sum), pairs->all.fv, pir_polytope_facet_count(pairs->of_p),
                                    pairs->normal_p, axis, half_angle);
    if (!wrong)
        wrong = check_cells(pir_sum_vf(sum), pairs->all.vf, of_q, normal_q, axis, half_angle);
    if (!wrong)
        wrong = check_edges(pairs, sum, axis, half_angle);
    if (!wrong && !pir_sum_is_valid(sum))
        wrong = "not valid";
    free(normal_q);
    return wrong;
}

/* --- what is tried --- */

/* A body whose Gaussian map has long arcs: pressed flat, so that an edge of its rim is like a knife's, or flat. */
static void thin_body(test_random *random, test_points *points) {
    static const test_body bodies[] = {TEST_SPHERE, TEST_SPHERE, TEST_SPHERE,  TEST_GRID,
                                       TEST_PRISM,  TEST_SPHERE, TEST_POLYGON, TEST_SEGMENT};
    test_body body = bodies[test_random_below(random, 8)];
    test_body_points(random, body, 4 + test_random_below(random, 21), points);
    if (body >= TEST_POLYGON)
        return;
    double thick = ldexp(1, -test_random_between(random, 4, 50)), far = test_random_below(random, 3) ? 0 : 100;
    uint32_t across = test_random_below(random, 3);
    for (size_t i = 0; i < points->count; i++) {
        pir_vec3 v = {points->at[i].x + far, points->at[i].y, thick * points->at[i].z};
        points->at[i] = across == 0 ? v : across == 1 ? (pir_vec3){v.z, v.x, v.y} : (pir_vec3){v.y, v.z, v.x};
    }
}

static pir_quat some_rotation(test_random *random) {
    return test_random_below(random, 2) ? test_integer_rotation(random) : test_general_rotation(random);
}

static void some_pose(test_random *random, uint64_t number, test_pose *pose) {
    if (number % 3 == 0) {
        pose->situation = "long arcs";
        thin_body(random, &pose->p);
        if (number % 2)
            thin_body(random, &pose->q);
        else
            test_body_points(random, (test_body)test_random_below(random, TEST_BODY_COUNT), 14, &pose->q);
    } else if (number % 3 == 1) {
        test_random_pose(random, 12, pose);
    } else {
        pose->situation = "two balls";
        test_body_points(random, TEST_BALL, 24, &pose->p);
        test_body_points(random, TEST_SPHERE, 14, &pose->q);
    }
    pose->rotation = some_rotation(random);
}

/* An axis: any, along the frame, along or against the normal of a pair, or across it. */
static pir_vec3 some_axis(test_random *random, const struct pairs *pairs) {
    static const pir_vec3 along[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    uint32_t kind = test_random_below(random, 5), facets = pir_polytope_facet_count(pairs->of_p);
    pir_vec3 any = test_random_direction(random), n = any;
    if (kind == 0)
        n = along[test_random_below(random, 6)];
    else if (kind == 1 && facets > 0)
        n = pairs->normal_p[test_random_below(random, facets)];
    else if (kind == 2 && pairs->all.count > 0)
        n = pairs->all.ee[test_random_below(random, pairs->all.count)].normal;
    if (test_random_below(random, 3) == 0)
        n = test_cross(n, any);
    return unit(test_length(n) > 0 ? n : any);
}

static double some_half_angle(test_random *random) {
    static const double sizes[] = {0, 1e-6, 0.01, 0.3, 0.6, 1, 1.5707963267948966, 2, 3, 3.1415926, 3.1415926535897931};
    return test_random_below(random, 2) ? sizes[test_random_below(random, 11)] : 1.6 + 1.5 * test_random_unit(random);
}

/* A sum at the rotation with a region: made there, or led there from elsewhere with a region. */
static pir_sum *lead(test_random *random, const struct pairs *pairs, int difference, pir_quat rotation, pir_vec3 axis,
                     double half_angle) {
    static const pir_method ways[] = {PIR_METHOD_UPDATE, PIR_METHOD_UPDATE, PIR_METHOD_WALK, PIR_METHOD_CGM};
    pir_sum_options options = pir_sum_options_default();
    options.difference = difference;
    bool led = test_random_below(random, 2);
    pir_sum *sum = NULL;
    assert_int_equal(pir_sum_create(pairs->p, pairs->q, led ? some_rotation(random) : rotation, &options, &sum),
                     PIR_OK);
    assert_int_equal(pir_sum_set_region(sum, axis, half_angle), PIR_OK);
    if (led)
        assert_int_equal(pir_sum_rotate(sum, rotation, ways[test_random_below(random, 4)]), PIR_OK);
    return sum;
}

static void try_pose(uint64_t number, uint32_t *regions, uint32_t *partial) {
    test_random random = test_random_case("region pairs", number);
    test_pose pose;
    some_pose(&random, number, &pose);
    struct pairs pairs = {.p = test_polytope(&pose.p), .q = test_polytope(&pose.q)};
    // the one pair of two segments has two facets
    if (pir_polytope_dimension(pairs.p) < 2 && pir_polytope_dimension(pairs.q) < 2) {
        pir_polytope_release(pairs.q);
        pairs.q = test_random_polytope(&random, TEST_BOX, 8);
    }
    int difference = (int)test_random_below(&random, 2);
    pir_sum_options options = pir_sum_options_default();
    options.difference = difference;
    pir_sum *whole = NULL, *sum = NULL;
    assert_int_equal(pir_sum_create(pairs.p, pairs.q, pose.rotation, &options, &whole), PIR_OK);
    pairs_init(&pairs, whole, pose.rotation);
    for (int i = 0; i < AT_A_POSE; i++) {
        pir_vec3 axis = some_axis(&random, &pairs);
        double half_angle = some_half_angle(&random);
        if (!sum || test_random_below(&random, 2)) {
            pir_sum_destroy(sum);
            sum = lead(&random, &pairs, difference, pose.rotation, axis, half_angle);
        } else {
            assert_int_equal(pir_sum_set_region(sum, axis, half_angle), PIR_OK);
        }
        const char *wrong = check_pairs(&pairs, sum, axis, half_angle);
        expect(!wrong, "case %llu, %s, region %d about %a, %a, %a by %a: %s", (unsigned long long)number,
               pose.situation, i, axis.x, axis.y, axis.z, half_angle, wrong);
    }
    *regions += pairs.regions;
    *partial += pairs.partial;
    pir_sum_destroy(sum);
    pairs_clear(&pairs);
    pir_sum_destroy(whole);
    pir_polytope_release(pairs.q);
    pir_polytope_release(pairs.p);
}

static void every_pair_whose_normal_is_in_the_cone_is_kept(void **state) {
    (void)state;
    const char *asked = getenv("PIR_TEST_REGIONS");
    uint64_t most = asked ? strtoull(asked, NULL, 10) : 40000;
    uint32_t regions = 0, partial = 0;
    for (uint64_t i = 0; regions < most; i++)
        try_pose(i, &regions, &partial);
    printf("# %u regions, %u of them with a part of the edge pairs\n", regions, partial);
    assert_true(partial > regions / 4);
}

/*
 * A body that is flat but for 2^-38: the arcs of its rim are nearly half a turn. Where all other arcs of a cluster lie
 * opposite the end that such an arc is known by, the cluster is still all of the sphere.
 */
static void arc_of_half_a_turn_among_arcs_at_its_far_end_is_kept(void **state) {
    (void)state;
    static const test_points bodies[] = {
        {5, {{0, 1, -1}, {5, 2, -3}, {8, 7, -2}, {-4, -1, 3}, {3, -6, 3}}},
        {7, {{-5, 1, -3}, {4, 4, -1}, {3, 5, -3}, {-6, 1, 1}, {6, -4, 1}, {7, 7, 0}, {5, -2, 0}}},
    };
    static const pir_vec3 axis[] = {{0, 1, 0}, {1, 0, 0}};
    const pir_quat rotation = {0, 0, 0, 1};
    test_random random = test_random_case("region half turns", 0);
    for (size_t i = 0; i < 2; i++) {
        test_points at = bodies[i];
        for (size_t k = 0; k < at.count; k++)
            at.at[k].z *= 0x1p-40;
        struct pairs pairs = {.p = test_polytope(&at), .q = test_random_polytope(&random, TEST_BOX, 8)};
        pir_sum *sum = NULL;
        assert_int_equal(pir_sum_create(pairs.p, pairs.q, rotation, NULL, &sum), PIR_OK);
        pairs_init(&pairs, sum, rotation);
        assert_int_equal(pir_sum_set_region(sum, axis[i], 0.6), PIR_OK);
        const char *wrong = check_pairs(&pairs, sum, axis[i], 0.6);
        expect(!wrong, "body %zu: %s", i, wrong);
        assert_true(pairs.partial > 0);
        pir_sum_destroy(sum);
        pairs_clear(&pairs);
        pir_polytope_release(pairs.q);
        pir_polytope_release(pairs.p);
    }
}

/* --- arcs --- */

/* The sum of two arcs of half a turn has a sine of −0; that of an arc and its supplement may be on either side. */
static void arcs_add_up_to_half_a_turn_at_most(void **state) {
    (void)state;
    const pir_arc none = {1, 0}, half = {-1, 0}, quarter = {0, 1};
    const pir_arc halves[] = {
        pir_arc_add(half, half), pir_arc_add(half, none), pir_arc_add(none, half), pir_arc_add(quarter, quarter),
        pir_arc_of(3.1416),      pir_arc_of(8),           pir_arc_of(1e300)};
    for (size_t i = 0; i < sizeof halves / sizeof *halves; i++)
        expect(halves[i].cosine == -1 && halves[i].sine == 0, "case %zu", i);
    assert_true(pir_arc_add(none, none).cosine == 1 && pir_arc_add(none, quarter).sine == 1);
    for (int i = 0; i <= 4000; i++)
        for (int j = 0; j <= 40; j++) {
            double a = 3.1415926535897931 * i / 4000, b = 3.1415926535897931 * j / 40, c = fmin(a + b, 4);
            pir_arc sum = pir_arc_add(pir_arc_of(a), pir_arc_of(b));
            assert_true(sum.sine >= 0);
            expect(fabs(sum.cosine - (c < 3.1415926535897931 ? cos(c) : -1)) < 1e-12, "%a + %a", a, b);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arcs_add_up_to_half_a_turn_at_most),
        cmocka_unit_test(arc_of_half_a_turn_among_arcs_at_its_far_end_is_kept),
        cmocka_unit_test(every_pair_whose_normal_is_in_the_cone_is_kept),
    };
    test_print_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
