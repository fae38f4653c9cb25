/* SPDX-License-Identifier: MIT */
/*
 * Rays against surfaces. A triangle is met where the ray is on the same side of all its edges, or on them: each edge's
 * side is one exact sign, the same for both triangles that have the edge but for its direction (after Woop, Benthin and
 * Wald, Watertight Ray/Triangle Intersection, JCGT 2(1), 2013, who do it in floats).
 */
#include "mesh/query/mesh_walk.h"
#include "mesh/query/swept_boxes.h"
#include "mesh/signs/heap_sort.h"
#include "mesh/signs/mesh_numbers.h"

struct mesh_ray {
    pir_surface_ref surface;
    pir_mesh_segment segment;
    pir_swept_box swept; /* its origin, wider */
    bool front, back;
    double most; /* times beyond this are not looked for */
};

/* A triangle that is met, and its time by doubles, off by at most `error`. */
struct hit {
    uint32_t triangle;
    bool back;
    double time, error;
};

static double at(pir_vec3 v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static bool is_near(pir_vec3 v) {
    return fabs(v.x) <= PIR_MESH_FARTHEST && fabs(v.y) <= PIR_MESH_FARTHEST && fabs(v.z) <= PIR_MESH_FARTHEST;
}

/*
 * The origin is widened by 2^-48 of the coordinates, which is more than a difference of two is off by; a time is then
 * too early, or late, by a few roundings of itself at most, which swept_boxes.h allows for.
 */
static pir_status init(struct mesh_ray *ray, pir_surface_ref surface, const pir_surface_ray *asked) {
    if (!asked || pir_surface_check(surface) != PIR_OK || asked->sides > PIR_RAY_BOTH)
        return PIR_ERR_ARGUMENT;
    if (!pir_vec_is_finite(asked->origin) || !pir_vec_is_finite(asked->way))
        return PIR_ERR_NOT_FINITE;
    if (!is_near(asked->origin) || !is_near(asked->way))
        return PIR_ERR_LIMIT;
    bool two_sided = surface.mesh ? surface.mesh->two_sided : surface.field->two_sided;
    *ray = (struct mesh_ray){.surface = surface, .segment = {asked->origin, asked->way}, .most = 1};
    ray->front = asked->sides != PIR_RAY_BACK;
    ray->back = asked->sides == PIR_RAY_BACK || asked->sides == PIR_RAY_BOTH ||
                (asked->sides == PIR_RAY_AS_SURFACE && two_sided);
    double reach[3], low[3], high[3];
    pir_surface_reach(surface, reach);
    for (int k = 0; k < 3; k++) {
        double from = at(asked->origin, k), pad = 0x1p-48 * (fabs(from) + reach[k]);
        low[k] = from - pad;
        high[k] = from + pad;
    }
    pir_swept_box_set(&ray->swept, low, high, asked->way);
    return PIR_OK;
}

/* Looks at the triangles that the ray may meet. */
static void walk(const struct mesh_ray *ray, pir_walk *by) {
    const pir_walk_box bounds = pir_surface_bounds(ray->surface);
    pir_walk_box part;
    by->within = &part;
    if (pir_swept_part(&ray->swept, &bounds, 1, &part))
        pir_surface_walk(ray->surface, by);
}

/* When each box is entered. */
static void measure(const void *context, const pir_mesh_boxes *boxes, double ret_near[PIR_MESH_WIDTH]) {
    pir_swept_times(&((const struct mesh_ray *)context)->swept, boxes, ret_near);
}

/* The side from which the line of the ray meets a triangle: 1 the front, −1 the back, 0 not. */
static int side_met(const pir_mesh_segment *segment, const pir_tri *tri) {
    int least = 1, most = -1;
    for (int k = 0; k < 3; k++) {
        int sign = pir_sign_around(segment, tri->p[k], tri->p[(k + 1) % 3]);
        least = sign < least ? sign : least;
        most = sign > most ? sign : most;
        if (least < 0 && most > 0)
            return 0;
    }
    // all three together have the sign of the way along the normal: 0 where the ray is in the plane
    return least < 0 ? 1 : most > 0 ? -1 : 0;
}

static bool meets(const struct mesh_ray *ray, const pir_met_triangle *met, struct hit *ret_hit) {
    int side = side_met(&ray->segment, &met->tri);
    if (side == 0 || !(side > 0 ? ray->front : ray->back) || !pir_time_is_within(&ray->segment, &met->tri))
        return false;
    *ret_hit = (struct hit){.triangle = met->number, .back = side < 0};
    ret_hit->time = pir_time_of(&ray->segment, &met->tri, &ret_hit->error);
    return true;
}

static void give(const struct mesh_ray *ray, const struct hit *hit, pir_ray_hit *ret_hit) {
    *ret_hit = (pir_ray_hit){.triangle = hit->triangle};
    if (hit->triangle == PIR_TRIANGLE_NONE)
        return;
    pir_tri tri = pir_surface_tri(ray->surface, hit->triangle);
    pir_vec3 n = pir_vec_cross(pir_vec_sub(tri.p[1], tri.p[0]), pir_vec_sub(tri.p[2], tri.p[0]));
    double length = sqrt(pir_vec_dot(n, n));
    ret_hit->material = pir_surface_material(ray->surface, hit->triangle);
    ret_hit->time = hit->time;
    ret_hit->back = hit->back;
    ret_hit->point = pir_vec_add(ray->segment.origin, pir_vec_scale(ray->segment.way, hit->time));
    ret_hit->normal = length > 0 ? pir_vec_scale(n, 1 / length) : n;
}

/* --- the nearest --- */

struct nearest_hit {
    struct mesh_ray ray; /* first, for `measure` */
    struct hit best;
};

/* Whether `hit` comes before the best: exactly, by its number where times are equal. */
static bool is_before(const struct nearest_hit *nearest, const struct hit *hit, const pir_tri *tri) {
    const struct hit *best = &nearest->best;
    if (best->triangle == PIR_TRIANGLE_NONE || hit->time + hit->error < best->time - best->error)
        return true;
    if (hit->time - hit->error > best->time + best->error)
        return false;
    pir_tri other = pir_surface_tri(nearest->ray.surface, best->triangle);
    int order = pir_sign_time_order(&nearest->ray.segment, tri, &other);
    return order < 0 || (order == 0 && hit->triangle < best->triangle);
}

static bool look_nearest(void *context, const pir_met_triangle *met) {
    struct nearest_hit *nearest = context;
    struct hit hit;
    if (meets(&nearest->ray, met, &hit) && is_before(nearest, &hit, &met->tri)) {
        nearest->best = hit;
        nearest->ray.most = hit.time + hit.error;
    }
    return true;
}

pir_status pir_surface_ray_nearest(pir_surface_ref surface, const pir_surface_ray *ray, pir_ray_hit *ret_hit) {
    struct nearest_hit nearest = {.best.triangle = PIR_TRIANGLE_NONE};
    pir_status status = ret_hit ? init(&nearest.ray, surface, ray) : PIR_ERR_ARGUMENT;
    if (status != PIR_OK)
        return status;
    walk(&nearest.ray, &(pir_walk){measure, look_nearest, &nearest, &nearest.ray.most, NULL});
    give(&nearest.ray, &nearest.best, ret_hit);
    return PIR_OK;
}

/* --- any --- */

struct any_hit {
    struct mesh_ray ray;
    bool hits;
};

static bool look_any(void *context, const pir_met_triangle *met) {
    struct any_hit *any = context;
    struct hit hit;
    any->hits = meets(&any->ray, met, &hit);
    return !any->hits;
}

pir_status pir_surface_ray_any(pir_surface_ref surface, const pir_surface_ray *ray, bool *ret_hits) {
    struct any_hit any = {.hits = false};
    pir_status status = ret_hits ? init(&any.ray, surface, ray) : PIR_ERR_ARGUMENT;
    if (status != PIR_OK)
        return status;
    walk(&any.ray, &(pir_walk){measure, look_any, &any, &any.ray.most, NULL});
    *ret_hits = any.hits;
    return PIR_OK;
}

/* --- all --- */

struct all_hits {
    struct mesh_ray ray;
    pir_ray_hit *hits;
    size_t capacity, count;
};

static bool look_all(void *context, const pir_met_triangle *met) {
    struct all_hits *all = context;
    struct hit hit;
    if (meets(&all->ray, met, &hit) && all->count++ < all->capacity)
        give(&all->ray, &hit, &all->hits[all->count - 1]);
    return true;
}

static int compare_hits(const void *a, const void *b) {
    const pir_ray_hit *x = a, *y = b;
    if (x->time != y->time)
        return x->time < y->time ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

pir_status pir_surface_ray_all(pir_surface_ref surface, const pir_surface_ray *ray, size_t capacity,
                               pir_ray_hit *ret_hits, size_t *ret_count) {
    struct all_hits all = {.hits = ret_hits, .capacity = capacity};
    pir_status status = ret_count && (ret_hits || capacity == 0) ? init(&all.ray, surface, ray) : PIR_ERR_ARGUMENT;
    if (status != PIR_OK)
        return status;
    walk(&all.ray, &(pir_walk){measure, look_all, &all, &all.ray.most, NULL});
    pir_heap_sort(ret_hits, all.count < capacity ? all.count : capacity, sizeof *ret_hits, compare_hits);
    *ret_count = all.count;
    return PIR_OK;
}
