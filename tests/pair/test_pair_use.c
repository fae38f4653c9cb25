/* SPDX-License-Identifier: MIT */
/*
 * Pairs as callers use them: what they refuse, memory that fails, poses in the world, resets, levels that are forced or
 * capped, no allocation once warm.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/mass.h>
#include <pirouette/pair.h>

#include "support/answers.h"
#include "support/bodies.h"
#include "support/memory.h"

static pir_polytope *cube(double half) {
    test_points points = {.count = 8};
    for (int i = 0; i < 8; i++)
        points.at[i] = (pir_vec3){i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half};
    return test_polytope(&points);
}

typedef pir_status ask_pair(pir_pair *, pir_workspace *, const pir_pair_input *, pir_query_result *);
static ask_pair *const calls[4] = {pir_pair_overlap, pir_pair_distance, pir_pair_penetration, pir_pair_signed_distance};

/* --- refusals --- */

static void what_is_no_pair_is_refused(void **state) {
    (void)state;
    pir_polytope *p = cube(1);
    pir_pair *pair = NULL;
    pir_workspace *workspace;
    pir_pair_options options = pir_pair_options_default();
    assert_int_equal(pir_workspace_create(NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_create(NULL, p, NULL, &pair), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_create(p, NULL, NULL, &pair), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_create(p, p, NULL, NULL), PIR_ERR_ARGUMENT);
    options.least = PIR_LEVEL_WHOLE, options.most = PIR_LEVEL_NEAR;
    assert_int_equal(pir_pair_create(p, p, &options, &pair), PIR_ERR_ARGUMENT);
    options.least = PIR_LEVEL_NONE, options.most = (pir_level)17;
    assert_int_equal(pir_pair_create(p, p, &options, &pair), PIR_ERR_ARGUMENT);
    assert_null(pair);
    assert_int_equal(pir_pair_create(p, p, NULL, &pair), PIR_OK);
    assert_int_equal(pir_pair_level(pair), PIR_LEVEL_NONE);
    assert_int_equal(pir_pair_reset(NULL, p, p), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_reset(pair, p, NULL), PIR_ERR_ARGUMENT);
    pir_pair_destroy(NULL);
    pir_workspace_destroy(NULL);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(p);
}

static void what_is_no_pose_is_refused_and_changes_nothing(void **state) {
    (void)state;
    struct {
        pir_quat q;
        pir_vec3 t;
        double radius, cutoff;
        pir_status status;
    } const cases[] = {{{0, 0, 0, 0}, {0, 0, 0}, 0, 1, PIR_ERR_ZERO_QUATERNION},
                       {{0, NAN, 0, 1}, {0, 0, 0}, 0, 1, PIR_ERR_NOT_FINITE},
                       {{0, 0, 0, INFINITY}, {0, 0, 0}, 0, 1, PIR_ERR_NOT_FINITE},
                       {{0, 0, 0, 1}, {0, NAN, 0}, 0, 1, PIR_ERR_NOT_FINITE},
                       {{0, 0, 0, 1}, {0, 0, 1e300}, 0, 1, PIR_ERR_LIMIT},
                       {{0, 0, 0, 1}, {0, 0, 0}, -1, 1, PIR_ERR_ARGUMENT},
                       {{0, 0, 0, 1}, {0, 0, 0}, NAN, 1, PIR_ERR_NOT_FINITE},
                       {{0, 0, 0, 1}, {0, 0, 0}, 0, NAN, PIR_ERR_NOT_FINITE},
                       {{0, 0, 0, 1}, {5, 0, 0}, 0.125, NAN, PIR_ERR_NOT_FINITE}};
    pir_polytope *p = cube(1);
    pir_pair *pair;
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, p, NULL, &pair), PIR_OK);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int of_q = 0; of_q < 2; of_q++)
            for (int k = 0; k < 4; k++) {
                pir_pair_input input = pir_pair_input_default();
                *(of_q ? &input.pose_q : &input.pose_p) = (pir_pose){cases[i].q, cases[i].t};
                *(of_q ? &input.radius_q : &input.radius_p) = cases[i].radius;
                input.cutoff = cases[i].cutoff;
                pir_query_result result, before;
                memset(&result, 42, sizeof result);
                before = result;
                expect(calls[k](pair, workspace, &input, &result) == cases[i].status, "case %zu of %d, call %d", i,
                       of_q, k);
                assert_memory_equal(&result, &before, sizeof result);
            }
    // components that span more than 2^900 have no room beside another rotation
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    input.pose_q.rotation = (pir_quat){1, 0, 0, 0x1p-1000};
    assert_int_equal(pir_pair_overlap(pair, workspace, &input, &result), PIR_ERR_LIMIT);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(calls[k](pair, workspace, &input, NULL), PIR_ERR_ARGUMENT);
        assert_int_equal(calls[k](pair, NULL, &input, &result), PIR_ERR_ARGUMENT);
        assert_int_equal(calls[k](NULL, workspace, &input, &result), PIR_ERR_ARGUMENT);
        assert_int_equal(calls[k](pair, workspace, NULL, &result), PIR_ERR_ARGUMENT);
    }
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(p);
}

/* --- memory --- */

/* A pair's life: poses apart, resting, deep, on an edge, with contacts. */
static pir_status live(const pir_allocator *a, pir_polytope *p, pir_polytope *q, pir_query_result results[5]) {
    static const pir_vec3 places[5] = {{5, 0.1, 0.2}, {0.1, 0.2, 2}, {0.3, 0.2, 0.4}, {2, 2, 0.25}, {1.5, 1.25, 1.75}};
    pir_pair_options options = {sizeof options, a, PIR_LEVEL_NONE, PIR_LEVEL_WHOLE};
    pir_workspace *workspace = NULL;
    pir_pair *pair = NULL;
    pir_status status = pir_workspace_create(a, &workspace);
    if (status == PIR_OK)
        status = pir_pair_create(p, q, &options, &pair);
    for (int i = 0; i < 5 && status == PIR_OK; i++) {
        pir_pair_input input = pir_pair_input_default();
        input.pose_p = (pir_pose){{0, 0, 0, 1}, places[i]};
        status = pir_pair_signed_distance(pair, workspace, &input, &results[i]);
        pir_contact contacts[16];
        size_t count;
        if (status == PIR_OK)
            status = pir_pair_manifold(pair, workspace, &input, &results[i], 16, contacts, &count);
    }
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    return status;
}

static void memory_that_fails_at_any_request_is_told(void **state) {
    (void)state;
    for (uint64_t at = 1, done = 0; !done; at++) {
        test_memory memory = {.fail_at = at};
        pir_allocator a = test_allocator(&memory);
        pir_polytope_options options = pir_polytope_options_default();
        const pir_vec3 points[8] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                    {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
        pir_polytope *p = NULL;
        pir_query_result results[5], expected[5];
        options.allocator = &a;
        pir_status status = pir_polytope_create(points, 8, &options, &p);
        if (status == PIR_OK)
            status = live(&a, p, p, results);
        done = memory.requests < at;
        // a surface that finds no memory costs time alone
        assert_true(status == PIR_OK || (status == PIR_ERR_MEMORY && !done));
        if (status == PIR_OK) {
            pir_polytope *plain = cube(1);
            assert_int_equal(live(NULL, plain, plain, expected), PIR_OK);
            for (int i = 0; i < 5; i++)
                expect(test_same_result(&results[i], &expected[i]), "request %llu, pose %d", (unsigned long long)at, i);
            pir_polytope_release(plain);
        }
        pir_polytope_release(p);
        expect(memory.blocks == 0 && !memory.wrong_size && !memory.overrun, "request %llu: %zu blocks are left",
               (unsigned long long)at, memory.blocks);
    }
}

static void a_pair_is_half_a_kibibyte_and_its_surface_less(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator a = test_allocator(&memory);
    pir_pair_options options = {sizeof options, &a, PIR_LEVEL_NONE, PIR_LEVEL_WHOLE};
    pir_polytope *p = cube(1);
    pir_workspace *workspace;
    pir_pair *pair;
    pir_query_result result;
    pir_pair_input input = pir_pair_input_default();
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, p, &options, &pair), PIR_OK);
    // apart, near, then deep
    const double along[3] = {9, 2.5, 0.3};
    for (int i = 0; i < 3; i++) {
        input.pose_p.translation = (pir_vec3){along[i], 0.1, 0.2};
        assert_int_equal(pir_pair_signed_distance(pair, workspace, &input, &result), PIR_OK);
        expect(memory.bytes <= (i < 2 ? 512 : 1024), "pose %d: %zu bytes", i, memory.bytes);
    }
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(p);
}

static void no_call_allocates_once_warm(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator a = test_allocator(&memory);
    pir_pair_options options = {sizeof options, &a, PIR_LEVEL_NONE, PIR_LEVEL_WHOLE};
    test_random random = test_random_case("warm pairs", 0);
    pir_polytope *p = test_sphere(&random, 20), *q = test_sphere(&random, 24);
    pir_workspace *workspace;
    pir_pair *pair;
    uint64_t warm = 0;
    assert_int_equal(pir_workspace_create(&a, &workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, q, &options, &pair), PIR_OK);
    for (int i = 0; i < 2000; i++) {
        pir_pair_input input = pir_pair_input_default();
        pir_vec3 d = test_random_direction(&random);
        double far = i % 7 * 0.4;
        pir_query_result result;
        input.pose_p = (pir_pose){test_general_rotation(&random), {far * d.x, far * d.y, far * d.z}};
        input.pose_q.rotation = test_general_rotation(&random);
        assert_int_equal(calls[i % 4](pair, workspace, &input, &result), PIR_OK);
        if (i == 200)
            warm = memory.requests;
        if (i % 50 == 49)
            assert_int_equal(pir_pair_reset(pair, i % 100 == 99 ? p : q, q), PIR_OK);
    }
    assert_int_equal(memory.requests, warm);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(p);
    pir_polytope_release(q);
    assert_int_equal(memory.blocks, 0);
}

/* --- poses in the world --- */

static bool is_near(pir_vec3 a, pir_vec3 b, double error) {
    return fabs(a.x - b.x) <= error && fabs(a.y - b.y) <= error && fabs(a.z - b.z) <= error;
}

/*
 * Two bodies in one common turn are as before: the state exactly, what is told in the world turned along. Whatever the
 * turn, faces that touch go on touching.
 */
static void a_common_turn_changes_no_state(void **state) {
    (void)state;
    pir_polytope *p = cube(1), *q = cube(0.5);
    pir_workspace *workspace;
    pir_pair *pair, *whole;
    pir_pair_options options = pir_pair_options_default();
    options.least = PIR_LEVEL_WHOLE;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, q, NULL, &pair), PIR_OK);
    assert_int_equal(pir_pair_create(p, q, &options, &whole), PIR_OK);
    uint32_t touching = 0;
    for (uint64_t i = 0; i < 400; i++) {
        test_random random = test_random_case("common turns", i);
        // Q turned by a and P by a·r, r a turn that takes the axes to axes: exact for small integers
        static const pir_quat turns[4] = {{0, 0, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}, {0, 1, 0, 0}};
        pir_quat a = test_integer_rotation(&random), r = turns[i % 4];
        // half steps: faces, edges and corners meet, or the bodies overlap or are apart; a translation along with a
        // turn by quarters stays exact
        pir_vec3 t = {test_random_between(&random, -4, 4) / 2.0, test_random_between(&random, -4, 4) / 2.0,
                      test_random_between(&random, -4, 4) / 2.0};
        if (i % 2)
            a = turns[test_random_below(&random, 4)];
        else
            t = (pir_vec3){0, 0, 0};
        pir_pair_input plain = pir_pair_input_default(), turned = plain;
        plain.pose_p = (pir_pose){r, t};
        turned.pose_q.rotation = a;
        turned.pose_p.rotation = test_compose(a, r, 0);
        pir_query_result expected, result, other;
        // what a does to t, which is exact for quarter turns
        double n = a.x * a.x + a.y * a.y + a.z * a.z + a.w * a.w,
               m[3][3] = {{a.w * a.w + a.x * a.x - a.y * a.y - a.z * a.z, 2 * (a.x * a.y - a.w * a.z),
                           2 * (a.x * a.z + a.w * a.y)},
                          {2 * (a.x * a.y + a.w * a.z), a.w * a.w - a.x * a.x + a.y * a.y - a.z * a.z,
                           2 * (a.y * a.z - a.w * a.x)},
                          {2 * (a.x * a.z - a.w * a.y), 2 * (a.y * a.z + a.w * a.x),
                           a.w * a.w - a.x * a.x - a.y * a.y + a.z * a.z}};
        pir_vec3 at = {(m[0][0] * t.x + m[0][1] * t.y + m[0][2] * t.z) / n,
                       (m[1][0] * t.x + m[1][1] * t.y + m[1][2] * t.z) / n,
                       (m[2][0] * t.x + m[2][1] * t.y + m[2][2] * t.z) / n};
        pir_vec3 origin = {i % 3 == 0 ? 0 : 3, -2, 8};
        turned.pose_q.translation = origin;
        turned.pose_p.translation = (pir_vec3){origin.x + at.x, origin.y + at.y, origin.z + at.z};
        assert_int_equal(pir_pair_signed_distance(pair, workspace, &plain, &expected), PIR_OK);
        assert_int_equal(pir_pair_signed_distance(pair, workspace, &turned, &result), PIR_OK);
        assert_int_equal(pir_pair_signed_distance(whole, workspace, &turned, &other), PIR_OK);
        expect(test_same_result(&result, &other), "turn %llu: levels %d and %d differ", (unsigned long long)i,
               (int)pir_pair_level(pair), (int)pir_pair_level(whole));
        expect(result.state == expected.state && result.witness.p.index == expected.witness.p.index &&
                   result.witness.q.index == expected.witness.q.index &&
                   fabs(result.distance - expected.distance) < 1e-13,
               "turn %llu: state %d, not %d, distance %g, not %g", (unsigned long long)i, (int)result.state,
               (int)expected.state, result.distance, expected.distance);
        pir_vec3 w = {(m[0][0] * expected.point_q.x + m[0][1] * expected.point_q.y + m[0][2] * expected.point_q.z) / n,
                      (m[1][0] * expected.point_q.x + m[1][1] * expected.point_q.y + m[1][2] * expected.point_q.z) / n,
                      (m[2][0] * expected.point_q.x + m[2][1] * expected.point_q.y + m[2][2] * expected.point_q.z) / n};
        w = (pir_vec3){w.x + origin.x, w.y + origin.y, w.z + origin.z};
        expect(is_near(w, result.point_q, 1e-13), "turn %llu: point", (unsigned long long)i);
        touching += result.state == PIR_BOUNDARY;
    }
    // a half of the poses with a translation have faces, edges or corners that meet
    assert_true(touching > 20);
    pir_pair_destroy(pair);
    pir_pair_destroy(whole);
    pir_workspace_destroy(workspace);
    pir_polytope_release(p);
    pir_polytope_release(q);
}

/* Poses of any kind: all levels agree with the whole difference, bit for bit. */
static void posed_pairs_answer_alike_at_all_levels(void **state) {
    (void)state;
    pir_workspace *workspace;
    pir_pair_options options = pir_pair_options_default();
    options.least = PIR_LEVEL_WHOLE;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("posed pairs", i);
        test_pose pose;
        test_random_pose(&random, 12, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        pir_pair *pair, *whole;
        pir_status status = pir_pair_create(p, q, NULL, &pair);
        if (status == PIR_OK) {
            assert_int_equal(pir_pair_create(p, q, &options, &whole), PIR_OK);
            pir_vec3 from = pir_polytope_vertex(p, 0), to = pir_polytope_vertex(q, 0);
            for (int k = 0; k < 24; k++) {
                pir_pair_input input = pir_pair_input_default();
                pir_query_result result, expected;
                double s = (k % 6) * 0.5;
                input.pose_q.rotation = k % 3 ? test_integer_rotation(&random) : test_general_rotation(&random);
                input.pose_p.rotation =
                    k % 2 ? input.pose_q.rotation : test_compose(input.pose_q.rotation, pose.rotation, 0);
                input.pose_q.translation = (pir_vec3){from.x, s, 1};
                input.pose_p.translation = (pir_vec3){s * to.x, 0, from.z};
                status = calls[k % 4](pair, workspace, &input, &result);
                assert_int_equal(calls[k % 4](whole, workspace, &input, &expected), status);
                expect(status != PIR_OK || test_same_result(&result, &expected), "case %llu (%s), pose %d, level %d",
                       (unsigned long long)i, pose.situation, k, (int)pir_pair_level(pair));
            }
            pir_pair_destroy(pair);
            pir_pair_destroy(whole);
        }
        pir_polytope_release(p);
        pir_polytope_release(q);
    }
    pir_workspace_destroy(workspace);
}

/* --- levels --- */

static void a_level_that_is_capped_refuses_and_one_that_is_forced_answers_alike(void **state) {
    (void)state;
    pir_polytope *p = cube(1);
    pir_workspace *workspace;
    pir_pair *capped, *forced;
    pir_pair_options options = pir_pair_options_default();
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result, expected;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    options.most = PIR_LEVEL_NEAR;
    assert_int_equal(pir_pair_create(p, p, &options, &capped), PIR_OK);
    options.least = options.most = PIR_LEVEL_WHOLE;
    assert_int_equal(pir_pair_create(p, p, &options, &forced), PIR_OK);
    // concentric: nothing below a surface tells
    assert_int_equal(pir_pair_penetration(capped, workspace, &input, &result), PIR_ERR_LIMIT);
    assert_int_equal(pir_pair_penetration(forced, workspace, &input, &expected), PIR_OK);
    assert_int_equal(pir_pair_level(forced), PIR_LEVEL_WHOLE);
    input.pose_p.translation = (pir_vec3){4, 0.25, 0.5};
    assert_int_equal(pir_pair_distance(capped, workspace, &input, &result), PIR_OK);
    assert_int_equal(pir_pair_distance(forced, workspace, &input, &expected), PIR_OK);
    assert_true(test_same_result(&result, &expected) && result.distance == 2);
    assert_int_equal(pir_pair_level(capped), PIR_LEVEL_NEAR);
    // the first answer beyond a cutoff leaves a proof, which is enough for the others
    input.cutoff = 0.5;
    for (int i = 0; i < 11; i++) {
        input.pose_p.translation.x -= 0.0625;
        assert_int_equal(pir_pair_distance(capped, workspace, &input, &result), PIR_OK);
        assert_int_equal(result.outcome, PIR_BEYOND_CUTOFF);
        assert_int_equal(pir_pair_level(capped), i == 0 ? PIR_LEVEL_NEAR : PIR_LEVEL_APART);
    }
    pir_pair_statistics statistics = pir_pair_get_statistics(capped);
    assert_int_equal(statistics.by_proof, 10);
    assert_int_equal(statistics.queries, 13);
    pir_pair_destroy(capped);
    pir_pair_destroy(forced);
    pir_workspace_destroy(workspace);
    pir_polytope_release(p);
}

/* The pair's answer is that of the whole difference, by a level of those allowed, or the call is refused. */
static void check_level(pir_pair *pair, const pir_pair_options *options, pir_workspace *workspace, int call,
                        const pir_pair_input *input, const pir_query_result *expected, size_t asked[2]) {
    pir_query_result result;
    pir_status status = calls[call](pair, workspace, input, &result);
    pir_level level = pir_pair_level(pair);
    expect(status == PIR_OK || (status == PIR_ERR_LIMIT && options->most < PIR_LEVEL_WHOLE),
           "levels %d to %d: status %d", (int)options->least, (int)options->most, (int)status);
    expect(status != PIR_OK || (level >= options->least && level <= options->most && level > PIR_LEVEL_NONE),
           "levels %d to %d: an answer by level %d", (int)options->least, (int)options->most, (int)level);
    expect(status != PIR_OK || test_same_result(&result, expected), "levels %d to %d: another answer by level %d",
           (int)options->least, (int)options->most, (int)level);
    asked[status != PIR_OK]++;
}

/* All options, at poses apart, resting and deep, one pair for each that goes from pose to pose. */
static void an_answer_comes_by_a_level_that_is_allowed(void **state) {
    (void)state;
    pir_workspace *workspace;
    size_t asked[2] = {0, 0};
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t i = 0; i < 40; i++) {
        test_random random = test_random_case("allowed levels", i);
        test_pose pose;
        test_random_pose(&random, i % 2 ? 12 : 60, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        for (int least = PIR_LEVEL_NONE; least <= PIR_LEVEL_WHOLE; least++)
            for (int most = least > PIR_LEVEL_APART ? least : PIR_LEVEL_APART; most <= PIR_LEVEL_WHOLE; most++) {
                pir_pair_options options = {sizeof options, NULL, (pir_level)least, (pir_level)most},
                                 all = {sizeof all, NULL, PIR_LEVEL_WHOLE, PIR_LEVEL_WHOLE};
                pir_pair *pair, *whole;
                if (pir_pair_create(p, q, &options, &pair) != PIR_OK)
                    continue;
                assert_int_equal(pir_pair_create(p, q, &all, &whole), PIR_OK);
                pir_vec3 from = pir_polytope_vertex(p, 0), to = pir_polytope_vertex(q, 0);
                for (int k = 0; k < 12; k++) {
                    pir_pair_input input = pir_pair_input_default();
                    pir_query_result expected;
                    double part = k % 3 == 0 ? 1 : 1 + 0.5 * test_random_unit(&random);
                    input.pose_p.translation =
                        (pir_vec3){part * (to.x - from.x), part * (to.y - from.y), part * (to.z - from.z)};
                    input.cutoff = k % 4 == 3 ? 0.125 : HUGE_VAL;
                    if (calls[k % 4](whole, workspace, &input, &expected) == PIR_OK)
                        check_level(pair, &options, workspace, k % 4, &input, &expected, asked);
                }
                pir_pair_destroy(pair);
                pir_pair_destroy(whole);
            }
        pir_polytope_release(p);
        pir_polytope_release(q);
    }
    print_message("# %zu answers, %zu refused\n", asked[0], asked[1]);
    assert_true(asked[0] > 1000 && asked[1] > 100);
    pir_workspace_destroy(workspace);
}

/* Whether bodies overlap is asked for without a distance: the cutoff is none of it. */
static void rounded_bodies_are_separated_or_overlap_whatever_the_cutoff(void **state) {
    (void)state;
    static const double places[3] = {5, 2.125, 2}, cutoffs[3] = {HUGE_VAL, 0, 0.5};
    static const pir_outcome outcomes[3] = {PIR_SEPARATED, PIR_TOUCHING, PIR_OVERLAPPING};
    pir_polytope *p = cube(1);
    pir_workspace *workspace;
    pir_pair *pair;
    pir_sum *sum;
    pir_query *query;
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, p, NULL, &pair), PIR_OK);
    assert_int_equal(pir_sum_create(p, p, (pir_quat){0, 0, 0, 1}, &options, &sum), PIR_OK);
    assert_int_equal(pir_query_create(sum, &query), PIR_OK);
    for (int i = 0; i < 9; i++) {
        pir_pair_input input = pir_pair_input_default();
        pir_query_input asked = pir_query_input_default();
        pir_query_result result, same;
        input.pose_p.translation.x = asked.translation.x = places[i % 3];
        input.radius_p = asked.radius_p = 0.125;
        input.cutoff = asked.cutoff = cutoffs[i / 3];
        assert_int_equal(pir_pair_overlap(pair, workspace, &input, &result), PIR_OK);
        assert_int_equal(pir_query_overlap(query, &asked, NULL, &same), PIR_OK);
        assert_int_equal(result.outcome, outcomes[i % 3]);
        assert_true(result.distance == 0 && test_same_result(&result, &same));
        // on the boundary alone there is a contact
        assert_true((result.normal.x == 1) == (result.outcome == PIR_TOUCHING));
    }
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(p);
}

/* P goes round Q with the same facet towards it: the direction that parts them turns with P, and is tried so. */
static void a_direction_that_turns_with_p_still_parts(void **state) {
    (void)state;
    pir_polytope *p = cube(1);
    pir_workspace *workspace;
    pir_pair *pair;
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, p, NULL, &pair), PIR_OK);
    input.cutoff = 0.5;
    for (int i = 0; i < 24; i++) {
        // 30 degrees a frame: along the direction as it was, the cubes overlap
        const double angle = i * 0.52359877559829887;
        input.pose_p.rotation = (pir_quat){0, 0, sin(angle / 2), cos(angle / 2)};
        input.pose_p.translation = (pir_vec3){3 * cos(angle), 3 * sin(angle), 0};
        assert_int_equal(pir_pair_distance(pair, workspace, &input, &result), PIR_OK);
        assert_int_equal(result.outcome, PIR_BEYOND_CUTOFF);
    }
    pir_pair_statistics statistics = pir_pair_get_statistics(pair);
    assert_int_equal(statistics.by_nearest, 1);
    assert_int_equal(statistics.by_proof, 23);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(p);
}

/* Signed distance of two bodies at their poses, by a pair of their own. */
static pir_query_result signed_distance(pir_polytope *p, pir_polytope *q, pir_pose pose_p, pir_pose pose_q) {
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result = {0};
    pir_workspace *workspace;
    pir_pair *pair;
    input.pose_p = pose_p;
    input.pose_q = pose_q;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, q, NULL, &pair), PIR_OK);
    assert_int_equal(pir_pair_signed_distance(pair, workspace, &input, &result), PIR_OK);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    return result;
}

/*
 * A body far from its origin, as a triangle of a terrain is, which is not turned, beside one that is. With the bodies
 * exchanged, and with the far one brought to its origin by its pose, the states are the same, and so are distances but
 * for rounding.
 */
static void a_body_far_from_its_origin_answers_as_one_near_it(void **state) {
    (void)state;
    const int most[4] = {5, 12, 20, 26};
    uint64_t states[3] = {0};
    for (uint64_t n = 0; n < 3000; n++) {
        test_random random = test_random_case("far bodies", n);
        const double far = ldexp(1, most[n % 4]);
        const pir_vec3 d = test_random_direction(&random),
                       by = {nearbyint(far * d.x), nearbyint(far * d.y), nearbyint(far * d.z)};
        test_points points, moved;
        test_body_points(&random, n % 3 ? TEST_BOX : TEST_SPHERE, n % 3 ? 8 : 3, &points);
        pir_polytope *near_p = test_polytope(&points), *p = NULL;
        assert_int_equal(pir_polytope_translate(near_p, by, &p), PIR_OK);
        test_body_points(&random, TEST_SPHERE, 12, &moved);
        pir_polytope *q = test_polytope(&moved);
        const pir_quat turn = test_general_rotation(&random);
        const pir_vec3 off = test_random_direction(&random);
        const double apart = 2.5 * test_random_unit(&random);
        const pir_pose none = {{0, 0, 0, n % 5 ? 1 : 3}, {0.25, 0, 0}};
        const pir_pose at_by = {{0, 0, 0, 1}, {by.x + 0.25, by.y, by.z}};
        const pir_pose pose = {turn, {by.x + apart * off.x, by.y + apart * off.y, by.z + apart * off.z}};
        const pir_query_result told = signed_distance(p, q, none, pose), back = signed_distance(q, p, pose, none),
                               near = signed_distance(near_p, q, at_by, pose);
        states[told.state]++;
        expect(told.state == back.state && told.state == near.state, "case %llu: states %d, %d, %d",
               (unsigned long long)n, (int)told.state, (int)back.state, (int)near.state);
        expect(fabs(told.distance - back.distance) <= 1e-13 && fabs(told.distance - near.distance) <= 1e-13,
               "case %llu: distances %.17g, %.17g, %.17g", (unsigned long long)n, told.distance, back.distance,
               near.distance);
        pir_polytope_release(p);
        pir_polytope_release(near_p);
        pir_polytope_release(q);
    }
    assert_true(states[PIR_OUTSIDE] > 300 && states[PIR_INSIDE] > 300);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_no_pair_is_refused),
        cmocka_unit_test(what_is_no_pose_is_refused_and_changes_nothing),
        cmocka_unit_test(memory_that_fails_at_any_request_is_told),
        cmocka_unit_test(a_pair_is_half_a_kibibyte_and_its_surface_less),
        cmocka_unit_test(no_call_allocates_once_warm),
        cmocka_unit_test(a_common_turn_changes_no_state),
        cmocka_unit_test(posed_pairs_answer_alike_at_all_levels),
        cmocka_unit_test(a_direction_that_turns_with_p_still_parts),
        cmocka_unit_test(a_body_far_from_its_origin_answers_as_one_near_it),
        cmocka_unit_test(an_answer_comes_by_a_level_that_is_allowed),
        cmocka_unit_test(rounded_bodies_are_separated_or_overlap_whatever_the_cutoff),
        cmocka_unit_test(a_level_that_is_capped_refuses_and_one_that_is_forced_answers_alike),
    };
    return cmocka_run_group_tests_name("pairs in use", tests, NULL, NULL);
}
