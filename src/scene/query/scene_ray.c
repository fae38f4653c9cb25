/* SPDX-License-Identifier: MIT */
/* The first hit of a segment: the least over the pieces whose boxes it meets, each by one of the ways of ray.h. */
#include "scene/query/probe.h"
#include "scene/query/ray_rounded.h"

/*
 * The slack of a facet at a point of the segment, in the piece's frame, is off by at most this times the sizes of
 * piece, origin and way, less the piece's translation: 8u for a unit normal, 40u for turning a point by a pose, with
 * u = 2^-53, twice each, and a few roundings.
 */
#define SLACK_ERROR 0x1p-45

struct scene_ray {
    pir_scene *scene;
    pir_world_ray world;
    uint32_t mask;
};

static double length(pir_vec3 v) {
    return sqrt(pir_vec_dot(v, v));
}

static pir_ray_segment seen_by(const struct scene_ray *ray, const pir_scene_body *body) {
    const pir_world_ray *world = &ray->world;
    pir_vec3 away = pir_vec_sub(world->origin, body->pose.translation);
    pir_ray_segment segment = {pir_pose_rotate_inverse(body->pose, away),
                               pir_pose_rotate_inverse(body->pose, world->way), 0};
    segment.error =
        SLACK_ERROR * (length(world->origin) + length(body->pose.translation) + length(world->way) + body->reach);
    return segment;
}

/* Sees to the room for the integers of a polytope. */
static pir_status reserve(pir_scene *scene, const pir_polytope *p) {
    pir_exact_room *room = &scene->exact_room;
    uint32_t need = pir_ray_limbs(p);
    if (!room->integers)
        room->integers = PIR_ZEROED(&scene->allocator, pir_rotation_integers, 1);
    if (room->integers && need > room->limbs.capacity) {
        mp_limb_t *limbs = PIR_NEW(&scene->allocator, mp_limb_t, need);
        if (!limbs)
            return PIR_ERR_MEMORY;
        PIR_FREE(&scene->allocator, room->limbs.base, room->limbs.capacity);
        room->limbs = (pir_limbs){limbs, 0, need};
    }
    return room->integers ? PIR_OK : PIR_ERR_MEMORY;
}

/* The impact on a piece, where there is one. */
static pir_status meet(const struct scene_ray *ray, uint32_t number, pir_impact *impact) {
    const pir_scene_piece *piece = &ray->scene->bodies.piece[number];
    const pir_scene_body *body = &ray->scene->bodies.body[piece->body];
    const pir_polytope *p = piece->extent.polytope;
    pir_ray_segment segment = seen_by(ray, body);
    pir_entry entry;
    if (body->radius > 0) {
        entry = pir_ray_rounded(p, &segment, body->radius);
    } else if (!pir_ray_by_doubles(p, &segment, &entry)) {
        pir_status status = reserve(ray->scene, p);
        if (status != PIR_OK)
            return status;
        entry = pir_ray_exact(p, &ray->world, body->pose, &segment, &ray->scene->exact_room);
    }
    *impact = (pir_impact){.body = entry.hits ? piece->body : PIR_SCENE_NONE,
                           .piece_q = piece->number,
                           .outcome = entry.inside ? PIR_CAST_START_INSIDE : PIR_CAST_HIT,
                           .time = entry.time,
                           .normal = pir_pose_rotate(body->pose, entry.normal),
                           .point = pir_vec_add(ray->world.origin, pir_vec_scale(ray->world.way, entry.time))};
    return PIR_OK;
}

/* Whether an impact comes before another, or there is no other. */
static bool comes_before(const pir_impact *a, const pir_impact *b) {
    if (a->body == PIR_SCENE_NONE || b->body == PIR_SCENE_NONE)
        return a->body != PIR_SCENE_NONE;
    if (a->time != b->time)
        return a->time < b->time;
    return a->body != b->body ? a->body < b->body : a->piece_q < b->piece_q;
}

/*
 * Whether the segment may meet a box, by axes of the box and its own, with twice the room that rounding needs. `to` is
 * how far along it the search still goes.
 */
static bool may_meet(const struct scene_ray *ray, const pir_box *box, double to) {
    double from[3] = {ray->world.origin.x, ray->world.origin.y, ray->world.origin.z},
           way[3] = {ray->world.way.x, ray->world.way.y, ray->world.way.z};
    double enter = 0, leave = to;
    for (int k = 0; k < 3; k++) {
        double room = 0x1p-40 * (fabs(from[k]) + fabs(way[k]) + fabs(box->low[k]) + fabs(box->high[k]));
        double low = box->low[k] - room - from[k], high = box->high[k] + room - from[k];
        if (fabs(way[k]) < 0x1p-900) {
            if (low > fabs(way[k]) || high < -fabs(way[k]))
                return false;
            continue;
        }
        double a = low / way[k], b = high / way[k];
        enter = fmax(enter, fmin(a, b) * (a > 0 && b > 0 ? 1 - 0x1p-40 : 1 + 0x1p-40));
        leave = fmin(leave, fmax(a, b) * (a > 0 || b > 0 ? 1 + 0x1p-40 : 1 - 0x1p-40));
    }
    return enter <= leave;
}

static pir_status search(struct scene_ray *ray, pir_impact *first) {
    const pir_tree *tree = &ray->scene->tree;
    pir_probe probe = {.scene = ray->scene, .body = PIR_SCENE_NONE, .mask = ray->mask, .except = PIR_SCENE_NONE};
    uint32_t n = tree->node ? tree->root : PIR_TREE_NONE;
    while (n != PIR_TREE_NONE) {
        double to = first->body == PIR_SCENE_NONE ? 1 : first->time * (1 + 0x1p-30);
        bool may = may_meet(ray, &tree->node[n].box, to);
        uint32_t piece = tree->node[n].child[1];
        if (may && tree->node[n].child[0] != PIR_TREE_NONE) {
            n = tree->node[n].child[0];
            continue;
        }
        if (may && pir_probe_meets(&probe, piece)) {
            pir_impact impact;
            pir_status status = meet(ray, piece, &impact);
            if (status != PIR_OK)
                return pir_fail(ray->scene->report, status, "ray: %s", pir_status_text(status));
            if (comes_before(&impact, first))
                *first = impact;
        }
        n = pir_tree_beyond(tree, n);
    }
    return PIR_OK;
}

pir_status pir_scene_ray(pir_scene *scene, pir_vec3 origin, pir_vec3 way, uint32_t mask, pir_impact *ret_impact) {
    if (!scene || !ret_impact)
        return PIR_ERR_ARGUMENT;
    if (!pir_vec_is_finite(origin) || !pir_vec_is_finite(way))
        return pir_fail(scene->report, PIR_ERR_NOT_FINITE, "ray: a coordinate is not finite");
    if (!(length(origin) <= PIR_BOX_FARTHEST && length(way) <= PIR_BOX_FARTHEST))
        return pir_fail(scene->report, PIR_ERR_LIMIT, "ray: its origin or its way is beyond 2^60");
    struct scene_ray ray = {scene, {origin, way}, mask};
    pir_impact first = {.body = PIR_SCENE_NONE, .piece_q = PIR_SCENE_NONE, .outcome = PIR_CAST_MISS, .time = 1};
    pir_status status = search(&ray, &first);
    if (status == PIR_OK)
        *ret_impact = first;
    return status;
}
