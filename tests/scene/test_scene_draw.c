/* SPDX-License-Identifier: MIT */
/*
 * Scenes as programs see them that draw or time them: every hull, triangle, box and contact is told once, with its
 * colour; profiles count what statistics and events have, and a clock is read in order; poses to cglm and back.
 */
#include "support/test.h"

#include <math.h>

#include <pirouette/cglm.h>
#include <pirouette/scene_draw.h>

#include "scene/crowd.h"
#include "scene/scene_bodies.h"

struct seen {
    uint32_t hulls, triangles, boxes, contacts, sensors;
    double area; /* of triangles seen from above */
};

static void see_hull(void *context, const pir_draw_hull *hull) {
    struct seen *seen = context;
    seen->hulls++;
    seen->sensors += hull->colour == PIR_DRAW_SENSOR;
    assert_non_null(hull->polytope);
}

static void see_triangle(void *context, const pir_draw_triangle *triangle) {
    struct seen *seen = context;
    const pir_vec3 *p = triangle->corner;
    seen->triangles++;
    seen->area += 0.5 * ((p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x));
    assert_int_equal(triangle->colour, PIR_DRAW_STATIC);
}

static void see_box(void *context, pir_vec3 low, pir_vec3 high, uint32_t colour) {
    ((struct seen *)context)->boxes++;
    assert_true(low.x <= high.x && low.y <= high.y && low.z <= high.z && colour == PIR_DRAW_BOX);
}

static void see_contact(void *context, const pir_draw_contact *contact) {
    struct seen *seen = context;
    seen->contacts++;
    assert_true(contact->event->contact_count > 0 && contact->level >= PIR_LEVEL_APART);
    assert_int_equal(contact->colour, contact->event->kind == PIR_EVENT_BEGAN ? PIR_DRAW_BEGAN : PIR_DRAW_PERSISTED);
}

static pir_scene_drawing drawing_of(struct seen *seen) {
    pir_scene_drawing drawing = pir_scene_drawing_default();
    drawing.context = seen;
    drawing.hull = see_hull;
    drawing.triangle = see_triangle;
    drawing.box = see_box;
    drawing.contact = see_contact;
    return drawing;
}

static void all_is_drawn_once(void **state) {
    (void)state;
    pir_scene *scene;
    pir_polytope *cube = scene_cube(0.5);
    float heights[25] = {0};
    unsigned char hole[16] = {0};
    hole[0] = 1;
    const pir_height_samples samples = {heights, PIR_NUMBERS_FLOAT, 5, 5, 1, 1, NULL, hole};
    pir_height_field *field;
    pir_body_options body = pir_body_options_default();
    uint32_t ground, sensor;
    struct seen seen = {0}, none = {0};
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    assert_int_equal(pir_height_field_create(&samples, NULL, NULL, &field), PIR_OK);
    body.kind = PIR_BODY_STATIC;
    body.field = field;
    assert_int_equal(pir_scene_add(scene, &body, &ground), PIR_OK);
    scene_add(scene, cube, scene_at(2.5, 2.5, 0.25), PIR_BODY_MOVING);
    scene_add(scene, cube, scene_at(3, 2.5, 0.75), PIR_BODY_MOVING);
    sensor = scene_add(scene, cube, scene_at(9, 9, 9), PIR_BODY_KINEMATIC);
    assert_int_equal(pir_scene_set_sensor(scene, sensor, true), PIR_OK);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    pir_scene_drawing drawing = drawing_of(&seen);
    assert_int_equal(pir_scene_draw(scene, &drawing), PIR_OK);
    size_t count, contacts = 0;
    const pir_scene_event *event = pir_scene_events(scene, &count);
    for (size_t i = 0; i < count; i++)
        contacts += event[i].contact_count;
    assert_true(seen.hulls == 3 && seen.sensors == 1 && seen.boxes == 4 && contacts > 4);
    assert_int_equal(seen.contacts, contacts);
    assert_true(seen.triangles == 30 && seen.area == 15);
    seen = none;
    drawing.near_triangles = true;
    assert_int_equal(pir_scene_draw(scene, &drawing), PIR_OK);
    assert_int_equal(seen.triangles, pir_scene_get_statistics(scene).triangles);
    assert_true(seen.triangles > 0 && seen.triangles < 30);
    seen = none;
    drawing = pir_scene_drawing_default();
    drawing.context = &seen;
    assert_int_equal(pir_scene_draw(scene, &drawing), PIR_OK);
    assert_memory_equal(&seen, &none, sizeof seen);
    assert_int_equal(pir_scene_draw(scene, NULL), PIR_ERR_ARGUMENT);
    pir_scene_destroy(scene);
    pir_height_field_release(field);
    pir_polytope_release(cube);
}

static uint64_t tick(void *context) {
    return *(uint64_t *)context += 1000;
}

static void profiles_count_what_was_done(void **state) {
    (void)state;
    static crowd c;
    for (uint64_t n = 0; n < 4; n++) {
        uint64_t time = 0;
        pir_scene_options options = pir_scene_options_default();
        options.threads = 1 + (uint32_t)(n % 2) * 3;
        options.profile = n < 2;
        options.clock = n > 0 ? tick : NULL;
        options.clock_context = &time;
        crowd_init(&c, 9000 + n, 40, &options);
        for (int frame = 0; frame < 8; frame++) {
            crowd_move(&c, 1);
            assert_int_equal(pir_scene_update(c.scene, c.move, c.moves), PIR_OK);
            const pir_scene_profile profile = pir_scene_get_profile(c.scene);
            const pir_scene_statistics statistics = pir_scene_get_statistics(c.scene);
            size_t count, contacts = 0;
            const pir_scene_event *event = pir_scene_events(c.scene, &count);
            for (size_t i = 0; i < count; i++)
                contacts += event[i].contact_count;
            assert_int_equal(profile.began + profile.persisted + profile.ended, count);
            assert_int_equal(profile.contacts, contacts);
            assert_true(profile.looked == statistics.looked && profile.asked == statistics.asked &&
                        profile.replaced == statistics.replaced && profile.boxes >= profile.moved);
            const uint64_t ways =
                profile.by_proof + profile.by_walk + profile.by_nearest + profile.by_depth + profile.by_whole;
            assert_true(n < 2 ? ways >= profile.asked : ways == 0);
            const uint64_t parts = profile.places_ns + profile.tree_ns + profile.pairs_ns + profile.looks_ns +
                                   profile.questions_ns + profile.unions_ns + profile.events_ns;
            assert_int_equal(parts, n > 0 ? 7000 : 0);
        }
        crowd_finish(&c);
    }
}

static void poses_go_to_cglm_and_back(void **state) {
    (void)state;
    const pir_pose pose = {{0.5, -1, 1.5, 2}, {1, -2, 3}};
    versor rotation;
    vec3 translation;
    mat4 matrix;
    pir_pose_to_cglm(pose, rotation, translation);
    pir_pose_to_mat4(pose, matrix);
    const pir_pose back[2] = {pir_pose_from_cglm(rotation, translation), pir_pose_from_mat4(matrix)};
    const pir_vec3 point = {0.25, 4, -1}, right = pir_pose_apply(pose, point);
    for (int k = 0; k < 2; k++) {
        const pir_vec3 there = pir_pose_apply(back[k], point);
        assert_true(fabs(there.x - right.x) < 1e-5 && fabs(there.y - right.y) < 1e-5 && fabs(there.z - right.z) < 1e-5);
    }
    vec4 at = {0.25f, 4, -1, 1}, moved;
    glm_mat4_mulv(matrix, at, moved);
    assert_true(fabs(moved[0] - right.x) < 1e-5 && fabs(moved[1] - right.y) < 1e-5 && fabs(moved[2] - right.z) < 1e-5 &&
                moved[3] == 1);
    const pir_contact contacts[2] = {{.point_p = {0, 0, 0}, .point_q = {2, 4, 6}, .distance = -0.5},
                                     {.point_p = {1, 1, 1}, .point_q = {1, 1, 1}, .distance = 0.25}};
    const pir_scene_event event = {.contact_count = 2, .contacts = contacts};
    vec3 points[2] = {{0}};
    float distances[2] = {0};
    assert_int_equal(pir_event_to_cglm(&event, 1, points, distances), 2);
    assert_true(points[0][0] == 1 && points[0][1] == 2 && points[0][2] == 3 && distances[0] == -0.5f);
    assert_true(points[1][0] == 0 && distances[1] == 0);
    assert_int_equal(pir_event_to_cglm(&event, 2, points, NULL), 2);
    assert_true(points[1][2] == 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_is_drawn_once),
        cmocka_unit_test(profiles_count_what_was_done),
        cmocka_unit_test(poses_go_to_cglm_and_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
