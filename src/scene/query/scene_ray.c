/* SPDX-License-Identifier: MIT */
/*
 * Hits of a segment on pieces and triangles whose boxes it meets: each by one of the ways of ray.h. It is
 * followed to its end where all are listed, to the time of the first hit so far, or no farther than to any hit.
 */
#include "base/options.h"
#include "scene/query/ray_rounded.h"
#include "scene/query/swept_pieces.h"
#include "scene/world/grow.h"
#include "scene/world/surfaces.h"
#include "scene/world/triangles.h"

/*
 * A point of the segment in a body's frame, and its way there, are off by at most this times the size of the origin
 * less the body's translation and that of the way: 37u for the rotation, 6u for products with it and their sums, u for
 * the difference, with u = 2^-53. A unit normal is off by 8u, a dot product with it by 6u of the lengths, and a vertex
 * by u, so this is at least the error of a slack, relative to the size of the piece and to those two.
 */
#define SEEN_ERROR 0x1p-47

struct scene_ray {
    pir_scene *scene;
    pir_world_ray world;
    pir_scene_ray_options options;
    pir_probe probe;     /* for its rules */
    pir_swept_box swept; /* its origin, in the world */
    double most;         /* times beyond this are not looked for */
    pir_status (*take)(struct scene_ray *ray, const pir_impact *impact);
    pir_impact first;
    size_t capacity, count; /* of the scene's room for impacts */
};

static double length(pir_vec3 v) {
    return sqrt(pir_vec_dot(v, v));
}

static bool is_at_origin(const pir_pose *pose) {
    const pir_quat q = pose->rotation;
    const pir_vec3 t = pose->translation;
    return q.x == 0 && q.y == 0 && q.z == 0 && q.w == 1 && t.x == 0 && t.y == 0 && t.z == 0;
}

/* The segment as a body sees it; its error is that of its points alone. */
static pir_ray_segment seen_by(const struct scene_ray *ray, const pir_scene_body *body) {
    const pir_world_ray *world = &ray->world;
    if (is_at_origin(&body->pose))
        return (pir_ray_segment){world->origin, world->way, 0};
    const pir_vec3 away = pir_vec_sub(world->origin, body->pose.translation);
    pir_rotation rotation;
    (void)pir_rotation_set(&rotation, body->pose.rotation); // checked when it came
    return (pir_ray_segment){pir_mat_apply_transposed(&rotation.r, away),
                             pir_mat_apply_transposed(&rotation.r, world->way),
                             SEEN_ERROR * (pir_vec_size(away) + pir_vec_size(world->way))};
}

/* The segment with the error of slacks of a polytope. */
static pir_ray_segment seen_by_polytope(const struct scene_ray *ray, const pir_scene_body *body) {
    pir_ray_segment segment = seen_by(ray, body);
    segment.error = SEEN_ERROR * (pir_vec_size(segment.from) + pir_vec_size(segment.way) + body->reach);
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

/* Whether a triangle is met where a segment enters it, by the side that it comes from. */
static bool counts(const struct scene_ray *ray, const pir_scene_body *body, const pir_entry *entry) {
    const pir_ray_sides sides = ray->options.sides;
    if (sides == PIR_RAY_BOTH || (sides == PIR_RAY_AS_SURFACE && pir_surface_is_two_sided(pir_body_surface_of(body))))
        return true;
    return sides == PIR_RAY_BACK ? entry->side < 0 : entry->side > 0;
}

/* Where the segment enters a piece, or a triangle that doubles have not settled. */
static pir_status enter(const struct scene_ray *ray, pir_scene_piece *piece, pir_entry *entry) {
    pir_scene *scene = ray->scene;
    const pir_scene_body *body = &scene->bodies.body[piece->body];
    const pir_ray_segment segment = seen_by_polytope(ray, body);
    pir_status status = pir_piece_ready(body, &scene->for_triangles, piece);
    if (status != PIR_OK)
        return status;
    if (body->radius + ray->options.radius > 0) {
        *entry = pir_ray_rounded(piece->extent.polytope, &segment, body->radius + ray->options.radius);
        return PIR_OK;
    }
    if (piece->kind != PIR_PIECE_TRIANGLE && pir_ray_by_doubles(piece->extent.polytope, &segment, entry))
        return PIR_OK;
    status = reserve(scene, piece->extent.polytope);
    if (status == PIR_OK)
        *entry = pir_ray_exact(piece->extent.polytope, &ray->world, body->pose, &segment, &scene->exact_room);
    return status;
}

static pir_status fail(const struct scene_ray *ray, pir_status status, const pir_scene_piece *piece) {
    return pir_fail(ray->scene->report, status, "ray: body %u, piece %u: %s", (unsigned)piece->body,
                    (unsigned)piece->number, pir_status_text(status));
}

/* Takes the impact where the segment enters a piece of a body. */
static pir_status take(struct scene_ray *ray, const pir_scene_piece *piece, const pir_entry *entry) {
    const pir_scene_body *body = &ray->scene->bodies.body[piece->body];
    pir_impact impact = {.body = piece->body,
                         .piece_q = piece->number,
                         .piece_user = pir_piece_user(&ray->scene->bodies, piece),
                         .outcome = entry->inside ? PIR_CAST_START_INSIDE : PIR_CAST_HIT,
                         .time = entry->time,
                         .normal =
                             is_at_origin(&body->pose) ? entry->normal : pir_pose_rotate(body->pose, entry->normal),
                         .point = pir_vec_add(ray->world.origin, pir_vec_scale(ray->world.way, entry->time))};
    // of a ball that begins outside: where it touches
    if (ray->options.radius > 0 && !entry->inside)
        impact.point = pir_vec_sub(impact.point, pir_vec_scale(impact.normal, ray->options.radius));
    const pir_status status = ray->take(ray, &impact);
    return status == PIR_OK ? PIR_OK : fail(ray, status, piece);
}

static pir_status look(struct scene_ray *ray, pir_scene_piece *piece) {
    pir_entry entry;
    const pir_status status = enter(ray, piece, &entry);
    if (status != PIR_OK)
        return fail(ray, status, piece);
    return entry.hits ? take(ray, piece, &entry) : PIR_OK;
}

/* --- triangles --- */

/* The walk of a segment over the triangles of a body's surface. */
struct surface_ray {
    struct scene_ray *ray;
    const pir_scene_body *body;
    uint32_t number; /* of that body */
    pir_ray_segment segment;
    pir_status status;
};

/* Where the segment enters a triangle that needs a polytope. */
static pir_status enter_flat(const struct surface_ray *on, pir_scene_piece *piece, pir_entry *entry) {
    pir_scene *scene = on->ray->scene;
    piece->extent.polytope = pir_triangles_recall(&scene->bodies, piece->body, piece->number);
    const pir_status status = enter(on->ray, piece, entry);
    pir_triangles_keep(&scene->bodies, &scene->allocator, piece);
    return status == PIR_OK ? PIR_OK : fail(on->ray, status, piece);
}

static bool look_at_triangle(void *context, const pir_met_triangle *met) {
    struct surface_ray *on = context;
    const bool is_rounded = on->body->radius + on->ray->options.radius > 0;
    pir_entry entry;
    pir_scene_piece piece = {.kind = PIR_PIECE_TRIANGLE, .body = on->number, .number = met->number};
    if (is_rounded || !pir_ray_by_corners(met->tri.p, &on->segment, &entry))
        on->status = enter_flat(on, &piece, &entry);
    if (on->status == PIR_OK && entry.hits && (is_rounded || counts(on->ray, on->body, &entry)))
        on->status = take(on->ray, &piece, &entry);
    return on->status == PIR_OK;
}

/* The triangles of a surface that the segment may meet. */
static pir_status look_at_surface(struct scene_ray *ray, const pir_scene_body *body) {
    struct surface_ray on = {
        .ray = ray, .body = body, .number = (uint32_t)(body - ray->scene->bodies.body), .segment = seen_by(ray, body)};
    const pir_vec3 from = on.segment.from;
    // more than distances in doubles are off by
    const double radius = body->radius + ray->options.radius,
                 room = radius > 0 ? radius + 0x1p-30 * (body->reach + radius) : 0, pad = room + 2 * on.segment.error;
    const double low[3] = {from.x - pad, from.y - pad, from.z - pad},
                 high[3] = {from.x + pad, from.y + pad, from.z + pad};
    pir_swept_walk walk; // of which all is set
    walk.until = &ray->most;
    walk.look = look_at_triangle;
    walk.context = &on;
    pir_swept_box_set(&walk.swept, low, high, on.segment.way);
    pir_swept_triangles(body, &walk);
    return on.status;
}

/* --- all pieces --- */

/* Whether an impact comes before another, or there is no other. */
static bool comes_before(const void *x, const void *y) {
    const pir_impact *a = x, *b = y;
    if (a->body == PIR_SCENE_NONE || b->body == PIR_SCENE_NONE)
        return a->body != PIR_SCENE_NONE;
    if (a->time != b->time)
        return a->time < b->time;
    return a->body != b->body ? a->body < b->body : a->piece_q < b->piece_q;
}

static pir_status look_at_leaf(void *context, pir_scene_piece *piece) {
    struct scene_ray *ray = context;
    return piece->kind == PIR_PIECE_SURFACE ? look_at_surface(ray, &ray->scene->bodies.body[piece->body])
                                            : look(ray, piece);
}

static pir_status search(struct scene_ray *ray) {
    return pir_swept_pieces(&(pir_swept_search){&ray->probe, &ray->swept, &ray->most, look_at_leaf, ray});
}

/* --- the calls --- */

/* `missing` as of pir_scene_given. */
static pir_status begin(pir_scene *scene, const char *missing, pir_world_ray world,
                        const pir_scene_ray_options *options, struct scene_ray *ray) {
    pir_scene_ray_options used = pir_scene_ray_options_default();
    pir_status status = pir_scene_given(scene, "ray", missing);
    if (status == PIR_OK)
        status = pir_options_take("pir_scene_ray_options", options, &used, &scene->report);
    if (status != PIR_OK)
        return status;
    if (used.sides < PIR_RAY_AS_SURFACE || used.sides > PIR_RAY_BOTH)
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "ray: there are no sides %d", (int)used.sides);
    if (isnan(used.radius))
        return pir_fail(scene->report, PIR_ERR_NOT_FINITE, "ray: its radius is not a number");
    if (!(used.radius >= 0 && used.radius <= PIR_BOX_FARTHEST))
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "ray: its radius is %g, not from 0 to 2^60", used.radius);
    if (!pir_vec_is_finite(world.origin) || !pir_vec_is_finite(world.way))
        return pir_fail(scene->report, PIR_ERR_NOT_FINITE, "ray: its %s is not finite",
                        pir_vec_is_finite(world.origin) ? "way" : "origin");
    if (!(length(world.origin) <= PIR_BOX_FARTHEST))
        return pir_fail(scene->report, PIR_ERR_LIMIT, "ray: its origin is beyond 2^60");
    if (!(length(world.way) <= PIR_BOX_FARTHEST))
        return pir_fail(scene->report, PIR_ERR_LIMIT, "ray: its way is longer than 2^60");
    // member by member, for clearing it takes longer; the callers set the others
    ray->scene = scene;
    ray->world = world;
    ray->options = used;
    ray->most = 1;
    ray->capacity = ray->count = 0;
    const double at[3] = {world.origin.x, world.origin.y, world.origin.z};
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        const double pad = used.radius > 0 ? used.radius + 0x1p-40 * (fabs(at[k]) + used.radius) : 0;
        low[k] = at[k] - pad;
        high[k] = at[k] + pad;
    }
    pir_swept_box_set(&ray->swept, low, high, world.way);
    ray->probe = (pir_probe){.scene = scene,
                             .body = PIR_SCENE_NONE,
                             .mask = used.mask,
                             .except = pir_bodies_find(&scene->bodies, used.except),
                             .filter = used.filter};
    return PIR_OK;
}

static pir_status take_first(struct scene_ray *ray, const pir_impact *impact) {
    if (comes_before(impact, &ray->first)) {
        ray->first = *impact;
        ray->most = fmin(impact->time * (1 + 0x1p-30), 1);
    }
    return PIR_OK;
}

static const pir_impact no_impact = {
    .body = PIR_SCENE_NONE, .piece_q = PIR_SCENE_NONE, .outcome = PIR_CAST_MISS, .time = 1};

/* The first hit of a ray that was begun. */
static pir_status find_first(struct scene_ray *ray, pir_impact *ret_impact) {
    ray->take = take_first;
    ray->first = no_impact;
    const pir_status status = search(ray);
    if (status != PIR_OK)
        return status;
    pir_name_impact(ray->scene, &ray->first);
    *ret_impact = ray->first;
    return PIR_OK;
}

pir_status pir_scene_ray_first(pir_scene *scene, pir_vec3 origin, pir_vec3 way, const pir_scene_ray_options *options,
                               pir_impact *ret_impact) {
    struct scene_ray ray;
    const pir_status status =
        begin(scene, ret_impact ? NULL : "ret_impact", (pir_world_ray){origin, way}, options, &ray);
    return status == PIR_OK ? find_first(&ray, ret_impact) : status;
}

pir_status pir_scene_ray(pir_scene *scene, pir_vec3 origin, pir_vec3 way, uint32_t mask, pir_impact *ret_impact) {
    pir_scene_ray_options options = pir_scene_ray_options_default();
    options.mask = mask;
    return pir_scene_ray_first(scene, origin, way, &options, ret_impact);
}

pir_status pir_scene_ray_batch(pir_scene *scene, const pir_scene_segment *segments, size_t count,
                               const pir_scene_ray_options *options, pir_impact *ret_impacts) {
    const char *missing = count == 0 ? NULL : !segments ? "segments" : !ret_impacts ? "ret_impacts" : NULL;
    pir_status status = pir_scene_given(scene, "ray", missing);
    if (status != PIR_OK || count == 0)
        return status;
    if (count > UINT32_MAX / 2)
        return pir_fail(scene->report, PIR_ERR_LIMIT, "ray: more than 2^31 segments");
    pir_scene_answers *answers = &scene->answers;
    if (!PIR_GROW(&scene->allocator, answers->impact, answers->impact_capacity, (uint32_t)count))
        return pir_fail(scene->report, PIR_ERR_MEMORY, "ray: no memory for %zu impacts", count);
    for (size_t i = 0; i < count; i++) {
        struct scene_ray ray;
        status = begin(scene, NULL, (pir_world_ray){segments[i].origin, segments[i].way}, options, &ray);
        if (status == PIR_OK)
            status = find_first(&ray, &answers->impact[i]);
        if (status != PIR_OK)
            return status;
    }
    memcpy(ret_impacts, answers->impact, count * sizeof *ret_impacts);
    return PIR_OK;
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

static pir_status take_all(struct scene_ray *ray, const pir_impact *impact) {
    pir_scene *scene = ray->scene;
    const pir_order order = {sizeof *impact, ray->capacity, comes_before};
    const bool is_put = pir_put_in_order(&scene->allocator, &scene->answers.impact, &scene->answers.impact_capacity,
                                         &order, impact, &ray->count);
    return is_put ? PIR_OK : PIR_ERR_MEMORY;
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
    for (size_t i = 0; i < ray.count && i < capacity; i++) {
        ret_impacts[i] = scene->answers.impact[i];
        pir_name_impact(scene, &ret_impacts[i]);
    }
    *ret_count = ray.count;
    return PIR_OK;
}
