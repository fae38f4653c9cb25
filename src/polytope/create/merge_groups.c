/* SPDX-License-Identifier: MIT */
/*
 * Which facets of a hull might become one. Doubles choose the groups here, and merge.c proves the outcome exactly.
 *
 * Greatest first, each facet that is in no group yet takes in its neighbours, theirs, and so on, while their corners
 * are within half of the tolerance of its plane. The plane of the group has the sum of its facets' areas for normal,
 * which slivers with inaccurate normals hardly change. Where the normal of an earlier group fits its corners nearly as
 * well, the group takes that normal: opposite sides of a body then share one, and the vertices have fewer denominators.
 */
#include "polytope/create/merge_groups.h"

#include <math.h>
#include <stdlib.h>

#include "exact/vectors.h"
#include "polytope/create/merge_thin.h"

/*
 * Bits of a slope beyond those that the tolerance asks for: its rounding moves no corner by more than a 32nd of the
 * tolerance.
 */
#define SPARE_BITS 5

/* More than the bits of a double are of no use. */
#define SLOPE_BITS_MAX 52

struct measured {
    const pir_polytope *hull;
    pir_vec3 *at;     /* per vertex: relative to vertex 0, in units of the body's size */
    double *area;     /* per facet, in those units */
    uint32_t *order;  /* facets, greatest first */
    double tolerance; /* in those units */
};

/* --- measuring --- */

/* Twice the area of a facet, as a vector along its normal. */
static pir_vec3 area_vector(const struct measured *measured, uint32_t facet) {
    const pir_polytope *hull = measured->hull;
    const uint32_t *loop = hull->loop + hull->loop_start[facet];
    uint32_t n = hull->loop_start[facet + 1] - hull->loop_start[facet];
    pir_vec3 origin = measured->at[hull->origin[loop[0]]], sum = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < n; i++)
        sum = pir_vec_add(sum, pir_vec_cross(pir_vec_sub(measured->at[hull->origin[loop[i]]], origin),
                                             pir_vec_sub(measured->at[hull->origin[loop[i + 1]]], origin)));
    return sum;
}

struct ranked {
    double area;
    uint32_t facet;
};

static int compare_ranked(const void *left, const void *right) {
    const struct ranked *a = left, *b = right;
    if (a->area != b->area)
        return a->area > b->area ? -1 : 1;
    return (a->facet > b->facet) - (a->facet < b->facet);
}

static bool rank_facets(struct measured *measured) {
    const pir_polytope *hull = measured->hull;
    struct ranked *ranked = PIR_NEW(&hull->allocator, struct ranked, hull->facet_count);
    if (!ranked)
        return false;
    for (uint32_t f = 0; f < hull->facet_count; f++) {
        pir_vec3 a = area_vector(measured, f);
        measured->area[f] = sqrt(pir_vec_dot(a, a)) / 2;
        ranked[f] = (struct ranked){measured->area[f], f};
    }
    qsort(ranked, hull->facet_count, sizeof *ranked, compare_ranked);
    for (uint32_t f = 0; f < hull->facet_count; f++)
        measured->order[f] = ranked[f].facet;
    PIR_FREE(&hull->allocator, ranked, hull->facet_count);
    return true;
}

static void finish_measured(struct measured *measured) {
    const pir_allocator *a = &measured->hull->allocator;
    PIR_FREE(a, measured->at, measured->hull->vertex_count);
    PIR_FREE(a, measured->area, measured->hull->facet_count);
    PIR_FREE(a, measured->order, measured->hull->facet_count);
}

static bool measure(struct measured *measured, const pir_polytope *hull, double tolerance) {
    const pir_allocator *a = &hull->allocator;
    *measured = (struct measured){.hull = hull,
                                  .at = PIR_NEW(a, pir_vec3, hull->vertex_count),
                                  .area = PIR_NEW(a, double, hull->facet_count),
                                  .order = PIR_NEW(a, uint32_t, hull->facet_count)};
    bool done = measured->at && measured->area && measured->order;
    if (done) {
        measured->tolerance = pir_merge_place(hull, tolerance, measured->at);
        done = rank_facets(measured);
    }
    if (!done)
        finish_measured(measured);
    return done;
}

/* --- growing --- */

/* Whether all corners of the facet are within `reach` of the plane, and its normal is not turned away. */
static bool fits(const struct measured *measured, uint32_t facet, pir_vec3 normal, pir_vec3 origin, double reach) {
    const pir_polytope *hull = measured->hull;
    if (pir_vec_dot(hull->normal[facet], normal) <= 0)
        return false;
    for (uint32_t i = hull->loop_start[facet]; i < hull->loop_start[facet + 1]; i++) {
        pir_vec3 d = pir_vec_sub(measured->at[hull->origin[hull->loop[i]]], origin);
        if (!(fabs(pir_vec_dot(normal, d)) <= reach))
            return false;
    }
    return true;
}

/* Takes facets into the group of `seed`, the next one, from facets[start] on; returns the end of its facets. */
static uint32_t grow(pir_merge_groups *groups, const struct measured *measured, uint32_t seed, uint32_t start) {
    const pir_polytope *hull = measured->hull;
    pir_vec3 normal = hull->normal[seed], origin = measured->at[hull->origin[hull->loop[hull->loop_start[seed]]]];
    uint32_t end = start;
    groups->of[seed] = groups->count;
    groups->facets[end++] = seed;
    for (uint32_t at = start; at < end; at++) {
        uint32_t f = groups->facets[at];
        for (uint32_t i = hull->loop_start[f]; i < hull->loop_start[f + 1]; i++) {
            uint32_t other = pir_right(hull, hull->loop[i]);
            if (groups->of[other] != PIR_NO_GROUP || !fits(measured, other, normal, origin, measured->tolerance / 2))
                continue;
            groups->of[other] = groups->count;
            groups->facets[end++] = other;
        }
    }
    return end;
}

/* --- planes --- */

/* The slope of the plane with this normal, for corners within `radius` of each other. */
static pir_merge_slope slope_of(pir_vec3 normal, double radius, double tolerance) {
    double x = fabs(normal.x), y = fabs(normal.y), z = fabs(normal.z);
    pir_merge_slope slope = {.axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2};
    int ratio = SLOPE_BITS_MAX;
    if (isfinite(radius / tolerance))
        frexp(radius / tolerance, &ratio);
    slope.bits = ratio + SPARE_BITS < 1 ? 1 : ratio + SPARE_BITS > SLOPE_BITS_MAX ? SLOPE_BITS_MAX : ratio + SPARE_BITS;
    for (int k = 0; k < 2; k++)
        slope.slope[k] = llround(ldexp(
            -pir_vec_component(normal, (slope.axis + 1 + k) % 3) / pir_vec_component(normal, slope.axis), slope.bits));
    return slope;
}

/*
 * How far the corners of the group whose facets stand from `start` on are from one plane of this slope: lowest to
 * highest, along the slope's axis; or a length above `most` once it is known to be that.
 */
static double spread_of(const pir_merge_groups *groups, const struct measured *measured, uint32_t start, uint32_t end,
                        const pir_merge_slope *slope, double most) {
    const pir_polytope *hull = measured->hull;
    pir_vec3 origin = measured->at[hull->origin[hull->loop[hull->loop_start[groups->facets[start]]]]];
    double rise[2], low = 0, high = 0;
    for (int k = 0; k < 2; k++)
        rise[k] = ldexp((double)slope->slope[k], -slope->bits);
    for (uint32_t i = start; i < end && high - low <= most; i++) {
        uint32_t f = groups->facets[i];
        for (uint32_t j = hull->loop_start[f]; j < hull->loop_start[f + 1]; j++) {
            pir_vec3 d = pir_vec_sub(measured->at[hull->origin[hull->loop[j]]], origin);
            double height = pir_vec_component(d, slope->axis) - rise[0] * pir_vec_component(d, (slope->axis + 1) % 3) -
                            rise[1] * pir_vec_component(d, (slope->axis + 2) % 3);
            low = fmin(low, height);
            high = fmax(high, height);
        }
    }
    return high - low;
}

/* Gives the group the slope of one before it where that fits its corners nearly as well as its own. */
static void share_slope(pir_merge_groups *groups, const struct measured *measured, uint32_t start) {
    pir_merge_group *group = &groups->group[groups->count];
    double own = spread_of(groups, measured, start, group->next, &group->slope, INFINITY);
    double most = fmax(2 * own, measured->tolerance / 64);
    for (uint32_t g = 0; g < groups->count; g++) {
        const pir_merge_slope *slope = &groups->group[g].slope;
        if (slope->axis == group->slope.axis && spread_of(groups, measured, start, group->next, slope, most) <= most) {
            group->slope = *slope;
            return;
        }
    }
}

/* Fits the plane of the group whose facets stand from `start` on. */
static void fit(pir_merge_groups *groups, const struct measured *measured, uint32_t start) {
    const pir_polytope *hull = measured->hull;
    pir_merge_group *group = &groups->group[groups->count];
    pir_vec3 sum = {0, 0, 0}, origin = measured->at[hull->origin[hull->loop[hull->loop_start[groups->facets[start]]]]];
    double radius = 0;
    for (uint32_t i = start; i < group->next; i++) {
        uint32_t f = groups->facets[i];
        sum = pir_vec_add(sum, area_vector(measured, f));
        group->area += measured->area[f];
        for (uint32_t j = hull->loop_start[f]; j < hull->loop_start[f + 1]; j++) {
            pir_vec3 d = pir_vec_sub(measured->at[hull->origin[hull->loop[j]]], origin);
            radius = fmax(radius, sqrt(pir_vec_dot(d, d)));
        }
    }
    // a facet without an area that doubles can tell has the exact normal of its greatest facet
    if (!(pir_vec_dot(sum, sum) > 0))
        sum = hull->normal[groups->facets[start]];
    group->slope = slope_of(sum, radius, measured->tolerance);
    group->active = true;
    share_slope(groups, measured, start);
}

void pir_merge_groups_finish(pir_merge_groups *groups, const pir_polytope *hull) {
    PIR_FREE(&hull->allocator, groups->group, groups->room);
    PIR_FREE(&hull->allocator, groups->of, hull->facet_count);
    PIR_FREE(&hull->allocator, groups->facets, hull->facet_count);
    *groups = (pir_merge_groups){0};
}

pir_status pir_merge_groups_make(pir_merge_groups *groups, const pir_polytope *hull, double tolerance) {
    const pir_allocator *a = &hull->allocator;
    struct measured measured;
    if (!measure(&measured, hull, tolerance))
        return PIR_ERR_MEMORY;
    // a group has two facets at least
    *groups = (pir_merge_groups){.room = hull->facet_count / 2 + 1};
    groups->group = PIR_ZEROED(a, pir_merge_group, groups->room);
    groups->of = PIR_NEW(a, uint32_t, hull->facet_count);
    groups->facets = PIR_NEW(a, uint32_t, hull->facet_count);
    bool done = groups->group && groups->of && groups->facets;
    for (uint32_t f = 0; done && f < hull->facet_count; f++)
        groups->of[f] = PIR_NO_GROUP;
    // a tolerance below the doubles, in units of the size, merges nothing
    for (uint32_t i = 0, start = 0; done && measured.tolerance > 0 && i < hull->facet_count; i++) {
        uint32_t seed = measured.order[i];
        if (groups->of[seed] != PIR_NO_GROUP)
            continue;
        uint32_t end = grow(groups, &measured, seed, start);
        if (end == start + 1) {
            groups->of[seed] = PIR_NO_GROUP;
            continue;
        }
        groups->group[groups->count].next = end;
        fit(groups, &measured, start);
        groups->count++;
        start = end;
    }
    finish_measured(&measured);
    if (!done)
        pir_merge_groups_finish(groups, hull);
    return done ? PIR_OK : PIR_ERR_MEMORY;
}
