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
 * strictly outside it waits in the list of one living triangle that it sees; neighbours name each other.
 */
#include "polytope/hull/quickhull.h"

#include <math.h>
#include <string.h>

/* How far point p is beyond triangle t, decided exactly: positive only when it is; the number
   serves to find the farthest. */
static double height_above(pir_quickhull *hull, uint32_t t, uint32_t p) {
    const pir_triangle *triangle = &hull->triangle[t];
    double height = pir_plane_height(&triangle->plane, hull->points, p);
    if (fabs(height) > PIR_ORIENT_BOUND)
        return height;
    const uint32_t *v = triangle->vertex;
    int side = pir_orient_exact(hull->points, v[0], v[1], v[2], p);
    return side > 0 ? fmax(height, 0x1p-1000) : side < 0 ? -0x1p-1000 : 0;
}

/* A new triangle, its neighbours not yet set; PIR_NONE when out of memory. */
static uint32_t new_triangle(pir_quickhull *hull, uint32_t a, uint32_t b, uint32_t c) {
    if (hull->count == hull->capacity) {
        uint32_t capacity = hull->capacity * 2;
        pir_triangle *grown = PIR_RESIZE(&hull->allocator, hull->triangle, hull->capacity, capacity);
        if (!grown)
            return PIR_NONE;
        hull->triangle = grown;
        hull->capacity = capacity;
    }
    hull->triangle[hull->count] = (pir_triangle){.vertex = {a, b, c},
                                                 .neighbor = {PIR_NONE, PIR_NONE, PIR_NONE},
                                                 .plane = pir_plane_through(hull->points, a, b, c),
                                                 .outside = PIR_NONE,
                                                 .alive = true};
    return hull->count++;
}

/* Puts point p in the list of the first of triangles [first, last) that it sees, the farthest at the list's head. */
static void assign_point(pir_quickhull *hull, uint32_t p, uint32_t first, uint32_t last, double *height) {
    for (uint32_t t = first; t < last; t++) {
        double h = height_above(hull, t, p);
        if (h <= 0)
            continue;
        uint32_t head = hull->triangle[t].outside;
        if (head == PIR_NONE || h > height[head] || (h == height[head] && p < head)) {
            hull->next[p] = head;
            hull->triangle[t].outside = p;
        } else {
            hull->next[p] = hull->next[head];
            hull->next[head] = p;
        }
        height[p] = h;
        return;
    }
}

/* Finds the triangles that p sees from `seed` on, their number to *ret_visible; they are left in hull->stack. */
static bool find_visible(pir_quickhull *hull, uint32_t seed, uint32_t p, uint32_t *ret_visible) {
    if (hull->stack_capacity < hull->count) {
        uint32_t capacity = hull->capacity;
        uint32_t *grown = PIR_RESIZE(&hull->allocator, hull->stack, hull->stack_capacity, capacity);
        if (!grown)
            return false;
        hull->stack = grown;
        hull->stack_capacity = capacity;
    }
    hull->round++;
    hull->triangle[seed].mark = hull->round;
    hull->triangle[seed].visible = true;
    uint32_t visible = 0;
    hull->stack[visible++] = seed;
    for (uint32_t i = 0; i < visible; i++)
        for (int k = 0; k < 3; k++) {
            uint32_t t = hull->triangle[hull->stack[i]].neighbor[k];
            if (hull->triangle[t].mark == hull->round)
                continue;
            hull->triangle[t].mark = hull->round;
            hull->triangle[t].visible = height_above(hull, t, p) > 0;
            if (hull->triangle[t].visible)
                hull->stack[visible++] = t;
        }
    *ret_visible = visible;
    return true;
}

/* The side of triangle t that looks at triangle `other`, from vertex b to vertex a. */
static int side_towards(const pir_triangle *t, uint32_t b) {
    return t->vertex[0] == b ? 0 : t->vertex[1] == b ? 1 : 2;
}

/* One triangle from each horizon edge to p. */
static bool build_cone(pir_quickhull *hull, uint32_t visible, uint32_t p) {
    uint32_t first = hull->count;
    for (uint32_t i = 0; i < visible; i++)
        for (int k = 0; k < 3; k++) {
            uint32_t t = hull->stack[i], outer = hull->triangle[t].neighbor[k];
            if (hull->triangle[outer].visible && hull->triangle[outer].mark == hull->round)
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
    for (uint32_t t = first; t < hull->count; t++) {
        uint32_t beside = hull->horizon[hull->triangle[t].vertex[1]];
        hull->triangle[t].neighbor[1] = beside;
        hull->triangle[beside].neighbor[2] = t;
    }
    return true;
}

/* Adds the farthest point of triangle t's list. */
static bool add_point(pir_quickhull *hull, uint32_t t, double *height) {
    uint32_t p = hull->triangle[t].outside, visible, first = hull->count;
    if (!find_visible(hull, t, p, &visible) || !build_cone(hull, visible, p))
        return false;
    // what waited on the deleted triangles moves to the new ones, or is inside
    for (uint32_t i = 0; i < visible; i++) {
        pir_triangle *gone = &hull->triangle[hull->stack[i]];
        gone->alive = false;
        for (uint32_t q = gone->outside, after; q != PIR_NONE; q = after) {
            after = hull->next[q];
            if (q != p)
                assign_point(hull, q, first, hull->count, height);
        }
    }
    return true;
}

/* The first tetrahedron, neighbours and all. */
static bool build_simplex(pir_quickhull *hull, const uint32_t simplex[4]) {
    uint32_t a = simplex[0], b = simplex[1], c = simplex[2], d = simplex[3];
    if (pir_orient(hull->points, a, b, c, d) > 0) {
        uint32_t swap = b;
        b = c, c = swap;
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
    double *height = PIR_NEW(allocator, double, count);
    bool done = hull->triangle && hull->next && hull->horizon && height && build_simplex(hull, simplex);
    for (uint32_t p = 0; done && p < count; p++)
        if (p != simplex[0] && p != simplex[1] && p != simplex[2] && p != simplex[3])
            assign_point(hull, p, 0, 4, height);
    // triangles are worked off in the order they were made
    for (uint32_t t = 0; done && t < hull->count; t++)
        if (hull->triangle[t].alive && hull->triangle[t].outside != PIR_NONE)
            done = add_point(hull, t, height);
    PIR_FREE(allocator, height, count);
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
    PIR_FREE(&hull->allocator, hull->stack, hull->stack_capacity);
    *hull = (pir_quickhull){0};
}
