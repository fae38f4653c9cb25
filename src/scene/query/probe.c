/* SPDX-License-Identifier: MIT */
/* Shapes held against pieces: see probe.h. */
#include "scene/query/probe.h"

#include "scene/world/triangles.h"

pir_scene_shape pir_scene_shape_default(pir_polytope *polytope) {
    return (pir_scene_shape){polytope, pir_pose_identity(), 0, UINT32_MAX, PIR_SCENE_NONE, NULL, NULL};
}

pir_status pir_probe_of_shape(pir_scene *scene, const pir_scene_shape *shape, pir_probe *ret_probe) {
    pir_place place;
    if (!shape->polytope)
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "shape: it has no polytope");
    if (!pir_is_coarse_of(shape->coarse, shape->polytope))
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "shape: its coarse bodies are another polytope's");
    if (isnan(shape->radius))
        return pir_fail(scene->report, PIR_ERR_NOT_FINITE, "shape: its radius is not a number");
    if (!(shape->radius >= 0 && shape->radius < HUGE_VAL))
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "shape: its radius is %g, not from 0 up", shape->radius);
    pir_status status = pir_place_make(shape->pose, &place);
    if (status != PIR_OK)
        return pir_place_fail(shape->pose, status, "shape", scene->report);
    pir_probe probe = {.scene = scene,
                       .extent = pir_extent_of(shape->polytope),
                       .pose = shape->pose,
                       .radius = shape->radius,
                       .body = PIR_SCENE_NONE,
                       .mask = shape->mask,
                       .except = pir_bodies_find(&scene->bodies, shape->except),
                       .filter = shape->filter};
    if (!pir_place_box(&place, &probe.extent, shape->radius, &probe.box))
        return pir_fail(scene->report, PIR_ERR_LIMIT, "shape: it reaches beyond 2^60");
    *ret_probe = probe;
    return PIR_OK;
}

pir_probe pir_probe_of_piece(pir_scene *scene, const pir_scene_piece *p) {
    const pir_scene_body *body = &scene->bodies.body[p->body];
    return (pir_probe){.scene = scene,
                       .extent = p->extent,
                       .pose = body->pose,
                       .radius = body->radius,
                       .body = p->body,
                       .piece_user = pir_piece_user(&scene->bodies, p),
                       .except = PIR_SCENE_NONE,
                       .box = p->tight};
}

void pir_name_impact(const pir_scene *scene, pir_impact *impact) {
    if (impact->body == PIR_SCENE_NONE)
        return;
    impact->user = scene->bodies.body[impact->body].user;
    impact->body = pir_body_id(&scene->bodies, impact->body);
}

/* Whether a body passes the caller's filter. */
static bool passes(const pir_probe *probe, uint32_t body) {
    const pir_query_filter *filter = probe->filter;
    const pir_bodies *bodies = &probe->scene->bodies;
    const uint32_t id = pir_body_id(bodies, body);
    for (size_t i = 0; filter->ignored && i < filter->ignored_count; i++)
        if (filter->ignored[i] == id)
            return false;
    return !filter->counts || filter->counts(filter->context, id, bodies->body[body].user);
}

bool pir_probe_meets(const pir_probe *probe, uint32_t body) {
    const pir_bodies *bodies = &probe->scene->bodies;
    if (bodies->body[body].sensor || bodies->body[body].disabled)
        return false;
    if (probe->body != PIR_SCENE_NONE)
        return pir_bodies_meet(bodies, probe->body, body);
    return body != probe->except && (bodies->body[body].category & probe->mask) != 0 &&
           (!probe->filter || passes(probe, body));
}

pir_box pir_probe_wider(const pir_probe *probe, double distance) {
    return pir_box_wider(&probe->box, distance);
}

pir_status pir_probe_pair(const pir_probe *probe, pir_scene_piece *q, pir_pair **ret_pair, pir_pair_input *ret_input) {
    pir_scene *scene = probe->scene;
    const pir_scene_body *body = &scene->bodies.body[q->body];
    pir_status status = pir_piece_ready(body, &scene->for_triangles, q);
    if (status != PIR_OK)
        return status;
    if (scene->spare) {
        status = pir_pair_reset(scene->spare, probe->extent.polytope, q->extent.polytope);
    } else {
        pir_pair_options options = pir_pair_options_default();
        options.allocator = &scene->allocator;
        status = pir_pair_create(probe->extent.polytope, q->extent.polytope, &options, &scene->spare);
    }
    if (status != PIR_OK)
        return status;
    *ret_input = pir_pair_input_default();
    ret_input->pose_p = probe->pose;
    ret_input->radius_p = probe->radius;
    ret_input->pose_q = body->pose;
    ret_input->radius_q = body->radius;
    *ret_pair = scene->spare;
    return PIR_OK;
}
