/* SPDX-License-Identifier: MIT */
/* See turn_bodies.h. */
#include "plan/turn_bodies.h"

#include <math.h>
#include <stdlib.h>

#include "base/vec.h"

#define GRID_BITS  24
#define KEPT       0x1p-22 /* of the size: how far points of inner pieces stay within half-spaces, unrounded */
#define MARGIN     0x1p-18 /* by which outer pieces are grown */
#define ROOM       0x1p-14 /* of the size */
#define EDGE_PARTS 2

static void set_form(pir_quat p, pir_quat q, pir_vec3 row[3]) {
    const double ww = p.w * q.w, xx = p.x * q.x, yy = p.y * q.y, zz = p.z * q.z, scale = 1 / (ww + xx + yy + zz);
    const double xy = p.x * q.y + p.y * q.x, yz = p.y * q.z + p.z * q.y, zx = p.z * q.x + p.x * q.z;
    const double wx = p.w * q.x + p.x * q.w, wy = p.w * q.y + p.y * q.w, wz = p.w * q.z + p.z * q.w;
    row[0] = pir_vec_scale((pir_vec3){ww + xx - yy - zz, xy - wz, zx + wy}, scale);
    row[1] = pir_vec_scale((pir_vec3){xy + wz, ww - xx + yy - zz, yz - wx}, scale);
    row[2] = pir_vec_scale((pir_vec3){zx - wy, yz + wx, ww - xx - yy + zz}, scale);
}

pir_turn_forms pir_turn_forms_of(const pir_plan_turns *turns) {
    pir_turn_forms forms = {.count = 0};
    pir_quat middle = {0, 0, 0, 0};
    for (int i = 0; i < turns->count; i++) {
        const pir_quat q = turns->q[i];
        for (int k = i; k < turns->count; k++)
            set_form(q, turns->q[k], forms.row[forms.count++]);
        middle = (pir_quat){middle.x + q.x, middle.y + q.y, middle.z + q.z, middle.w + q.w};
    }
    set_form(middle, middle, forms.row[forms.count]);
    return forms;
}

static pir_vec3 turned(const pir_turn_forms *forms, int which, pir_vec3 v) {
    const pir_vec3 *row = forms->row[which];
    return (pir_vec3){pir_vec_dot(row[0], v), pir_vec_dot(row[1], v), pir_vec_dot(row[2], v)};
}

static double size_of(const pir_polytope *piece) {
    double size = 0;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(piece); v++)
        size = fmax(size, pir_vec_length(pir_polytope_vertex(piece, v)));
    return size;
}

static pir_vec3 mean_of(const pir_vec3 *v, size_t count) {
    pir_vec3 mean = {0, 0, 0};
    for (size_t i = 0; i < count; i++)
        mean = pir_vec_along(mean, 1 / (double)count, v[i]);
    return mean;
}

static pir_vec3 middle_of(const pir_polytope *piece) {
    const uint32_t count = pir_polytope_vertex_count(piece);
    pir_vec3 mean = {0, 0, 0};
    for (uint32_t v = 0; v < count; v++)
        mean = pir_vec_along(mean, 1 / (double)count, pir_polytope_vertex(piece, v));
    return mean;
}

/* Half-spaces n·x ≤ d of unit normals, of all facets over a set of rotations. */
struct halves {
    pir_vec3 *n;
    double *d;
    size_t count;
};

static void list_halves(const pir_polytope *piece, const pir_turn_forms *forms, uint32_t *corner,
                        struct halves *halves) {
    for (uint32_t i = 0; i < pir_polytope_facet_count(piece); i++) {
        const pir_vec3 n = pir_polytope_normal(piece, i);
        pir_polytope_facet(piece, i, corner);
        const double d = pir_vec_dot(n, pir_polytope_vertex(piece, corner[0]));
        for (int k = 0; k < forms->count; k++) {
            const pir_vec3 to = turned(forms, k, n);
            const double length = pir_vec_length(to);
            halves->n[halves->count] = pir_vec_scale(to, 1 / length);
            halves->d[halves->count++] = d / length;
        }
    }
}

/* Corners, and points of edges between them, at the middle rotation. */
static size_t list_points(const pir_polytope *piece, const pir_turn_forms *forms, uint32_t *corner, pir_vec3 *x) {
    const int middle = forms->count;
    size_t count = 0;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(piece); v++)
        x[count++] = turned(forms, middle, pir_polytope_vertex(piece, v));
    for (uint32_t f = 0; f < pir_polytope_facet_count(piece); f++) {
        const uint32_t size = pir_polytope_facet_size(piece, f);
        pir_polytope_facet(piece, f, corner);
        for (uint32_t i = 0; i < size; i++) {
            const uint32_t a = corner[i], b = corner[(i + 1) % size];
            for (int part = 1; part < EDGE_PARTS && a < b; part++)
                x[count++] =
                    pir_vec_along(pir_vec_scale(x[a], (double)part / EDGE_PARTS), 1 - (double)part / EDGE_PARTS, x[b]);
        }
    }
    return count;
}

/* How much of the way from a point within to another keeps all half-spaces; 0 where the first itself has no room. */
static double part_within(const struct halves *halves, pir_vec3 middle, double size, pir_vec3 way) {
    double part = 1;
    for (size_t i = 0; i < halves->count; i++) {
        const double room = halves->d[i] - pir_vec_dot(halves->n[i], middle) - KEPT * size,
                     need = pir_vec_dot(halves->n[i], way);
        if (!(room > ROOM * size))
            return 0;
        if (need * part > room)
            part = room / need;
    }
    return part;
}

static pir_vec3 rounded(pir_vec3 x, double grid) {
    return (pir_vec3){rint(x.x / grid) * grid, rint(x.y / grid) * grid, rint(x.z / grid) * grid};
}

static pir_status piece_within(const pir_polytope *piece, const pir_plan_turns *turns, pir_polytope **ret_inner) {
    const pir_turn_forms forms = pir_turn_forms_of(turns);
    const double size = size_of(piece), grid = ldexp(1, ilogb(size) - GRID_BITS);
    const pir_vec3 middle = turned(&forms, forms.count, middle_of(piece));
    const size_t most = (size_t)forms.count * pir_polytope_facet_count(piece);
    const size_t points = pir_polytope_vertex_count(piece) + (EDGE_PARTS - 1) * (size_t)pir_polytope_edge_count(piece);
    struct halves halves = {calloc(most, sizeof *halves.n), calloc(most, sizeof *halves.d), 0};
    uint32_t *corner = calloc(pir_polytope_vertex_count(piece), sizeof *corner);
    pir_vec3 *x = calloc(points, sizeof *x);
    pir_status status = halves.n && halves.d && corner && x ? PIR_OK : PIR_ERR_MEMORY;
    *ret_inner = NULL;
    if (status == PIR_OK) {
        list_halves(piece, &forms, corner, &halves);
        const size_t count = list_points(piece, &forms, corner, x);
        bool has_room = true;
        for (size_t i = 0; i < count && has_room; i++) {
            const pir_vec3 way = pir_vec_along(x[i], -1, middle);
            const double part = part_within(&halves, middle, size, way);
            has_room = part > 0;
            x[i] = rounded(pir_vec_along(middle, part, way), grid);
        }
        // flat ones have no inside
        if (has_room && pir_polytope_create(x, count, NULL, ret_inner) == PIR_ERR_MEMORY)
            status = PIR_ERR_MEMORY;
    }
    free(x);
    free(corner);
    free(halves.d);
    free(halves.n);
    return status;
}

/* The radius of a ball about a piece's middle that it has; turned, it has one about the turned middle. */
static double thickness_of(const pir_polytope *piece, uint32_t *corner) {
    const pir_vec3 own = middle_of(piece);
    double least = INFINITY;
    for (uint32_t f = 0; f < pir_polytope_facet_count(piece); f++) {
        pir_polytope_facet(piece, f, corner);
        const pir_vec3 way = pir_vec_along(pir_polytope_vertex(piece, corner[0]), -1, own);
        least = fmin(least, pir_vec_dot(pir_polytope_normal(piece, f), way));
    }
    return least;
}

static pir_status piece_around(const pir_polytope *piece, const pir_plan_turns *turns, pir_polytope **ret_outer) {
    const uint32_t vertices = pir_polytope_vertex_count(piece);
    const pir_turn_forms forms = pir_turn_forms_of(turns);
    const size_t count = (size_t)forms.count * vertices;
    pir_vec3 *x = calloc(count, sizeof *x);
    uint32_t *corner = calloc(vertices, sizeof *corner);
    pir_status status = x && corner ? PIR_OK : PIR_ERR_MEMORY;
    const double thickness = status == PIR_OK ? thickness_of(piece, corner) : 0;
    if (status == PIR_OK && !(thickness > ROOM * size_of(piece)))
        status = PIR_ERR_LIMIT;
    if (status == PIR_OK) {
        const double grid = ldexp(1, ilogb(thickness) - GRID_BITS + 4);
        for (uint32_t v = 0; v < vertices; v++)
            for (int k = 0; k < forms.count; k++)
                x[(size_t)v * forms.count + k] = turned(&forms, k, pir_polytope_vertex(piece, v));
        const pir_vec3 middle = mean_of(x, count);
        for (size_t i = 0; i < count; i++)
            x[i] = rounded(pir_vec_along(middle, 1 + MARGIN, pir_vec_along(x[i], -1, middle)), grid);
        status = pir_polytope_create(x, count, NULL, ret_outer);
    }
    free(corner);
    free(x);
    return status;
}

pir_status pir_plan_pieces_over(const pir_plan_pieces *robot, const pir_plan_turns *turns, bool outer,
                                pir_plan_pieces *ret_pieces) {
    *ret_pieces = (pir_plan_pieces){.at = calloc(robot->count, sizeof *ret_pieces->at),
                                    .body = calloc(robot->count, sizeof *ret_pieces->body)};
    pir_status status = ret_pieces->at && ret_pieces->body ? PIR_OK : PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < robot->count && status == PIR_OK; i++) {
        pir_polytope *made = NULL;
        status = outer ? piece_around(robot->at[i], turns, &made) : piece_within(robot->at[i], turns, &made);
        if (made) {
            ret_pieces->body[ret_pieces->count] = i;
            ret_pieces->at[ret_pieces->count++] = made;
        }
    }
    return status;
}

void pir_plan_pieces_over_free(pir_plan_pieces *pieces) {
    for (uint32_t i = 0; i < pieces->count; i++)
        pir_polytope_release(pieces->at[i]);
    free(pieces->at);
    free(pieces->body);
    *pieces = (pir_plan_pieces){0};
}
