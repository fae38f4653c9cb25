/* SPDX-License-Identifier: MIT */
/*
 * Hits of a segment on pieces and triangles whose boxes it meets: each by one of the ways of ray.h. How far it
 * is followed falls to the time of the first hit, to nothing after any, or stays where all are listed.
 */
#include "scene/query/near_pieces.h"
#include "scene/query/ray_rounded.h"
#include "scene/world/grow.h"
#include "scene/world/surfaces.h"
#include "scene/world/triangles.h"

/*
 * The slack of a facet at a point of the segment, in the piece's frame, is off by at most this times the sizes of
 * piece, origin and way, less the piece's translation: 8u for a unit normal, 40u for turning a point by a pose, with
 * u = 2^-53, twice each, and a few roundings.
 */
#define SLACK_ERROR 0x1p-45

struct scene_ray {
    pir_scene *scene;
    pir_world_ray world;
    pir_scene_ray_options options;
    pir_probe probe; /* for its rules */
    double most;     /* times beyond this are not looked for */
    pir_status (*take)(struct scene_ray *ray, const pir_impact *impact);
    pir_impact first;
    size_t capacity, count; /* of the scene's room for impacts */
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

/*
 * The error of a triangle, whose corners are exact: pir_ray_by_corners knows its own errors, and a body that is not
 * posed sees the segment as it is. Turning a point is off by 40u of the coordinates, twice.
 */
static double error_for_corners(const struct scene_ray *ray, const pir_scene_body *body) {
    const pir_quat q = body->pose.rotation;
    const pir_vec3 t = body->pose.translation;
    if (q.x == 0 && q.y == 0 && q.z == 0 && q.w == 1 && t.x == 0 && t.y == 0 && t.z == 0)
        return 0;
    return 0.5 * SLACK_ERROR * (length(ray->world.origin) + length(t) + length(ray->world.way));
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

/* Whether a triangle is met where a segment enters it, by the side that it comes from. */
static bool counts(const struct scene_ray *ray, const pir_scene_body *body, const pir_entry *entry) {
    const pir_ray_sides sides = ray->options.sides;
    if (sides == PIR_RAY_BOTH || (sides == PIR_RAY_AS_SURFACE && pir_surface_is_two_sided(pir_body_surface_of(body))))
        return true;
    return sides == PIR_RAY_BACK ? entry->side < 0 : entry->side > 0;
}

/* Where the segment enters a piece without a radius. */
static pir_status enter(const struct scene_ray *ray, const pir_ray_segment *segment, pir_scene_piece *piece,
                        pir_entry *entry) {
    pir_scene *scene = ray->scene;
    const pir_scene_body *body = &scene->bodies.body[piece->body];
    if (piece->kind == PIR_PIECE_TRIANGLE) {
        pir_vec3 corner[3];
        pir_ray_segment exact_corners = *segment;
        exact_corners.error = error_for_corners(ray, body);
        pir_surface_triangle(pir_body_surface_of(body), piece->number, corner);
        if (pir_ray_by_corners(corner, &exact_corners, entry))
            return PIR_OK;
    } else if (pir_ray_by_doubles(piece->extent.polytope, segment, entry)) {
        return PIR_OK;
    }
    pir_status status = pir_piece_ready(body, &scene->for_triangles, piece);
    if (status == PIR_OK)
        status = reserve(scene, piece->extent.polytope);
    if (status == PIR_OK)
        *entry = pir_ray_exact(piece->extent.polytope, &ray->world, body->pose, segment, &scene->exact_room);
    return status;
}

/* Where the segment enters a rounded piece. */
static pir_status enter_rounded(const struct scene_ray *ray, const pir_ray_segment *segment, pir_scene_piece *piece,
                                pir_entry *entry) {
    const pir_scene_body *body = &ray->scene->bodies.body[piece->body];
    pir_status status = pir_piece_ready(body, &ray->scene->for_triangles, piece);
    if (status == PIR_OK)
        *entry = pir_ray_rounded(piece->extent.polytope, segment, body->radius);
    return status;
}

static pir_status fail(const struct scene_ray *ray, pir_status status, const pir_scene_piece *piece) {
    return pir_fail(ray->scene->report, status, "ray: body %u, piece %u: %s", (unsigned)piece->body,
                    (unsigned)piece->number, pir_status_text(status));
}

/* Takes the impact on a piece, where there is one. */
static pir_status look(void *context, pir_scene_piece *piece) {
    struct scene_ray *ray = context;
    const pir_scene_body *body = &ray->scene->bodies.body[piece->body];
    const pir_ray_segment segment = seen_by(ray, body);
    const bool is_rounded = body->radius > 0;
    pir_entry entry;
    pir_status status = (is_rounded ? enter_rounded : enter)(ray, &segment, piece, &entry);
    if (status != PIR_OK)
        return fail(ray, status, piece);
    if (!entry.hits)
        return PIR_OK;
    if (piece->kind == PIR_PIECE_TRIANGLE && !is_rounded && !counts(ray, body, &entry))
        return PIR_OK;
    const pir_impact impact = {.body = piece->body,
                               .piece_q = piece->number,
                               .outcome = entry.inside ? PIR_CAST_START_INSIDE : PIR_CAST_HIT,
                               .time = entry.time,
                               .normal = pir_pose_rotate(body->pose, entry.normal),
                               .point = pir_vec_add(ray->world.origin, pir_vec_scale(ray->world.way, entry.time))};
    status = ray->take(ray, &impact);
    return status == PIR_OK ? PIR_OK : fail(ray, status, piece);
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

/* The triangles of a surface that the segment may meet. */
static pir_status look_at_surface(struct scene_ray *ray, const pir_scene_body *body) {
    const pir_vec3 o = ray->world.origin;
    const pir_box from = {{pir_float_below(o.x), pir_float_below(o.y), pir_float_below(o.z)},
                          {pir_float_above(o.x), pir_float_above(o.y), pir_float_above(o.z)}};
    return pir_near_triangles(&(pir_near_search){.probe = &ray->probe,
                                                 .by = PIR_NEAR_TIME,
                                                 .from = from,
                                                 .way = ray->world.way,
                                                 .most = &ray->most,
                                                 .without_boxes = true,
                                                 .look = look,
                                                 .context = ray},
                              body);
}

static pir_status search(struct scene_ray *ray) {
    const pir_tree *tree = &ray->scene->tree;
    pir_status status = PIR_OK;
    uint32_t n = tree->node ? tree->root : PIR_TREE_NONE;
    while (n != PIR_TREE_NONE && status == PIR_OK) {
        const bool may = ray->most >= 0 && may_meet(ray, &tree->node[n].box, ray->most);
        if (may && tree->node[n].child[0] != PIR_TREE_NONE) {
            n = tree->node[n].child[0];
            continue;
        }
        pir_scene_piece *piece = may ? &ray->scene->bodies.piece[tree->node[n].child[1]] : NULL;
        if (piece && pir_probe_meets(&ray->probe, piece->body))
            status = piece->kind == PIR_PIECE_SURFACE ? look_at_surface(ray, &ray->scene->bodies.body[piece->body])
                                                      : look(ray, piece);
        n = pir_tree_beyond(tree, n);
    }
    return status;
}

/* --- the calls --- */

/* `missing` as of pir_scene_given. */
static pir_status begin(pir_scene *scene, const char *missing, pir_world_ray world,
                        const pir_scene_ray_options *options, struct scene_ray *ray) {
    const pir_scene_ray_options used = options ? *options : pir_scene_ray_options_default();
    const pir_status status = pir_scene_given(scene, "ray", missing);
    if (status != PIR_OK)
        return status;
    if (used.sides < PIR_RAY_AS_SURFACE || used.sides > PIR_RAY_BOTH)
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "ray: there are no sides %d", (int)used.sides);
    if (!pir_vec_is_finite(world.origin) || !pir_vec_is_finite(world.way))
        return pir_fail(scene->report, PIR_ERR_NOT_FINITE, "ray: its %s is not finite",
                        pir_vec_is_finite(world.origin) ? "way" : "origin");
    if (!(length(world.origin) <= PIR_BOX_FARTHEST))
        return pir_fail(scene->report, PIR_ERR_LIMIT, "ray: its origin is beyond 2^60");
    if (!(length(world.way) <= PIR_BOX_FARTHEST))
        return pir_fail(scene->report, PIR_ERR_LIMIT, "ray: its way is longer than 2^60");
    *ray = (struct scene_ray){.scene = scene, .world = world, .options = used, .most = 1};
    ray->probe = (pir_probe){.scene = scene, .body = PIR_SCENE_NONE, .mask = used.mask, .except = used.except};
    return PIR_OK;
}

pir_scene_ray_options pir_scene_ray_options_default(void) {
    return (pir_scene_ray_options){UINT32_MAX, PIR_SCENE_NONE, PIR_RAY_AS_SURFACE};
}

static pir_status take_first(struct scene_ray *ray, const pir_impact *impact) {
    if (comes_before(impact, &ray->first)) {
        ray->first = *impact;
        ray->most = fmin(impact->time * (1 + 0x1p-30), 1);
    }
    return PIR_OK;
}

pir_status pir_scene_ray(pir_scene *scene, pir_vec3 origin, pir_vec3 way, uint32_t mask, pir_impact *ret_impact) {
    struct scene_ray ray;
    pir_scene_ray_options options = pir_scene_ray_options_default();
    options.mask = mask;
    pir_status status = begin(scene, ret_impact ? NULL : "ret_impact", (pir_world_ray){origin, way}, &options, &ray);
    if (status != PIR_OK)
        return status;
    ray.take = take_first;
    ray.first = (pir_impact){.body = PIR_SCENE_NONE, .piece_q = PIR_SCENE_NONE, .outcome = PIR_CAST_MISS, .time = 1};
    status = search(&ray);
    if (status == PIR_OK)
        *ret_impact = ray.first;
    return status;
}

static pir_status take_any(struct scene_ray *ray, const pir_impact *impact) {
    (void)impact;
    ray->count++;
    ray->most = -1;
    return PIR_OK;
}

pir_status pir_scene_ray_any(pir_scene *scene, pir_vec3 origin, pir_vec3 way, const pir_scene_ray_options *options,
                             bool *ret_hits) {
    struct scene_ray ray;
    pir_status status = begin(scene, ret_hits ? NULL : "ret_hits", (pir_world_ray){origin, way}, options, &ray);
    if (status != PIR_OK)
        return status;
    ray.take = take_any;
    status = search(&ray);
    if (status == PIR_OK)
        *ret_hits = ray.count > 0;
    return status;
}

/* Puts an impact in its place among those that there are, of which the first `capacity` are kept. */
static pir_status take_all(struct scene_ray *ray, const pir_impact *impact) {
    pir_scene_answers *answers = &ray->scene->answers;
    size_t at = ray->count < ray->capacity ? ray->count : ray->capacity;
    const bool is_full = at == ray->capacity;
    if (!is_full && !PIR_GROW(&ray->scene->allocator, answers->impact, answers->impact_capacity, (uint32_t)at + 1))
        return PIR_ERR_MEMORY;
    ray->count++;
    if (is_full && (at == 0 || !comes_before(impact, &answers->impact[--at])))
        return PIR_OK;
    for (; at > 0 && comes_before(impact, &answers->impact[at - 1]); at--)
        answers->impact[at] = answers->impact[at - 1];
    answers->impact[at] = *impact;
    return PIR_OK;
}

pir_status pir_scene_ray_all(pir_scene *scene, pir_vec3 origin, pir_vec3 way, const pir_scene_ray_options *options,
                             size_t capacity, pir_impact *ret_impacts, size_t *ret_count) {
    struct scene_ray ray;
    const char *missing = !ret_impacts && capacity > 0 ? "ret_impacts" : !ret_count ? "ret_count" : NULL;
    pir_status status = begin(scene, missing, (pir_world_ray){origin, way}, options, &ray);
    if (status != PIR_OK)
        return status;
    ray.take = take_all;
    ray.capacity = capacity;
    status = search(&ray);
    if (status != PIR_OK)
        return status;
    for (size_t i = 0; i < ray.count && i < capacity; i++)
        ret_impacts[i] = scene->answers.impact[i];
    *ret_count = ray.count;
    return PIR_OK;
}
