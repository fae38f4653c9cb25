/* SPDX-License-Identifier: MIT */
/* Scenes with a surface and without: see twin_scenes.h. */
#include "scene/twin_scenes.h"

#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/mesh_models.h"
#include "support/bodies.h"

/* --- the ground --- */

static void make_mesh(twin_scenes *t, const mesh_arrays *arrays) {
    pir_trimesh_options options = pir_trimesh_options_default();
    options.two_sided = t->two_sided;
    t->mesh = mesh_of(arrays, &options);
    t->triangles = arrays->triangles;
}

static void make_field(twin_scenes *t) {
    enum { SIDE = 9 };
    float heights[SIDE * SIDE];
    uint8_t holes[(SIDE - 1) * (SIDE - 1)];
    for (int i = 0; i < SIDE * SIDE; i++)
        heights[i] = (float)(i % 3 ? test_random_between(&t->random, -2, 2) : test_random_unit(&t->random));
    for (int i = 0; i < (SIDE - 1) * (SIDE - 1); i++)
        holes[i] = test_random_below(&t->random, 10) == 0;
    const pir_height_samples samples = {.heights = heights,
                                        .type = PIR_NUMBERS_FLOAT,
                                        .columns = SIDE,
                                        .rows = SIDE,
                                        .step_x = 1,
                                        .step_y = 1,
                                        .holes = holes};
    pir_height_options options = pir_height_options_default();
    options.two_sided = t->two_sided;
    assert_int_equal(pir_height_field_create(&samples, &options, NULL, &t->field), PIR_OK);
    t->triangles = 2 * (SIDE - 1) * (SIDE - 1);
}

static void make_ground(twin_scenes *t, twin_ground ground) {
    t->size = ground == TWIN_SPHERE ? 1.5 : 8;
    t->two_sided = test_random_below(&t->random, 2);
    if (ground == TWIN_FIELD) {
        make_field(t);
        return;
    }
    mesh_arrays arrays = ground == TWIN_SOUP     ? mesh_soup(&t->random, 120, 8, true)
                         : ground == TWIN_SPHERE ? mesh_bumpy_sphere(2, 0.2)
                                                 : mesh_plane(8);
    make_mesh(t, &arrays);
    mesh_arrays_clear(&arrays);
}

/* A triangle as a polytope; far away where there is none or it has no area. */
static pir_polytope *flat_of(const twin_scenes *t, uint32_t number) {
    static const pir_vec3 away[3] = {{100, 0, 0}, {100, 1, 0}, {100, 0, 1}};
    pir_triangle_corners corners;
    pir_polytope *flat = NULL;
    const pir_status status = t->mesh ? pir_trimesh_triangle(t->mesh, number, &corners)
                                      : pir_height_field_triangle(t->field, number, &corners);
    if (status == PIR_OK)
        assert_int_equal(pir_polytope_create(corners.corner, 3, NULL, &flat), PIR_OK);
    if (flat && pir_polytope_dimension(flat) == 2)
        return flat;
    pir_polytope_release(flat);
    assert_int_equal(pir_polytope_create(away, 3, NULL, &flat), PIR_OK);
    return flat;
}

static pir_quat rotation_of(twin_scenes *t) {
    return test_random_below(&t->random, 2) ? test_integer_rotation(&t->random) : test_general_rotation(&t->random);
}

static void add_ground(twin_scenes *t, const twin_options *options) {
    uint32_t other;
    pir_body_options body = pir_body_options_default();
    body.kind = options->kind;
    body.radius = options->radius;
    if (test_random_below(&t->random, 2))
        body.pose = (pir_pose){rotation_of(t), test_random_direction(&t->random)};
    else if (options->ground >= TWIN_PLANE)
        body.pose.translation = (pir_vec3){-4, -4, 0};
    body.mesh = t->mesh;
    body.field = t->field;
    assert_int_equal(pir_scene_add(t->with, &body, &t->ground), PIR_OK);
    body.mesh = NULL;
    body.field = NULL;
    body.pieces = t->flat;
    body.piece_count = t->triangles;
    assert_int_equal(pir_scene_add(t->without, &body, &other), PIR_OK);
    assert_int_equal(other, t->ground);
}

/* --- the others --- */

/* Points of a small body, of whole numbers or quarters now and then. */
static pir_polytope *small_polytope(twin_scenes *t) {
    static const test_body kinds[8] = {TEST_BOX,  TEST_GRID,    TEST_SPHERE, TEST_OCTAHEDRON,
                                       TEST_BALL, TEST_POLYGON, TEST_POINT,  TEST_SEGMENT};
    test_points points;
    const double by = t->size < 2 ? 0x1p-5 : test_random_below(&t->random, 2) ? 0.25 : 0.5;
    test_body_points(&t->random, kinds[test_random_below(&t->random, 8)], 12, &points);
    for (size_t i = 0; i < points.count; i++)
        points.at[i] = (pir_vec3){by * points.at[i].x, by * points.at[i].y, by * points.at[i].z};
    return test_polytope(&points);
}

static double coordinate(twin_scenes *t) {
    const int most = (int)(8 * t->size);
    return test_random_below(&t->random, 2) ? test_random_between(&t->random, -most, most) * 0.125
                                            : t->size * test_random_unit(&t->random);
}

static pir_pose pose_near(twin_scenes *t) {
    pir_pose pose = {{0, 0, 0, 1}, {coordinate(t), coordinate(t), coordinate(t)}};
    if (t->field)
        pose.translation.z *= 0.25;
    if (test_random_below(&t->random, 2))
        pose.rotation = rotation_of(t);
    return pose;
}

static void add_body(twin_scenes *t, uint32_t index) {
    uint32_t other;
    pir_body_options body = pir_body_options_default();
    t->shape[index] = small_polytope(t);
    body.pieces = &t->shape[index];
    body.piece_count = 1;
    body.pose = pose_near(t);
    body.radius = test_random_below(&t->random, 3) == 0 ? 0.125 : 0;
    body.sensor = test_random_below(&t->random, 8) == 0;
    assert_int_equal(pir_scene_add(t->with, &body, &t->body[index]), PIR_OK);
    assert_int_equal(pir_scene_add(t->without, &body, &other), PIR_OK);
    assert_int_equal(other, t->body[index]);
}

void twin_init(twin_scenes *t, uint64_t number, const twin_options *options) {
    *t = (twin_scenes){.random = test_random_case("twin scenes", number),
                       .ground_moves = options->kind == PIR_BODY_KINEMATIC};
    make_ground(t, options->ground);
    t->flat = malloc(t->triangles * sizeof *t->flat);
    assert_non_null(t->flat);
    for (uint32_t i = 0; i < t->triangles; i++)
        t->flat[i] = flat_of(t, i);
    pir_scene_options scene = options->scene;
    assert_int_equal(pir_scene_create(&scene, &t->without), PIR_OK);
    scene.threads = options->threads;
    assert_int_equal(pir_scene_create(&scene, &t->with), PIR_OK);
    if (options->ground_first)
        add_ground(t, options);
    for (uint32_t i = 0; i < TWIN_BODIES; i++)
        add_body(t, i);
    if (!options->ground_first)
        add_ground(t, options);
}

void twin_finish(twin_scenes *t) {
    pir_scene_destroy(t->with);
    pir_scene_destroy(t->without);
    for (uint32_t i = 0; i < t->triangles; i++)
        pir_polytope_release(t->flat[i]);
    for (uint32_t i = 0; i < TWIN_BODIES; i++)
        pir_polytope_release(t->shape[i]);
    free(t->flat);
    pir_trimesh_release(t->mesh);
    pir_height_field_release(t->field);
}

/* --- motion --- */

static pir_pose pose_after(twin_scenes *t, uint32_t body, double far) {
    pir_pose pose;
    assert_int_equal(pir_scene_pose(t->with, body, &pose), PIR_OK);
    const pir_vec3 way = test_random_direction(&t->random), turn = test_random_direction(&t->random);
    return pir_pose_integrate(pose, way, turn, far * test_random_unit(&t->random));
}

void twin_move(twin_scenes *t, double part) {
    t->moves = 0;
    for (uint32_t i = 0; i < TWIN_BODIES; i++) {
        if (test_random_unit(&t->random) > 2 * part - 1)
            continue;
        const uint32_t kind = test_random_below(&t->random, 6);
        t->move[t->moves++] =
            (pir_scene_move){t->body[i], kind == 0 ? pose_near(t) : pose_after(t, t->body[i], kind < 4 ? 0.01 : 0.3)};
    }
    if (t->ground_moves && test_random_below(&t->random, 4) > 0)
        t->move[t->moves++] =
            (pir_scene_move){t->ground, pose_after(t, t->ground, test_random_below(&t->random, 4) ? 0.02 : 0.5)};
}

/* --- comparisons --- */

static bool same_numbers(const pir_scene_event *a, const pir_scene_event *b) {
    return a->distance == b->distance && memcmp(&a->normal, &b->normal, sizeof a->normal) == 0 &&
           memcmp(&a->witness, &b->witness, sizeof a->witness) == 0 && a->approach == b->approach &&
           a->contact_count == b->contact_count;
}

static bool same_contacts(const pir_scene_event *a, const pir_scene_event *b) {
    for (uint32_t i = 0; i < a->contact_count; i++) {
        const pir_contact *x = &a->contacts[i], *y = &b->contacts[i];
        if (x->id != y->id || memcmp(&x->point_p, &y->point_p, sizeof x->point_p) != 0 ||
            memcmp(&x->point_q, &y->point_q, sizeof x->point_q) != 0 || x->distance != y->distance)
            return false;
    }
    return true;
}

bool twin_same_event(const pir_scene_event *a, const pir_scene_event *b) {
    return a->kind == b->kind && a->body_p == b->body_p && a->body_q == b->body_q && a->piece_p == b->piece_p &&
           a->piece_q == b->piece_q && a->sensor == b->sensor && a->state == b->state && same_numbers(a, b) &&
           same_contacts(a, b);
}

void twin_update_and_compare(twin_scenes *t, uint64_t number) {
    size_t with, without;
    assert_int_equal(pir_scene_update(t->with, t->move, t->moves), PIR_OK);
    assert_int_equal(pir_scene_update(t->without, t->move, t->moves), PIR_OK);
    const pir_scene_event *a = pir_scene_events(t->with, &with), *b = pir_scene_events(t->without, &without);
    for (size_t i = 0; i < with && i < without; i++)
        expect(twin_same_event(&a[i], &b[i]), "case %llu, event %zu: bodies %u %u, pieces %u %u, others %u %u %u %u",
               (unsigned long long)number, i, a[i].body_p, a[i].body_q, a[i].piece_p, a[i].piece_q, b[i].body_p,
               b[i].body_q, b[i].piece_p, b[i].piece_q);
    expect(with == without, "case %llu: %zu events, and %zu without the surface", (unsigned long long)number, with,
           without);
    expect(pir_scene_is_valid(t->with), "case %llu", (unsigned long long)number);
    t->events += with;
}

pir_scene_shape twin_shape(twin_scenes *t) {
    pir_scene_shape shape = pir_scene_shape_default(small_polytope(t));
    shape.pose = pose_near(t);
    shape.radius = test_random_below(&t->random, 3) == 0 ? 0.25 : 0;
    return shape;
}
