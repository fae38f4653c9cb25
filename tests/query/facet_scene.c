/* SPDX-License-Identifier: MIT */
/* Differences, pieces of them and places: see facet_scene.h. */
#include "support/test.h"

#include "facet_scene.h"

#include <math.h>
#include <string.h>

#include "query/frame/body.h"
#include "support/bodies.h"

/* A body with tables of what is around its vertices, or too large or too flat for them. */
static pir_polytope *some_body(test_random *random) {
    static const test_body kinds[5] = {TEST_BOX, TEST_SPHERE, TEST_OCTAHEDRON, TEST_SPHERE, TEST_POLYGON};
    test_points points;
    uint32_t kind = test_random_below(random, 5);
    test_body_points(random, kinds[kind], kind == 3 ? 40 : 20, &points);
    if (test_random_below(random, 2) == 0)
        test_bake(&points, test_general_rotation(random));
    pir_polytope *p = test_polytope(&points);
    if (p->dimension >= 2)
        return p;
    // without facets there is nothing to prove
    pir_polytope_release(p);
    return some_body(random);
}

void facet_scene_make(test_random *random, facet_scene *scene) {
    static pir_rotation_integers integers;
    pir_rotation rotation = {.integers = &integers};
    memset(scene, 0, sizeof *scene);
    scene->p = some_body(random);
    scene->q = some_body(random);
    assert_int_equal(pir_polytope_reflect(scene->p, &scene->reflected), PIR_OK);
    assert_int_equal(pir_frame_set_bodies(&scene->frame, scene->reflected, scene->q), PIR_OK);
    assert_int_equal(pir_rotation_set(&rotation, test_rotation(random)), PIR_OK);
    pir_frame_turn(&scene->frame, &rotation);
}

void facet_scene_free(facet_scene *scene) {
    pir_polytope_release(scene->reflected);
    pir_polytope_release(scene->p);
    pir_polytope_release(scene->q);
}

/* The middle of a facet's corners, in its body's frame. */
static pir_vec3 middle_of(const pir_body *body, uint32_t facet) {
    const pir_polytope *p = body->polytope;
    const uint32_t start = p->loop_start[facet], end = p->loop_start[facet + 1];
    pir_vec3 sum = {0, 0, 0};
    for (uint32_t i = start; i < end; i++)
        sum = pir_vec_add(sum, body->vertex[p->origin[p->loop[i]]]);
    return pir_vec_scale(sum, 1.0 / (end - start));
}

static pir_vec3 half_way(const pir_body *body, uint32_t half) {
    const pir_polytope *p = body->polytope;
    return pir_vec_scale(pir_vec_add(body->vertex[p->origin[half]], body->vertex[p->target[half]]), 0.5);
}

pir_piece facet_scene_piece(test_random *random, const pir_frame *frame, pir_vec3 *ret_in, pir_vec3 *ret_normal) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    const uint32_t kind = test_random_below(random, 3);
    if (kind == 0) {
        uint32_t f = test_random_below(random, p->facet_count);
        *ret_normal = pir_mat_apply(&frame->r, p->normal[f]);
        uint32_t b = pir_climb(q, *ret_normal, test_random_below(random, q->vertex_count));
        *ret_in = pir_vec_add(pir_mat_apply(&frame->r, middle_of(&frame->p, f)), frame->q.vertex[b]);
        return (pir_piece){PIR_FACET_FV, f, test_random_below(random, 2) ? b : 0};
    }
    if (kind == 1) {
        uint32_t g = test_random_below(random, q->facet_count);
        *ret_normal = q->normal[g];
        pir_vec3 back = pir_mat_apply_transposed(&frame->r, *ret_normal);
        uint32_t a = pir_climb(p, back, test_random_below(random, p->vertex_count));
        *ret_in = pir_vec_add(pir_mat_apply(&frame->r, frame->p.vertex[a]), middle_of(&frame->q, g));
        return (pir_piece){PIR_FACET_VF, test_random_below(random, 2) ? a : 0, g};
    }
    // most edges do not cross: a few tries find some that do
    pir_piece piece = {PIR_FACET_EE, 0, 0};
    for (int tries = 0; tries < 200; tries++) {
        piece.first = test_random_below(random, p->edge_count);
        piece.second = test_random_below(random, q->half_count);
        uint32_t half = p->edge_half[piece.first], a = p->origin[half], b = q->origin[piece.second];
        pir_vec3 n = pir_vec_cross(q->direction[piece.second], pir_mat_apply(&frame->r, p->direction[half]));
        n = pir_vec_scale(n, 1 / sqrt(pir_vec_dot(n, n)));
        pir_vec3 back = pir_mat_apply_transposed(&frame->r, n);
        *ret_normal = n;
        *ret_in = pir_vec_add(pir_mat_apply(&frame->r, half_way(&frame->p, half)), half_way(&frame->q, piece.second));
        // at a corner that is a support along its normal, but for rounding
        if (pir_climb_above(p, back, 0x1p-40, a) == a && pir_climb_above(q, n, 0x1p-40, b) == b)
            break;
    }
    return piece;
}

pir_placement facet_scene_place(test_random *random, const pir_frame *frame, pir_vec3 in, pir_vec3 normal) {
    pir_placement placement;
    double up = test_random_below(random, 8) == 0 ? 0 : 0.5 * test_random_unit(random);
    pir_vec3 beside = test_random_direction(random);
    double far = test_random_below(random, 2) ? 0.3 * test_random_unit(random) : 0.01;
    memset(&placement, 0, sizeof placement);
    placement.x = pir_vec_add(pir_vec_add(in, pir_vec_scale(normal, up)), pir_vec_scale(beside, far));
    pir_frame_set_reach(frame, 0, &placement);
    return placement;
}
