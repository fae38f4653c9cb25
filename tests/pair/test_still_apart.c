/* SPDX-License-Identifier: MIT */
/*
 * A pair that was apart answers from how far the bodies have moved since, without a frame: as a pair does that is new,
 * in whatever steps they move, by whatever quaternions the rotations are given, with Q at other places, Q moving too,
 * and with radii and cutoffs that change. What is no input is refused there too.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include <pirouette/pair.h>

#include "support/answers.h"
#include "support/bodies.h"

#define FRAMES 30000

static double between(test_random *random, double low, double high) {
    return low + (high - low) * (test_random_unit(random) + 1) / 2;
}

static pir_polytope *ball(test_random *random, int count, pir_vec3 middle) {
    test_points points = {.count = (size_t)count};
    for (int i = 0; i < count; i++) {
        pir_vec3 d = test_random_direction(random);
        points.at[i] = (pir_vec3){middle.x + d.x, middle.y + d.y, middle.z + d.z};
    }
    return test_polytope(&points);
}

static pir_vec3 moved(test_random *random, pir_vec3 from, double by) {
    pir_vec3 d = test_random_direction(random);
    return (pir_vec3){from.x + by * d.x, from.y + by * d.y, from.z + by * d.z};
}

/* A quaternion beside q: of length 1 or of another, or of the other sign. */
static pir_quat turned(test_random *random, pir_quat q, double by) {
    pir_vec3 d = test_random_direction(random);
    pir_quat n = {q.x + by * d.x, q.y + by * d.y, q.z + by * d.z, q.w + by * between(random, -1, 1)};
    double length = sqrt(n.x * n.x + n.y * n.y + n.z * n.z + n.w * n.w);
    double scale = test_random_below(random, 8) ? 1 : between(random, -2, 2);
    double s = (test_random_below(random, 16) ? 1 : -1) * scale / length;
    return (pir_quat){n.x * s, n.y * s, n.z * s, n.w * s};
}

/* P comes straight towards Q's middle, from wherever it is. */
static void come(pir_pair_input *input, double by) {
    pir_vec3 p = input->pose_p.translation, q = input->pose_q.translation;
    pir_vec3 way = {q.x - p.x, q.y - p.y, q.z - p.z};
    double length = sqrt(way.x * way.x + way.y * way.y + way.z * way.z) + 1e-9;
    input->pose_p.translation =
        (pir_vec3){p.x + by * way.x / length, p.y + by * way.y / length, p.z + by * way.z / length};
}

/* P turns on about an axis of its own, from which it is far. */
static void turn_on(pir_pair_input *input, double by) {
    pir_quat q = input->pose_p.rotation;
    input->pose_p.rotation = (pir_quat){q.x + by * q.y, q.y - by * q.x, q.z + by * q.w, q.w - by * q.z};
}

/* The next frame: mostly a little beside the last one. */
static void next_input(test_random *random, int frame, pir_pair_input *input) {
    double by = ldexp(1, -(int)test_random_below(random, 24)), far = between(random, 1, 7);
    if (frame % 50 == 0)
        input->pose_p.translation = moved(random, input->pose_q.translation, far);
    if (test_random_below(random, 100) == 0)
        input->pose_q =
            (pir_pose){turned(random, input->pose_q.rotation, 1),
                       moved(random, input->pose_q.translation, ldexp(1, (int)test_random_below(random, 9)))};
    if (test_random_below(random, 20) == 0)
        input->cutoff = between(random, -0.1, 1);
    if (test_random_below(random, 20) == 0)
        input->radius_p = test_random_below(random, 2) ? between(random, 0, 0.5) : 0;
    // both go along, Q at its own pace
    if (frame / 50 % 5 == 4) {
        input->pose_q.translation = moved(random, input->pose_q.translation, by / 8);
        input->pose_q.rotation = turned(random, input->pose_q.rotation, by / 8);
    }
    if (frame / 50 % 3 == 0) {
        come(input, 0.02);
    } else if (frame / 50 % 3 == 1) {
        turn_on(input, 0.01);
    } else {
        input->pose_p.rotation = turned(random, input->pose_p.rotation, by);
        input->pose_p.translation = moved(random, input->pose_p.translation, by);
    }
}

struct scene {
    pir_pair *kept, *fresh;
    pir_workspace *of_kept, *of_fresh;
    pir_polytope *p, *q;
};

/* States and depths of both pairs, for which apart is enough. */
static void check_state(const struct scene *scene, const pir_pair_input *input, int frame) {
    pir_query_result result, expected;
    assert_int_equal(pir_pair_overlap(scene->fresh, scene->of_fresh, input, &expected), PIR_OK);
    assert_int_equal(pir_pair_overlap(scene->kept, scene->of_kept, input, &result), PIR_OK);
    expect(test_same_result(&result, &expected), "frame %d: state %d not %d", frame, (int)result.state,
           (int)expected.state);
    assert_int_equal(pir_pair_penetration(scene->fresh, scene->of_fresh, input, &expected), PIR_OK);
    assert_int_equal(pir_pair_penetration(scene->kept, scene->of_kept, input, &result), PIR_OK);
    expect(test_same_result(&result, &expected), "frame %d: outcome %d not %d, depth %.17g not %.17g", frame,
           (int)result.outcome, (int)expected.outcome, result.distance, expected.distance);
}

static void check_still_apart(const struct scene *scene, const pir_pair_input *input, int frame) {
    pir_query_result result, expected;
    pir_contact contacts[32], right[32];
    size_t count = 99, right_count = 98;
    assert_int_equal(pir_pair_reset(scene->fresh, scene->p, scene->q), PIR_OK);
    if (frame % 8 == 7)
        check_state(scene, input, frame);
    assert_int_equal(pir_pair_signed_distance(scene->fresh, scene->of_fresh, input, &expected), PIR_OK);
    assert_int_equal(pir_pair_signed_distance(scene->kept, scene->of_kept, input, &result), PIR_OK);
    expect(test_same_result(&result, &expected), "frame %d: outcome %d not %d, distance %.17g not %.17g", frame,
           (int)result.outcome, (int)expected.outcome, result.distance, expected.distance);
    pir_status status = pir_pair_manifold(scene->kept, scene->of_kept, input, &result, 32, contacts, &count);
    assert_int_equal(status, PIR_OK);
    status = pir_pair_manifold(scene->fresh, scene->of_fresh, input, &expected, 32, right, &right_count);
    assert_int_equal(status, PIR_OK);
    expect(count == right_count, "frame %d: %zu contacts, not %zu", frame, count, right_count);
}

/* P with its middle at some place of its own. */
static void check_motion(uint64_t number, pir_vec3 middle) {
    test_random random = test_random_case("still apart", number);
    struct scene scene = {.p = ball(&random, 12, middle), .q = ball(&random, 30, (pir_vec3){0, 0, 0})};
    assert_int_equal(pir_workspace_create(NULL, &scene.of_kept), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &scene.of_fresh), PIR_OK);
    assert_int_equal(pir_pair_create(scene.p, scene.q, NULL, &scene.kept), PIR_OK);
    assert_int_equal(pir_pair_create(scene.p, scene.q, NULL, &scene.fresh), PIR_OK);
    pir_pair_input input = pir_pair_input_default();
    input.cutoff = 0.1;
    for (int frame = 0; frame < FRAMES; frame++) {
        next_input(&random, frame, &input);
        check_still_apart(&scene, &input, frame);
    }
    pir_pair_statistics used = pir_pair_get_statistics(scene.kept);
    expect(used.by_proof > FRAMES / 4, "%llu by certificate", (unsigned long long)used.by_proof);
    expect(used.queries == FRAMES + FRAMES / 8 * 2, "%llu queries in as many frames", (unsigned long long)used.queries);
    expect(used.by_walk + used.by_depth > FRAMES / 50, "near in %llu", (unsigned long long)used.by_walk);
    pir_pair_destroy(scene.kept);
    pir_pair_destroy(scene.fresh);
    pir_workspace_destroy(scene.of_kept);
    pir_workspace_destroy(scene.of_fresh);
    pir_polytope_release(scene.p);
    pir_polytope_release(scene.q);
}

static void answers_without_a_frame_are_those_of_a_new_pair(void **state) {
    (void)state;
    check_motion(0, (pir_vec3){0, 0, 0});
    check_motion(1, (pir_vec3){3, -1, 0.5});
}

static void what_is_no_input_is_refused_where_bodies_were_apart(void **state) {
    (void)state;
    test_random random = test_random_case("refused apart", 0);
    pir_polytope *p = ball(&random, 12, (pir_vec3){0, 0, 0});
    pir_workspace *workspace;
    pir_pair *pair;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, p, NULL, &pair), PIR_OK);
    const pir_vec3 apart = {10, 0, 0};
    struct {
        pir_quat q;
        pir_vec3 t;
        double radius, cutoff;
        pir_status status;
    } const cases[] = {{{0, 0, 0, 0}, apart, 0, 1, PIR_ERR_ZERO_QUATERNION},
                       {{0, NAN, 0, 1}, apart, 0, 1, PIR_ERR_NOT_FINITE},
                       {{0, 0, 0, 1}, {10, NAN, 0}, 0, 1, PIR_ERR_NOT_FINITE},
                       {{0, 0, 0, 1}, {INFINITY, 0, 0}, 0, 1, PIR_ERR_NOT_FINITE},
                       {{0, 0, 0, 1}, {1e300, 0, 0}, 0, 1, PIR_ERR_LIMIT},
                       {{0, 0, 0, 1}, apart, -1e-3, 1, PIR_ERR_ARGUMENT},
                       {{0, 0, 0, 1}, apart, NAN, 1, PIR_ERR_NOT_FINITE},
                       {{0, 0, 0, 1}, apart, 0, NAN, PIR_ERR_NOT_FINITE},
                       {{0x1p-1000, 0, 0, 1}, apart, 0, 1, PIR_ERR_LIMIT}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        pir_pair_input input = pir_pair_input_default();
        pir_query_result result;
        input.pose_p.translation = apart;
        input.pose_q.rotation = (pir_quat){0, 0, 0.6, 0.8};
        input.cutoff = 1;
        assert_int_equal(pir_pair_signed_distance(pair, workspace, &input, &result), PIR_OK);
        assert_int_equal(pir_pair_signed_distance(pair, workspace, &input, &result), PIR_OK);
        assert_int_equal(pir_pair_level(pair), PIR_LEVEL_APART);
        input.pose_p = (pir_pose){cases[i].q, cases[i].t};
        input.radius_p = cases[i].radius;
        input.cutoff = cases[i].cutoff;
        pir_status status = pir_pair_signed_distance(pair, workspace, &input, &result);
        expect(status == cases[i].status, "case %zu: status %d", i, (int)status);
    }
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(answers_without_a_frame_are_those_of_a_new_pair),
        cmocka_unit_test(what_is_no_input_is_refused_where_bodies_were_apart),
    };
    return cmocka_run_group_tests_name("still apart", tests, NULL, NULL);
}
