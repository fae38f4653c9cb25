/* SPDX-License-Identifier: MIT */
/* See turn_bodies.h. */
#include "plan/turn_bodies.h"

#include <math.h>
#include <stdlib.h>

#define MARGIN 0x1p-28
#define ROOM   0x1p-14
#define SLACK  0x1p-43 /* of the size: how far out a corner of the inner piece may be before it is shrunk */

static double dot(pir_vec3 a, pir_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static pir_vec3 cross(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static pir_vec3 sum_of(pir_vec3 a, double s, pir_vec3 b) {
    return (pir_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

/* v at both ends of the arc, and where the tangents meet. */
static void turn(const pir_plan_arc *arc, pir_vec3 v, pir_vec3 ret[3]) {
    const pir_vec3 axis = {arc->axis[0], arc->axis[1], arc->axis[2]}, none = {0, 0, 0};
    const pir_vec3 along = sum_of(none, dot(axis, v), axis), across = sum_of(v, -1, along), side = cross(axis, across);
    const double angle[3] = {arc->low, arc->high, (arc->low + arc->high) / 2};
    for (int i = 0; i < 3; i++) {
        const double far = i < 2 ? 1 : 1 / cos((arc->high - arc->low) / 2);
        ret[i] = sum_of(sum_of(along, far * cos(angle[i]), across), far * sin(angle[i]), side);
    }
}

static double size_of(const pir_vec3 *v, size_t count) {
    double size = 0;
    for (size_t i = 0; i < count; i++)
        size = fmax(size, sqrt(dot(v[i], v[i])));
    return size;
}

static pir_vec3 mean_of(const pir_vec3 *v, size_t count) {
    pir_vec3 mean = {0, 0, 0};
    for (size_t i = 0; i < count; i++)
        mean = sum_of(mean, 1 / (double)count, v[i]);
    return mean;
}

static void scale(pir_vec3 *v, size_t count, pir_vec3 about, double by) {
    for (size_t i = 0; i < count; i++)
        v[i] = sum_of(about, by, sum_of(v[i], -1, about));
}

/* Half-spaces n·x ≤ d of unit normals in threes, of facets at all angles. */
struct turned_halves {
    pir_vec3 *n;
    double *d, size;
    size_t count;
};

/* The corner of three half-spaces where no other cuts it off. */
static bool corner_of(const struct turned_halves *h, size_t i, size_t j, size_t k, pir_vec3 *ret) {
    const pir_vec3 c = cross(h->n[j], h->n[k]);
    const double volume = dot(h->n[i], c);
    if (fabs(volume) < ROOM)
        return false;
    const pir_vec3 none = {0, 0, 0}, a = sum_of(none, h->d[i] / volume, c);
    const pir_vec3 b = sum_of(a, h->d[j] / volume, cross(h->n[k], h->n[i]));
    *ret = sum_of(b, h->d[k] / volume, cross(h->n[i], h->n[j]));
    for (size_t l = 0; l < h->count; l++)
        if (dot(h->n[l], *ret) > h->d[l] + SLACK * h->size)
            return false;
    return true;
}

static double room_at(const struct turned_halves *h, pir_vec3 x) {
    double room = INFINITY;
    for (size_t i = 0; i < h->count; i++)
        room = fmin(room, h->d[i] - dot(h->n[i], x));
    return room;
}

static pir_status corners_of(const struct turned_halves *h, pir_vec3 **ret, size_t *ret_count) {
    size_t room = 0;
    for (size_t i = 0; i < h->count; i++)
        for (size_t j = i + 1; j < h->count; j++)
            for (size_t k = j + 1; k < h->count; k++) {
                pir_vec3 x;
                if (!corner_of(h, i, j, k, &x))
                    continue;
                if (*ret_count == room) {
                    room = 2 * room + 64;
                    pir_vec3 *grown = realloc(*ret, room * sizeof **ret);
                    if (!grown)
                        return PIR_ERR_MEMORY;
                    *ret = grown;
                }
                (*ret)[(*ret_count)++] = x;
            }
    return PIR_OK;
}

static void fill_halves(const pir_polytope *piece, const pir_plan_arc *arc, uint32_t *corner, struct turned_halves *h) {
    for (uint32_t v = 0; v < pir_polytope_vertex_count(piece); v++) {
        const pir_vec3 x = pir_polytope_vertex(piece, v);
        h->size = fmax(h->size, sqrt(dot(x, x)));
    }
    for (uint32_t f = 0; f < pir_polytope_facet_count(piece); f++) {
        pir_vec3 n = pir_polytope_normal(piece, f), to[3];
        pir_polytope_facet(piece, f, corner);
        const double d = dot(n, pir_polytope_vertex(piece, corner[0]));
        turn(arc, n, to);
        for (int i = 0; i < 3; i++) {
            const double length = sqrt(dot(to[i], to[i]));
            h->n[h->count] = sum_of((pir_vec3){0, 0, 0}, 1 / length, to[i]);
            h->d[h->count++] = d / length;
        }
    }
}

pir_status pir_plan_piece_within(const pir_polytope *piece, const pir_plan_arc *arc, pir_polytope **ret_inner) {
    const size_t most = 3 * (size_t)pir_polytope_facet_count(piece);
    struct turned_halves h = {calloc(most, sizeof *h.n), calloc(most, sizeof *h.d), 0, 0};
    uint32_t *corner = calloc(pir_polytope_vertex_count(piece), sizeof *corner);
    pir_vec3 *x = NULL;
    size_t count = 0;
    *ret_inner = NULL;
    pir_status status = h.n && h.d && corner ? PIR_OK : PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        fill_halves(piece, arc, corner, &h);
        status = corners_of(&h, &x, &count);
    }
    if (status == PIR_OK && count > 3) {
        const pir_vec3 middle = mean_of(x, count);
        if (room_at(&h, middle) > ROOM * h.size) {
            scale(x, count, middle, 1 - MARGIN);
            status = pir_polytope_create(x, count, NULL, ret_inner);
        }
    }
    free(x);
    free(corner);
    free(h.d);
    free(h.n);
    return status;
}

pir_status pir_plan_piece_around(const pir_polytope *piece, const pir_plan_arc *arc, pir_polytope **ret_outer) {
    const uint32_t vertices = pir_polytope_vertex_count(piece), facets = pir_polytope_facet_count(piece);
    pir_vec3 *x = calloc(3 * (size_t)vertices, sizeof *x);
    uint32_t *corner = calloc(vertices, sizeof *corner);
    pir_status status = x && corner ? PIR_OK : PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        for (uint32_t v = 0; v < vertices; v++)
            x[v] = pir_polytope_vertex(piece, v);
        // a ball about the mean that the piece has is, turned, about the turned mean at each angle
        const pir_vec3 own = mean_of(x, vertices);
        const double size = size_of(x, vertices);
        for (uint32_t f = 0; f < facets && status == PIR_OK; f++) {
            pir_polytope_facet(piece, f, corner);
            const pir_vec3 n = pir_polytope_normal(piece, f);
            if (!(dot(n, sum_of(x[corner[0]], -1, own)) > ROOM * size))
                status = PIR_ERR_LIMIT;
        }
        for (uint32_t v = vertices; v-- > 0;)
            turn(arc, pir_polytope_vertex(piece, v), x + 3 * (size_t)v);
        scale(x, 3 * (size_t)vertices, mean_of(x, 3 * (size_t)vertices), 1 + MARGIN);
    }
    if (status == PIR_OK)
        status = pir_polytope_create(x, 3 * (size_t)vertices, NULL, ret_outer);
    free(corner);
    free(x);
    return status;
}
