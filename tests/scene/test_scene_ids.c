/* SPDX-License-Identifier: MIT */
/*
 * Bodies by their ids: one that was removed is refused for good, also when its number is given again, until its
 * generations are used up; enumeration while bodies go; users in events and hits; bodies that are disabled, and sensors
 * that kinematic bodies enter.
 */
#include "support/test.h"

#include <math.h>

#include <pirouette/scene_file.h>
#include <pirouette/scene_query.h>

#include "scene/scene_bodies.h"

static pir_report report;

static pir_scene *new_scene(void) {
    pir_scene_options options = pir_scene_options_default();
    pir_scene *scene;
    options.report = &report;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
    return scene;
}

/* All calls that take an id refuse one, in words that name it. */
static void expect_refused(pir_scene *scene, uint32_t id) {
    pir_pose pose = pir_pose_identity();
    pir_body_state body;
    pir_impact impact;
    pir_polytope *polytope;
    const pir_motion motion = {{1, 0, 0}, {0, 0, 0}, 0};
    const pir_scene_move move = {id, pose};
    const pir_status status[] = {pir_scene_remove(scene, id),
                                 pir_scene_pose(scene, id, &pose),
                                 pir_scene_update(scene, &move, 1),
                                 pir_scene_get_body(scene, id, &body),
                                 pir_scene_get_piece(scene, id, 0, &polytope, NULL),
                                 pir_scene_set_user(scene, id, 1),
                                 pir_scene_set_piece_user(scene, id, 0, 1),
                                 pir_scene_set_filter(scene, id, 1, 1),
                                 pir_scene_set_sensor(scene, id, true),
                                 pir_scene_set_disabled(scene, id, true),
                                 pir_scene_time_of_impact(scene, id, &motion, 0.01, &impact)};
    assert_false(pir_scene_has(scene, id));
    for (size_t i = 0; i < sizeof status / sizeof *status; i++)
        assert_int_equal(status[i], PIR_ERR_ARGUMENT);
    assert_non_null(strstr(report.text, "time of impact: "));
}

static void a_stale_id_moves_no_other_body(void **state) {
    (void)state;
    pir_scene *scene = new_scene();
    pir_polytope *cube = scene_cube(1);
    const uint32_t first = scene_add(scene, cube, scene_at(0, 0, 0), PIR_BODY_MOVING);
    assert_int_equal(pir_scene_remove(scene, first), PIR_OK);
    const uint32_t second = scene_add(scene, cube, scene_at(5, 0, 0), PIR_BODY_MOVING);
    assert_true(first != second && pir_body_number(first) == pir_body_number(second));
    expect_refused(scene, first);
    assert_string_equal(report.text, "time of impact: body 0 was removed, it was number 0");
    expect_refused(scene, 7);
    assert_string_equal(report.text, "time of impact: there is no body 7");
    expect_refused(scene, PIR_SCENE_NONE);
    pir_pose pose;
    assert_int_equal(pir_scene_pose(scene, second, &pose), PIR_OK);
    assert_true(pose.translation.x == 5);
    // an except that is stale leaves nothing out
    pir_scene_ray_options options = pir_scene_ray_options_default();
    bool hits;
    options.except = first;
    assert_int_equal(pir_scene_ray_any(scene, (pir_vec3){0, 0, 0}, (pir_vec3){9, 0, 0}, &options, &hits), PIR_OK);
    assert_true(hits);
    options.except = second;
    assert_int_equal(pir_scene_ray_any(scene, (pir_vec3){0, 0, 0}, (pir_vec3){9, 0, 0}, &options, &hits), PIR_OK);
    assert_false(hits);
    pir_scene_destroy(scene);
    pir_polytope_release(cube);
}

static void a_number_is_given_until_its_generations_are_used_up(void **state) {
    (void)state;
    pir_scene *scene = new_scene();
    pir_polytope *cube = scene_cube(1);
    uint32_t id = 0;
    for (uint32_t i = 0; i < 4095; i++) {
        id = scene_add(scene, cube, scene_at(0, 0, 0), PIR_BODY_MOVING);
        assert_int_equal(id, i << 20);
        assert_int_equal(pir_scene_remove(scene, id), PIR_OK);
    }
    assert_int_equal(scene_add(scene, cube, scene_at(0, 0, 0), PIR_BODY_MOVING), 1);
    expect_refused(scene, id);
    // a snapshot knows that number 0 is used up
    unsigned char bytes[4096];
    const size_t size = pir_scene_serialised_size(scene);
    assert_true(size <= sizeof bytes);
    assert_int_equal(pir_scene_serialise(scene, bytes, size), PIR_OK);
    assert_int_equal(pir_scene_restore(scene, bytes, size, NULL), PIR_OK);
    assert_int_equal(scene_add(scene, cube, scene_at(9, 0, 0), PIR_BODY_MOVING), 2);
    assert_true(pir_scene_is_valid(scene));
    pir_scene_destroy(scene);
    pir_polytope_release(cube);
}

static void bodies_are_told_one_after_the_other_while_they_go(void **state) {
    (void)state;
    pir_scene *scene = new_scene();
    pir_polytope *cube = scene_cube(1);
    uint32_t seen = 0;
    assert_int_equal(pir_scene_next(scene, PIR_SCENE_NONE), PIR_SCENE_NONE);
    for (int i = 0; i < 9; i++)
        scene_add(scene, cube, scene_at(3 * i, 0, 0), PIR_BODY_MOVING);
    for (uint32_t id = pir_scene_next(scene, PIR_SCENE_NONE); id != PIR_SCENE_NONE; id = pir_scene_next(scene, id)) {
        assert_int_equal(id, seen++);
        if (id % 2)
            assert_int_equal(pir_scene_remove(scene, id), PIR_OK);
    }
    assert_int_equal(seen, 9);
    for (uint32_t id = pir_scene_next(scene, PIR_SCENE_NONE); id != PIR_SCENE_NONE; id = pir_scene_next(scene, id))
        seen += id % 2 == 0;
    assert_int_equal(seen, 14);
    assert_int_equal(pir_scene_next(NULL, PIR_SCENE_NONE), PIR_SCENE_NONE);
    pir_scene_destroy(scene);
    pir_polytope_release(cube);
}

/* The one event of the last update. */
static const pir_scene_event *one_event(const pir_scene *scene, pir_event_kind kind) {
    size_t count;
    const pir_scene_event *event = pir_scene_events(scene, &count);
    assert_int_equal(count, 1);
    assert_int_equal(event->kind, kind);
    return event;
}

static void events_and_hits_tell_users(void **state) {
    (void)state;
    pir_scene *scene = new_scene();
    pir_polytope *cube = scene_cube(1), *both[2] = {cube, cube};
    const uint64_t users[2] = {11, 12};
    const float heights[4] = {0};
    const uint32_t material = 77;
    pir_height_field *field;
    pir_body_options body = pir_body_options_default();
    uint32_t ground, block;
    const pir_height_samples samples = {heights, PIR_NUMBERS_FLOAT, 2, 2, 8, 8, &material, NULL};
    assert_int_equal(pir_height_field_create(&samples, NULL, NULL, &field), PIR_OK);
    body.kind = PIR_BODY_STATIC;
    body.field = field;
    body.user = 1000;
    assert_int_equal(pir_scene_add(scene, &body, &ground), PIR_OK);
    body = pir_body_options_default();
    body.pieces = both;
    body.piece_count = 2;
    body.piece_users = users;
    body.user = UINT64_C(0xfedcba9876543210);
    body.pose = scene_at(5, 2, 0.5);
    assert_int_equal(pir_scene_add(scene, &body, &block), PIR_OK);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    size_t count;
    const pir_scene_event *event = pir_scene_events(scene, &count);
    assert_true(count > 0);
    for (size_t i = 0; i < count; i++)
        assert_true(event[i].user_p == 1000 && event[i].user_q == body.user && event[i].piece_user_p == 77 &&
                    event[i].piece_user_q == users[event[i].piece_q]);
    pir_impact impact;
    assert_int_equal(pir_scene_ray(scene, (pir_vec3){1, 1, 3}, (pir_vec3){0, 0, -9}, UINT32_MAX, &impact), PIR_OK);
    assert_true(impact.body == ground && impact.user == 1000 && impact.piece_user == 77);
    pir_scene_shape shape = pir_scene_shape_default(cube);
    pir_scene_hit hit[8];
    shape.pose = scene_at(5, 2, 4);
    const pir_motion down = {{0, 0, -9}, {0, 0, 0}, 0};
    assert_int_equal(pir_scene_cast(scene, &shape, &down, 0.001, &impact), PIR_OK);
    assert_true(impact.body == block && impact.user == body.user && impact.piece_user == 11);
    shape.pose = scene_at(5, 2, 2);
    assert_int_equal(pir_scene_set_user(scene, block, 5), PIR_OK);
    assert_int_equal(pir_scene_set_piece_user(scene, block, 1, 6), PIR_OK);
    assert_int_equal(pir_scene_overlap(scene, &shape, 8, hit, &count), PIR_OK);
    assert_int_equal(count, 2);
    assert_true(hit[0].user == 5 && hit[0].piece_user == 11 && hit[1].user == 5 && hit[1].piece_user == 6);
    pir_body_state told;
    assert_int_equal(pir_scene_get_body(scene, ground, &told), PIR_OK);
    assert_true(told.field == field && told.piece_count == 0 && told.kind == PIR_BODY_STATIC);
    assert_int_equal(pir_scene_get_piece(scene, ground, 0, NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_get_piece(scene, block, 2, NULL, NULL), PIR_ERR_ARGUMENT);
    pir_scene_destroy(scene);
    pir_height_field_release(field);
    pir_polytope_release(cube);
}

static void a_disabled_body_is_not_there(void **state) {
    (void)state;
    pir_scene *scene = new_scene();
    pir_polytope *cube = scene_cube(1);
    const uint32_t a = scene_add(scene, cube, scene_at(0, 0, 0), PIR_BODY_MOVING),
                   b = scene_add(scene, cube, scene_at(1, 0, 0), PIR_BODY_STATIC);
    pir_scene_near near;
    pir_impact impact;
    size_t count;
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    one_event(scene, PIR_EVENT_BEGAN);
    assert_int_equal(pir_scene_set_disabled(scene, b, true), PIR_OK);
    assert_int_equal(pir_scene_closest_pairs(scene, HUGE_VAL, 1, &near, &count), PIR_OK);
    assert_int_equal(count, 0);
    assert_int_equal(pir_scene_ray(scene, (pir_vec3){1.5, 0, 9}, (pir_vec3){0, 0, -9}, UINT32_MAX, &impact), PIR_OK);
    assert_int_equal(impact.outcome, PIR_CAST_MISS);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    const pir_scene_event *event = one_event(scene, PIR_EVENT_ENDED);
    assert_true(event->body_p == a && event->body_q == b);
    assert_int_equal(pir_scene_update(scene, &(pir_scene_move){a, scene_at(0.5, 0, 0)}, 1), PIR_OK);
    pir_scene_events(scene, &count);
    assert_int_equal(count, 0);
    assert_int_equal(pir_scene_set_disabled(scene, b, false), PIR_OK);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    one_event(scene, PIR_EVENT_BEGAN);
    // off and on between two updates: it ended, and began
    assert_int_equal(pir_scene_set_disabled(scene, a, true), PIR_OK);
    assert_int_equal(pir_scene_set_disabled(scene, a, false), PIR_OK);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    event = pir_scene_events(scene, &count);
    assert_true(count == 2 && event[0].kind == PIR_EVENT_ENDED && event[1].kind == PIR_EVENT_BEGAN);
    assert_int_equal(pir_scene_remove(scene, b), PIR_OK);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    one_event(scene, PIR_EVENT_ENDED);
    assert_true(pir_scene_is_valid(scene));
    pir_scene_destroy(scene);
    pir_polytope_release(cube);
}

static void kinematic_bodies_enter_static_sensors(void **state) {
    (void)state;
    pir_scene *scene = new_scene();
    pir_polytope *cube = scene_cube(1);
    const uint32_t door = scene_add(scene, cube, scene_at(0, 0, 0), PIR_BODY_STATIC),
                   lift = scene_add(scene, cube, scene_at(5, 0, 0), PIR_BODY_KINEMATIC);
    assert_int_equal(pir_scene_update(scene, &(pir_scene_move){lift, scene_at(1, 0, 0)}, 1), PIR_OK);
    size_t count;
    pir_scene_events(scene, &count);
    assert_int_equal(count, 0);
    assert_int_equal(pir_scene_set_sensor(scene, door, true), PIR_OK);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    assert_true(one_event(scene, PIR_EVENT_BEGAN)->sensor);
    // the sensor is the kinematic one, and the other stands: they do not meet
    assert_int_equal(pir_scene_set_sensor(scene, door, false), PIR_OK);
    assert_int_equal(pir_scene_set_sensor(scene, lift, true), PIR_OK);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    one_event(scene, PIR_EVENT_ENDED);
    assert_true(pir_scene_is_valid(scene));
    pir_scene_destroy(scene);
    pir_polytope_release(cube);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stale_id_moves_no_other_body),
        cmocka_unit_test(a_number_is_given_until_its_generations_are_used_up),
        cmocka_unit_test(bodies_are_told_one_after_the_other_while_they_go),
        cmocka_unit_test(events_and_hits_tell_users),
        cmocka_unit_test(a_disabled_body_is_not_there),
        cmocka_unit_test(kinematic_bodies_enter_static_sensors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
