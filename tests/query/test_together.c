/* SPDX-License-Identifier: MIT */
/*
 * Placements at ties and in common planes, against exact arithmetic: bodies of many facets about one middle, cubes
 * face to face and edge to edge. Warm, cold, single and batch queries give the same answer.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/query.h>
#include <pirouette/shape.h>

#include "query/place_oracle.h"
#include "query/query_of.h"
#include "support/bodies.h"

#define BOUND 1e-12

struct scene {
    pir_polytope *p;
    pir_sum *sum;
    pir_query *query;
    pir_query_cache cache;
    double size;
};

static struct scene make_scene(const char *shape) {
    struct scene scene = {0};
    pir_vec3 low, high;
    pir_report report;
    assert_int_equal(pir_shape_create(shape, NULL, &report, &scene.p), PIR_OK);
    pir_polytope_bounds(scene.p, &low, &high);
    scene.size = high.x - low.x;
    test_query_make(scene.p, scene.p, (pir_quat){0, 0, 0, 1}, &scene.sum, &scene.query);
    return scene;
}

static void clear_scene(struct scene *scene) {
    test_query_free(scene->query, scene->sum);
    pir_polytope_release(scene->p);
}

static void expect_right(const pir_query_result *r, place_answer right, place_oracle *oracle, pir_vec3 t, double size,
                         const char *how) {
    double should = right.state == PIR_OUTSIDE ? right.distance : right.state == PIR_INSIDE ? -right.depth : 0;
    expect(r->state == right.state && fabs(r->distance - should) <= BOUND * size && r->outcome != PIR_STEP_LIMIT,
           "%s at (%.17g, %.17g, %.17g): state %d not %d, distance %.17g not %.17g", how, t.x, t.y, t.z, (int)r->state,
           (int)right.state, r->distance, should);
    // the normal proves the number
    double slack = place_oracle_slack(oracle, t, r->normal);
    expect(fabs(slack + should) <= 2 * BOUND * size, "%s at (%.17g, %.17g, %.17g): slack %.17g along the normal", how,
           t.x, t.y, t.z, slack);
}

static void check_place(struct scene *scene, place_oracle *oracle, pir_vec3 t) {
    pir_query_input input = pir_query_input_default();
    input.translation = t;
    place_answer right = place_oracle_ask(oracle, t);
    pir_query *fresh;
    pir_query_result warm, cold, again;
    pir_state state;
    double depth;
    assert_int_equal(pir_query_create(scene->sum, &fresh), PIR_OK);
    assert_int_equal(pir_query_signed_distance(scene->query, &input, &scene->cache, &warm), PIR_OK);
    assert_int_equal(pir_query_signed_distance(fresh, &input, NULL, &cold), PIR_OK);
    assert_int_equal(pir_query_signed_distance(fresh, &input, NULL, &again), PIR_OK);
    assert_int_equal(pir_query_batch_depths(fresh, &t, 1, &depth, &state), PIR_OK);
    expect_right(&warm, right, oracle, t, scene->size, "warm");
    expect_right(&cold, right, oracle, t, scene->size, "cold");
    expect_right(&again, right, oracle, t, scene->size, "again");
    assert_int_equal(state, right.state);
    if (right.state == PIR_INSIDE)
        assert_true(depth == -cold.distance && warm.distance == cold.distance && again.distance == cold.distance &&
                    memcmp(&warm.normal, &cold.normal, sizeof warm.normal) == 0);
    pir_query_destroy(fresh);
}

static void spheres_about_one_middle(void **state) {
    (void)state;
    struct scene scene = make_scene("gs4");
    test_random random = test_random_case("together", 0);
    for (int turn = 0; turn < 4; turn++) {
        pir_quat r = turn == 0 ? (pir_quat){0, 0, 0, 1} : turn == 1 ? (pir_quat){0, 0, 1, 1} : test_rotation(&random);
        assert_int_equal(pir_sum_rotate(scene.sum, r, PIR_METHOD_AUTO), PIR_OK);
        place_oracle *oracle = place_oracle_make(scene.p, scene.p, r);
        check_place(&scene, oracle, (pir_vec3){0, 0, 0});
        for (int i = 0; i < 5; i++) {
            pir_vec3 d = test_random_direction(&random);
            double away = scene.size * ldexp(1, -test_random_between(&random, 2, 50));
            check_place(&scene, oracle, (pir_vec3){d.x * away, d.y * away, d.z * away});
        }
        place_oracle_free(oracle);
    }
    clear_scene(&scene);
}

/* Zero, or a power of ten below a fifth, of either sign. */
static double some_gap(test_random *random) {
    int k = test_random_between(random, 0, 18);
    double gap = k == 0 ? 0 : 2 * pow(10, -k);
    return test_random_below(random, 2) ? gap : -gap;
}

static void faces_lie_on_faces(void **state) {
    (void)state;
    static const pir_quat turns[4] = {{0, 0, 0, 1}, {0, 0, 1, 1}, {1, 0, 0, 1}, {1, 1, 1, 1}};
    struct scene scene = make_scene("cube");
    test_random random = test_random_case("together", 1);
    for (int turn = 0; turn < 4; turn++) {
        assert_int_equal(pir_sum_rotate(scene.sum, turns[turn], PIR_METHOD_AUTO), PIR_OK);
        place_oracle *oracle = place_oracle_make(scene.p, scene.p, turns[turn]);
        for (int i = 0; i < 150; i++) {
            double t[3];
            for (int k = 0; k < 3; k++)
                t[k] = scene.size * test_random_unit(&random);
            double out = scene.size * (1 + some_gap(&random));
            t[i % 3] = test_random_below(&random, 2) ? out : -out;
            // on an edge of the difference too
            if (i % 5 == 0)
                t[(i + 1) % 3] = scene.size;
            check_place(&scene, oracle, (pir_vec3){t[0], t[1], t[2]});
        }
        place_oracle_free(oracle);
    }
    clear_scene(&scene);
}

static void edges_lie_across_edges(void **state) {
    (void)state;
    struct scene scene = make_scene("cube");
    test_random random = test_random_case("together", 2);
    const pir_quat r = {1, 1, 0, sqrt(2)};
    assert_int_equal(pir_sum_rotate(scene.sum, r, PIR_METHOD_AUTO), PIR_OK);
    place_oracle *oracle = place_oracle_make(scene.p, scene.p, r);
    for (int i = 0; i < 300; i++) {
        double at = scene.size * (1 + some_gap(&random));
        check_place(&scene, oracle, (pir_vec3){at, at, 0.25 * scene.size * test_random_unit(&random)});
    }
    place_oracle_free(oracle);
    clear_scene(&scene);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(spheres_about_one_middle), cmocka_unit_test(faces_lie_on_faces),
                                       cmocka_unit_test(edges_lie_across_edges)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
