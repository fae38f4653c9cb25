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
#include "support/vectors.h"

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

static void set_scene(test_random *random, pir_polytope *p, pir_polytope *q, struct scene *scene) {
    static pir_rotation_integers integers;
    pir_rotation rotation = {.integers = &integers};
    memset(scene, 0, sizeof *scene);
    scene->p = p;
    scene->q = q;
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

static void make_scene(test_random *random, struct scene *scene) {
    pir_polytope *p = small_body(random);
    set_scene(random, p, small_body(random), scene);
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

/* --- parallelepipeds --- */

/* A parallelepiped about any point, at times as thin as a 2^-20th, its vertices sums without rounding. */
static pir_polytope *leaning_box(test_random *random) {
    test_points points = {.count = 8};
    pir_vec3 half[3];
    for (int k = 0; k < 3; k++) {
        const double size = test_random_below(random, 4) ? 1 : ldexp(1, -test_random_between(random, 1, 20));
        int64_t c[3];
        for (int i = 0; i < 3; i++)
            c[i] = test_random_between(random, -1000, 1000) + (i == k ? 1500 : 0);
        half[k] = (pir_vec3){size * (double)c[0], size * (double)c[1], size * (double)c[2]};
    }
    const double at = (double)test_random_between(random, -3, 3);
    for (int i = 0; i < 8; i++) {
        points.at[i] = (pir_vec3){at, 2 * at, -at};
        for (int k = 0; k < 3; k++)
            points.at[i] = test_add(points.at[i], half[k], i >> k & 1 ? 1 : -1);
    }
    return test_polytope(&points);
}

/* The slack at x along a direction, from all vertices, in numbers of twice the length where there are such. */
static long double slack_along(const struct scene *scene, const long double n[3]) {
    const pir_body *of[2] = {&scene->frame.p, &scene->frame.q};
    const double x[3] = {scene->placement.x.x, scene->placement.x.y, scene->placement.x.z};
    const double(*m)[3] = scene->frame.r.m;
    long double slack = 0, length = sqrtl(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int body = 0; body < 2; body++) {
        long double most = -HUGE_VALL;
        for (uint32_t v = 0; v < of[body]->polytope->vertex_count; v++) {
            const double a[3] = {of[body]->vertex[v].x, of[body]->vertex[v].y, of[body]->vertex[v].z};
            long double to = 0;
            for (int k = 0; k < 3; k++)
                to += n[k] * (body == 0 ? (long double)m[k][0] * a[0] + (long double)m[k][1] * a[1] +
                                              (long double)m[k][2] * a[2]
                                        : (long double)a[k]);
            most = to > most ? to : most;
        }
        slack += most;
    }
    for (int k = 0; k < 3; k++)
        slack -= n[k] * x[k];
    return slack / length;
}

/* Three directions of each body, of normals or edges, as all look from Q. */
static void directions_of(const struct scene *scene, bool of_p, bool edges, pir_vec3 to[3]) {
    const pir_axes_lanes *lanes = of_p ? &scene->axes_p->lanes : &scene->axes_q->lanes;
    const double(*from)[PIR_AXES_PADDED] = edges ? lanes->edge : lanes->normal;
    for (int i = 0; i < 3; i++) {
        const pir_vec3 d = {from[0][i], from[1][i], from[2][i]};
        to[i] = of_p ? pir_mat_apply(&scene->frame.r, d) : d;
    }
}

/* All 30 slacks; 1 where edges are next to parallel. */
static void list_slacks(const struct scene *scene, long double slack[30]) {
    pir_vec3 lines[2][3], along[2][3];
    for (int body = 0; body < 2; body++) {
        directions_of(scene, body == 0, false, lines[body]);
        directions_of(scene, body == 0, true, along[body]);
    }
    for (int i = 0; i < 15; i++) {
        const pir_vec3 d = along[0][i % 3], e = along[1][i < 6 ? 0 : (i - 6) / 3];
        const long double across[3] = {(long double)d.y * e.z - (long double)d.z * e.y,
                                       (long double)d.z * e.x - (long double)d.x * e.z,
                                       (long double)d.x * e.y - (long double)d.y * e.x};
        const pir_vec3 line = lines[i / 3 % 2][i % 3];
        for (int back = 0; back < 2; back++) {
            const long double sign = back ? -1 : 1;
            const long double n[3] = {sign * (i < 6 ? line.x : across[0]), sign * (i < 6 ? line.y : across[1]),
                                      sign * (i < 6 ? line.z : across[2])};
            const bool is_none = n[0] * n[0] + n[1] * n[1] + n[2] * n[2] < 1e-12L;
            slack[2 * i + back] = is_none ? 1 : slack_along(scene, n);
        }
    }
}

/* Those that are below the bound are counted, and of those above it by more than a little none. */
static void slacks_of_parallelepipeds_near_a_bound_are_counted(void **state) {
    (void)state;
    uint32_t asked = 0, one = 0;
    for (uint64_t i = 0; i < 2000; i++) {
        test_random random = test_random_case("parallelepipeds", i);
        struct scene scene;
        set_scene(&random, leaning_box(&random), leaning_box(&random), &scene);
        if (scene.axes_p && scene.axes_q && scene.axes_p->lanes.has_halves && scene.axes_q->lanes.has_halves) {
            const pir_axes_lanes *p = &scene.axes_p->lanes, *q = &scene.axes_q->lanes;
            const double error = scene.placement.error;
            long double slack[30];
            list_slacks(&scene, slack);
            for (int k = 0; k < 30; k++) {
                const double most = k == 0 ? 1e-300 : (double)slack[k] * (1 + 0x1p-40);
                uint32_t least = 0, greatest = 0, found = 0;
                for (int j = 0; j < 30; j++) {
                    least += slack[j] < most;
                    // edges next to parallel are known a millionth as well
                    greatest += slack[j] < most + 1e7 * error || slack[j] == 1;
                }
                for (unsigned version = 0; most > 0 && pir_processor_version(version); version++) {
                    const uint32_t near = pir_processor_version(version)->axes->near(p, q, &scene.frame.r,
                                                                                     scene.placement.x, error, most);
                    assert_true(version == 0 || near == found);
                    found = near;
                }
                expect(most <= 0 || (found >= least && found <= greatest), "case %llu: %u, not %u to %u",
                       (unsigned long long)i, found, least, greatest);
                asked += most > 0;
                one += most > 0 && found == 1;
            }
        }
        free_scene(&scene);
    }
    print_message("# %u bounds, %u with one slack below\n", asked, one);
    assert_true(asked > 20000 && one > 500);
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
        cmocka_unit_test(slacks_of_parallelepipeds_near_a_bound_are_counted),
        cmocka_unit_test(a_body_with_many_axes_has_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
