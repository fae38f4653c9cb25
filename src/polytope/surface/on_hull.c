/* SPDX-License-Identifier: MIT */
/*
 * See on_hull.h. A point of the hull's boundary that is no vertex is on one facet, or, on an edge, on two. It is looked
 * for first on the facets of a corner that is found already, then on all; neighbours in a model are neighbours on the
 * hull.
 */
#include "polytope/surface/on_hull.h"

#include "polytope/hull/quickhull.h"

/* --- volumes --- */

bool pir_six_volumes_init(struct pir_six_volumes *volumes, const pir_allocator *allocator, const pir_vectors *points) {
    // the apex, three corners from there, a cross product, a determinant, a product on the way, and two sums, which
    // 2^34 determinants lengthen by a limb
    uint32_t corner = points->stride + 2, limbs = 12 * corner + 3 * 2 * corner + 4 * (3 * corner + 4);
    *volumes = (struct pir_six_volumes){.points = points};
    volumes->scratch = (pir_limbs){PIR_NEW(allocator, mp_limb_t, limbs), 0, limbs};
    if (!volumes->scratch.base)
        return false;
    volumes->apex = pir_int3_take(&volumes->scratch, corner);
    volumes->sum = pir_limbs_take(&volumes->scratch, 3 * corner + 4);
    return true;
}

void pir_six_volumes_lift(struct pir_six_volumes *volumes, uint32_t point, int axis) {
    mp_limb_t one_limb = 1;
    const pir_int one = {&one_limb, 1, 0};
    pir_int3 p = pir_vectors_at(volumes->points, point);
    for (int k = 0; k < 3; k++)
        pir_int_copy(&volumes->apex.c[k], &p.c[k]);
    pir_int_add(&volumes->apex.c[axis], &volumes->apex.c[axis], &one);
}

void pir_six_volumes_finish(struct pir_six_volumes *volumes, const pir_allocator *allocator) {
    PIR_FREE(allocator, volumes->scratch.base, volumes->scratch.capacity);
}

/* A point from the apex, in scratch. */
static pir_int3 from_apex(struct pir_six_volumes *volumes, uint32_t point) {
    pir_int3 v = pir_int3_take(&volumes->scratch, volumes->points->stride + 2);
    pir_int3 p = pir_vectors_at(volumes->points, point);
    for (int k = 0; k < 3; k++)
        pir_int_sub(&v.c[k], &p.c[k], &volumes->apex.c[k]);
    return v;
}

void pir_six_volumes_add(struct pir_six_volumes *volumes, const uint32_t *corner, uint32_t count, bool turned) {
    pir_limbs *scratch = &volumes->scratch;
    uint32_t stride = volumes->points->stride + 2;
    for (uint32_t i = 1; i + 1 < count; i++) {
        uint32_t mark = scratch->used;
        pir_int3 a = from_apex(volumes, corner[0]);
        pir_int3 b = from_apex(volumes, corner[turned ? i + 1 : i]);
        pir_int3 c = from_apex(volumes, corner[turned ? i : i + 1]);
        pir_int3 across = pir_int3_take(scratch, 2 * stride);
        pir_int determinant = pir_limbs_take(scratch, 3 * stride + 4);
        pir_int3_cross(&across, &a, &b, scratch);
        pir_int3_dot(&determinant, &across, &c, scratch);
        pir_int_add(&volumes->sum, &volumes->sum, &determinant);
        scratch->used = mark;
    }
}

/* --- where points are --- */

bool pir_on_hull_init(struct pir_on_hull *on, const pir_polytope *hull, const struct pir_facets *facets,
                      const pir_vectors *exact, const pir_allocator *allocator) {
    *on = (struct pir_on_hull){.allocator = allocator, .hull = hull};
    if (!pir_points_init(&on->points, allocator, exact))
        return false;
    on->vertex = PIR_NEW(allocator, uint32_t, exact->count);
    on->on = PIR_NEW(allocator, struct pir_two_facets, exact->count);
    if (!on->vertex || !on->on) {
        pir_on_hull_finish(on);
        return false;
    }
    for (uint32_t p = 0; p < exact->count; p++)
        on->vertex[p] = on->on[p].one = on->on[p].other = PIR_NONE;
    for (uint32_t v = 0; v < hull->vertex_count; v++)
        on->vertex[facets->place[hull->source[v]]] = v;
    return true;
}

void pir_on_hull_finish(struct pir_on_hull *on) {
    if (!on->points.exact)
        return;
    uint32_t count = on->points.exact->count;
    PIR_FREE(on->allocator, on->on, count);
    PIR_FREE(on->allocator, on->vertex, count);
    pir_points_finish(&on->points, on->allocator);
}

/* Whether a point, which is in the hull, is on facet `facet` of it: on its plane. */
static bool is_on(struct pir_on_hull *on, uint32_t facet, uint32_t point) {
    const pir_polytope *hull = on->hull;
    const uint32_t *loop = hull->loop + hull->loop_start[facet];
    return pir_orient(&on->points, hull->source[hull->origin[loop[0]]], hull->source[hull->origin[loop[1]]],
                      hull->source[hull->origin[loop[2]]], point) == 0;
}

uint32_t pir_on_hull_degree(const struct pir_on_hull *on, uint32_t point) {
    uint32_t v = on->vertex[point];
    if (v != PIR_NONE)
        return on->hull->ring_start[v + 1] - on->hull->ring_start[v];
    return (uint32_t)(on->on[point].one != PIR_NONE) + (on->on[point].other != PIR_NONE);
}

uint32_t pir_on_hull_facet(const struct pir_on_hull *on, uint32_t point, uint32_t index) {
    uint32_t v = on->vertex[point];
    if (v != PIR_NONE)
        return on->hull->left[on->hull->ring_start[v] + index];
    return index == 0 ? on->on[point].one : on->on[point].other;
}

/* Notes that a point that is no vertex is on `facet`, and on which of its neighbours. */
static void put_on(struct pir_on_hull *on, uint32_t facet, uint32_t point) {
    const pir_polytope *hull = on->hull;
    on->on[point].one = facet;
    for (uint32_t i = hull->loop_start[facet]; i < hull->loop_start[facet + 1]; i++) {
        uint32_t beyond = pir_right(hull, hull->loop[i]);
        if (is_on(on, beyond, point)) {
            on->on[point].other = beyond;
            return;
        }
    }
}

/* Finds where a point is; `near` is a point that is found already, or PIR_NONE. False when it is inside. */
static bool find_point(struct pir_on_hull *on, uint32_t point, uint32_t near) {
    for (uint32_t i = 0; near != PIR_NONE && i < pir_on_hull_degree(on, near); i++)
        if (is_on(on, pir_on_hull_facet(on, near, i), point)) {
            put_on(on, pir_on_hull_facet(on, near, i), point);
            return true;
        }
    for (uint32_t f = 0; f < on->hull->facet_count; f++)
        if (is_on(on, f, point)) {
            put_on(on, f, point);
            return true;
        }
    return false;
}

/* The corner that is on the fewest facets, of those found, or PIR_NONE. */
static uint32_t simplest_corner(const struct pir_on_hull *on, const uint32_t *corner, uint32_t count) {
    uint32_t best = PIR_NONE;
    for (uint32_t i = 0; i < count; i++)
        if (pir_on_hull_degree(on, corner[i]) > 0 &&
            (best == PIR_NONE || pir_on_hull_degree(on, corner[i]) < pir_on_hull_degree(on, best)))
            best = corner[i];
    return best;
}

static bool find_corners(struct pir_on_hull *on, const uint32_t *corner, uint32_t count) {
    for (uint32_t i = 0; i < count; i++)
        if (pir_on_hull_degree(on, corner[i]) == 0 && !find_point(on, corner[i], simplest_corner(on, corner, count)))
            return false;
    return true;
}

/* Whether one facet of the hull holds all corners. */
static bool is_on_one(struct pir_on_hull *on, const uint32_t *corner, uint32_t count) {
    uint32_t simplest = simplest_corner(on, corner, count);
    for (uint32_t i = 0; i < pir_on_hull_degree(on, simplest); i++) {
        uint32_t k = 0, facet = pir_on_hull_facet(on, simplest, i);
        while (k < count && is_on(on, facet, corner[k]))
            k++;
        if (k == count)
            return true;
    }
    return false;
}

enum pir_on_hull_answer pir_on_hull_add(struct pir_on_hull *on, const uint32_t *corner, uint32_t count, bool turned,
                                        struct pir_six_volumes *volumes) {
    if (count == 0)
        return PIR_IS_ON_HULL;
    if (!find_corners(on, corner, count))
        return PIR_IS_OFF_HULL;
    if (!is_on_one(on, corner, count))
        return count > 3 ? pir_on_hull_cut(on, corner, count, turned, volumes) : PIR_IS_OFF_HULL;
    pir_six_volumes_add(volumes, corner, count, turned);
    return PIR_IS_ON_HULL;
}
