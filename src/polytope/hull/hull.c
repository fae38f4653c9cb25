/* SPDX-License-Identifier: MIT */
/*
 * The exact convex hull of points of any dimension.
 *
 * Points that span a line, a plane or nothing are found exactly while looking for a first tetrahedron. In space,
 * quickhull gives triangles; those whose planes are exactly equal are joined to one facet, and corners at which only
 * two facets meet, being straight, are dropped. So the facets are maximal and all their corners extreme.
 */
#include "polytope/hull/hull.h"

#include <string.h>

#include "polytope/hull/polygon.h"
#include "polytope/hull/quickhull.h"

/* The point farthest from point 0, or 0 when all are equal. */
static uint32_t farthest_point(const pir_points *points) {
    uint32_t best = 0;
    double most = 0;
    for (uint32_t p = 1; p < points->exact->count; p++) {
        double d = pir_vec_dot(points->near[p], points->near[p]);
        if (d > most) {
            most = d;
            best = p;
        }
    }
    return best;
}

/* A point off the line ab, the widest by doubles when that is certain, or 0 when there is none. */
static uint32_t point_off_line(pir_points *points, uint32_t a, uint32_t b) {
    uint32_t best = a;
    double most = 0;
    for (uint32_t p = 0; p < points->exact->count; p++) {
        pir_vec3 n = pir_plane_through(points, a, b, p).normal;
        if (pir_vec_dot(n, n) > most) {
            most = pir_vec_dot(n, n);
            best = p;
        }
    }
    if (!pir_collinear(points, a, b, best))
        return best;
    for (uint32_t p = 0; p < points->exact->count; p++)
        if (!pir_collinear(points, a, b, p))
            return p;
    return a;
}

/* A point off the plane abc, or a when there is none. */
static uint32_t point_off_plane(pir_points *points, uint32_t a, uint32_t b, uint32_t c) {
    // the three are on their plane, which would take integers to tell
    if (points->exact->count == 3)
        return a;
    pir_hull_plane plane = pir_plane_through(points, a, b, c);
    uint32_t best = a;
    double most = 0;
    for (uint32_t p = 0; p < points->exact->count; p++) {
        double height = fabs(pir_plane_height(&plane, points, p));
        if (height > most) {
            most = height;
            best = p;
        }
    }
    if (pir_orient(points, a, b, c, best) != 0)
        return best;
    for (uint32_t p = 0; p < points->exact->count; p++)
        if (pir_orient(points, a, b, c, p) != 0)
            return p;
    return a;
}

/* Marks the points in `index` and lists the marked ones in rising order in hull->vertices. */
static bool list_vertices(pir_hull *hull, const pir_allocator *allocator, uint32_t points, const uint32_t *index,
                          uint32_t count) {
    uint8_t *is_vertex = PIR_ZEROED(allocator, uint8_t, points);
    if (!is_vertex)
        return false;
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; i++)
        if (!is_vertex[index[i]]) {
            is_vertex[index[i]] = 1;
            n++;
        }
    hull->vertices = PIR_NEW(allocator, uint32_t, n);
    if (hull->vertices)
        for (uint32_t p = 0; p < points; p++)
            if (is_vertex[p])
                hull->vertices[hull->vertex_count++] = p;
    PIR_FREE(allocator, is_vertex, points);
    return hull->vertices != NULL;
}

/* All points on one line or one place: the ends, by exact order along an axis on which they differ. */
static bool hull_of_line(pir_hull *hull, const pir_allocator *allocator, pir_points *points, int dimension) {
    uint32_t ends[2] = {0, 0}, count = points->exact->count;
    hull->dimension = dimension;
    if (dimension == 0)
        return list_vertices(hull, allocator, count, ends, 1);
    // the polygon of collinear points is their two ends; one of two axes shows them apart
    uint32_t *index = PIR_NEW(allocator, uint32_t, count);
    if (!index)
        return false;
    bool done = true;
    uint32_t corners = 1;
    for (int axis = 0; done && corners < 2 && axis < 2; axis++) {
        for (uint32_t p = 0; p < count; p++)
            index[p] = p;
        corners = pir_polygon_corners(points, allocator, axis, 1, index, count);
        done = corners > 0;
    }
    done = done && list_vertices(hull, allocator, count, index, corners);
    PIR_FREE(allocator, index, count);
    return done;
}

/* All points on the plane of a, b, c: one loop for each side. */
static bool hull_of_plane(pir_hull *hull, const pir_allocator *allocator, pir_points *points, uint32_t a, uint32_t b,
                          uint32_t c) {
    uint32_t count = points->exact->count;
    uint32_t *index = PIR_NEW(allocator, uint32_t, count);
    if (!index)
        return false;
    for (uint32_t p = 0; p < count; p++)
        index[p] = p;
    hull->dimension = 2;
    uint32_t corners = pir_polygon_corners(points, allocator, pir_steepest_axis(points, a, b, c), 1, index, count);
    bool done = corners > 0 && list_vertices(hull, allocator, count, index, corners);
    if (done) {
        hull->corners = 2 * corners;
        done = pir_loops_init(&hull->facets, allocator, 2, hull->corners);
    }
    if (done) {
        for (uint32_t i = 0; i < corners; i++) {
            hull->facets.corner[i] = index[i];
            hull->facets.corner[corners + i] = index[corners - 1 - i];
        }
        hull->facets.start[1] = corners;
        hull->facets.start[2] = 2 * corners;
        done = pir_loops_canonicalise(&hull->facets, NULL, allocator);
    }
    PIR_FREE(allocator, index, count);
    return done;
}

/* --- in space: joining coplanar triangles --- */

struct hull_merge {
    const pir_quickhull *quick;
    uint32_t *parent; /* union-find over triangles */
    uint32_t *degree; /* per point: facets that meet there */
    uint8_t *seen;    /* per triangle and side: boundary side walked */
};

static uint32_t find_root(uint32_t *parent, uint32_t t) {
    while (parent[t] != t) {
        parent[t] = parent[parent[t]];
        t = parent[t];
    }
    return t;
}

/* The corner of triangle t that is not on its side from vertex b to a. */
static uint32_t apex_beyond(const pir_triangle *t, uint32_t a, uint32_t b) {
    for (int k = 0; k < 3; k++)
        if (t->vertex[k] != a && t->vertex[k] != b)
            return t->vertex[k];
    return PIR_NONE;
}

/* Joins each triangle with the coplanar ones beside it. */
static void join_coplanar(struct hull_merge *merge) {
    const pir_quickhull *quick = merge->quick;
    for (uint32_t t = 0; t < quick->count; t++) {
        const pir_triangle *triangle = &quick->triangle[t];
        for (int k = 0; pir_triangle_lives(triangle) && k < 3; k++) {
            uint32_t other = triangle->neighbor[k];
            const uint32_t *v = triangle->vertex;
            if (other < t)
                continue;
            uint32_t apex = apex_beyond(&quick->triangle[other], v[k], v[(k + 1) % 3]);
            if (pir_orient(quick->points, v[0], v[1], v[2], apex) == 0)
                merge->parent[find_root(merge->parent, t)] = find_root(merge->parent, other);
        }
    }
}

static bool is_boundary(struct hull_merge *merge, uint32_t t, int side) {
    return find_root(merge->parent, t) != find_root(merge->parent, merge->quick->triangle[t].neighbor[side]);
}

/* Counts the facets at each point: the boundary sides that start there. Returns the number of boundary sides. */
static uint32_t count_degrees(struct hull_merge *merge) {
    uint32_t sides = 0;
    for (uint32_t t = 0; t < merge->quick->count; t++)
        for (int k = 0; pir_triangle_lives(&merge->quick->triangle[t]) && k < 3; k++)
            if (is_boundary(merge, t, k)) {
                merge->degree[merge->quick->triangle[t].vertex[k]]++;
                sides++;
            }
    return sides;
}

/* Walks the facet that has boundary side (t, k), writing its corners that are not straight; returns their number. */
static uint32_t walk_facet(struct hull_merge *merge, uint32_t t, int k, uint32_t *corner) {
    const pir_triangle *triangle = merge->quick->triangle;
    uint32_t count = 0;
    while (!merge->seen[(size_t)t * 3 + (size_t)k]) {
        merge->seen[(size_t)t * 3 + (size_t)k] = 1;
        uint32_t v = triangle[t].vertex[k];
        if (merge->degree[v] > 2)
            corner[count++] = pir_points_source(merge->quick->points, v);
        // on to the next boundary side of the same facet, turning about the side's end
        k = (k + 1) % 3;
        while (!is_boundary(merge, t, k)) {
            uint32_t pivot = triangle[t].vertex[k];
            t = triangle[t].neighbor[k];
            for (k = 0; triangle[t].vertex[k] != pivot; k++)
                ;
        }
    }
    return count;
}

/* Turns the triangles into facets. */
static bool collect_facets(pir_hull *hull, const pir_allocator *allocator, struct hull_merge *merge) {
    const pir_quickhull *quick = merge->quick;
    uint32_t points = quick->points->exact->count;
    merge->parent = PIR_NEW(allocator, uint32_t, quick->count);
    merge->degree = PIR_ZEROED(allocator, uint32_t, points);
    merge->seen = PIR_ZEROED(allocator, uint8_t, (size_t)quick->count * 3);
    bool done = merge->parent && merge->degree && merge->seen;
    if (done) {
        for (uint32_t t = 0; t < quick->count; t++)
            merge->parent[t] = t;
        join_coplanar(merge);
        hull->corners = count_degrees(merge);
        done = pir_loops_init(&hull->facets, allocator, quick->count, hull->corners);
    }
    if (done) {
        uint32_t at = 0, facets = 0;
        for (uint32_t t = 0; t < quick->count; t++)
            for (int k = 0; pir_triangle_lives(&quick->triangle[t]) && k < 3; k++)
                if (!merge->seen[(size_t)t * 3 + (size_t)k] && is_boundary(merge, t, k)) {
                    at += walk_facet(merge, t, k, hull->facets.corner + at);
                    hull->facets.start[++facets] = at;
                }
        // the room was for as many facets as triangles
        uint32_t *start = PIR_RESIZE(allocator, hull->facets.start, (size_t)quick->count + 1, (size_t)facets + 1);
        done = start != NULL;
        if (done) {
            hull->facets.start = start;
            hull->facets.count = facets;
            done = pir_loops_canonicalise(&hull->facets, NULL, allocator) &&
                   list_vertices(hull, allocator, points, hull->facets.corner, at);
        }
    }
    PIR_FREE(allocator, merge->parent, quick->count);
    PIR_FREE(allocator, merge->degree, points);
    PIR_FREE(allocator, merge->seen, (size_t)quick->count * 3);
    return done;
}

/* So many points take more than the caches near a processor hold: they are sorted. */
#define MANY 8192

/* Sorts the points, and finds those of the simplex again. */
static bool sort_many(pir_points *points, const pir_allocator *allocator, uint32_t simplex[4]) {
    if (points->exact->count < MANY)
        return true;
    if (!pir_points_sort(points, allocator))
        return false;
    uint32_t sorted[4] = {0};
    for (uint32_t i = 0; i < points->exact->count; i++)
        for (int k = 0; k < 4; k++)
            if (points->source[i] == simplex[k])
                sorted[k] = i;
    memcpy(simplex, sorted, sizeof sorted);
    return true;
}

static bool hull_in_space(pir_hull *hull, const pir_allocator *allocator, pir_points *points, uint32_t simplex[4]) {
    pir_quickhull quick;
    if (!sort_many(points, allocator, simplex) || pir_quickhull_run(&quick, points, allocator, simplex) != PIR_OK)
        return false;
    hull->dimension = 3;
    struct hull_merge merge = {.quick = &quick};
    bool done = collect_facets(hull, allocator, &merge);
    pir_quickhull_finish(&quick);
    return done;
}

pir_status pir_hull_make(const pir_vectors *exact, const pir_vec3 *doubles, const pir_allocator *allocator,
                         pir_hull *ret_hull) {
    if (exact->count >= (uint32_t)1 << 30)
        return PIR_ERR_LIMIT;
    pir_points points;
    if (!pir_points_init(&points, allocator, exact, doubles))
        return PIR_ERR_MEMORY;
    pir_hull hull = {0};
    uint32_t a = 0, b = farthest_point(&points), c = 0, d = 0;
    if (b != a)
        c = point_off_line(&points, a, b);
    if (c != a)
        d = point_off_plane(&points, a, b, c);
    bool done = d != a   ? hull_in_space(&hull, allocator, &points, (uint32_t[4]){a, b, c, d})
                : c != a ? hull_of_plane(&hull, allocator, &points, a, b, c)
                         : hull_of_line(&hull, allocator, &points, b != a);
    pir_points_finish(&points, allocator);
    if (!done) {
        pir_hull_finish(&hull, allocator);
        return PIR_ERR_MEMORY;
    }
    *ret_hull = hull;
    return PIR_OK;
}

void pir_hull_finish(pir_hull *hull, const pir_allocator *allocator) {
    PIR_FREE(allocator, hull->vertices, hull->vertex_count);
    pir_loops_finish(&hull->facets, allocator, hull->corners);
    *hull = (pir_hull){0};
}
