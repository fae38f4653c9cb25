/* SPDX-License-Identifier: MIT */
/*
 * Reports of scenes: what every call says of each argument that it refuses, of memory that fails in it, and of more
 * triangles than it takes.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/scene_file.h>
#include <pirouette/scene_query.h>

#include "scene/scene_bodies.h"
#include "support/memory.h"

static pir_report report;

/* What the call before has said: it failed with this status, and told it in these words. */
static void expect_told(int line, pir_status status, pir_status expected, const char *words) {
    expect(status == expected && report.status == status, "line %d: status %d, told %d, not %d", line, (int)status,
           (int)report.status, (int)expected);
    expect(strcmp(report.text, words) == 0, "line %d: `%s`, not `%s`", line, report.text, words);
    report = (pir_report){.status = PIR_OK, .text = "as it was"};
}

#define TELLS(call, status, words) expect_told(__LINE__, call, status, words)
#define BAD                        PIR_ERR_ARGUMENT

static void bodies_are_reported(pir_scene *scene, pir_polytope *cube) {
    const pir_body_options none = pir_body_options_default();
    pir_body_options body = none;
    pir_trimesh *mesh;
    pir_pose pose;
    uint32_t number;
    const double corner[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t triangle[3] = {0, 1, 2};
    const pir_trimesh_arrays arrays = {
        .vertices = corner, .vertex_count = 3, .triangles = triangle, .triangle_count = 1};
    const float heights[4] = {0};
    const pir_height_samples samples = {heights, PIR_NUMBERS_FLOAT, 2, 2, 1, 1, NULL, NULL};
    pir_height_field *field;
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &mesh), PIR_OK);
    assert_int_equal(pir_height_field_create(&samples, NULL, NULL, &field), PIR_OK);
    TELLS(pir_scene_add(scene, NULL, &number), BAD, "body: body is NULL");
    TELLS(pir_scene_add(scene, &body, NULL), BAD, "body: ret_body is NULL");
    TELLS(pir_scene_add(scene, &body, &number), BAD, "body: it has no pieces");
    body.mesh = mesh;
    TELLS(pir_scene_add(scene, &body, &number), BAD, "body: it has a surface, which must be static or kinematic");
    body.kind = PIR_BODY_STATIC;
    body.field = field;
    TELLS(pir_scene_add(scene, &body, &number), BAD, "body: it has both a mesh and a height field");
    body.field = NULL;
    body.pieces = &cube;
    TELLS(pir_scene_add(scene, &body, &number), BAD, "body: it has both pieces and a surface");
    body = none;
    body.pieces = &cube;
    body.piece_count = 1;
    body.radius = -1;
    TELLS(pir_scene_add(scene, &body, &number), BAD, "body: its radius is -1, not from 0 up");
    body.radius = 0;
    body.pose.rotation = (pir_quat){0, 0, 0, 0};
    TELLS(pir_scene_add(scene, &body, &number), PIR_ERR_ZERO_QUATERNION, "body: its pose: zero quaternion");
    body.pose = scene_at(0, 0x1p61, 0);
    TELLS(pir_scene_add(scene, &body, &number), PIR_ERR_LIMIT, "body: its pose: y is 2.30584e+18, beyond 2^60");
    TELLS(pir_scene_remove(scene, 9), BAD, "remove: there is no body 9");
    TELLS(pir_scene_pose(scene, 9, &pose), BAD, "pose: there is no body 9");
    TELLS(pir_scene_pose(scene, 0, NULL), BAD, "pose: ret_pose is NULL");
    pir_trimesh_release(mesh);
    pir_height_field_release(field);
}

static void updates_are_reported(pir_scene *scene) {
    const pir_scene_move twice[2] = {{0, scene_at(0, 0, 0)}, {0, scene_at(1, 0, 0)}}, no_body = {9, scene_at(0, 0, 0)},
                         far = {0, scene_at(1e300, 0, 0)}, edge = {0, scene_at(0, 0, 0x1p60)},
                         nowhere = {0, scene_at(0, NAN, 0)}, unturned = {0, {{0, 0, INFINITY, 1}, {0, 0, 0}}};
    TELLS(pir_scene_update(scene, NULL, 1), BAD, "update: moves is NULL");
    TELLS(pir_scene_update(scene, twice, 2), BAD, "update: move 1: body 0 comes twice");
    TELLS(pir_scene_update(scene, &no_body, 1), BAD, "update: move 0: there is no body 9");
    TELLS(pir_scene_update(scene, &far, 1), PIR_ERR_LIMIT, "update: body 0: its pose: x is 1e+300, beyond 2^60");
    TELLS(pir_scene_update(scene, &edge, 1), PIR_ERR_LIMIT, "update: body 0: it reaches beyond 2^60");
    TELLS(pir_scene_update(scene, &nowhere, 1), PIR_ERR_NOT_FINITE, "update: body 0: its pose: y is nan");
    TELLS(pir_scene_update(scene, &unturned, 1), PIR_ERR_NOT_FINITE, "update: body 0: its rotation: z is inf");
}

static void searches_are_reported(pir_scene *scene, pir_polytope *cube) {
    pir_scene_shape shape = pir_scene_shape_default(cube), wrong = shape;
    pir_scene_near near;
    pir_scene_distance distance;
    const pir_accuracy exact = {0, 0};
    size_t count;
    wrong.radius = NAN;
    TELLS(pir_scene_overlap(scene, NULL, 0, NULL, &count), BAD, "overlap: shape is NULL");
    TELLS(pir_scene_overlap(scene, &shape, 3, NULL, &count), BAD, "overlap: ret_hits is NULL");
    TELLS(pir_scene_overlap(scene, &shape, 0, NULL, NULL), BAD, "overlap: ret_count is NULL");
    TELLS(pir_scene_overlap(scene, &wrong, 0, NULL, &count), PIR_ERR_NOT_FINITE, "shape: its radius is not a number");
    wrong = shape;
    wrong.pose.translation.z = -0x1p61;
    TELLS(pir_scene_overlap(scene, &wrong, 0, NULL, &count), PIR_ERR_LIMIT,
          "shape: its pose: z is -2.30584e+18, beyond 2^60");
    TELLS(pir_scene_nearest(scene, NULL, 1, 1, &near, &count), BAD, "nearest: shape is NULL");
    TELLS(pir_scene_nearest(scene, &shape, 1, 1, NULL, &count), BAD, "nearest: ret_near is NULL");
    TELLS(pir_scene_nearest(scene, &shape, 1, 1, &near, NULL), BAD, "nearest: ret_count is NULL");
    TELLS(pir_scene_nearest(scene, &shape, -1, 1, &near, &count), BAD, "nearest: the cutoff is -1, below 0");
    TELLS(pir_scene_nearest(scene, &shape, 1, 0, &near, &count), BAD,
          "nearest: none is asked for, and at least 1 must be");
    TELLS(pir_scene_closest_pairs(scene, 1, 1, NULL, &count), BAD, "closest pairs: ret_near is NULL");
    TELLS(pir_scene_closest_pairs(scene, 1, 1, &near, NULL), BAD, "closest pairs: ret_count is NULL");
    TELLS(pir_scene_closest_pairs(scene, -1, 1, &near, &count), BAD, "closest pairs: the cutoff is -1, below 0");
    TELLS(pir_scene_closest_pairs(scene, NAN, 1, &near, &count), PIR_ERR_NOT_FINITE,
          "closest pairs: the cutoff is not a number");
    TELLS(pir_scene_distances(scene, NULL, 1, exact, 0, NULL, &count), BAD, "distances: shape is NULL");
    TELLS(pir_scene_distances(scene, &shape, 1, exact, 1, NULL, &count), BAD, "distances: ret_distances is NULL");
    TELLS(pir_scene_distances(scene, &shape, 1, exact, 1, &distance, NULL), BAD, "distances: ret_count is NULL");
    TELLS(pir_scene_distances(scene, &shape, -1, exact, 0, NULL, &count), BAD, "distances: the cutoff is below 0");
    TELLS(pir_scene_distances(scene, &shape, 1, (pir_accuracy){-1, 0}, 0, NULL, &count), BAD,
          "distances: the accuracy's length is below 0");
    TELLS(pir_scene_distances(scene, &shape, 1, (pir_accuracy){0, NAN}, 0, NULL, &count), PIR_ERR_NOT_FINITE,
          "distances: the accuracy's part is not a number");
}

static void rays_are_reported(pir_scene *scene) {
    const pir_vec3 origin = {0, 0, 0}, way = {1, 0, 0}, none = {0, NAN, 0}, far = {0x1p61, 0, 0};
    pir_scene_ray_options options = pir_scene_ray_options_default();
    pir_impact impact;
    bool hits;
    size_t count;
    TELLS(pir_scene_ray(scene, origin, way, 1, NULL), BAD, "ray: ret_impact is NULL");
    TELLS(pir_scene_ray(scene, none, way, 1, &impact), PIR_ERR_NOT_FINITE, "ray: its origin is not finite");
    TELLS(pir_scene_ray(scene, origin, none, 1, &impact), PIR_ERR_NOT_FINITE, "ray: its way is not finite");
    TELLS(pir_scene_ray(scene, far, way, 1, &impact), PIR_ERR_LIMIT, "ray: its origin is beyond 2^60");
    TELLS(pir_scene_ray(scene, origin, far, 1, &impact), PIR_ERR_LIMIT, "ray: its way is longer than 2^60");
    TELLS(pir_scene_ray_any(scene, origin, way, NULL, NULL), BAD, "ray: ret_hits is NULL");
    TELLS(pir_scene_ray_all(scene, origin, way, NULL, 1, NULL, &count), BAD, "ray: ret_impacts is NULL");
    TELLS(pir_scene_ray_all(scene, origin, way, NULL, 1, &impact, NULL), BAD, "ray: ret_count is NULL");
    options.sides = (pir_ray_sides)7;
    TELLS(pir_scene_ray_any(scene, origin, way, &options, &hits), BAD, "ray: there are no sides 7");
}

static void motions_are_reported(pir_scene *scene, pir_polytope *cube) {
    const struct {
        pir_motion motion;
        double tolerance;
        pir_status status;
        const char *words;
    } cases[8] = {
        {{{1, 0, 0}, {0, 0, 0}, 0}, 0, BAD, "its tolerance is not above 0"},
        {{{1, 0, 0}, {0, 0, 0}, 0}, HUGE_VAL, BAD, "its tolerance is infinite"},
        {{{1, 0, 0}, {0, 0, 0}, 0}, NAN, PIR_ERR_NOT_FINITE, "its tolerance is not a number"},
        {{{1, 0, 0}, {0, 0, 0}, -1}, 1, BAD, "its motion's held is below 0"},
        {{{1, 0, 0}, {0, 0, 0}, NAN}, 1, PIR_ERR_NOT_FINITE, "its motion's held is not a number"},
        {{{NAN, 0, 0}, {0, 0, 0}, 0}, 1, PIR_ERR_NOT_FINITE, "its way is not finite"},
        {{{1, 0, 0}, {0, NAN, 0}, 0}, 1, PIR_ERR_NOT_FINITE, "its turn is not finite"},
        {{{1, 0, 0}, {0, 0x1p21, 0}, 0}, 1, PIR_ERR_LIMIT, "its turn is longer than 2^20"},
    };
    const pir_scene_shape shape = pir_scene_shape_default(cube);
    pir_impact impact;
    char words[80];
    for (int i = 0; i < 8; i++) {
        snprintf(words, sizeof words, "cast: %s", cases[i].words);
        TELLS(pir_scene_cast(scene, &shape, &cases[i].motion, cases[i].tolerance, &impact), cases[i].status, words);
        snprintf(words, sizeof words, "time of impact: %s", cases[i].words);
        TELLS(pir_scene_time_of_impact(scene, 0, &cases[i].motion, cases[i].tolerance, &impact), cases[i].status,
              words);
    }
    TELLS(pir_scene_cast(scene, NULL, &cases[0].motion, 1, &impact), BAD, "cast: shape is NULL");
    TELLS(pir_scene_cast(scene, &shape, NULL, 1, &impact), BAD, "cast: motion is NULL");
    TELLS(pir_scene_cast(scene, &shape, &cases[0].motion, 1, NULL), BAD, "cast: ret_impact is NULL");
    size_t count;
    TELLS(pir_scene_cast_all(scene, &shape, &cases[0].motion, 1, 1, NULL, &count), BAD, "cast: ret_impacts is NULL");
    TELLS(pir_scene_cast_all(scene, &shape, &cases[0].motion, 1, 1, &impact, NULL), BAD, "cast: ret_count is NULL");
    TELLS(pir_scene_time_of_impact(scene, 0, NULL, 1, &impact), BAD, "time of impact: motion is NULL");
    TELLS(pir_scene_time_of_impact(scene, 0, &cases[0].motion, 1, NULL), BAD, "time of impact: ret_impact is NULL");
    TELLS(pir_scene_time_of_impact(scene, 9, &cases[0].motion, 1, &impact), BAD, "time of impact: there is no body 9");
}

static void snapshots_are_reported(pir_scene *scene) {
    unsigned char bytes[1000] = {0};
    const size_t size = pir_scene_serialised_size(scene);
    pir_report own = {.status = PIR_OK};
    char words[80];
    assert_true(size < sizeof bytes);
    snprintf(words, sizeof words, "snapshot: room for 3 bytes, not the %zu that it takes", size);
    TELLS(pir_scene_serialise(scene, bytes, 3), BAD, words);
    TELLS(pir_scene_serialise(scene, NULL, size), BAD, "snapshot: memory is NULL");
    TELLS(pir_scene_restore(scene, NULL, 3, NULL), BAD, "snapshot: data is NULL");
    TELLS(pir_scene_restore(scene, "abc", 3, NULL), PIR_ERR_FORMAT, "snapshot: no snapshot of a scene");
    // a report of the call's own is filled in place of the scene's
    assert_int_equal(pir_scene_restore(scene, "abc", 3, &own), PIR_ERR_FORMAT);
    assert_string_equal(own.text, "snapshot: no snapshot of a scene");
    assert_string_equal(report.text, "as it was");
}

static void scenes_are_reported(pir_scene_options options) {
    pir_scene *scene;
    TELLS(pir_scene_create(&options, NULL), BAD, "scene: ret_scene is NULL");
    options.threads = 0;
    TELLS(pir_scene_create(&options, &scene), BAD, "scene: 0 threads, not 1 to 64");
    options.threads = 1;
    options.margin = -1;
    TELLS(pir_scene_create(&options, &scene), BAD, "scene: its margin is -1, below 0");
    options.margin = 1;
    options.detail = PIR_SCENE_STATES;
    TELLS(pir_scene_create(&options, &scene), BAD, "scene: a margin of 1 needs distances, and it has states alone");
}

static void a_report_says_what_was_wrong_and_where(void **state) {
    (void)state;
    pir_polytope *cube = scene_cube(1);
    pir_scene_options options = pir_scene_options_default();
    pir_scene *scene;
    report = (pir_report){.status = PIR_OK, .text = "as it was"};
    options.report = &report;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
    scene_add(scene, cube, scene_at(0, 0, 0), PIR_BODY_MOVING);
    scene_add(scene, cube, scene_at(9, 0, 0), PIR_BODY_MOVING);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    assert_string_equal(report.text, "as it was");
    bodies_are_reported(scene, cube);
    updates_are_reported(scene);
    searches_are_reported(scene, cube);
    rays_are_reported(scene);
    motions_are_reported(scene, cube);
    snapshots_are_reported(scene);
    pir_scene_destroy(scene);
    scenes_are_reported(options);
    pir_polytope_release(cube);
}

/* --- memory --- */

/* Makes each call in turn, on a field and a cube in it, until one fails; the status of that one. */
static pir_status ask_all(pir_scene *scene, pir_polytope *cube, pir_height_field *field) {
    pir_body_options ground = pir_body_options_default(), box = ground;
    const pir_scene_shape shape = pir_scene_shape_default(cube);
    const pir_motion motion = {{1, 1, 1}, {0, 0, 1}, 0};
    unsigned char bytes[4096];
    pir_scene_near near[40];
    pir_scene_hit hits[40];
    pir_scene_distance distances[40];
    pir_impact impacts[40];
    pir_scene_part parts[40];
    const pir_scene_box everywhere =
        pir_scene_box_default((pir_vec3){-HUGE_VAL, -HUGE_VAL, -9}, (pir_vec3){HUGE_VAL, HUGE_VAL, 9});
    size_t count;
    uint32_t number;
    ground.kind = PIR_BODY_KINEMATIC;
    ground.field = field;
    box.pieces = &cube;
    box.piece_count = 1;
    box.pose = scene_at(2, 2, 0.75);
    pir_status status = pir_scene_add(scene, &ground, &number);
    status = status ? status : pir_scene_add(scene, &box, &number);
    status = status ? status : pir_scene_update(scene, NULL, 0);
    status = status ? status : pir_scene_overlap(scene, &shape, 40, hits, &count);
    status = status ? status : pir_scene_nearest(scene, &shape, 9, 40, near, &count);
    status = status ? status : pir_scene_closest_pairs(scene, 9, 40, near, &count);
    status = status ? status : pir_scene_distances(scene, &shape, 9, (pir_accuracy){0, 0}, 40, distances, &count);
    status = status ? status : pir_scene_ray_all(scene, shape.pose.translation, motion.way, NULL, 40, impacts, &count);
    status = status ? status : pir_scene_cast(scene, &shape, &motion, 1e-3, impacts);
    status = status ? status : pir_scene_cast_all(scene, &shape, &motion, 1e-3, 40, impacts, &count);
    status = status ? status : pir_scene_in_box(scene, &everywhere, 40, parts, &count);
    status = status ? status : pir_scene_time_of_impact(scene, 0, &motion, 1e-3, impacts);
    const size_t size = pir_scene_serialised_size(scene);
    assert_true(size <= sizeof bytes);
    status = status ? status : pir_scene_serialise(scene, bytes, size);
    return status ? status : pir_scene_restore(scene, bytes, size, NULL);
}

static void memory_that_fails_is_reported_by_every_call(void **state) {
    (void)state;
    const float heights[25] = {0, 0.5f, 0, 0, 0.25f};
    const pir_height_samples samples = {heights, PIR_NUMBERS_FLOAT, 5, 5, 1, 1, NULL, NULL};
    pir_height_field *field;
    pir_polytope *cube = scene_cube(1);
    assert_int_equal(pir_height_field_create(&samples, NULL, NULL, &field), PIR_OK);
    uint64_t request = 1;
    for (bool failed = true; failed; request++) {
        test_memory memory = {.fail_at = request};
        const pir_allocator allocator = test_allocator(&memory);
        pir_scene_options options = pir_scene_options_default();
        pir_scene *scene = NULL;
        options.allocator = &allocator;
        options.report = &report;
        report = (pir_report){.status = PIR_OK, .text = "as it was"};
        pir_status status = pir_scene_create(&options, &scene);
        if (status == PIR_OK)
            status = ask_all(scene, cube, field);
        failed = memory.requests >= request;
        expect(report.status == status && (status == PIR_OK) == (strcmp(report.text, "as it was") == 0),
               "request %llu: status %d, told `%s`", (unsigned long long)request, (int)status, report.text);
        pir_scene_destroy(scene);
    }
    assert_true(request > 60);
    pir_height_field_release(field);
    pir_polytope_release(cube);
}

/* --- limits --- */

static void more_triangles_than_contacts_take_are_named(void **state) {
    (void)state;
    float *heights = calloc(190 * 190, sizeof *heights);
    assert_non_null(heights);
    const pir_height_samples samples = {heights, PIR_NUMBERS_FLOAT, 190, 190, 1, 1, NULL, NULL};
    pir_polytope *cube = scene_cube(200);
    pir_scene_options options = pir_scene_options_default();
    pir_body_options ground = pir_body_options_default();
    pir_scene *scene;
    uint32_t number;
    options.report = &report;
    ground.kind = PIR_BODY_STATIC;
    assert_int_equal(pir_height_field_create(&samples, NULL, NULL, &ground.field), PIR_OK);
    assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
    assert_int_equal(pir_scene_add(scene, &ground, &number), PIR_OK);
    scene_add(scene, cube, scene_at(95, 95, 200), PIR_BODY_MOVING);
    TELLS(pir_scene_update(scene, NULL, 0), PIR_ERR_LIMIT,
          "update: body 1, piece 0: more than 65536 triangles near it, of the surface of body 0");
    assert_true(pir_scene_is_valid(scene));
    pir_scene_destroy(scene);
    pir_polytope_release(cube);
    pir_height_field_release(ground.field);
    free(heights);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_report_says_what_was_wrong_and_where),
        cmocka_unit_test(memory_that_fails_is_reported_by_every_call),
        cmocka_unit_test(more_triangles_than_contacts_take_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
