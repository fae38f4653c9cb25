/* SPDX-License-Identifier: MIT */
/*
 * Shapes of bodies by name: their masses by the formulas of textbooks, where rays and the nearest points find them,
 * what they say of themselves, what is refused, memory that fails.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/body_shape.h>
#include <pirouette/scene_query.h>

#include "scene/scene_bodies.h"
#include "support/memory.h"

#define PI 3.14159265358979323846

static pir_report report;

/* Makes one shape of each kind of pieces. */
static pir_status make_all(const pir_allocator *a, pir_body_shape *shape[8]) {
    const pir_vec3 corner[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    pir_status status = pir_body_shape_ball(0.5, a, &report, &shape[0]);
    if (status == PIR_OK)
        status = pir_body_shape_capsule((pir_vec3){0, 0, -1}, (pir_vec3){0, 0, 1}, 0.5, a, &report, &shape[1]);
    if (status == PIR_OK)
        status = pir_body_shape_box((pir_vec3){1, 0.5, 0.25}, 0.25, a, &report, &shape[2]);
    if (status == PIR_OK)
        status = pir_body_shape_cylinder(0.5, 2, 0, a, &report, &shape[3]);
    if (status == PIR_OK)
        status = pir_body_shape_cone(0.5, 2, 64, a, &report, &shape[4]);
    if (status == PIR_OK)
        status = pir_body_shape_plane((pir_vec3){0, 0, 2}, -0.5, 16, a, &report, &shape[5]);
    if (status == PIR_OK)
        status = pir_body_shape_hull(corner, 4, 0, a, &report, &shape[6]);
    const pir_body_part parts[2] = {{shape[3], scene_at(1, 0, 0)}, {shape[6], scene_at(-1, 0, 0)}};
    if (status == PIR_OK)
        status = pir_body_shape_compound(parts, 2, a, &report, &shape[7]);
    return status;
}

static void release_all(pir_body_shape *shape[8]) {
    for (int i = 0; i < 8; i++)
        pir_body_shape_release(shape[i]);
}

static void expect_mass(const pir_body_shape *shape, double volume, double along_x, double along_z, double room) {
    pir_mass mass;
    assert_int_equal(pir_body_shape_mass(shape, &mass), PIR_OK);
    expect(fabs(mass.volume / volume - 1) <= room && fabs(mass.inertia[0][0] / along_x - 1) <= room &&
               fabs(mass.inertia[2][2] / along_z - 1) <= room,
           "%s: volume %.17g, inertia %.17g and %.17g", pir_body_shape_text(shape), mass.volume, mass.inertia[0][0],
           mass.inertia[2][2]);
}

static void masses_are_those_of_textbooks(void **state) {
    (void)state;
    pir_body_shape *shape[8] = {NULL}, *sharp;
    const double r = 0.5, ball = 4 * PI / 3 * r * r * r, tube = PI * r * r * 2;
    assert_int_equal(make_all(NULL, shape), PIR_OK);
    expect_mass(shape[0], ball, 0.4 * ball * r * r, 0.4 * ball * r * r, 1e-14);
    expect_mass(shape[1], ball + tube, tube * (r * r / 4 + 1. / 3) + ball * (0.4 * r * r + 1 + 0.75 * r),
                0.5 * tube * r * r + 0.4 * ball * r * r, 1e-14);
    // as a polygon of 32 sides the base has sin(2π/32)/(2π/32) of the area of its circle
    expect_mass(shape[3], tube, tube * (r * r / 4 + 1. / 3), 0.5 * tube * r * r, 0.015);
    expect_mass(shape[4], tube / 3, tube / 3 * 3. / 80 * (4 * r * r + 4), tube / 3 * 0.3 * r * r, 0.005);
    pir_mass cone;
    assert_int_equal(pir_body_shape_mass(shape[4], &cone), PIR_OK);
    assert_true(fabs(cone.centroid.z) < 1e-15);
    // a rounded box, by Steiner: volume, surface, edges, corners of its core of 1.5 × 0.5 × 0
    pir_mass mass;
    assert_int_equal(pir_body_shape_mass(shape[2], &mass), PIR_OK);
    const double q = 0.25, steiner = 2 * 0.75 * q + PI * q * q * (1.5 + 0.5) + 4 * PI / 3 * q * q * q;
    assert_true(fabs(mass.volume - steiner) < 1e-15);
    assert_int_equal(pir_body_shape_box((pir_vec3){1, 2, 3}, 0, NULL, NULL, &sharp), PIR_OK);
    expect_mass(sharp, 48, 48 * (16 + 36) / 12., 48 * (4 + 16) / 12., 1e-15);
    pir_body_shape_release(sharp);
    release_all(shape);
}

/* Where a ray from above meets a body of a shape at the origin. */
static double height_over(const pir_body_shape *shape, double x, double y) {
    pir_scene *scene;
    pir_body_options body = pir_body_shape_options(shape);
    pir_impact impact;
    uint32_t id;
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    assert_int_equal(pir_scene_add(scene, &body, &id), PIR_OK);
    assert_int_equal(pir_scene_ray(scene, (pir_vec3){x, y, 8}, (pir_vec3){0, 0, -16}, UINT32_MAX, &impact), PIR_OK);
    pir_scene_destroy(scene);
    return impact.outcome == PIR_CAST_HIT ? impact.point.z : NAN;
}

static void rays_meet_the_round_parts(void **state) {
    (void)state;
    pir_body_shape *shape[8] = {NULL};
    assert_int_equal(make_all(NULL, shape), PIR_OK);
    const double over = sqrt(0.25 - 0.09);
    assert_true(fabs(height_over(shape[0], 0.3, 0) - over) < 1e-12);
    assert_true(fabs(height_over(shape[1], 0, 0.3) - (1 + over)) < 1e-12);
    assert_true(isnan(height_over(shape[0], 0.51, 0)));
    assert_true(fabs(height_over(shape[2], 0, 0) - 0.25) < 1e-12);
    assert_true(fabs(height_over(shape[2], 0.9, 0) - sqrt(0.0625 - 0.0225)) < 1e-12);
    assert_true(fabs(height_over(shape[3], 0.1, 0.1) - 1) < 1e-12);
    assert_true(fabs(height_over(shape[4], 0, 0) - 1.5) < 1e-12);
    assert_true(height_over(shape[5], 3, -7) == -0.5);
    assert_true(isnan(height_over(shape[5], 16.5, 0)));
    assert_true(fabs(height_over(shape[7], 1, 0.1) - 1) < 1e-12 && isnan(height_over(shape[7], 0.25, 0.25)));
    release_all(shape);
}

static void a_capsule_rests_where_its_radius_ends(void **state) {
    (void)state;
    pir_body_shape *shape[8] = {NULL};
    pir_scene *scene;
    uint32_t ground, capsule;
    size_t count;
    assert_int_equal(make_all(NULL, shape), PIR_OK);
    pir_scene_options options = pir_scene_options_default();
    options.margin = 0.25;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
    pir_body_options body = pir_body_shape_options(shape[5]);
    body.kind = PIR_BODY_STATIC;
    assert_int_equal(pir_scene_add(scene, &body, &ground), PIR_OK);
    body = pir_body_shape_options(shape[1]);
    body.pose = scene_at(0, 0, 1.125);
    assert_int_equal(pir_scene_add(scene, &body, &capsule), PIR_OK);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    const pir_scene_event *event = pir_scene_events(scene, &count);
    assert_int_equal(count, 1);
    assert_true(fabs(event->distance - 0.125) < 1e-12 && event->normal.z == -1);
    char text[256], cut[8];
    assert_int_equal(pir_scene_body_text(scene, capsule, sizeof text, text), PIR_OK);
    assert_string_equal(text,
                        "body 1, number 1: moving, 1 piece, radius 0.5, at (0, 0, 1.125), category 1, mask ffffffff");
    assert_int_equal(pir_scene_body_text(scene, capsule, sizeof cut, cut), PIR_OK);
    assert_string_equal(cut, "body 1,");
    assert_int_equal(pir_scene_body_text(scene, 7, sizeof text, text), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_body_text(scene, capsule, 0, text), PIR_ERR_ARGUMENT);
    pir_scene_destroy(scene);
    release_all(shape);
}

static void surfaces_are_shapes_too(void **state) {
    (void)state;
    const float heights[4] = {1, 1, 1, 1};
    const pir_height_samples samples = {heights, PIR_NUMBERS_FLOAT, 2, 2, 4, 4, NULL, NULL};
    const double corner[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t triangle[3] = {0, 1, 2};
    const pir_trimesh_arrays arrays = {
        .vertices = corner, .vertex_count = 3, .triangles = triangle, .triangle_count = 1};
    pir_height_field *field;
    pir_trimesh *mesh;
    pir_body_shape *of_field, *of_mesh, *compound;
    pir_mass mass;
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &mesh), PIR_OK);
    assert_int_equal(pir_height_field_create(&samples, NULL, NULL, &field), PIR_OK);
    assert_int_equal(pir_body_shape_field(field, 0.5, NULL, NULL, &of_field), PIR_OK);
    assert_int_equal(pir_body_shape_mesh(mesh, 0, NULL, NULL, &of_mesh), PIR_OK);
    pir_height_field_release(field);
    pir_trimesh_release(mesh);
    assert_true(height_over(of_field, 1, 2) == 1.5 && height_over(of_mesh, 0.25, 0.25) == 0);
    assert_string_equal(pir_body_shape_text(of_field), "height field, radius 0.5");
    assert_int_equal(pir_body_shape_mass(of_mesh, &mass), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_body_shape_mesh(NULL, 0, NULL, &report, &of_mesh), PIR_ERR_ARGUMENT);
    assert_string_equal(report.text, "mesh: it is NULL");
    assert_int_equal(pir_body_shape_compound(&(pir_body_part){of_mesh, scene_at(0, 0, 0)}, 1, NULL, &report, &compound),
                     PIR_ERR_ARGUMENT);
    assert_string_equal(report.text, "compound: part 0 is NULL or a surface");
    assert_ptr_equal(pir_body_shape_retain(of_mesh), of_mesh);
    pir_body_shape_release(of_mesh);
    pir_body_shape_release(of_mesh);
    pir_body_shape_release(of_field);
    pir_body_shape_release(NULL);
}

static void expect_words(pir_status status, pir_status right, const char *words) {
    expect(status == right && strcmp(report.text, words) == 0, "status %d: `%s`", (int)status, report.text);
}

static void what_is_no_shape_is_refused(void **state) {
    (void)state;
    pir_body_shape *shape = NULL, *ball[2];
    const pir_vec3 up = {0, 0, 1}, zero = {0, 0, 0};
    expect_words(pir_body_shape_ball(0, NULL, &report, &shape), PIR_ERR_ARGUMENT, "ball: its radius is 0");
    expect_words(pir_body_shape_ball(NAN, NULL, &report, &shape), PIR_ERR_NOT_FINITE, "ball: its radius is nan");
    expect_words(pir_body_shape_ball(1, NULL, &report, NULL), PIR_ERR_ARGUMENT, "ball: ret_shape is NULL");
    expect_words(pir_body_shape_capsule(zero, (pir_vec3){0, INFINITY, 0}, 1, NULL, &report, &shape), PIR_ERR_NOT_FINITE,
                 "capsule: its second end: y is inf");
    expect_words(pir_body_shape_box((pir_vec3){1, 0.25, 1}, 0.5, NULL, &report, &shape), PIR_ERR_ARGUMENT,
                 "box: its half edge, which the radius is part of, is 0.25");
    expect_words(pir_body_shape_cylinder(1, 1, 2, NULL, &report, &shape), PIR_ERR_ARGUMENT,
                 "cylinder: 2 sides, not 3 to 1024");
    expect_words(pir_body_shape_cone(1, -1, 0, NULL, &report, &shape), PIR_ERR_ARGUMENT, "cone: its height is -1");
    expect_words(pir_body_shape_plane(zero, 0, 1, NULL, &report, &shape), PIR_ERR_ARGUMENT,
                 "plane: its normal's length is 0");
    expect_words(pir_body_shape_plane(up, NAN, 1, NULL, &report, &shape), PIR_ERR_NOT_FINITE,
                 "plane: its offset is nan");
    assert_int_not_equal(pir_body_shape_hull(NULL, 0, 0, NULL, &report, &shape), PIR_OK);
    expect_words(pir_body_shape_compound(NULL, 0, NULL, &report, &shape), PIR_ERR_ARGUMENT,
                 "compound: it has no parts, or ret_shape is NULL");
    assert_int_equal(pir_body_shape_ball(1, NULL, NULL, &ball[0]), PIR_OK);
    assert_int_equal(pir_body_shape_ball(2, NULL, NULL, &ball[1]), PIR_OK);
    const pir_body_part parts[2] = {{ball[0], scene_at(0, 0, 0)}, {ball[1], scene_at(0, 0, 0)}};
    expect_words(pir_body_shape_compound(parts, 2, NULL, &report, &shape), PIR_ERR_ARGUMENT,
                 "compound: part 1 has radius 2, the first one 1");
    assert_null(shape);
    assert_int_equal(pir_body_shape_options(NULL).piece_count, 0);
    assert_string_equal(pir_body_shape_text(NULL), "no shape");
    pir_body_shape_release(ball[0]);
    pir_body_shape_release(ball[1]);
}

static void memory_that_fails_leaves_nothing(void **state) {
    (void)state;
    pir_status status = PIR_ERR_MEMORY;
    uint64_t failures = 0;
    for (uint64_t request = 1; status == PIR_ERR_MEMORY; request++) {
        test_memory memory = {.fail_at = request};
        const pir_allocator allocator = test_allocator(&memory);
        pir_body_shape *shape[8] = {NULL};
        status = make_all(&allocator, shape);
        failures += status == PIR_ERR_MEMORY;
        release_all(shape);
        assert_int_equal(memory.blocks, 0);
    }
    assert_int_equal(status, PIR_OK);
    assert_true(failures > 20);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(masses_are_those_of_textbooks),         cmocka_unit_test(rays_meet_the_round_parts),
        cmocka_unit_test(a_capsule_rests_where_its_radius_ends), cmocka_unit_test(surfaces_are_shapes_too),
        cmocka_unit_test(what_is_no_shape_is_refused),           cmocka_unit_test(memory_that_fails_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
