/* SPDX-License-Identifier: MIT */
/* Bounds without pairs: see far_bounds.h. */
#include "scene/query/far_bounds.h"

#include "polytope/polytope.h"
#include "simplify/coarse.h"

/* Lengths of boxes, rounded down and up. */
#define DOWN (1 - 0x1p-48)
#define UP   (1 + 0x1p-48)

/* Directions at most, and vertices of a coarse body at most, that are looked at before a pair is cheaper. */
#define DIRECTIONS 4
#define VERTICES   40

static void narrow(pir_far_bounds *bounds, double least, double most) {
    bounds->least = fmax(bounds->least, least - bounds->slack);
    bounds->most = fmin(bounds->most, most + bounds->slack);
}

/* --- boxes --- */

static double diagonal(const pir_box *box) {
    double square = 0;
    for (int k = 0; k < 3; k++) {
        double edge = (double)box->high[k] - box->low[k];
        square += edge * edge;
    }
    return sqrt(square);
}

pir_far_bounds pir_far_bounds_of_boxes(const pir_box *p, const pir_box *q, double slack) {
    double square = 0;
    for (int k = 0; k < 3; k++) {
        double gap = fmax(0, fmax((double)p->low[k] - q->high[k], (double)q->low[k] - p->high[k]));
        square += gap * gap;
    }
    double gap = sqrt(square);
    return (pir_far_bounds){gap * DOWN, (gap + diagonal(p) + diagonal(q)) * UP, slack};
}

/* --- balls --- */

pir_placed pir_placed_of(const pir_coarse *coarse, pir_quat u, pir_vec3 translation, double radius) {
    pir_placed placed = {.coarse = coarse, .t = translation, .radius = radius};
    placed.r =
        (pir_mat3){{{1 - 2 * (u.y * u.y + u.z * u.z), 2 * (u.x * u.y - u.z * u.w), 2 * (u.x * u.z + u.y * u.w)},
                    {2 * (u.x * u.y + u.z * u.w), 1 - 2 * (u.x * u.x + u.z * u.z), 2 * (u.y * u.z - u.x * u.w)},
                    {2 * (u.x * u.z - u.y * u.w), 2 * (u.y * u.z + u.x * u.w), 1 - 2 * (u.x * u.x + u.y * u.y)}}};
    placed.centre = pir_vec_add(pir_mat_apply(&placed.r, coarse->centre), translation);
    return placed;
}

static double length(pir_vec3 v) {
    return sqrt(pir_vec_dot(v, v));
}

void pir_far_bounds_by_balls(pir_far_bounds *bounds, const pir_placed *p, const pir_placed *q) {
    double apart = length(pir_vec_sub(q->centre, p->centre)) - p->radius - q->radius;
    narrow(bounds, apart - p->coarse->around - q->coarse->around, apart - p->coarse->inside - q->coarse->inside);
}

/* --- supports --- */

/* The coarsest that is within `error`, or NULL where that has too many vertices. */
static const pir_coarse_body *coarsest(const pir_coarse *coarse, double error) {
    uint32_t i = 0;
    while (coarse->body[i].error > error)
        i++;
    return coarse->body[i].polytope->vertex_count <= VERTICES ? &coarse->body[i] : NULL;
}

/* The vertex farthest along a direction of the world, in the world. */
static pir_vec3 support(const pir_placed *placed, const pir_polytope *body, pir_vec3 direction) {
    const pir_vec3 along = pir_mat_apply_transposed(&placed->r, direction);
    uint32_t best = 0;
    double most = pir_vec_dot(along, body->vertex[0]);
    for (uint32_t v = 1; v < body->vertex_count; v++) {
        double reach = pir_vec_dot(along, body->vertex[v]);
        if (reach > most) {
            most = reach;
            best = v;
        }
    }
    return pir_vec_add(pir_mat_apply(&placed->r, body->vertex[best]), placed->t);
}

/*
 * Along a unit u from P to Q, let x be the support of P's coarse body along u, and y that of Q's along −u. The coarse
 * bodies are apart by at least the part of y − x along u, and by at most its length. The bodies are apart by at most
 * as much, and by at least as much less both errors.
 */
void pir_far_bounds_by_supports(pir_far_bounds *bounds, const pir_placed *p, const pir_placed *q, double error) {
    const pir_coarse_body *of_p = coarsest(p->coarse, error / 4), *of_q = coarsest(q->coarse, error / 4);
    double radii = p->radius + q->radius;
    pir_vec3 way = pir_vec_sub(q->centre, p->centre);
    for (int k = 0; k < DIRECTIONS && of_p && of_q && !(bounds->most - bounds->least <= error); k++) {
        double far = length(way);
        if (!(far > 0))
            return;
        pir_vec3 u = pir_vec_scale(way, 1 / far);
        pir_vec3 x = support(p, of_p->polytope, u), y = support(q, of_q->polytope, pir_vec_scale(u, -1));
        way = pir_vec_sub(y, x);
        narrow(bounds, pir_vec_dot(u, way) - of_p->error - of_q->error - radii, length(way) - radii);
    }
}
