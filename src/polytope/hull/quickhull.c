/* SPDX-License-Identifier: MIT */
/*
 * Quickhull (Barber, Dobkin, Huhdanpaa, ACM TOMS 22(4), 1996) with exact signs.
 *
 * A point sees a triangle when it is strictly beyond its plane, decided exactly; a coplanar point does not. Then the
 * visible triangles are whole facets and form a disc, no new triangle is degenerate (a point on the line of a horizon
 * edge would be on the plane of the visible triangle beside it), and a point that saw a deleted triangle and is still
 * outside sees a new one.
 *
 * Invariants between rounds: the living triangles bound a convex polytope, coplanar neighbours allowed; every point
 * strictly outside it waits in the list of one living triangle that it sees; neighbours name each other;
 * deleted triangles have no list.
 */
#include "polytope/hull/quickhull.h"

#include <math.h>
#include <string.h>

/*
 * How far point p is beyond triangle t, decided exactly: positive only when it is; the number serves to find the
 * farthest.
 */
static inline double height_above(pir_quickhull *hull, const pir_triangle *t, uint32_t p) {
    const pir_hull_plane plane = {hull->points->near[t->vertex[0]], t->normal};
    double height = pir_plane_height(&plane, hull->points, p);
    if (fabs(height) > PIR_ORIENT_BOUND)
        return height;
    int side = pir_orient_exact(hull->points, t->vertex[0], t->vertex[1], t->vertex[2], p);
    return side > 0 ? fmax(height, 0x1p-1000) : side < 0 ? -0x1p-1000 : 0;
}

/* --- slots --- */

static bool push(pir_quickhull *hull, pir_slots *slots, uint32_t t) {
    if (slots->count == slots->capacity) {
        uint32_t capacity = slots->capacity > 0 ? 2 * slots->capacity : 64;
        uint32_t *grown = PIR_RESIZE(&hull->allocator, slots->slot, slots->capacity, capacity);
        if (!grown)
            return false;
        slots->slot = grown;
        slots->capacity = capacity;
    }
    slots->slot[slots->count++] = t;
    return true;
}

static void finish_slots(pir_quickhull *hull, pir_slots *slots) {
    PIR_FREE(&hull->allocator, slots->slot, slots->capacity);
}

/* A new triangle, its neighbours not yet set, in hull->fresh; PIR_NONE when out of memory. */
static uint32_t new_triangle(pir_quickhull *hull, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t t = hull->count;
    if (hull->free.count > 0) {
        t = hull->free.slot[--hull->free.count];
    } else if (hull->count == hull->capacity) {
        uint32_t capacity = hull->capacity * 2;
        pir_triangle *grown = PIR_RESIZE(&hull->allocator, hull->triangle, hull->capacity, capacity);
        if (!grown)
            return PIR_NONE;
        hull->triangle = grown;
        hull->capacity = capacity;
    }
    hull->count += t == hull->count;
    hull->triangle[t] = (pir_triangle){.normal = pir_plane_through(hull->points, a, b, c).normal,
                                       .vertex = {a, b, c},
                                       .neighbor = {PIR_NONE, PIR_NONE, PIR_NONE},
                                       .outside = PIR_NONE};
    return push(hull, &hull->fresh, t) ? t : PIR_NONE;
}

/* --- a point --- */

/* Puts point p in the list of the first of the fresh triangles that it sees, the farthest at the list's head. */
static void assign_point(pir_quickhull *hull, uint32_t p) {
    for (uint32_t i = 0; i < hull->fresh.count; i++) {
        pir_triangle *t = &hull->triangle[hull->fresh.slot[i]];
        double h = height_above(hull, t, p);
        if (h <= 0)
            continue;
        uint32_t head = t->outside;
        if (head == PIR_NONE || h > t->farthest || (h == t->farthest && p < head)) {
            hull->next[p] = head;
            t->outside = p;
            t->farthest = h;
        } else {
            hull->next[p] = hull->next[head];
            hull->next[head] = p;
        }
        return;
    }
}

/* Whether triangle t has been found visible in this round. */
static inline bool is_visible(const pir_quickhull *hull, const pir_triangle *t) {
    return t->mark == 2 * hull->round + 1;
}

/* Lists the triangles that p sees, from `seed` on, in hull->visible. */
static bool find_visible(pir_quickhull *hull, uint32_t seed, uint32_t p) {
    hull->round++;
    hull->visible.count = 0;
    hull->triangle[seed].mark = 2 * hull->round + 1;
    bool done = push(hull, &hull->visible, seed);
    for (uint32_t i = 0; done && i < hull->visible.count; i++) {
        const uint32_t *neighbor = hull->triangle[hull->visible.slot[i]].neighbor;
        for (int k = 0; done && k < 3; k++) {
            pir_triangle *t = &hull->triangle[neighbor[k]];
            if (t->mark >= 2 * hull->round)
                continue;
            bool visible = height_above(hull, t, p) > 0;
            t->mark = 2 * hull->round + visible;
            if (visible)
                done = push(hull, &hull->visible, neighbor[k]);
        }
    }
    return done;
}

/* The side of triangle t that looks at its neighbour across the edge that begins at vertex b. */
static int side_towards(const pir_triangle *t, uint32_t b) {
    return t->vertex[0] == b ? 0 : t->vertex[1] == b ? 1 : 2;
}

/* One triangle from each horizon edge to p, in hull->fresh. */
static bool build_cone(pir_quickhull *hull, uint32_t p) {
    hull->fresh.count = 0;
    for (uint32_t i = 0; i < hull->visible.count; i++)
        for (int k = 0; k < 3; k++) {
            uint32_t t = hull->visible.slot[i], outer = hull->triangle[t].neighbor[k];
            if (is_visible(hull, &hull->triangle[outer]))
                continue;
            uint32_t a = hull->triangle[t].vertex[k], b = hull->triangle[t].vertex[(k + 1) % 3];
            uint32_t made = new_triangle(hull, a, b, p);
            if (made == PIR_NONE)
                return false;
            hull->triangle[made].neighbor[0] = outer;
            hull->triangle[outer].neighbor[side_towards(&hull->triangle[outer], b)] = made;
            hull->horizon[a] = made;
        }
    // (a, b, p) meets (b, c, p) along b–p
    for (uint32_t i = 0; i < hull->fresh.count; i++) {
        uint32_t t = hull->fresh.slot[i], beside = hull->horizon[hull->triangle[t].vertex[1]];
        hull->triangle[t].neighbor[1] = beside;
        hull->triangle[beside].neighbor[2] = t;
    }
    return true;
}

/* Opens those of the fresh triangles that have a list. */
static bool open_fresh(pir_quickhull *hull) {
    bool done = true;
    for (uint32_t i = 0; done && i < hull->fresh.count; i++)
        if (hull->triangle[hull->fresh.slot[i]].outside != PIR_NONE)
            done = push(hull, &hull->open, hull->fresh.slot[i]);
    return done;
}

/* Adds the farthest point of triangle t's list. */
static bool add_point(pir_quickhull *hull, uint32_t t) {
    uint32_t p = hull->triangle[t].outside;
    if (!find_visible(hull, t, p) || !build_cone(hull, p))
        return false;
    // what waited on the deleted triangles moves to the new ones, or is inside
    for (uint32_t i = 0; i < hull->visible.count; i++) {
        pir_triangle *gone = &hull->triangle[hull->visible.slot[i]];
        gone->mark = PIR_DELETED;
        for (uint32_t q = gone->outside, after; q != PIR_NONE; q = after) {
            after = hull->next[q];
            if (q != p)
                assign_point(hull, q);
        }
        gone->outside = PIR_NONE;
        if (!push(hull, &hull->free, hull->visible.slot[i]))
            return false;
    }
    return open_fresh(hull);
}

/* The first tetrahedron, neighbours and all. */
static bool build_simplex(pir_quickhull *hull, const uint32_t simplex[4]) {
    uint32_t a = simplex[0], b = simplex[1], c = simplex[2], d = simplex[3];
    if (pir_orient(hull->points, a, b, c, d) > 0) {
        uint32_t swap = b;
        b = c;
        c = swap;
    }
    // d is below abc; each neighbour is across the edge from a vertex to the next
    const uint32_t vertex[4][3] = {{a, b, c}, {b, a, d}, {c, b, d}, {a, c, d}};
    const uint32_t neighbor[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (int t = 0; t < 4; t++) {
        uint32_t made = new_triangle(hull, vertex[t][0], vertex[t][1], vertex[t][2]);
        if (made == PIR_NONE)
            return false;
        memcpy(hull->triangle[made].neighbor, neighbor[t], sizeof neighbor[t]);
    }
    return true;
}

pir_status pir_quickhull_run(pir_quickhull *hull, pir_points *points, const pir_allocator *allocator,
                             const uint32_t simplex[4]) {
    uint32_t count = points->exact->count;
    *hull = (pir_quickhull){.points = points, .allocator = *allocator, .capacity = 64};
    hull->triangle = PIR_NEW(allocator, pir_triangle, hull->capacity);
    hull->next = PIR_NEW(allocator, uint32_t, count);
    hull->horizon = PIR_NEW(allocator, uint32_t, count);
    bool done = hull->triangle && hull->next && hull->horizon && build_simplex(hull, simplex);
    for (uint32_t p = 0; done && p < count; p++)
        if (p != simplex[0] && p != simplex[1] && p != simplex[2] && p != simplex[3])
            assign_point(hull, p);
    done = done && open_fresh(hull);
    // the youngest first: what it needs is what was touched last
    while (done && hull->open.count > 0) {
        uint32_t t = hull->open.slot[--hull->open.count];
        // its slot may have been freed, and given to another, since it was opened
        if (hull->triangle[t].outside != PIR_NONE)
            done = add_point(hull, t);
    }
    if (done)
        return PIR_OK;
    pir_quickhull_finish(hull);
    return PIR_ERR_MEMORY;
}

void pir_quickhull_finish(pir_quickhull *hull) {
    if (!hull->points)
        return;
    uint32_t count = hull->points->exact->count;
    PIR_FREE(&hull->allocator, hull->triangle, hull->capacity);
    PIR_FREE(&hull->allocator, hull->next, count);
    PIR_FREE(&hull->allocator, hull->horizon, count);
    finish_slots(hull, &hull->visible);
    finish_slots(hull, &hull->fresh);
    finish_slots(hull, &hull->open);
    finish_slots(hull, &hull->free);
    *hull = (pir_quickhull){0};
}
