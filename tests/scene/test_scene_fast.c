/* SPDX-License-Identifier: MIT */
/*
 * Fast bodies: nothing passes through a thin wall, at any speed and from any side; meetings are those of casts in a
 * scene that stands as this one after its update, bit for bit, in the order of numbers and with any threads; failures
 * leave none.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/body_shape.h>
#include <pirouette/scene_file.h>
#include <pirouette/scene_query.h>

#include "scene/scene_bodies.h"
#include "support/memory.h"
#include "support/random.h"
#include "support/vectors.h"

#define STEP (1. / 60)

static uint32_t add_shape(pir_scene *scene, const pir_body_shape *shape, pir_pose pose, pir_body_kind kind,
                          double fast) {
    pir_body_options body = pir_body_shape_options(shape);
    uint32_t id;
    body.pose = pose;
    body.kind = kind;
    body.fast = fast;
    assert_int_equal(pir_scene_add(scene, &body, &id), PIR_OK);
    return id;
}

/* Bullets of 1 cm at 200 m/s, 3.3 m a step, through a wall of 1 cm that turns a little every time. */
static void nothing_passes_a_thin_wall(void **state) {
    (void)state;
    test_random random = test_random_case("bullets", 0);
    pir_body_shape *ball, *shard, *wall;
    const pir_vec3 corner[4] = {{-0.01, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}};
    pir_scene *scene;
    uint32_t hits = 0;
    assert_int_equal(pir_body_shape_ball(0.005, NULL, NULL, &ball), PIR_OK);
    assert_int_equal(pir_body_shape_hull(corner, 4, 0, NULL, NULL, &shard), PIR_OK);
    assert_int_equal(pir_body_shape_box((pir_vec3){0.005, 2, 2}, 0, NULL, NULL, &wall), PIR_OK);
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    const uint32_t wall_id = add_shape(scene, wall, scene_at(0, 0, 0), PIR_BODY_KINEMATIC, 0);
    const uint32_t bullet[2] = {add_shape(scene, ball, scene_at(5, 0, 0), PIR_BODY_MOVING, 1e-4),
                                add_shape(scene, shard, scene_at(5, 1, 0), PIR_BODY_MOVING, 1e-4)};
    for (int shot = 0; shot < 400; shot++) {
        const double turn = 0.1 * test_random_unit(&random);
        pir_scene_move move[3] = {{wall_id, scene_at(0, 0, 0)},
                                  {bullet[0], {{0, 0, 0, 1}, {0, 0, 0}}},
                                  {bullet[1], {{0, 0, 0, 1}, {0, 0, 0}}}};
        const double side = shot % 2 ? -1 : 1;
        move[0].pose.rotation = (pir_quat){0, sin(turn), 0, cos(turn)};
        for (int k = 1; k < 3; k++) {
            const pir_vec3 off = test_random_direction(&random);
            move[k].pose.translation = (pir_vec3){side * (2 + test_random_unit(&random)), off.y, off.z};
            move[k].pose.rotation =
                test_random_unit(&random) > 0.5 ? (pir_quat){off.x, off.y, off.z, 1} : (pir_quat){0, 0, 0, 1};
        }
        assert_int_equal(pir_scene_update(scene, move, 3), PIR_OK);
        for (int k = 1; k < 3; k++)
            move[k].pose =
                pir_pose_integrate(move[k].pose, (pir_vec3){-200 * side, 0, 0}, test_random_direction(&random), STEP);
        size_t count;
        assert_int_equal(pir_scene_update(scene, move + 1, 2), PIR_OK);
        const pir_scene_impact *met = pir_scene_impacts(scene, &count);
        expect(count == 2 && met[0].body == bullet[0] && met[1].body == bullet[1], "shot %d: %zu meetings", shot,
               count);
        for (size_t k = 0; k < count; k++) {
            expect(met[k].impact.body == wall_id && met[k].impact.outcome == PIR_CAST_HIT && met[k].impact.time > 0 &&
                       met[k].impact.time < 1 && met[k].impact.normal.x * side > 0.9,
                   "shot %d: outcome %d at %g", shot, (int)met[k].impact.outcome, met[k].impact.time);
            hits++;
        }
        pir_scene_events(scene, &count);
        assert_int_equal(count, 0); // it was never there at the end of a step
    }
    assert_int_equal(hits, 800);
    pir_scene_destroy(scene);
    pir_body_shape_release(ball);
    pir_body_shape_release(shard);
    pir_body_shape_release(wall);
}

#define CROWD 24

/* All that moves is fast; the meetings are those of bodies at their old poses among others at the new ones. */
static void meetings_are_those_of_casts(void **state) {
    (void)state;
    test_random random = test_random_case("fast", 0);
    pir_body_shape *shape[2];
    uint32_t met_all = 0;
    assert_int_equal(pir_body_shape_box((pir_vec3){0.25, 0.125, 0.5}, 0.0625, NULL, NULL, &shape[0]), PIR_OK);
    assert_int_equal(pir_body_shape_cone(0.25, 0.5, 8, NULL, NULL, &shape[1]), PIR_OK);
    for (uint32_t threads = 1; threads < 4; threads += 2) {
        pir_scene_options options = pir_scene_options_default();
        pir_scene *scene, *other;
        pir_scene_move move[CROWD];
        uint32_t id[CROWD];
        options.threads = threads;
        assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
        assert_int_equal(pir_scene_create(NULL, &other), PIR_OK);
        for (uint32_t i = 0; i < CROWD; i++) {
            const pir_vec3 at = test_random_direction(&random);
            const pir_body_kind kind = i % 4 == 3 ? PIR_BODY_STATIC : PIR_BODY_MOVING;
            const pir_pose pose = scene_at(3 * at.x, 3 * at.y, 3 * at.z);
            id[i] = add_shape(scene, shape[i % 2], pose, kind, i % 3 ? 1e-3 : 0);
            assert_int_equal(add_shape(other, shape[i % 2], pose, kind, 0), id[i]);
        }
        for (int frame = 0; frame < 12; frame++) {
            pir_pose before[CROWD];
            size_t moves = 0, count, next = 0;
            for (uint32_t i = CROWD; i-- > 0;) {
                assert_int_equal(pir_scene_pose(scene, id[i], &before[i]), PIR_OK);
                if (i % 4 == 3)
                    continue;
                const pir_vec3 velocity = test_random_direction(&random), spin = test_random_direction(&random);
                move[moves++] = (pir_scene_move){id[i], pir_pose_integrate(before[i], velocity, spin, 2)};
            }
            assert_int_equal(pir_scene_update(scene, move, moves), PIR_OK);
            const pir_scene_impact *met = pir_scene_impacts(scene, &count);
            for (uint32_t i = 0; i < CROWD; i++) {
                if (i % 4 == 3 || i % 3 == 0)
                    continue;
                pir_impact right;
                pir_pose after;
                assert_int_equal(pir_scene_update(other, move, moves), PIR_OK);
                assert_int_equal(pir_scene_pose(other, id[i], &after), PIR_OK);
                const pir_scene_move back = {id[i], before[i]};
                assert_int_equal(pir_scene_update(other, &back, 1), PIR_OK);
                // the turn as its axis and angle, by another formula
                const pir_quat a = before[i].rotation, b = after.rotation;
                const double la = sqrt(a.x * a.x + a.y * a.y + a.z * a.z + a.w * a.w);
                const pir_vec3 u = {-a.x / la, -a.y / la, -a.z / la}, v = {b.x, b.y, b.z};
                pir_vec3 axis = test_add(test_add(test_cross(v, u), v, a.w / la), test_add(test_zero, u, b.w), 1);
                double w = a.w / la * b.w - test_dot(v, u);
                const double sign = w < 0 ? -1 : 1, s = test_length(axis);
                axis = test_add(test_zero, axis, s > 0 ? sign * 2 * atan2(s, sign * w) / s : 0);
                const pir_motion motion = {test_add(after.translation, before[i].translation, -1), axis, 0};
                assert_int_equal(pir_scene_time_of_impact(other, id[i], &motion, 1e-3, &right), PIR_OK);
                if (right.body == PIR_SCENE_NONE) {
                    expect(next == count || met[next].body != id[i], "frame %d, body %u", frame, i);
                    continue;
                }
                expect(next < count && met[next].body == id[i] && met[next].impact.body == right.body &&
                           met[next].impact.outcome == right.outcome && fabs(met[next].impact.time - right.time) < 1e-6,
                       "frame %d, body %u: %g", frame, i, right.time);
                next++;
            }
            expect(next == count, "frame %d: %zu meetings, and %zu", frame, count, next);
            met_all += (uint32_t)count;
        }
        pir_scene_destroy(scene);
        pir_scene_destroy(other);
    }
    expect(met_all > 20, "%u meetings", met_all);
    pir_body_shape_release(shape[0]);
    pir_body_shape_release(shape[1]);
}

static void failures_leave_no_meetings(void **state) {
    (void)state;
    pir_polytope *cube = scene_cube(0.25);
    pir_status status = PIR_ERR_MEMORY;
    uint64_t failures = 0;
    pir_body_shape *shape;
    pir_report report;
    assert_int_equal(pir_body_shape_box((pir_vec3){0.25, 0.25, 0.25}, 0, NULL, NULL, &shape), PIR_OK);
    for (uint64_t request = 1; status == PIR_ERR_MEMORY; request++) {
        test_memory memory = {0};
        const pir_allocator allocator = test_allocator(&memory);
        pir_scene_options options = pir_scene_options_default();
        pir_scene *scene;
        size_t count = 7;
        options.allocator = &allocator;
        assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
        scene_add(scene, cube, scene_at(0, 0, 0), PIR_BODY_STATIC);
        const uint32_t id = add_shape(scene, shape, scene_at(2, 0, 0), PIR_BODY_MOVING, 1e-3);
        assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
        memory.fail_at = memory.requests + request;
        status = pir_scene_update(scene, &(pir_scene_move){id, scene_at(-2, 0, 0)}, 1);
        memory.fail_at = 0;
        pir_scene_impacts(scene, &count);
        assert_int_equal(count, status == PIR_OK);
        assert_true(pir_scene_is_valid(scene));
        failures += status == PIR_ERR_MEMORY;
        pir_scene_destroy(scene);
        assert_int_equal(memory.blocks, 0);
    }
    assert_int_equal(status, PIR_OK);
    assert_true(failures > 0);
    // what is no tolerance is refused
    pir_scene_options options = pir_scene_options_default();
    pir_scene *scene;
    pir_body_options body = pir_body_shape_options(shape);
    uint32_t id;
    options.report = &report;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
    body.fast = -1;
    assert_int_equal(pir_scene_add(scene, &body, &id), PIR_ERR_ARGUMENT);
    body.fast = NAN;
    assert_int_equal(pir_scene_add(scene, &body, &id), PIR_ERR_NOT_FINITE);
    assert_string_equal(report.text, "body: its tolerance as a fast body is not a number");
    pir_scene_destroy(scene);
    pir_body_shape_release(shape);
    pir_polytope_release(cube);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_passes_a_thin_wall),
        cmocka_unit_test(meetings_are_those_of_casts),
        cmocka_unit_test(failures_leave_no_meetings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
