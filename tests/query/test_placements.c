/* SPDX-License-Identifier: MIT */
/*
 * Queries against exact arithmetic, over random and degenerate bodies, rotations and translations: far, near, deep,
 * and on vertices, edges and facets of the difference. States must always agree, numbers within 1e-12 of the sizes.
 * One cache goes through all poses of a pair, and every answer must be the same without it.
 *
 * PIR_TEST_PAIRS in the environment sets the number of pairs.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/query.h>

#include "query/place_oracle.h"
#include "query/query_of.h"
#include "support/bodies.h"
#include "support/vectors.h"

#define POSES 24
#define BOUND 1e-12

static double length(pir_vec3 a) {
    return sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
}

/* A translation of one of many kinds, most of them hard. */
static pir_vec3 some_translation(test_random *random, const place_oracle *oracle) {
    double size = place_oracle_size(oracle);
    uint32_t index = (uint32_t)test_random_bits(random);
    pir_vec3 direction = test_random_direction(random), v = place_oracle_vertex(oracle, index);
    double step = ldexp(size, -test_random_between(random, 8, 56));
    switch (test_random_below(random, 8)) {
    case 0:
        return test_add(v, direction, 3 * size);
    case 1:
        return v;
    case 2:
        return place_oracle_on_facet(oracle, index);
    case 3:
        return place_oracle_on_edge(oracle, index);
    case 4:
        return test_add(place_oracle_on_facet(oracle, index), direction, step);
    case 5:
        return test_add(place_oracle_on_edge(oracle, index), direction, step);
    case 6: {
        // between two vertices: inside, often deep
        pir_vec3 w = place_oracle_vertex(oracle, (uint32_t)test_random_bits(random));
        return (pir_vec3){(v.x + w.x) / 2, (v.y + w.y) / 2, (v.z + w.z) / 2};
    }
    default:
        return test_add(v, direction, 0.3 * size * test_random_unit(random));
    }
}

static int same_answer(const pir_query_result *a, const pir_query_result *b) {
    return a->state == b->state && a->outcome == b->outcome;
}

static void check_pose(pir_query *query, place_oracle *oracle, pir_query_cache *cache, pir_vec3 t,
                       const char *situation, uint64_t number, pir_quat r0) {
    pir_query_input input = pir_query_input_default();
    input.translation = t;
    place_answer right = place_oracle_ask(oracle, t);
    pir_query_result warm, cold, overlap, depth, apart;
    pir_query_cache none = {0};
    assert_int_equal(pir_query_signed_distance(query, &input, cache, &warm), PIR_OK);
    assert_int_equal(pir_query_signed_distance(query, &input, &none, &cold), PIR_OK);
    assert_int_equal(pir_query_overlap(query, &input, cache, &overlap), PIR_OK);
    assert_int_equal(pir_query_penetration(query, &input, cache, &depth), PIR_OK);
    assert_int_equal(pir_query_distance(query, &input, NULL, &apart), PIR_OK);
    double size = place_oracle_size(oracle), reach = size + length(t), bound = BOUND * reach;
    const char *where = "%s, case %llu at (%.17g, %.17g, %.17g): state %d not %d, distance %.17g not %.17g, outcome "
                        "%d, size %g, rotation %.17g,%.17g,%.17g,%.17g";
    double should = right.state == PIR_OUTSIDE ? right.distance : right.state == PIR_INSIDE ? -right.depth : 0;
    const pir_query_result *all[3] = {&warm, &cold, right.state == PIR_INSIDE ? &depth : &apart};
    for (int i = 0; i < 3; i++) {
        expect(all[i]->state == right.state && fabs(all[i]->distance - should) <= bound &&
                   all[i]->outcome != PIR_STEP_LIMIT,
               where, situation, (unsigned long long)number, t.x, t.y, t.z, (int)all[i]->state, (int)right.state,
               all[i]->distance, should, (int)all[i]->outcome, size, r0.x, r0.y, r0.z, r0.w);
        const pir_query_result *r = all[i];
        // the answer's own invariant, and the normal as a proof of the number
        pir_vec3 end = test_add(r->point_q, r->normal, r->distance);
        pir_vec3 miss = test_add(r->point_p, end, -1);
        expect(length(miss) <= bound && fabs(length(r->normal) - 1) < 1e-14, where, situation,
               (unsigned long long)number, t.x, t.y, t.z, (int)r->state, (int)right.state, r->distance, should,
               (int)r->outcome, size, r0.x, r0.y, r0.z, r0.w);
        double slack = place_oracle_slack(oracle, t, r->normal);
        expect(fabs(slack + should) <= 2 * bound,
               "slack %.17g along the normal, not %.17g (%s, case %llu, t (%.17g, %.17g, %.17g), size %g)", slack,
               -should, situation, (unsigned long long)number, t.x, t.y, t.z, size);
        expect(r->witness.p.kind != PIR_FEATURE_NONE && r->witness.q.kind != PIR_FEATURE_NONE,
               "no witness (%s, case %llu)", situation, (unsigned long long)number);
    }
    expect(overlap.state == right.state, "overlap says %d, not %d (%s, case %llu)", (int)overlap.state,
           (int)right.state, situation, (unsigned long long)number);
    expect(same_answer(&warm, &cold), "warm and cold differ (%s, case %llu)", situation, (unsigned long long)number);
    if (right.state == PIR_INSIDE)
        expect(memcmp(&warm.normal, &cold.normal, sizeof warm.normal) == 0 && warm.distance == cold.distance,
               "warm and cold depths differ (%s, case %llu)", situation, (unsigned long long)number);
}

/* One pair of bodies at two rotations, each with many translations. */
static void check_pair(uint64_t number) {
    test_random random = test_random_case("placements", number);
    test_pose pose;
    test_random_pose(&random, 10, &pose);
    pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
    pir_sum *sum;
    pir_query *query;
    test_query_make(p, q, pose.rotation, &sum, &query);
    pir_query_cache cache = {0};
    pir_quat rotation = pose.rotation;
    for (int turn = 0; turn < 2; turn++) {
        place_oracle *oracle = place_oracle_make(p, q, rotation);
        for (int i = 0; i < POSES; i++)
            check_pose(query, oracle, &cache, some_translation(&random, oracle), pose.situation, number, rotation);
        place_oracle_free(oracle);
        rotation = test_rotation(&random);
        assert_int_equal(pir_sum_rotate(sum, rotation, PIR_METHOD_AUTO), PIR_OK);
    }
    test_query_free(query, sum);
    pir_polytope_release(p);
    pir_polytope_release(q);
}

/*
 * Pairs that failed once, with the first seed: slivers in which x lies near faces that are equally near but for
 * rounding.
 */
static const uint64_t kept[] = {11790};

static void answers_agree_with_exact_arithmetic(void **state) {
    (void)state;
    const char *asked = getenv("PIR_TEST_PAIRS");
    uint64_t pairs = asked ? strtoull(asked, NULL, 10) : 120;
    for (size_t i = 0; i < sizeof kept / sizeof kept[0]; i++)
        check_pair(kept[i]);
    for (uint64_t number = 0; number < pairs; number++)
        check_pair(number);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(answers_agree_with_exact_arithmetic)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
