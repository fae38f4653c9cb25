/* SPDX-License-Identifier: MIT */
/* Heaps of bodies: see reuse_heap.h. */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include "scene/reuse_heap.h"
#include "support/bodies.h"

#define SIDE 9

/* --- the ground --- */

static void make_field(heap *h) {
    float heights[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++)
        heights[i] = (float)(0.2 * test_random_unit(&h->random));
    const pir_height_samples samples = {
        .heights = heights, .type = PIR_NUMBERS_FLOAT, .columns = SIDE, .rows = SIDE, .step_x = 0.5, .step_y = 0.5};
    assert_int_equal(pir_height_field_create(&samples, NULL, NULL, &h->field), PIR_OK);
}

/* A square in two triangles, one of which may be bent. */
static void make_mesh(heap *h) {
    const double bend = test_random_below(&h->random, 2) ? 0.5 : 0;
    const pir_vec3 corner[4] = {{-3, -3, 0}, {3, -3, 0}, {3, 3, bend}, {-3, 3, 0}};
    const uint32_t triangle[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const pir_trimesh_arrays arrays = {.vertices = corner,
                                       .vertex_type = PIR_NUMBERS_DOUBLE,
                                       .vertex_stride = sizeof *corner,
                                       .vertex_count = 4,
                                       .triangles = triangle[0],
                                       .triangle_stride = sizeof *triangle,
                                       .triangle_count = 2};
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &h->mesh), PIR_OK);
}

static void add_ground(heap *h) {
    h->ground_at = h->count;
    heap_body *body = &h->body[h->count++];
    body->options = pir_body_options_default();
    body->options.kind = h->ground == HEAP_LIFT ? PIR_BODY_KINEMATIC : PIR_BODY_STATIC;
    body->options.piece_count = h->ground == HEAP_TILES ? 4 : 1;
    if (h->ground == HEAP_FIELD) {
        make_field(h);
        body->options.pose.translation = (pir_vec3){-2, -2, 0};
    } else if (h->ground == HEAP_MESH) {
        make_mesh(h);
    } else if (h->ground == HEAP_TILES) {
        for (uint32_t i = 0; i < 4; i++)
            body->piece[i] = test_box_at(1.5, 1.5, 0.5, (pir_vec3){i % 2 ? 1.5 : -1.5, i / 2 ? 1.5 : -1.5, -0.5});
    } else {
        body->piece[0] = test_box_at(3, 3, 0.5, (pir_vec3){0, 0, -0.5});
    }
    body->options.mesh = h->mesh;
    body->options.field = h->field;
    if (h->mesh || h->field)
        body->options.piece_count = 0;
}

/* --- the others --- */

static pir_polytope *small_hull(heap *h) {
    static const test_body kinds[5] = {TEST_SPHERE, TEST_BALL, TEST_BOX, TEST_OCTAHEDRON, TEST_POINT};
    test_points points;
    const test_body kind = kinds[test_random_below(&h->random, 5)];
    test_body_points(&h->random, kind, 14, &points);
    const double by = kind == TEST_BOX ? 0.1 : 0.4;
    for (size_t i = 0; i < points.count; i++)
        points.at[i] = (pir_vec3){by * points.at[i].x, by * points.at[i].y, by * points.at[i].z};
    return test_polytope(&points);
}

static void add_body(heap *h) {
    heap_body *body = &h->body[h->count++];
    const double wide = 0.3 * cbrt((double)h->count) + 0.5;
    body->options = pir_body_options_default();
    body->options.piece_count = test_random_below(&h->random, 5) ? 1 : 2;
    for (uint32_t i = 0; i < body->options.piece_count; i++)
        body->piece[i] = small_hull(h);
    body->options.radius = test_random_below(&h->random, 3) ? 0 : 0.125;
    body->options.sensor = test_random_below(&h->random, 12) == 0;
    const double x = test_random_unit(&h->random), y = test_random_unit(&h->random);
    body->options.pose.translation = (pir_vec3){wide * x, wide * y, wide * (0.6 + 0.4 * test_random_unit(&h->random))};
    if (test_random_below(&h->random, 4))
        body->options.pose.rotation = test_general_rotation(&h->random);
}

void heap_init(heap *h, uint64_t number, uint32_t count) {
    *h = (heap){.random = test_random_case("heaps", number), .ground = (heap_ground)(number % HEAP_GROUNDS)};
    const bool ground_first = test_random_below(&h->random, 2);
    h->ground_at = HEAP_BODIES;
    if (h->ground != HEAP_NO_GROUND && ground_first)
        add_ground(h);
    for (uint32_t i = 0; i < count; i++)
        add_body(h);
    if (h->ground != HEAP_NO_GROUND && !ground_first)
        add_ground(h);
}

void heap_finish(heap *h) {
    for (uint32_t i = 0; i < h->count; i++)
        for (uint32_t k = 0; k < HEAP_PIECES; k++)
            pir_polytope_release(h->body[i].piece[k]);
    pir_trimesh_release(h->mesh);
    pir_height_field_release(h->field);
}

pir_scene *heap_scene(const heap *h, const pir_scene_options *options) {
    pir_scene *scene;
    assert_int_equal(pir_scene_create(options, &scene), PIR_OK);
    for (uint32_t i = 0; i < h->count; i++) {
        pir_body_options body = h->body[i].options;
        uint32_t id;
        body.pieces = body.piece_count > 0 ? h->body[i].piece : NULL;
        assert_int_equal(pir_scene_add(scene, &body, &id), PIR_OK);
        assert_int_equal(id, i);
    }
    return scene;
}

/* --- motion --- */

static bool stands(const heap *h, uint32_t body) {
    return body == h->ground_at && (h->ground != HEAP_LIFT || h->moves % 3 == 0);
}

void heap_move(heap *h) {
    static const double trembles[4] = {0, 1e-5, 1e-3, 1e-2};
    const bool all = test_random_below(&h->random, 3) > 0;
    const double far = trembles[test_random_below(&h->random, 4)];
    h->moves = 0;
    for (uint32_t i = 0; i < h->count; i++) {
        if (stands(h, i) || (!all && test_random_below(&h->random, 2)))
            continue;
        pir_pose *pose = &h->body[i].options.pose;
        const pir_vec3 way = test_random_direction(&h->random), spin = test_random_direction(&h->random);
        const double by = test_random_below(&h->random, 40) ? far : 0.3;
        *pose = pir_pose_integrate(*pose, way, spin, by * test_random_unit(&h->random));
        h->move[h->moves++] = (pir_scene_move){i, *pose};
    }
}

/* --- comparisons --- */

static bool same_numbers(const pir_scene_event *a, const pir_scene_event *b) {
    return a->distance == b->distance && memcmp(&a->normal, &b->normal, sizeof a->normal) == 0 &&
           memcmp(&a->witness, &b->witness, sizeof a->witness) == 0 && a->approach == b->approach &&
           a->error == b->error && a->contact_count == b->contact_count;
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

bool heap_same_events(const pir_scene *a, const pir_scene *b) {
    size_t count, others;
    const pir_scene_event *x = pir_scene_events(a, &count), *y = pir_scene_events(b, &others);
    bool same = count == others;
    for (size_t i = 0; i < count && same; i++)
        same = x[i].kind == y[i].kind && x[i].body_p == y[i].body_p && x[i].body_q == y[i].body_q &&
               x[i].piece_p == y[i].piece_p && x[i].piece_q == y[i].piece_q && x[i].state == y[i].state &&
               same_numbers(&x[i], &y[i]) && same_contacts(&x[i], &y[i]);
    return same;
}
