/* SPDX-License-Identifier: MIT */
/* Fast bodies: see fast_bodies.h. Each is cast from the pose before the update, against all others after it. */
#include "scene/update/fast_bodies.h"

#include "scene/query/scene_cast.h"
#include "scene/world/grow.h"

/* The rotation vector that brings one rotation to another, the shorter way; both of length 1. */
static pir_vec3 turn_between(pir_quat a, pir_quat b) {
    const pir_vec3 u = {a.x, a.y, a.z}, v = {b.x, b.y, b.z};
    // b · conj(a)
    pir_vec3 axis = pir_vec_sub(pir_vec_sub(pir_vec_scale(v, a.w), pir_vec_scale(u, b.w)), pir_vec_cross(v, u));
    double w = a.w * b.w + pir_vec_dot(u, v);
    if (w < 0) {
        axis = pir_vec_scale(axis, -1);
        w = -w;
    }
    const double s = sqrt(pir_vec_dot(axis, axis));
    return s > 0 ? pir_vec_scale(axis, 2 * atan2(s, w) / s) : (pir_vec3){0, 0, 0};
}

static pir_status find_impact(pir_scene *scene, uint32_t number) {
    const pir_scene_body *body = &scene->bodies.body[number];
    pir_place before;
    pir_scene_impact found = {.body = pir_body_id(&scene->bodies, number), .user = body->user};
    if (pir_place_make(body->previous, &before) != PIR_OK)
        return PIR_ERR_INTERNAL;
    const pir_motion motion = {.way = pir_vec_sub(body->pose.translation, body->previous.translation),
                               .turn = turn_between(before.unit, body->unit)};
    if (pir_vec_dot(motion.way, motion.way) == 0 && pir_vec_dot(motion.turn, motion.turn) == 0)
        return PIR_OK;
    const pir_status status = pir_scene_fly_body(scene, number, &body->previous, &motion, body->fast, &found.impact);
    if (status != PIR_OK || found.impact.body == PIR_SCENE_NONE)
        return status;
    // by number: bodies come in the order of moves
    uint32_t at = scene->impact_count++;
    for (; at > 0 && pir_body_number(scene->impact[at - 1].body) > number; at--)
        scene->impact[at] = scene->impact[at - 1];
    scene->impact[at] = found;
    return PIR_OK;
}

pir_status pir_scene_find_impacts(pir_scene *scene) {
    uint32_t fast = 0;
    for (uint32_t i = 0; i < scene->lists.moved_count; i++)
        fast += scene->bodies.body[scene->lists.moved[i].body].fast > 0;
    if (fast == 0)
        return PIR_OK;
    if (!PIR_GROW(&scene->allocator, scene->impact, scene->impact_capacity, fast))
        return pir_fail(scene->report, PIR_ERR_MEMORY, "update: no memory for %u fast bodies", (unsigned)fast);
    for (uint32_t i = 0; i < scene->lists.moved_count; i++) {
        const uint32_t number = scene->lists.moved[i].body;
        const pir_scene_body *body = &scene->bodies.body[number];
        if (!(body->fast > 0) || body->sensor || body->disabled)
            continue;
        const pir_status status = find_impact(scene, number);
        if (status != PIR_OK)
            return pir_fail(scene->report, status, "update: body %u, which is fast: %s",
                            (unsigned)pir_body_id(&scene->bodies, number), pir_status_text(status));
    }
    return PIR_OK;
}
