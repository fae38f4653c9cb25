/* SPDX-License-Identifier: MIT */
/*
 * All facets that a difference of two small bodies can have: every version of the loops gives the same bits, the least
 * slack is the depth that a query on the sum finds, and its piece is the facet of that depth. What they leave open is
 * not asked again at once.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/query.h>
#include <pirouette/shape.h>
#include <pirouette/sum.h>

#include "base/processor.h"
#include "pair/axes/axes.h"
#include "pair/pair.h"
#include "query/frame/body.h"
#include "support/bodies.h"

/* A body that may have few axes, turned or not, its vertices in any order. */
static pir_polytope *small_body(test_random *random) {
    static const test_body kinds[4] = {TEST_BOX, TEST_BOX, TEST_OCTAHEDRON, TEST_SPHERE};
    test_points points;
    test_body kind = kinds[test_random_below(random, 4)];
    test_body_points(random, kind, 4, &points);
    if (test_random_below(random, 8) == 0)
        test_bake(&points, test_general_rotation(random));
    for (size_t i = points.count; i > 1; i--) {
        const size_t k = test_random_below(random, (uint32_t)i);
        const pir_vec3 kept = points.at[i - 1];
        points.at[i - 1] = points.at[k];
        points.at[k] = kept;
    }
    return test_polytope(&points);
}

/* A difference, and its bodies as pairs look at them. */
struct scene {
    pir_polytope *p, *q, *reflected;
    pir_frame frame;
    pir_placement placement;
    const pir_axes *axes_p, *axes_q;
};

static void make_scene(test_random *random, struct scene *scene) {
    static pir_rotation_integers integers;
    pir_rotation rotation = {.integers = &integers};
    memset(scene, 0, sizeof *scene);
    scene->p = small_body(random);
    scene->q = small_body(random);
    assert_int_equal(pir_polytope_reflect(scene->p, &scene->reflected), PIR_OK);
    assert_int_equal(pir_frame_set_bodies(&scene->frame, scene->reflected, scene->q), PIR_OK);
    assert_int_equal(pir_rotation_set(&rotation, test_rotation(random)), PIR_OK);
    pir_frame_turn(&scene->frame, &rotation);
    int exponent = scene->frame.exponent;
    assert_int_equal(pir_axes_find(scene->reflected, exponent, &scene->frame.p, &scene->axes_p), PIR_OK);
    assert_int_equal(pir_axes_find(scene->q, exponent, &scene->frame.q, &scene->axes_q), PIR_OK);
    pir_vec3 d = test_random_direction(random);
    double far = ldexp(test_random_unit(random), exponent);
    assert_int_equal(pir_frame_place(&scene->frame, (pir_vec3){far * d.x, far * d.y, far * d.z}, &scene->placement),
                     PIR_OK);
}

static void free_scene(struct scene *scene) {
    pir_polytope_release(scene->reflected);
    pir_polytope_release(scene->p);
    pir_polytope_release(scene->q);
}

/* The answer of a query on the sum. */
static pir_query_result ask_sum(const struct scene *scene) {
    pir_sum_options options = pir_sum_options_default();
    pir_sum *sum;
    pir_query *query;
    pir_query_result result;
    options.difference = true;
    assert_int_equal(pir_sum_create(scene->p, scene->q, scene->frame.given, &options, &sum), PIR_OK);
    assert_int_equal(pir_query_create(sum, &query), PIR_OK);
    pir_query_input input = pir_query_input_default();
    input.translation = scene->placement.translation;
    assert_int_equal(pir_query_signed_distance(query, &input, NULL, &result), PIR_OK);
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    return result;
}

static void check_versions(const struct scene *scene, const pir_axes *p, const pir_axes *q) {
    double low[2][PIR_AXES_SLACKS], next[2];
    uint32_t count[2], at[2];
    for (unsigned version = 0; pir_processor_version(version); version++) {
        const pir_axes_loops *loops = pir_processor_version(version)->axes;
        int i = version > 0;
        count[i] =
            loops->slacks(&p->lanes, &q->lanes, &scene->frame.r, scene->placement.x, scene->placement.error, low[i]);
        at[i] = loops->least(low[i], count[i], &next[i]);
        assert_true(count[i] == count[0] && at[i] == at[0] && next[i] == next[0]);
        assert_memory_equal(low[i], low[0], count[0] * sizeof low[0][0]);
        for (uint32_t k = 0; k < count[0]; k++)
            assert_true(low[0][k] >= low[0][at[0]] && (k == at[0] || low[0][k] >= next[0]));
    }
}

static void the_least_slack_is_the_depth(void **state) {
    (void)state;
    uint32_t few = 0, ahead = 0, cases = 2000;
    for (uint64_t i = 0; i < cases; i++) {
        test_random random = test_random_case("axes", i);
        struct scene scene;
        make_scene(&random, &scene);
        const pir_axes *p = scene.axes_p, *q = scene.axes_q;
        if (p && q) {
            pir_axes_slack least;
            few++;
            check_versions(&scene, p, q);
            pir_axes_least(pir_processor_best()->axes, p, q, &scene.frame, &scene.placement, &least);
            pir_query_result right = ask_sum(&scene);
            double depth = pir_frame_from(&scene.frame, -right.distance), error = scene.placement.error;
            if (right.state == PIR_INSIDE) {
                pir_vec3 n;
                pir_axes_piece(p, q, &scene.frame, least.at, &n);
                expect(least.low <= depth + error, "case %llu: %g, not %g", (unsigned long long)i, least.low, depth);
                if (least.next > depth + error) {
                    // the one axis that is not proven to be farther
                    ahead++;
                    pir_vec3 off = pir_vec_sub(n, right.normal);
                    expect(pir_vec_dot(off, off) < 1e-16, "case %llu: another normal", (unsigned long long)i);
                    expect(least.low > depth - 1e-9 * scene.placement.reach, "case %llu", (unsigned long long)i);
                }
            } else {
                expect(least.low <= error, "case %llu: outside", (unsigned long long)i);
            }
        }
        free_scene(&scene);
    }
    print_message("%u of %u have few axes, %u one facet ahead\n", few, cases, ahead);
    assert_true(few > cases / 5 && ahead > few / 4);
}

static void a_body_with_many_axes_has_none(void **state) {
    (void)state;
    test_random random = test_random_case("many axes", 0);
    pir_polytope *ball = test_sphere(&random, 12);
    const pir_kept_body *body;
    int exponent;
    const pir_axes *axes = NULL;
    assert_int_equal(pir_kept_exponent(ball, &exponent), PIR_OK);
    assert_int_equal(pir_kept_body_of(ball, exponent, &body), PIR_OK);
    assert_int_equal(pir_axes_find(ball, exponent, &body->body, &axes), PIR_OK);
    assert_null(axes);
    pir_polytope_release(ball);
}

/* Two boxes that rest on each other have facets of one slack, and edges that are parallel however one of them spins. */
static void what_axes_leave_open_is_not_asked_again_at_once(void **state) {
    (void)state;
    pir_polytope *box;
    pir_pair *pair;
    pir_workspace *workspace;
    pir_query_result result;
    pir_pair_input input = pir_pair_input_default();
    assert_int_equal(pir_shape_create("cube", NULL, NULL, &box), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (int spins = 0; spins < 2; spins++) {
        uint8_t last = 0, asked = 0;
        assert_int_equal(pir_pair_create(box, box, NULL, &pair), PIR_OK);
        assert_true(pair->axes_p && pair->axes_q);
        for (int i = 0; i < 100; i++) {
            double angle = 0.3 * spins * i, depth = 0.01 * (1 + i % 3);
            pir_vec3 low, high;
            pir_polytope_bounds(box, &low, &high);
            input.pose_p.rotation = (pir_quat){0, 0, sin(angle / 2), cos(angle / 2)};
            input.pose_p.translation = (pir_vec3){0, 0, high.z - low.z - depth};
            assert_int_equal(pir_pair_signed_distance(pair, workspace, &input, &result), PIR_OK);
            assert_true(fabs(result.distance + depth) < 1e-12);
            asked += pair->resting > last;
            last = pair->resting;
        }
        expect(asked > 0 && asked <= 100 / 8, "spins %d: asked %d times", spins, asked);
        pir_pair_destroy(pair);
    }
    pir_workspace_destroy(workspace);
    pir_polytope_release(box);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_axes_leave_open_is_not_asked_again_at_once),
        cmocka_unit_test(the_least_slack_is_the_depth),
        cmocka_unit_test(a_body_with_many_axes_has_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
