/* SPDX-License-Identifier: MIT */
/*
 * The nearest point of D from outside: see nearest.h. Its descent in integers is for what doubles leave open: parallel
 * features, feet on the rim of a face, bodies that nearly touch.
 *
 * The corners W of D minus t (placed.h) are integer vectors. The hull of up to four of them, affinely independent,
 * has its point nearest to 0 in the inside of one of its faces. On that face the foot of 0 has positive weights, and
 * no other corner lies beyond the face along n, the direction from the foot to 0. n is an integer vector:
 *
 *     corner W             n = −W
 *     segment W, W + e     n = (W·e) e − (e·e) W
 *     triangle             n = ± its normal, the sign with n·W < 0
 *
 * Then both bodies are climbed along n by exact slopes. A corner of D beyond the face joins the simplex, whose
 * nearest point then is strictly nearer, so no simplex comes twice. Where there is none, n exposes the face of D that
 * holds the nearest point.
 */
#include "query/nearest/nearest.h"

#include "query/decide/short_numbers.h"

/*
 * A bound on steps, which no input is known to come near. Every step is strictly nearer, so there is an end, and the
 * start is where doubles ended.
 */
#define MOST_STEPS 1024

struct simplex_corners {
    uint32_t count, a[4], b[4];
    pir_int3 w[4];
};

/* --- the nearest face of a simplex --- */

/* Whether no corner of the set is beyond corner i along n. */
static bool is_farthest(pir_exact *exact, const struct simplex_corners *set, uint32_t i, const pir_int3 *n) {
    uint32_t mark = exact->scratch.used;
    bool farthest = true;
    for (uint32_t k = 0; k < set->count && farthest; k++)
        if (k != i) {
            pir_int3 e = pir_exact_difference(exact, &set->w[k], &set->w[i]);
            farthest = pir_exact_dot_sign(exact, n, &e) <= 0;
            exact->scratch.used = mark;
        }
    return farthest;
}

static void negate(pir_int3 *v) {
    for (int k = 0; k < 3; k++)
        pir_int_negate(&v->c[k]);
}

/* n of corner i, in the scratch, where that corner is the nearest face. */
static bool try_corner(pir_exact *exact, const struct simplex_corners *set, uint32_t i, pir_int3 *ret_n) {
    *ret_n = set->w[i];
    negate(ret_n);
    return is_farthest(exact, set, i, ret_n);
}

static bool try_segment(pir_exact *exact, const struct simplex_corners *set, uint32_t i, uint32_t j, pir_int3 *ret_n) {
    pir_int3 e = pir_exact_difference(exact, &set->w[j], &set->w[i]);
    pir_int from = pir_exact_dot(exact, &set->w[i], &e), to = pir_exact_dot(exact, &set->w[j], &e);
    if (pir_int_sign(&from) >= 0 || pir_int_sign(&to) <= 0)
        return false;
    pir_int square = pir_exact_square(exact, &e);
    pir_int3 along = pir_exact_scaled(exact, &e, &from), whole = pir_exact_scaled(exact, &set->w[i], &square);
    *ret_n = pir_exact_difference(exact, &along, &whole);
    return !pir_int3_is_zero(ret_n) && is_farthest(exact, set, i, ret_n);
}

/* The sign of n·(W_i × W_j). */
static int weight(pir_exact *exact, const pir_int3 *n, const pir_int3 *w, const pir_int3 *v) {
    uint32_t mark = exact->scratch.used;
    pir_int3 c = pir_exact_cross(exact, w, v);
    int sign = pir_exact_dot_sign(exact, n, &c);
    exact->scratch.used = mark;
    return sign;
}

static bool try_triangle(pir_exact *exact, const struct simplex_corners *set, uint32_t i, uint32_t j, uint32_t k,
                         pir_int3 *ret_n) {
    const pir_int3 *w = set->w;
    pir_int3 e = pir_exact_difference(exact, &w[j], &w[i]), f = pir_exact_difference(exact, &w[k], &w[i]);
    pir_int3 n = pir_exact_cross(exact, &e, &f);
    if (pir_int3_is_zero(&n) || weight(exact, &n, &w[j], &w[k]) <= 0 || weight(exact, &n, &w[k], &w[i]) <= 0 ||
        weight(exact, &n, &w[i], &w[j]) <= 0)
        return false;
    int side = pir_exact_dot_sign(exact, &n, &w[i]);
    if (side > 0)
        negate(&n);
    *ret_n = n;
    return side != 0 && is_farthest(exact, set, i, &n);
}

/* Reduces the set to the corners that are named. */
static void keep(struct simplex_corners *set, const uint32_t *index, uint32_t count) {
    for (uint32_t k = 0; k < count; k++) {
        set->a[k] = set->a[index[k]];
        set->b[k] = set->b[index[k]];
    }
    set->count = count;
}

/* Reduces the set to its face that is nearest to 0. Its n is in the scratch. False where 0 is in the hull. */
static bool nearest_face(pir_exact *exact, struct simplex_corners *set, pir_int3 *ret_n) {
    uint32_t mark = exact->scratch.used;
    for (uint32_t i = 0; i < set->count; i++, exact->scratch.used = mark)
        if (try_corner(exact, set, i, ret_n)) {
            keep(set, (const uint32_t[1]){i}, 1);
            return true;
        }
    for (uint32_t j = 1; j < set->count; j++)
        for (uint32_t i = 0; i < j; i++, exact->scratch.used = mark)
            if (try_segment(exact, set, i, j, ret_n)) {
                keep(set, (const uint32_t[2]){i, j}, 2);
                return true;
            }
    for (uint32_t k = 2; k < set->count; k++)
        for (uint32_t j = 1; j < k; j++)
            for (uint32_t i = 0; i < j; i++, exact->scratch.used = mark)
                if (try_triangle(exact, set, i, j, k, ret_n)) {
                    keep(set, (const uint32_t[3]){i, j, k}, 3);
                    return true;
                }
    return false;
}

/* --- the descent --- */

/* The vertex farthest along the normal, from `from` uphill. */
static uint32_t climb(pir_exact *exact, const pir_normal *normal, const pir_view *view, uint32_t from) {
    const pir_polytope *p = view->body;
    for (uint32_t h = p->ring_start[from]; h < p->ring_start[from + 1]; h++)
        if (pir_slope(exact, normal, view, h) > 0) {
            from = p->target[h];
            h = p->ring_start[from] - 1;
        }
    return from;
}

static void make_corners(pir_exact *exact, struct simplex_corners *set) {
    for (uint32_t i = 0; i < set->count; i++)
        set->w[i] = pir_exact_corner(exact, set->a[i], set->b[i]);
}

/* One step. True where it is the last: then the faces are set. */
static bool step(pir_exact *exact, struct simplex_corners *set, pir_witness *ret_faces, pir_facet *ret_facet,
                 bool *ret_flat) {
    const pir_frame *frame = exact->frame;
    make_corners(exact, set);
    pir_int3 n;
    if (!nearest_face(exact, set, &n)) {
        // not possible from outside; begin anew from one corner
        set->count = 1;
        return false;
    }
    pir_normal normal = {.unit = pir_int3_unit(&n), .err = 1, .exact = &n};
    pir_view of_p = pir_view_of(frame, &normal, false), of_q = pir_view_of(frame, &normal, true);
    uint32_t a = climb(exact, &normal, &of_p, set->a[0]), b = climb(exact, &normal, &of_q, set->b[0]);
    if (a != set->a[0] || b != set->b[0]) {
        set->a[set->count] = a;
        set->b[set->count++] = b;
        return false;
    }
    ret_faces->p = pir_exposed(exact, &normal, &of_p, a);
    ret_faces->q = pir_exposed(exact, &normal, &of_q, b);
    *ret_flat = pir_facet_of_faces(exact, &normal, *ret_faces, ret_facet);
    return true;
}

/*
 * The faces that the direction from the nearest point to x exposes, given that x is outside of D. False after
 * MOST_STEPS steps. *ret_flat tells whether their sum is a facet; then it is *ret_facet.
 */
static bool find_faces(pir_exact *exact, const pir_placement *placement, const pir_simplex *simplex,
                       pir_witness *ret_faces, pir_facet *ret_facet, bool *ret_flat, uint32_t *steps) {
    struct simplex_corners set = {.count = simplex->count};
    for (uint32_t i = 0; i < simplex->count; i++) {
        set.a[i] = simplex->a[i];
        set.b[i] = simplex->b[i];
    }
    pir_exact_begin(exact, placement->translation);
    uint32_t mark = exact->scratch.used;
    bool done = false;
    for (uint32_t i = 0; i < MOST_STEPS && !done; i++, ++*steps) {
        done = step(exact, &set, ret_faces, ret_facet, ret_flat);
        exact->scratch.used = mark;
    }
    return done;
}

/* --- by doubles --- */

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

static pir_edge_of_d line_of(const pir_frame *frame, pir_witness faces) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    pir_edge_of_d line = {.a = pir_face_lowest(p, faces.p), .b = pir_face_lowest(q, faces.q)};
    line.of_p = faces.p.kind == PIR_FEATURE_EDGE;
    line.of_q = !line.of_p && faces.q.kind == PIR_FEATURE_EDGE;
    if (line.of_p)
        line.half = p->edge_half[faces.p.index];
    if (line.of_q)
        line.half = q->edge_half[faces.q.index];
    return line;
}

static pir_vec3 direction_of(const pir_frame *frame, const pir_edge_of_d *line) {
    return line->of_p ? pir_mat_apply(&frame->r, frame->p.polytope->direction[line->half])
                      : frame->q.polytope->direction[line->half];
}

/*
 * The vector from the corner or the edge to x, in doubles. *ret_along is the distance from the corner along the edge.
 */
static pir_vec3 away_from(const pir_frame *frame, const pir_placement *placement, const pir_edge_of_d *line,
                          double *ret_along) {
    pir_vec3 w = pir_vec_sub(placement->x, pir_frame_vertex(frame, line->a, line->b));
    *ret_along = 0;
    if (!line->of_p && !line->of_q)
        return w;
    pir_vec3 e = direction_of(frame, line);
    *ret_along = pir_vec_dot(w, e);
    return pir_vec_sub(w, pir_vec_scale(e, *ret_along));
}

/* Distance and unit normal from integers. */
static double exactly_away(pir_exact *exact, const pir_placement *placement, const pir_edge_of_d *line,
                           pir_vec3 *ret_normal) {
    double distance;
    if (pir_short_distance(exact, placement->translation, line, &distance, ret_normal))
        return distance;
    pir_exact_begin(exact, placement->translation);
    uint32_t mark = exact->scratch.used;
    pir_int3 w = pir_exact_corner(exact, line->a, line->b), n = w;
    negate(&n);
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

/* The distance of x from the corner or the edge of D, and the direction from there. */
static double measure_line(pir_exact *exact, const pir_placement *placement, pir_witness faces,
                           pir_normal *ret_normal) {
    pir_edge_of_d line = line_of(exact->frame, faces);
    double along;
    pir_vec3 w = away_from(exact->frame, placement, &line, &along);
    double distance = sqrt(pir_vec_dot(w, w)), error = 4 * placement->error;
    *ret_normal = (pir_normal){.err = direction_error(error, distance)};
    if (is_sharp(placement, distance)) {
        ret_normal->unit = pir_vec_scale(w, 1 / distance);
    } else {
        distance = exactly_away(exact, placement, &line, &ret_normal->unit);
        ret_normal->err = 1;
    }
    return distance;
}

static bool answer_line(pir_exact *exact, const pir_placement *placement, pir_witness faces, pir_nearest *ret_nearest) {
    pir_normal normal;
    const double distance = measure_line(exact, placement, faces, &normal);
    ret_nearest->distance = distance;
    ret_nearest->normal = normal.unit;
    pir_meeting meeting = {&normal, faces, false, -distance, NULL};
    return pir_touch_find(exact, placement, &meeting, &ret_nearest->touch);
}

/* --- proofs in doubles --- */

/* Whether every edge of a body's vertex, but those to `except`, falls along −n by more than n may be off. */
static bool leads_down(const pir_polytope *p, pir_vec3 n, double off, uint32_t vertex, uint32_t except) {
    for (uint32_t h = p->ring_start[vertex]; h < p->ring_start[vertex + 1]; h++)
        if (p->target[h] != except && !(pir_vec_dot(n, p->direction[h]) < -off))
            return false;
    return true;
}

/* Whether the corner or edge of D that is the sum of the faces certainly holds the nearest point. */
static bool line_is_nearest(const pir_frame *frame, const pir_placement *placement, pir_witness faces) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    pir_edge_of_d line = line_of(frame, faces);
    double along, error = 4 * placement->error;
    pir_vec3 w = away_from(frame, placement, &line, &along);
    double distance = sqrt(pir_vec_dot(w, w));
    if (!is_far(placement, distance))
        return false;
    pir_vec3 n = pir_vec_scale(w, 1 / distance);
    // the error of a slope is that of n, and rounding
    double off = error / distance + 0x1p-45;
    const pir_vec3 back = pir_mat_apply_transposed(&frame->r, n);
    if (!line.of_p && !line.of_q)
        return leads_down(p, back, off, line.a, UINT32_MAX) && leads_down(q, n, off, line.b, UINT32_MAX);
    const pir_polytope *of = line.of_p ? p : q;
    const pir_vec3 *vertex = line.of_p ? frame->p.vertex : frame->q.vertex, along_of = line.of_p ? back : n;
    uint32_t from = of->origin[line.half], to = of->target[line.half];
    pir_vec3 edge = pir_vec_sub(vertex[to], vertex[from]);
    double length = sqrt(pir_vec_dot(edge, edge));
    return along > error && along < length - error && leads_down(of, along_of, off, from, to) &&
           leads_down(of, along_of, off, to, from) &&
           (line.of_p ? leads_down(q, n, off, line.b, UINT32_MAX) : leads_down(p, back, off, line.a, UINT32_MAX));
}

bool pir_nearest_prove(pir_exact *exact, const pir_placement *placement, pir_witness faces, pir_nearest *ret_nearest) {
    const bool are_edges = faces.p.kind == PIR_FEATURE_EDGE && faces.q.kind == PIR_FEATURE_EDGE;
    return !are_edges && line_is_nearest(exact->frame, placement, faces) &&
           answer_line(exact, placement, faces, ret_nearest);
}

bool pir_nearest_find(pir_exact *exact, const pir_placement *placement, const pir_simplex *simplex,
                      pir_nearest *ret_nearest, uint32_t *steps) {
    pir_witness faces;
    pir_facet facet;
    bool flat;
    if (!find_faces(exact, placement, simplex, &faces, &facet, &flat, steps))
        return false;
    return flat ? pir_nearest_at_facet(exact, placement, &facet, ret_nearest)
                : answer_line(exact, placement, faces, ret_nearest);
}

bool pir_nearest_each(pir_exact *exact, const pir_placement *placement, const pir_simplex *simplex,
                      pir_nearest *ret_nearest, const pir_touch_visitor *visitor) {
    pir_witness faces;
    pir_facet facet;
    pir_normal normal;
    bool flat;
    uint32_t steps = 0;
    double slack;
    if (!find_faces(exact, placement, simplex, &faces, &facet, &flat, &steps))
        return false;
    if (flat) {
        slack = fmin(0, pir_facet_slack(exact, placement, &facet));
        normal = pir_facet_normal(&facet);
    } else {
        slack = -measure_line(exact, placement, faces, &normal);
    }
    ret_nearest->distance = -slack;
    ret_nearest->normal = normal.unit;
    const pir_meeting meeting = {&normal, faces, flat, slack, NULL};
    pir_touch_each(exact, placement, &meeting, visitor);
    return true;
}
