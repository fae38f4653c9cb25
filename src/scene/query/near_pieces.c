/* SPDX-License-Identifier: MIT */
/* Pieces and triangles near something: see near_pieces.h. */
#include "scene/query/near_pieces.h"

#include "mesh/query/mesh_walk.h"
#include "mesh/query/swept_boxes.h"
#include "scene/world/near_triangles.h"
#include "scene/world/triangles.h"

/* A walk over the triangles of a surface; the boxes are in its frame. */
struct near_walk {
    const pir_near_search *near;
    const pir_scene_body *body;
    uint32_t number; /* of that body */
    pir_place place;
    pir_walk_box box, from;
    pir_swept_box swept;
    pir_status status;
};

static void measure_box(const void *context, const pir_mesh_boxes *boxes, double ret_near[PIR_MESH_WIDTH]) {
    pir_walk_box_measure(&((const struct near_walk *)context)->box, boxes, ret_near);
}

static void measure_distance(const void *context, const pir_mesh_boxes *boxes, double ret_near[PIR_MESH_WIDTH]) {
    const pir_walk_box *from = &((const struct near_walk *)context)->from;
    double square[PIR_MESH_WIDTH] = {0};
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < PIR_MESH_WIDTH; i++) {
            const double gap =
                fmax(fmax((double)boxes->low[k][i] - from->high[k], from->low[k] - (double)boxes->high[k][i]), 0);
            square[i] += gap * gap;
        }
    for (int i = 0; i < PIR_MESH_WIDTH; i++)
        ret_near[i] = sqrt(square[i]) * (1 - 0x1p-40);
}

static void measure_time(const void *context, const pir_mesh_boxes *boxes, double ret_near[PIR_MESH_WIDTH]) {
    pir_swept_times(&((const struct near_walk *)context)->swept, boxes, ret_near);
}

/* The box around a triangle, as a node's first child. */
static pir_mesh_boxes box_around(const pir_tri *tri) {
    const double p[3][3] = {{tri->p[0].x, tri->p[0].y, tri->p[0].z},
                            {tri->p[1].x, tri->p[1].y, tri->p[1].z},
                            {tri->p[2].x, tri->p[2].y, tri->p[2].z}};
    pir_mesh_boxes boxes;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < PIR_MESH_WIDTH; i++) {
            boxes.low[k][i] = pir_float_below(fmin(p[0][k], fmin(p[1][k], p[2][k])));
            boxes.high[k][i] = pir_float_above(fmax(p[0][k], fmax(p[1][k], p[2][k])));
        }
    return boxes;
}

typedef void pir_measure_boxes(const void *context, const pir_mesh_boxes *boxes, double ret_near[PIR_MESH_WIDTH]);

static pir_measure_boxes *const measure[] = {
    [PIR_NEAR_BOX] = measure_box, [PIR_NEAR_DISTANCE] = measure_distance, [PIR_NEAR_TIME] = measure_time};

static bool look(void *context, const pir_met_triangle *met) {
    struct near_walk *walk = context;
    const pir_near_search *near = walk->near;
    pir_scene *scene = near->probe->scene;
    const pir_mesh_boxes around = box_around(&met->tri);
    double nearness[PIR_MESH_WIDTH];
    measure[near->by](walk, &around, nearness);
    if (!(nearness[0] <= *near->most))
        return true;
    pir_scene_piece piece = pir_triangle_piece(&scene->bodies, walk->number, met->number);
    pir_piece_box(walk->body, &piece, &walk->place, pir_scene_around(scene, walk->body), &piece.tight);
    piece.extent.polytope = pir_triangles_recall(&scene->bodies, piece.body, piece.number);
    walk->status = near->look(near->context, &piece);
    pir_triangles_keep(&scene->bodies, &scene->allocator, &piece);
    return walk->status == PIR_OK;
}

pir_status pir_near_triangles(const pir_near_search *near, const pir_scene_body *body) {
    struct near_walk walk = {.near = near, .body = body, .number = (uint32_t)(body - near->probe->scene->bodies.body)};
    const pir_vec3 t = body->pose.translation;
    // more than distances in doubles are off by
    const double around = pir_scene_around(near->probe->scene, body) +
                          0x1p-30 * (body->reach + body->radius + fabs(t.x) + fabs(t.y) + fabs(t.z));
    walk.status = pir_place_make(body->pose, &walk.place);
    if (walk.status != PIR_OK)
        return walk.status;
    const pir_box box = pir_box_wider(&near->box, around), from = pir_box_wider(&near->from, around);
    walk.box = pir_place_sees(&walk.place, &box);
    walk.from = pir_place_sees(&walk.place, &from);
    pir_swept_box_set(&walk.swept, walk.from.low, walk.from.high, pir_mat_apply_transposed(&walk.place.r, near->way));
    pir_walk_box within = walk.box;
    const pir_walk_box bounds = pir_surface_bounds(pir_body_surface_of(body));
    if (near->by == PIR_NEAR_TIME && !pir_swept_part(&walk.swept, &bounds, *near->most, &within))
        return PIR_OK;
    pir_surface_walk(pir_body_surface_of(body), &(pir_walk){measure[near->by], look, &walk, near->most,
                                                            near->by == PIR_NEAR_DISTANCE ? NULL : &within});
    return walk.status;
}

pir_status pir_near_pieces(const pir_near_search *near) {
    pir_scene *scene = near->probe->scene;
    pir_status status = PIR_OK;
    for (uint32_t leaf = pir_tree_first(&scene->tree, &near->box); leaf != PIR_TREE_NONE && status == PIR_OK;
         leaf = pir_tree_next(&scene->tree, &near->box, leaf)) {
        pir_scene_piece *piece = &scene->bodies.piece[pir_tree_item(&scene->tree, leaf)];
        if (!pir_box_meets(&near->box, &piece->tight) || !pir_probe_meets(near->probe, piece->body))
            continue;
        status = piece->kind == PIR_PIECE_SURFACE ? pir_near_triangles(near, &scene->bodies.body[piece->body])
                                                  : near->look(near->context, piece);
    }
    return status;
}
