/* SPDX-License-Identifier: MIT */
/*
 * Gradients in use: known cases by hand, which slacks count as active to the last bit, other coordinates and vertices
 * against differences of the library's own distances, answers without a normal, refusals.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/solid_query.h>

#include "solid/bodies.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/random.h"
#include "support/vectors.h"

enum { ROOM = 64 };

struct bench {
    pir_polytope *p, *q;
    pir_pair *pair;
    pir_workspace *workspace;
    pir_query_result result;
    pir_gradient gradient;
    pir_curvature curvature;
    pir_active active[ROOM];
    size_t count;
};

static void open_bench(struct bench *b, pir_polytope *p, pir_polytope *q) {
    memset(b, 0, sizeof *b);
    b->p = p;
    b->q = q;
    assert_int_equal(pir_workspace_create(NULL, &b->workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, q, NULL, &b->pair), PIR_OK);
}

static void close_bench(struct bench *b) {
    pir_pair_destroy(b->pair);
    pir_workspace_destroy(b->workspace);
    pir_polytope_release(b->p);
    pir_polytope_release(b->q);
}

static pir_pair_input at(double x, double y, double z) {
    pir_pair_input input = pir_pair_input_default();
    input.pose_p.translation = (pir_vec3){x, y, z};
    return input;
}

static void ask(struct bench *b, const pir_pair_input *input, double slack) {
    assert_int_equal(pir_pair_gradient(b->pair, b->workspace, input, &b->result, &b->gradient, &b->curvature), PIR_OK);
    assert_int_equal(pir_pair_active(b->pair, b->workspace, input, slack, ROOM, b->active, &b->count), PIR_OK);
}

static void is_vector(pir_vec3 v, double x, double y, double z) {
    expect(test_length(test_add(v, (pir_vec3){x, y, z}, -1)) < 1e-12, "%g, %g, %g not %g, %g, %g", v.x, v.y, v.z, x, y,
           z);
}

static void a_box_over_a_box_has_the_corners_they_share(void **state) {
    (void)state;
    struct bench b;
    open_bench(&b, test_box(1, 1, 1), test_box(2, 2, 1));
    pir_pair_input input = at(0, 0, 3);
    ask(&b, &input, 0);
    assert_int_equal(b.count, 4);
    is_vector(b.gradient.p.force, 0, 0, 1);
    is_vector(b.gradient.q.force, 0, 0, -1);
    pir_vec3 mean = {0, 0, 0};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(b.active[i].facet, 0);
        assert_int_equal(b.active[i].features.p.kind, PIR_FEATURE_VERTEX);
        assert_int_equal(b.active[i].features.q.kind, PIR_FEATURE_FACET);
        assert_true(b.active[i].distance == 1);
        is_vector(test_add(b.active[i].point_p, b.active[i].point_q, -1), 0, 0, 1);
        mean = test_add(mean, b.active[i].p.torque, 0.25);
    }
    is_vector(mean, 0, 0, 0);
    // as deep, from the side: the same corners, and as many facets as tie
    input = at(0, 0, 1.5);
    ask(&b, &input, 0);
    assert_int_equal(b.count, 4);
    assert_true(b.active[0].distance == -0.5 && b.result.distance == -0.5);
    // corners are crossings where the boxes are turned against each other by an eighth
    input.pose_p.rotation = (pir_quat){0, 0, 0.4142135623730951, 1};
    input.pose_p.translation.x = 1;
    ask(&b, &input, 0);
    assert_true(b.count > 4);
    close_bench(&b);
}

static void a_slack_counts_to_the_last_bit(void **state) {
    (void)state;
    struct bench b;
    open_bench(&b, test_box(1, 1, 1), test_box(1, 1, 1));
    // ways out: 0.5 along z, 0.75 along x, 0.875 along −y
    pir_pair_input input = at(1.25, -1.125, 1.5);
    const struct {
        double slack;
        uint32_t facets;
    } asked[] = {{0, 1},     {nextafter(0.25, 0), 1},  {0.25, 2},  {nextafter(0.375, 0), 2},
                 {0.375, 3}, {nextafter(2.625, 0), 3}, {2.625, 4}, {3, 6}};
    for (size_t i = 0; i < sizeof asked / sizeof *asked; i++) {
        ask(&b, &input, asked[i].slack);
        expect(b.active[b.count - 1].facet + 1 == asked[i].facets, "slack %g: %u facets", asked[i].slack,
               b.active[b.count - 1].facet + 1);
    }
    close_bench(&b);
}

/* The slack of a facet whose normal is no rational one: within by one bit more, not by one less. */
static void a_slack_counts_to_the_last_bit_by_roots(void **state) {
    (void)state;
    struct bench b;
    const pir_vec3 wedge[] = {{-4, -4, 0}, {4, -4, 0}, {-4, 4, 0}, {4, 4, 0}, {-4, 0, 4}, {4, 0, 4}};
    const pir_vec3 point[] = {{0, 0, 0}};
    open_bench(&b, test_hull(point, 1), test_hull(wedge, 6));
    // √2/2 below one roof, √2 below the other: they differ by √½
    pir_pair_input input = at(0, 0.5, 2.5);
    const double low = 0.70710678118654746, high = 0.70710678118654757;
    assert_true(nextafter(low, 1) == high && low * low < 0.5 && high * high > 0.5);
    ask(&b, &input, low);
    assert_int_equal(b.count, 1);
    ask(&b, &input, high);
    assert_int_equal(b.count, 2);
    assert_true(b.active[0].facet == 0 && b.active[1].facet == 1);
    close_bench(&b);
}

static void answers_without_a_normal_have_no_derivatives(void **state) {
    (void)state;
    struct bench b;
    open_bench(&b, test_box(1, 1, 1), test_box(1, 1, 1));
    pir_pair_input input = at(5, 0, 0);
    input.cutoff = 1;
    for (int again = 0; again < 2; again++) {
        ask(&b, &input, 0);
        assert_int_equal(b.result.outcome, PIR_BEYOND_CUTOFF);
        assert_int_equal(b.count, 0);
        assert_int_equal(b.gradient.features.p.kind, PIR_FEATURE_NONE);
        assert_true(!b.curvature.is_known && b.curvature.hessian[4][4] == 0);
        is_vector(b.gradient.p.force, 0, 0, 0);
    }
    close_bench(&b);
    // two points at one place: a normal, of any direction, and no second derivatives
    const pir_vec3 origin[] = {{0, 0, 0}};
    open_bench(&b, test_hull(origin, 1), test_hull(origin, 1));
    input = at(0, 0, 0);
    ask(&b, &input, 0);
    assert_int_equal(b.result.outcome, PIR_TOUCHING);
    assert_int_equal(b.count, 1);
    assert_true(!b.curvature.is_known && fabs(test_length(b.gradient.p.force) - 1) < 1e-12);
    close_bench(&b);
}

/* --- other coordinates --- */

static double distance(struct bench *b, const pir_pair_input *input) {
    pir_query_result result;
    assert_int_equal(pir_pair_signed_distance(b->pair, b->workspace, input, &result), PIR_OK);
    return result.distance;
}

static pir_quat times(pir_quat a, pir_quat b) {
    return (pir_quat){a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

#define STEP 0x1p-18

/* The pose of P after a small motion in one of the three conventions. */
static pir_pose moved(pir_pose pose, int convention, pir_vec3 v, pir_vec3 w) {
    const pir_quat turn = {0.5 * w.x, 0.5 * w.y, 0.5 * w.z, 1};
    pir_pose to = pose;
    to.rotation = convention == 1 ? times(pose.rotation, turn) : times(turn, pose.rotation);
    if (convention == 2)
        to.translation = test_turn(turn, pose.translation, 1);
    to.translation = test_add(to.translation, convention == 1 ? pir_pose_rotate(pose, v) : v, 1);
    return to;
}

static void is_derivative(struct bench *b, const pir_pair_input *input, pir_pose ahead, pir_pose behind, double told) {
    pir_pair_input to = *input;
    to.pose_p = ahead;
    const double after = distance(b, &to);
    to.pose_p = behind;
    const double should = (after - distance(b, &to)) / (2 * STEP);
    expect(fabs(told - should) < 1e-6, "derivative %.9g, should be %.9g", told, should);
}

static void check_conventions(struct bench *b, const pir_pair_input *input, pir_vec3 v, pir_vec3 w) {
    const pir_pose pose = input->pose_p;
    const pir_wrench wrenches[3] = {b->gradient.p, pir_wrench_in_body(b->gradient.p, pose),
                                    pir_wrench_in_space(b->gradient.p, pose)};
    for (int k = 0; k < 3; k++)
        is_derivative(b, input, moved(pose, k, test_add(test_zero, v, STEP), test_add(test_zero, w, STEP)),
                      moved(pose, k, test_add(test_zero, v, -STEP), test_add(test_zero, w, -STEP)),
                      pir_wrench_along(wrenches[k], v, w));
    const pir_quat by = pir_wrench_by_quat(b->gradient.p, pose.rotation), q = pose.rotation;
    const pir_quat d = {v.x, w.y, w.z, v.z};
    pir_pose ahead = pose, behind = pose;
    ahead.rotation = (pir_quat){q.x + STEP * d.x, q.y + STEP * d.y, q.z + STEP * d.z, q.w + STEP * d.w};
    behind.rotation = (pir_quat){q.x - STEP * d.x, q.y - STEP * d.y, q.z - STEP * d.z, q.w - STEP * d.w};
    is_derivative(b, input, ahead, behind, by.x * d.x + by.y * d.y + by.z * d.z + by.w * d.w);
    assert_true(fabs(by.x * q.x + by.y * q.y + by.z * q.z + by.w * q.w) < 1e-12);
}

/* Second derivatives in the bodies' axes: those of gradients there, by the twelve columns. */
static void check_in_body(const struct bench *b, const pir_pair_input *input) {
    const pir_curvature turned = pir_curvature_in_body(&b->curvature, input->pose_p, input->pose_q);
    for (int i = 0; i < 12; i++) {
        const pir_vec3 e = {i % 3 == 0, i % 3 == 1, i % 3 == 2};
        const pir_vec3 world = pir_pose_rotate(i < 6 ? input->pose_p : input->pose_q, e);
        double row = 0, sum = 0;
        for (int j = 0; j < 12; j++) {
            const pir_vec3 f = {j % 3 == 0, j % 3 == 1, j % 3 == 2};
            const pir_vec3 other = pir_pose_rotate(j < 6 ? input->pose_p : input->pose_q, f);
            const double a[3] = {world.x, world.y, world.z}, c[3] = {other.x, other.y, other.z};
            row = 0;
            for (int k = 0; k < 9; k++)
                row += a[k / 3] * b->curvature.hessian[i - i % 3 + k / 3][j - j % 3 + k % 3] * c[k % 3];
            sum = fmax(sum, fabs(row - turned.hessian[i][j]));
            assert_true(turned.hessian[i][j] == turned.hessian[j][i]);
        }
        expect(sum < 1e-9, "row %d is off by %g", i, sum);
    }
}

/* Along motions of single vertices the distance changes as the weights say. */
static void check_vertices(const struct bench *b, const pir_pair_input *input, test_points points) {
    uint32_t vertices[3];
    double weights[3], sum = 0;
    const pir_feature feature = b->gradient.features.p;
    const pir_vec3 on = pir_pose_apply_inverse(input->pose_p, b->result.point_p);
    const pir_vec3 force = pir_wrench_in_body(b->gradient.p, input->pose_p).force;
    const size_t count = pir_feature_weights(b->p, feature, on, vertices, weights);
    assert_true(count >= 1 && count <= 3);
    for (size_t i = 0; i < count; i++) {
        const uint32_t source = pir_polytope_source(b->p, vertices[i]);
        const pir_vec3 d = {0.5, -0.25, 0.75}, was = points.at[source];
        double side[2];
        sum += weights[i];
        for (int k = 0; k < 2; k++) {
            struct bench other;
            points.at[source] = test_add(was, d, k ? STEP : -STEP);
            open_bench(&other, test_polytope(&points), pir_polytope_retain(b->q));
            side[k] = distance(&other, input);
            close_bench(&other);
        }
        points.at[source] = was;
        const double told = weights[i] * test_dot(force, d), should = (side[1] - side[0]) / (2 * STEP);
        expect(fabs(told - should) < 1e-6, "vertex %u: %.9g, should be %.9g", vertices[i], told, should);
    }
    assert_true(fabs(sum - 1) < 1e-12);
}

static void other_coordinates_tell_the_same(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("conventions", i);
        test_points p, q;
        struct bench b;
        test_body_points(&random, TEST_SPHERE, 12, &p);
        test_body_points(&random, TEST_SPHERE, 12, &q);
        open_bench(&b, test_polytope(&p), test_polytope(&q));
        pir_pair_input input = pir_pair_input_default();
        const pir_vec3 way = test_random_direction(&random);
        input.pose_p.rotation = (pir_quat){way.y, way.z, 0.5, way.x};
        input.pose_q.rotation = (pir_quat){way.z, 0.25, way.x, 1};
        input.pose_q.translation = test_random_direction(&random);
        input.pose_p.translation = test_add(input.pose_q.translation, way, i % 2 ? 1.2 : 3);
        ask(&b, &input, 0);
        check_conventions(&b, &input, test_random_direction(&random), test_random_direction(&random));
        check_in_body(&b, &input);
        check_vertices(&b, &input, p);
        close_bench(&b);
    }
}

/* The gradient of the distance of two bodies of cubes, against differences of it, where one pair of pieces has it. */
static void solids_have_the_gradient_of_two_pieces(void **state) {
    (void)state;
    pir_workspace *workspace;
    unsigned told = 0, none = 0;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t i = 0; i < 40; i++) {
        test_random random = test_random_case("solids", i);
        const cells p = cells_random(&random, 6), q = cells_random(&random, 9);
        pir_solid *of_p = solid_of_cells(&p), *of_q = solid_of_cells(&q);
        pir_pieces *pieces_p = NULL, *pieces_q = NULL;
        pir_solid_query *query = NULL;
        assert_int_equal(pir_solid_decompose(of_p, NULL, NULL, &pieces_p), PIR_OK);
        assert_int_equal(pir_solid_decompose(of_q, NULL, NULL, &pieces_q), PIR_OK);
        assert_int_equal(pir_solid_query_create(pieces_p, pieces_q, NULL, &query), PIR_OK);
        pir_pair_input input = pir_pair_input_default();
        const pir_vec3 way = test_random_direction(&random), v = test_random_direction(&random);
        const pir_vec3 w = test_random_direction(&random);
        input.pose_p.rotation = (pir_quat){way.y, way.z, 0.5, way.x};
        input.pose_p.translation = test_add(test_zero, way, i % 2 ? 9 : 0.25);
        pir_solid_distance distance, side[2];
        pir_gradient gradient;
        pir_curvature curvature;
        assert_int_equal(pir_solid_query_gradient(query, workspace, &input, &distance, &gradient, &curvature), PIR_OK);
        assert_int_equal(pir_solid_query_gradient(query, workspace, &input, NULL, &gradient, NULL), PIR_ERR_ARGUMENT);
        if (distance.result.outcome == PIR_SEPARATED) {
            pir_pair_input to = input;
            for (int k = 0; k < 2; k++) {
                const double step = k ? STEP : -STEP;
                to.pose_p = moved(input.pose_p, 0, test_add(test_zero, v, step), test_add(test_zero, w, step));
                assert_int_equal(pir_solid_query_distance(query, workspace, &to, &side[k]), PIR_OK);
            }
            const double should = (side[1].result.distance - side[0].result.distance) / (2 * STEP);
            expect(fabs(pir_wrench_along(gradient.p, v, w) - should) < 1e-6 && curvature.is_known,
                   "case %u: %g, not %g", (unsigned)i, pir_wrench_along(gradient.p, v, w), should);
            told++;
        } else {
            assert_true(gradient.features.p.kind == PIR_FEATURE_NONE && !curvature.is_known);
            none++;
        }
        pir_solid_query_destroy(query);
        pir_pieces_destroy(pieces_q);
        pir_pieces_destroy(pieces_p);
        pir_solid_release(of_q);
        pir_solid_release(of_p);
    }
    expect(told >= 20 && none >= 1, "%u apart, %u overlap", told, none);
    pir_workspace_destroy(workspace);
}

static void what_is_no_question_is_refused(void **state) {
    (void)state;
    struct bench b;
    open_bench(&b, test_box(1, 1, 1), test_box(1, 1, 1));
    const pir_pair_input good = at(0, 0, 1.5);
    pir_pair_input wild = good;
    wild.radius_p = -1;
    size_t count = 77;
    static const double slacks[] = {-1, NAN, HUGE_VAL};
    for (int i = 0; i < 3; i++)
        assert_int_equal(pir_pair_active(b.pair, b.workspace, &good, slacks[i], ROOM, b.active, &count),
                         PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_active(b.pair, b.workspace, &wild, 0, ROOM, b.active, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_active(NULL, b.workspace, &good, 0, ROOM, b.active, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_gradient(b.pair, b.workspace, &good, NULL, &b.gradient, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_gradient(b.pair, b.workspace, &good, &b.result, NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_gradient(b.pair, NULL, &good, &b.result, &b.gradient, NULL), PIR_ERR_ARGUMENT);
    wild.radius_p = NAN;
    assert_int_equal(pir_pair_gradient(b.pair, b.workspace, &wild, &b.result, &b.gradient, NULL), PIR_ERR_NOT_FINITE);
    uint32_t vertices[3];
    double weights[3];
    const pir_feature none[] = {
        {PIR_FEATURE_NONE, 0}, {PIR_FEATURE_VERTEX, 8}, {PIR_FEATURE_EDGE, 12}, {PIR_FEATURE_FACET, 6}};
    for (int i = 0; i < 4; i++)
        assert_int_equal(pir_feature_weights(b.p, none[i], test_zero, vertices, weights), 0);
    assert_int_equal(count, 77);
    close_bench(&b);
    pir_pair_options options = pir_pair_options_default();
    pir_polytope *box = test_box(1, 1, 1);
    open_bench(&b, box, pir_polytope_retain(box));
    pir_pair_destroy(b.pair);
    options.most = PIR_LEVEL_OVERLAPPING;
    assert_int_equal(pir_pair_create(b.p, b.q, &options, &b.pair), PIR_OK);
    assert_int_equal(pir_pair_active(b.pair, b.workspace, &good, 0, ROOM, b.active, &count), PIR_ERR_LIMIT);
    close_bench(&b);
}

static void running_out_of_memory_is_a_status(void **state) {
    (void)state;
    pir_polytope *box = test_box(1, 1, 1);
    bool failed = true;
    uint64_t refused = 0;
    for (uint64_t n = 1; failed; n++) {
        test_memory memory = {0};
        const pir_allocator allocator = test_allocator(&memory);
        pir_workspace *workspace;
        pir_pair *pair;
        pir_active active[ROOM];
        size_t count = 77;
        const pir_pair_input input = at(0, 0, 1.5);
        assert_int_equal(pir_workspace_create(&allocator, &workspace), PIR_OK);
        assert_int_equal(pir_pair_create(box, box, NULL, &pair), PIR_OK);
        memory.fail_at = memory.requests + n;
        const pir_status status = pir_pair_active(pair, workspace, &input, 0, ROOM, active, &count);
        failed = memory.requests >= memory.fail_at;
        assert_true(status == (failed ? PIR_ERR_MEMORY : PIR_OK) && (count == 77) == failed);
        refused += failed;
        pir_pair_destroy(pair);
        pir_workspace_destroy(workspace);
        assert_true(memory.blocks == 0 && !memory.wrong_size);
    }
    assert_true(refused > 2);
    pir_polytope_release(box);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_over_a_box_has_the_corners_they_share),
        cmocka_unit_test(a_slack_counts_to_the_last_bit),
        cmocka_unit_test(a_slack_counts_to_the_last_bit_by_roots),
        cmocka_unit_test(answers_without_a_normal_have_no_derivatives),
        cmocka_unit_test(other_coordinates_tell_the_same),
        cmocka_unit_test(solids_have_the_gradient_of_two_pieces),
        cmocka_unit_test(what_is_no_question_is_refused),
        cmocka_unit_test(running_out_of_memory_is_a_status),
    };
    test_print_seed();
    return cmocka_run_group_tests_name("gradients in use", tests, NULL, NULL);
}
