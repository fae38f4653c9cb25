/* SPDX-License-Identifier: MIT */
/* The nearest point of D from outside: see nearest.h. */
#include "query/decide/nearest.h"

/*
 * Nearer than this, relative to the placement's reach, the faces that hold the nearest point come from integers where
 * they are a corner or an edge of D.
 */
#define CLOSE 0x1p-16

/*
 * Nearer than this, their distance and direction do. Doubles know x and a corner to a few 2^-53 of the reach, hence the
 * direction to as many 2^-44 at this distance, and worse below it; 10^-12 is what an answer promises.
 */
#define BLURRED 0x1p-9

/* Lengths above this have squares that are normal numbers, with room for products of them. */
#define LEAST_LENGTH 0x1p-400

/* Whether doubles know a distance and its direction well enough to decide by them, and to answer by them. */
static bool is_far(const pir_placement *placement, double distance) {
    return distance > CLOSE * placement->reach && distance > placement->error / CLOSE && distance > LEAST_LENGTH;
}

static bool is_sharp(const pir_placement *placement, double distance) {
    return distance > BLURRED * placement->reach && is_far(placement, distance);
}

/* The error of a direction for an error in lengths and a distance, in units of 64·2^-53 (facet.h). */
static double direction_error(double error, double distance) {
    return 1 + error / distance * 0x1p47;
}

/* --- answers from faces --- */

bool pir_nearest_at_facet(pir_exact *exact, const pir_placement *placement, const pir_facet *facet,
                          pir_nearest *ret_nearest) {
    return pir_nearest_at_slack(exact, placement, facet, pir_facet_slack(exact, placement, facet), ret_nearest);
}

bool pir_nearest_at_slack(pir_exact *exact, const pir_placement *placement, const pir_facet *facet, double slack,
                          pir_nearest *ret_nearest) {
    if (!pir_touch_facet(exact, placement, facet, slack, NULL, &ret_nearest->touch))
        return false;
    ret_nearest->distance = fmax(0, -slack);
    ret_nearest->normal = facet->n;
    return true;
}

/* A corner or an edge of D: its corner, and the halfedge along it. */
struct line {
    uint32_t a, b;
    bool of_p, of_q; /* an edge of P, an edge of Q; neither for a corner */
    uint32_t half;
};

static struct line line_of(const pir_frame *frame, pir_witness faces) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    struct line line = {.a = pir_face_lowest(p, faces.p), .b = pir_face_lowest(q, faces.q)};
    line.of_p = faces.p.kind == PIR_FEATURE_EDGE;
    line.of_q = !line.of_p && faces.q.kind == PIR_FEATURE_EDGE;
    if (line.of_p)
        line.half = p->edge_half[faces.p.index];
    if (line.of_q)
        line.half = q->edge_half[faces.q.index];
    return line;
}

static pir_vec3 direction_of(const pir_frame *frame, const struct line *line) {
    return line->of_p ? pir_mat_apply(&frame->r, frame->p.polytope->direction[line->half])
                      : frame->q.polytope->direction[line->half];
}

/*
 * The vector from the corner or the edge to x, in doubles. *ret_along is the distance from the corner along the edge.
 */
static pir_vec3 away_from(const pir_frame *frame, const pir_placement *placement, const struct line *line,
                          double *ret_along) {
    pir_vec3 w = pir_vec_sub(placement->x, pir_frame_vertex(frame, line->a, line->b));
    *ret_along = 0;
    if (!line->of_p && !line->of_q)
        return w;
    pir_vec3 e = direction_of(frame, line);
    *ret_along = pir_vec_dot(w, e);
    return pir_vec_sub(w, pir_vec_scale(e, *ret_along));
}

/* The same from integers: the distance and the unit normal. */
static double exactly_away(pir_exact *exact, const pir_placement *placement, const struct line *line,
                           pir_vec3 *ret_normal) {
    pir_exact_begin(exact, placement->translation);
    uint32_t mark = exact->scratch.used;
    pir_int3 w = pir_exact_corner(exact, line->a, line->b), n = w;
    for (int k = 0; k < 3; k++)
        pir_int_negate(&n.c[k]);
    pir_real length;
    if (line->of_p || line->of_q) {
        pir_int3 e = line->of_p ? pir_exact_half_p(exact, line->half) : pir_exact_half_q(exact, line->half);
        pir_int dot = pir_exact_dot(exact, &w, &e), square = pir_exact_square(exact, &e);
        pir_int3 along = pir_exact_scaled(exact, &e, &dot), whole = pir_exact_scaled(exact, &w, &square);
        n = pir_exact_difference(exact, &along, &whole);
        length = pir_real_over(pir_exact_length(exact, &n), pir_real_of(&square));
    } else {
        length = pir_exact_length(exact, &n);
    }
    *ret_normal = pir_int3_is_zero(&n) ? (pir_vec3){1, 0, 0} : pir_int3_unit(&n);
    exact->scratch.used = mark;
    return pir_real_double(pir_real_times(length, pir_exact_unit(exact)));
}

static bool answer_line(pir_exact *exact, const pir_placement *placement, pir_witness faces, pir_nearest *ret_nearest) {
    const pir_frame *frame = exact->frame;
    struct line line = line_of(frame, faces);
    double along;
    pir_vec3 w = away_from(frame, placement, &line, &along);
    double distance = sqrt(pir_vec_dot(w, w)), error = 4 * placement->error;
    pir_normal normal = {.err = direction_error(error, distance)};
    if (is_sharp(placement, distance)) {
        normal.unit = pir_vec_scale(w, 1 / distance);
    } else {
        distance = exactly_away(exact, placement, &line, &normal.unit);
        normal.err = 1;
    }
    ret_nearest->distance = distance;
    ret_nearest->normal = normal.unit;
    pir_meeting meeting = {&normal, faces, false, -distance, NULL};
    return pir_touch_find(exact, placement, &meeting, &ret_nearest->touch);
}

/* --- proofs in doubles --- */

/* Whether every edge of a vertex, but those to `except`, falls along −n by more than n may be off. */
static bool leads_down_p(const pir_frame *frame, pir_vec3 n, double off, uint32_t vertex, uint32_t except) {
    const pir_polytope *p = frame->p.polytope;
    pir_vec3 back = pir_mat_apply_transposed(&frame->r, n);
    for (uint32_t h = p->ring_start[vertex]; h < p->ring_start[vertex + 1]; h++)
        if (p->target[h] != except && !(pir_vec_dot(back, p->direction[h]) < -off))
            return false;
    return true;
}

static bool leads_down_q(const pir_frame *frame, pir_vec3 n, double off, uint32_t vertex, uint32_t except) {
    const pir_polytope *q = frame->q.polytope;
    for (uint32_t h = q->ring_start[vertex]; h < q->ring_start[vertex + 1]; h++)
        if (q->target[h] != except && !(pir_vec_dot(n, q->direction[h]) < -off))
            return false;
    return true;
}

/* Whether the corner or edge of D that is the sum of the faces certainly holds the nearest point. */
static bool line_is_nearest(const pir_frame *frame, const pir_placement *placement, pir_witness faces) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    struct line line = line_of(frame, faces);
    double along, error = 4 * placement->error;
    pir_vec3 w = away_from(frame, placement, &line, &along);
    double distance = sqrt(pir_vec_dot(w, w));
    if (!is_far(placement, distance))
        return false;
    pir_vec3 n = pir_vec_scale(w, 1 / distance);
    // the error of a slope is that of n, and rounding
    double off = error / distance + 0x1p-45;
    if (!line.of_p && !line.of_q)
        return leads_down_p(frame, n, off, line.a, UINT32_MAX) && leads_down_q(frame, n, off, line.b, UINT32_MAX);
    const pir_polytope *of = line.of_p ? p : q;
    const pir_vec3 *vertex = line.of_p ? frame->p.vertex : frame->q.vertex;
    uint32_t from = of->origin[line.half], to = of->target[line.half];
    pir_vec3 edge = pir_vec_sub(vertex[to], vertex[from]);
    double length = sqrt(pir_vec_dot(edge, edge));
    if (!(along > error && along < length - error))
        return false;
    if (line.of_p)
        return leads_down_p(frame, n, off, from, to) && leads_down_p(frame, n, off, to, from) &&
               leads_down_q(frame, n, off, line.b, UINT32_MAX);
    return leads_down_q(frame, n, off, from, to) && leads_down_q(frame, n, off, to, from) &&
           leads_down_p(frame, n, off, line.a, UINT32_MAX);
}

/* Answers from a facet of D that certainly separates and that holds the foot of x. False where it does not. */
static bool facet_is_nearest(pir_exact *exact, const pir_placement *placement, const pir_facet *facet,
                             pir_nearest *ret_nearest) {
    double slack = facet->h - pir_vec_dot(facet->n, placement->x);
    return slack < -placement->error * facet->err && pir_nearest_at_facet(exact, placement, facet, ret_nearest);
}

bool pir_nearest_prove(pir_exact *exact, const pir_placement *placement, pir_witness faces, const pir_piece *piece,
                       pir_nearest *ret_nearest) {
    pir_facet facet;
    if (piece)
        return pir_facet_of(exact, *piece, &facet) && facet_is_nearest(exact, placement, &facet, ret_nearest);
    if (faces.p.kind == PIR_FEATURE_EDGE && faces.q.kind == PIR_FEATURE_EDGE)
        return false;
    return line_is_nearest(exact->frame, placement, faces) && answer_line(exact, placement, faces, ret_nearest);
}

bool pir_nearest_find(pir_exact *exact, const pir_placement *placement, const pir_simplex *simplex,
                      pir_nearest *ret_nearest, uint32_t *steps) {
    pir_witness faces;
    pir_facet facet;
    bool flat;
    if (!pir_nearest_faces(exact, placement, simplex, &faces, &facet, &flat, steps))
        return false;
    return flat ? pir_nearest_at_facet(exact, placement, &facet, ret_nearest)
                : answer_line(exact, placement, faces, ret_nearest);
}
