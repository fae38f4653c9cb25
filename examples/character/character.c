/* SPDX-License-Identifier: MIT */
/*
 * Moves and slides by casts: see character.h.
 *
 * A cast ends NEAR away from what it meets, at most. The capsule then goes back until it is a skin away, so by the
 * plane between both the next cast begins farther than NEAR. What came nearer, for it moves itself, pushes first.
 */
#include "character.h"

#include <vec.h>

#define NEAR    1e-3
#define LEVEL   0.64 /* the least height of a unit normal that one can stand on: the cosine of 50 degrees */
#define GRAVITY 9.81
#define ROOM    5e-3
#define GRAZING 0.05
#define PLANES  6

pir_scene_shape character_shape(const struct character *character) {
    pir_scene_shape shape = pir_scene_shape_default(character->spine);
    shape.pose.translation = character->at;
    shape.radius = character->radius;
    shape.except = character->body;
    return shape;
}

/* Out of what came too near: by all planes between the capsule and what is about it at once, so that it does not swing
   from one to another. Nothing where there is room. */
static void leave(struct character *c, pir_scene *scene) {
    for (int round = 0; round < 4 && c->status == PIR_OK; round++) {
        const pir_scene_shape shape = character_shape(c);
        pir_scene_near near[16];
        pir_vec3 by = {0, 0, 0};
        size_t count = 0;
        c->status = pir_scene_nearest(scene, &shape, 2 * CHARACTER_SKIN, 16, near, &count);
        if (c->status != PIR_OK || count == 0 || near[0].result.distance > 2 * NEAR)
            return;
        for (size_t k = 0; k < 32 * count; k++) {
            const pir_query_result *off = &near[k % count].result;
            const double lacks = ROOM - off->distance - vec_dot(by, off->normal);
            by = vec_add(by, vec_times(fmax(0, 0.5 * lacks), off->normal));
        }
        c->at = vec_add(c->at, by);
    }
}

/* Goes along a way until a skin away from what is met; `except` is not met. Whether anything is; the time becomes the
   part of the way that it went. The cast goes farther, so that what is near its end counts as well. */
static bool go(struct character *c, pir_scene *scene, pir_vec3 way, uint32_t except, pir_impact *ret_impact) {
    const pir_query_filter but = {.ignored = &except, .ignored_count = except != PIR_SCENE_NONE};
    const double length = vec_length(way), back = CHARACTER_SKIN - NEAR, farther = length + back / GRAZING;
    pir_scene_shape shape = character_shape(c);
    shape.filter = &but;
    *ret_impact = (pir_impact){.body = PIR_SCENE_NONE, .time = 0};
    if (c->status != PIR_OK || length == 0)
        return false;
    const pir_motion motion = {.way = vec_times(farther / length, way)};
    c->status = pir_scene_cast(scene, &shape, &motion, NEAR, ret_impact);
    const double against = -vec_dot(ret_impact->normal, way) / length, until = ret_impact->time * farther;
    const bool some = ret_impact->body != PIR_SCENE_NONE, grazes = some && against < GRAZING;
    const double part = (some && !grazes ? fmax(0, until - back / against) : until) / length;
    if (c->status != PIR_OK)
        return false;
    ret_impact->time = fmin(part, 1);
    c->at = vec_add(c->at, vec_times(ret_impact->time, way));
    if (grazes && part < 1) // over an edge, say: going back would not lead away from it
        leave(c, scene);
    return some && part < 1;
}

static bool is_free(pir_vec3 way, const pir_vec3 *plane, int count) {
    for (int i = 0; i < count; i++)
        if (vec_dot(way, plane[i]) < -1e-12 * vec_length(way))
            return false;
    return true;
}

/* What is left of a way that goes into none of the planes: in one of them, along two, or nothing. */
static pir_vec3 along_planes(pir_vec3 way, const pir_vec3 *plane, int count) {
    for (int i = count; i-- > 0;) {
        pir_vec3 in = vec_less(way, vec_times(vec_dot(way, plane[i]), plane[i]));
        if (is_free(in, plane, count))
            return in;
    }
    for (int i = 0; i < count; i++)
        for (int k = 0; k < i; k++) {
            const pir_vec3 edge = vec_cross(plane[i], plane[k]);
            const double square = vec_dot(edge, edge);
            const pir_vec3 in = square > 1e-9 ? vec_times(vec_dot(edge, way) / square, edge) : (pir_vec3){0, 0, 0};
            if (is_free(in, plane, count))
                return in;
        }
    return (pir_vec3){0, 0, 0};
}

/* Slides along what is met. Of what is too steep only the level part of the normal counts for one that walks. */
static bool slide(struct character *c, pir_scene *scene, pir_vec3 way, uint32_t except, bool walks) {
    const pir_vec3 wanted = way;
    pir_vec3 plane[PLANES];
    pir_impact impact;
    bool barred = false;
    for (int count = 0; count < PLANES && go(c, scene, way, except, &impact);) {
        const pir_vec3 n = impact.normal, level = {n.x, n.y, 0}, rest = vec_times(1 - impact.time, way);
        const bool steep = walks && n.z < LEVEL && vec_length(level) > 0;
        barred |= n.z < LEVEL;
        plane[count++] = steep ? vec_times(1 / vec_length(level), level) : n;
        way = along_planes(rest, plane, count);
        if (vec_dot(way, wanted) <= 1e-9 * vec_dot(wanted, wanted))
            break;
    }
    return barred;
}

/* Whether one can stand on what was met: it is level there, or a little farther in, behind an edge. */
static bool is_ground(struct character *c, pir_scene *scene, const pir_impact *impact) {
    const pir_vec3 n = impact->normal, level = {n.x, n.y, 0};
    if (n.z >= LEVEL || n.z <= 0)
        return n.z > 0;
    const pir_vec3 above = vec_add(impact->point, (pir_vec3){-0.02 * level.x / vec_length(level),
                                                             -0.02 * level.y / vec_length(level), CHARACTER_STEP / 2});
    pir_scene_ray_options options = pir_scene_ray_options_default();
    pir_impact met = {.body = PIR_SCENE_NONE};
    options.except = c->body;
    c->status = pir_scene_ray_first(scene, above, (pir_vec3){0, 0, -CHARACTER_STEP}, &options, &met);
    return c->status == PIR_OK && met.body != PIR_SCENE_NONE && met.outcome == PIR_CAST_HIT && met.normal.z >= LEVEL;
}

/* Down onto the ground, where there is some within a length, along what is steep; else it stays. */
static bool settle(struct character *c, pir_scene *scene, double length) {
    const pir_vec3 from = c->at;
    pir_vec3 plane[PLANES], way = {0, 0, -length};
    pir_impact impact;
    for (int count = 0; count < PLANES && go(c, scene, way, PIR_SCENE_NONE, &impact);) {
        if (is_ground(c, scene, &impact)) {
            c->stands = true;
            c->ground = impact.body;
            c->status = pir_scene_pose(scene, c->ground, &c->stood);
            return true;
        }
        plane[count++] = impact.normal;
        way = along_planes(vec_times(1 - impact.time, way), plane, count);
    }
    c->at = from;
    c->stands = false;
    return false;
}

/* On the level; where that is barred, up a stair, on and down to where one can stand, if this leads up and farther. */
static void walk(struct character *c, pir_scene *scene, pir_vec3 way) {
    const struct character before = *c;
    pir_impact impact;
    if (!slide(c, scene, way, PIR_SCENE_NONE, true) || !before.stands)
        return;
    const struct character slid = *c;
    *c = before;
    go(c, scene, (pir_vec3){0, 0, CHARACTER_STEP}, PIR_SCENE_NONE, &impact);
    const double up = c->at.z - before.at.z;
    slide(c, scene, way, PIR_SCENE_NONE, true);
    const double farther = vec_dot(vec_less(c->at, slid.at), way);
    if (!settle(c, scene, up) || c->at.z < before.at.z + CHARACTER_SKIN || farther <= 1e-6 * vec_dot(way, way))
        *c = slid;
}

void character_move(struct character *c, pir_scene *scene, pir_vec3 velocity, double time) {
    pir_pose now;
    if (c->stands && pir_scene_pose(scene, c->ground, &now) == PIR_OK) {
        const pir_vec3 carried = pir_pose_apply(now, pir_pose_apply_inverse(c->stood, c->at));
        slide(c, scene, vec_less(carried, c->at), c->ground, false);
    }
    leave(c, scene);
    walk(c, scene, vec_times(time, velocity));
    const double fall = c->rise - GRAVITY * time, from = c->at.z;
    if (c->rise <= 0 && settle(c, scene, c->stands ? CHARACTER_STEP : -fall * time)) {
        c->rise = 0;
        return;
    }
    c->stands = false;
    slide(c, scene, (pir_vec3){0, 0, fall * time}, PIR_SCENE_NONE, false);
    c->rise = (c->at.z - from) / time; // what was met takes the rest
}
