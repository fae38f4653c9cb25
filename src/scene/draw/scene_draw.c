/* SPDX-License-Identifier: MIT */
/* A scene told to callbacks: see pirouette/scene_draw.h. */
#include <pirouette/scene_draw.h>

#include "base/options.h"
#include "mesh/query/mesh_walk.h"
#include "scene/world/scene.h"
#include "scene/world/surfaces.h"

static uint32_t colour_of(const pir_scene_body *body) {
    static const uint32_t colours[3] = {PIR_DRAW_MOVING, PIR_DRAW_KINEMATIC, PIR_DRAW_STATIC};
    return body->disabled ? PIR_DRAW_DISABLED : body->sensor ? PIR_DRAW_SENSOR : colours[body->kind];
}

static void draw_triangle(const pir_scene *scene, const pir_scene_drawing *drawing, uint32_t number,
                          uint32_t triangle) {
    const pir_scene_body *body = &scene->bodies.body[number];
    pir_draw_triangle drawn = {
        .body = pir_body_id(&scene->bodies, number), .triangle = triangle, .colour = colour_of(body)};
    pir_surface_triangle(pir_body_surface_of(body), triangle, drawn.corner);
    for (int k = 0; k < 3; k++)
        drawn.corner[k] = pir_pose_apply(body->pose, drawn.corner[k]);
    drawing->triangle(drawing->context, &drawn);
}

static void draw_surface(const pir_scene *scene, const pir_scene_drawing *drawing, uint32_t number) {
    const pir_body_surface *surface = &scene->bodies.body[number].surface;
    if (drawing->near_triangles) {
        for (uint32_t t = surface->triangles; t != PIR_PIECE_NONE; t = scene->bodies.piece[t].next)
            draw_triangle(scene, drawing, number, scene->bodies.piece[t].number);
        return;
    }
    const uint32_t count = surface->mesh ? surface->mesh->triangle_count : 2 * pir_height_cells(surface->field);
    for (uint32_t t = 0; t < count; t++)
        if (surface->mesh || !pir_height_is_hole(surface->field, t / 2))
            draw_triangle(scene, drawing, number, t);
}

static void draw_box(const pir_scene_drawing *drawing, const pir_box *box) {
    drawing->box(drawing->context, (pir_vec3){box->low[0], box->low[1], box->low[2]},
                 (pir_vec3){box->high[0], box->high[1], box->high[2]}, PIR_DRAW_BOX);
}

static void draw_body(const pir_scene *scene, const pir_scene_drawing *drawing, uint32_t number) {
    const pir_scene_body *body = &scene->bodies.body[number];
    for (uint32_t i = body->first; i != PIR_PIECE_NONE; i = scene->bodies.piece[i].next) {
        const pir_scene_piece *piece = &scene->bodies.piece[i];
        if (drawing->hull && piece->kind == PIR_PIECE_CONVEX)
            drawing->hull(drawing->context,
                          &(pir_draw_hull){pir_body_id(&scene->bodies, number), piece->number, piece->extent.polytope,
                                           body->pose, body->radius, colour_of(body)});
        if (drawing->box)
            draw_box(drawing, &scene->tree.node[piece->node].box);
    }
    if (drawing->triangle && pir_body_has_surface(body))
        draw_surface(scene, drawing, number);
}

/* The way by which the pair of an event was answered. */
static pir_level level_of(const pir_scene *scene, const pir_scene_event *event) {
    const uint32_t p = pir_bodies_find(&scene->bodies, event->body_p),
                   q = pir_bodies_find(&scene->bodies, event->body_q);
    if (p == PIR_SCENE_NONE || q == PIR_SCENE_NONE)
        return PIR_LEVEL_APART;
    const uint32_t of[2] = {pir_bodies_piece(&scene->bodies, p, event->piece_p),
                            pir_bodies_piece(&scene->bodies, q, event->piece_q)};
    for (uint32_t end = of[0] == PIR_PIECE_NONE ? PIR_END_NONE : scene->bodies.piece[of[0]].first; end != PIR_END_NONE;
         end = scene->pairs.at[end / 2].next[end % 2]) {
        const pir_scene_pair *pair = &scene->pairs.at[end / 2];
        if (pair->piece[0] == of[0] && pair->piece[1] == of[1] && pair->asked)
            return pir_pair_level(pair->asked);
    }
    return PIR_LEVEL_APART;
}

static void draw_event(const pir_scene *scene, const pir_scene_drawing *drawing, const pir_scene_event *event) {
    const pir_level level = event->contact_count > 0 ? level_of(scene, event) : PIR_LEVEL_APART;
    for (uint32_t i = 0; i < event->contact_count; i++) {
        const pir_contact *contact = &event->contacts[i];
        const pir_draw_contact drawn = {.event = event,
                                        .point = pir_vec_scale(pir_vec_add(contact->point_p, contact->point_q), 0.5),
                                        .normal = event->normal,
                                        .distance = contact->distance,
                                        .level = level,
                                        .colour = event->kind == PIR_EVENT_BEGAN ? PIR_DRAW_BEGAN : PIR_DRAW_PERSISTED};
        drawing->contact(drawing->context, &drawn);
    }
}

pir_status pir_scene_draw(const pir_scene *scene, const pir_scene_drawing *drawing) {
    pir_scene_drawing used = pir_scene_drawing_default();
    pir_status status = pir_scene_given(scene, "draw", drawing ? NULL : "drawing");
    if (status == PIR_OK)
        status = pir_options_take("pir_scene_drawing", drawing, &used, &scene->report);
    if (status != PIR_OK)
        return status;
    for (uint32_t b = 0; b < scene->bodies.body_end; b++)
        if (scene->bodies.body[b].used)
            draw_body(scene, &used, b);
    for (uint32_t i = 0; used.contact && i < scene->event_count; i++)
        draw_event(scene, &used, &scene->event[i]);
    return PIR_OK;
}
