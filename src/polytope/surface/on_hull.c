/* SPDX-License-Identifier: MIT */
/*
 * See on_hull.h. A point of the hull's boundary that is no vertex is on one facet, or, on an edge, on two. The search
 * begins with the facets of a corner that is already found, since neighbours in a model are neighbours on the hull, and
 * goes on to all facets.
 */
#include "polytope/surface/on_hull.h"

#include "polytope/hull/quickhull.h"

bool pir_on_hull_init(struct pir_on_hull *on, const pir_polytope *hull, const struct pir_model_facets *facets,
                      const pir_vectors *exact, const pir_allocator *allocator) {
    *on = (struct pir_on_hull){.allocator = allocator, .hull = hull};
    if (!pir_points_init(&on->points, allocator, exact, NULL))
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

bool pir_on_hull_find(struct pir_on_hull *on, const uint32_t *corner, uint32_t count) {
    for (uint32_t i = 0; i < count; i++)
        if (pir_on_hull_degree(on, corner[i]) == 0 && !find_point(on, corner[i], simplest_corner(on, corner, count)))
            return false;
    return true;
}

bool pir_on_hull_is_on_one(struct pir_on_hull *on, const uint32_t *corner, uint32_t count) {
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
