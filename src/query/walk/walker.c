/* SPDX-License-Identifier: MIT */
/* Walks from facet to facet: see walker.h. The version for any processor. */
#include "query/walk/walker.h"

/* --- loops around vertices and facets --- */

/* The steepest of the edges of a vertex along n. */
static inline double steepest_at(const pir_body *body, uint32_t vertex, pir_vec3 n) {
    const pir_polytope *p = body->polytope;
    double most = -HUGE_VAL;
    for (uint32_t h = p->ring_start[vertex]; h < p->ring_start[vertex + 1]; h++) {
        double slope = pir_vec_dot(n, p->direction[h]);
        most = slope > most ? slope : most;
    }
    return most;
}

/* How far `at` is from the nearest side of a body's facet with normal n; negative outside. */
static double within_facet(const pir_body *body, uint32_t facet, pir_vec3 n, pir_vec3 at) {
    const pir_polytope *p = body->polytope;
    double least = HUGE_VAL;
    for (uint32_t i = p->loop_start[facet]; i < p->loop_start[facet + 1]; i++) {
        uint32_t half = p->loop[i];
        pir_vec3 in = pir_vec_cross(n, p->direction[half]);
        double s = pir_vec_dot(in, pir_vec_sub(at, body->vertex[p->origin[half]]));
        least = s < least ? s : least;
    }
    return least;
}

/*
 * The steepest of the halfedges from the origin of one, but that itself. They are taken from the one after it, all
 * around: two loops over what lies before and behind it would end at different lengths from frame to frame.
 */
static inline double steepest_beside(const pir_body *body, uint32_t half, pir_vec3 n) {
    const pir_polytope *p = body->polytope;
    const uint32_t *ring = &p->ring_start[p->origin[half]], start = ring[0], end = ring[1];
    double most = -HUGE_VAL;
    for (uint32_t h = half, left = end - start - 1; left > 0; left--) {
        h = h + 1 < end ? h + 1 : start;
        double slope = pir_vec_dot(n, p->direction[h]);
        most = slope > most ? slope : most;
    }
    return most;
}

/*
 * The edge of a vertex's ring through which the straight way from n to m leaves the vertex's cell; UINT32_MAX where m
 * is in that. n is in it, or on its rim.
 */
static uint32_t leave_cell(const pir_body *body, uint32_t vertex, pir_vec3 n, pir_vec3 m) {
    const pir_polytope *p = body->polytope;
    uint32_t first = UINT32_MAX, end = p->ring_start[vertex + 1];
    double least = HUGE_VAL;
    for (uint32_t h = p->ring_start[vertex]; h < end; h++) {
        double from = pir_vec_dot(p->direction[h], n), to = pir_vec_dot(p->direction[h], m), part = from / (from - to);
        bool leaves = (to > 0) & (part < least);
        first = leaves ? h : first;
        least = leaves ? part : least;
    }
    return first;
}

/* The side of a facet that a point is farthest beyond, by its place in the loops. */
static uint32_t farthest_beyond(const pir_body *body, uint32_t facet, pir_vec3 at) {
    const pir_polytope *p = body->polytope;
    uint32_t side = p->loop_start[facet];
    double least = HUGE_VAL;
    for (uint32_t i = side; i < p->loop_start[facet + 1]; i++) {
        uint32_t half = p->loop[i];
        pir_vec3 in = pir_vec_cross(p->normal[facet], p->direction[half]);
        double within = pir_vec_dot(in, pir_vec_sub(at, body->vertex[p->origin[half]]));
        side = within < least ? i : side;
        least = within < least ? within : least;
    }
    return side;
}

static inline uint32_t climb(const pir_body *body, pir_vec3 n, uint32_t from) {
    return pir_climb(body->polytope, n, from);
}

/* A segment or a point has no facet of its own. */
static pir_same leave_in_doubt(const pir_frame *frame, const pir_placement *placement, pir_piece piece,
                               pir_same_facet *same) {
    (void)frame, (void)placement, (void)piece, (void)same;
    return PIR_SAME_IN_DOUBT;
}

static const pir_walker none = {.prove = leave_in_doubt};

#define WALK_TARGET
#define WALK_CAN(frame) (!(frame)->p.polytope->artificial && !(frame)->q.polytope->artificial)
#define WALK_ELSE       (&none)
#define WALK_NAME       pir_walker_plain
#include "query/walk/walker_body.h"

/* --- a slack by integers --- */

void pir_same_facet_set_slack(const pir_frame *frame, const pir_placement *placement, double slack,
                              pir_same_facet *same) {
    const pir_facet *facet = &same->facet;
    const pir_polytope *p = frame->p.polytope;
    const pir_vec3 y = foot(placement, facet->n, slack);
    same->slack = slack;
    if (facet->piece.kind == PIR_FACET_FV) {
        same->touch.point_q = frame->q.vertex[facet->b];
        return;
    }
    struct of_p of_p = {pir_mat_apply(&frame->r, frame->p.vertex[facet->a]), {0, 0, 0}};
    if (facet->piece.kind == PIR_FACET_VF) {
        same->touch.point_q = pir_vec_sub(y, of_p.corner);
        return;
    }
    of_p.along = pir_mat_apply(&frame->r, p->direction[p->edge_half[facet->piece.first]]);
    same->touch.point_q = crossing(frame, facet, y, &of_p);
}
