/* SPDX-License-Identifier: MIT */
/*
 * The point of D nearest to x, by descent from vertex to vertex (Gilbert, Johnson and Keerthi, 1988) with supports by hill climbing.
 *
 * A step takes the nearest point v of the hull of at most three vertices of D (all relative to x), then the vertex w of D farthest
 * towards x; |v| is an upper bound on the distance, w·v/|v| a lower one. It ends when they meet, or when no step brings v nearer: v then is
 * as near as these numbers tell.
 *
 * Near D doubles lose the direction of v: |v| is known to an ulp of the bodies' size, no better. fine.c is for that.
 */
#include "query/query.h"

/* A slope this small is no slope: unit vectors are off by a few 2^-53. */
#define LEAST_SLOPE 0x1p-49

uint32_t pir_climb(const pir_polytope *polytope, pir_vec3 n, uint32_t from) {
    // every step rises, so no vertex comes twice; the count bounds it even if rounding should err
    for (uint32_t left = polytope->vertex_count; left > 0; left--) {
        uint32_t best = from;
        double steepest = LEAST_SLOPE;
        for (uint32_t h = polytope->ring_start[from]; h < polytope->ring_start[from + 1]; h++) {
            double slope = pir_vec_dot(n, polytope->direction[h]);
            if (slope > steepest)
                steepest = slope, best = polytope->target[h];
        }
        if (best == from)
            break;
        from = best;
    }
    return from;
}

/* --- the nearest point of a simplex to the origin --- */

/* Points, and which of them hold the nearest point with which weights. */
struct nearest {
    uint32_t count, index[3];
    double weight[3];
    pir_vec3 v;
    double square;
};

static void take_point(const pir_vec3 *w, uint32_t a, struct nearest *best) {
    double square = pir_vec_dot(w[a], w[a]);
    if (square < best->square)
        *best = (struct nearest){1, {a, 0, 0}, {1, 0, 0}, w[a], square};
}

/* The inside of the segment a–b; its ends are points. */
static void take_segment(const pir_vec3 *w, uint32_t a, uint32_t b, struct nearest *best) {
    pir_vec3 e = pir_vec_sub(w[b], w[a]);
    double along = -pir_vec_dot(w[a], e), whole = pir_vec_dot(e, e);
    if (!(along > 0 && along < whole))
        return;
    double t = along / whole;
    // from the nearer end, which loses less
    pir_vec3 v = t <= 0.5 ? pir_vec_add(w[a], pir_vec_scale(e, t)) : pir_vec_sub(w[b], pir_vec_scale(e, 1 - t));
    double square = pir_vec_dot(v, v);
    if (square < best->square)
        *best = (struct nearest){2, {a, b, 0}, {1 - t, t, 0}, v, square};
}

/*
 * The inside of the triangle; its sides are segments. Where the foot is inside, the triangle is nearer than its sides, by less than
 * rounding tells when it is nearly flat towards x: it goes first, or the descent would stay on the side.
 */
static void take_triangle(const pir_vec3 *w, uint32_t a, uint32_t b, uint32_t c, struct nearest *best) {
    pir_vec3 n = pir_vec_cross(pir_vec_sub(w[b], w[a]), pir_vec_sub(w[c], w[a]));
    double whole = pir_vec_dot(n, n);
    double wa = pir_vec_dot(n, pir_vec_cross(w[b], w[c])), wb = pir_vec_dot(n, pir_vec_cross(w[c], w[a]));
    double wc = pir_vec_dot(n, pir_vec_cross(w[a], w[b]));
    if (!(wa > 0 && wb > 0 && wc > 0) || whole == 0)
        return;
    double sum = wa + wb + wc;
    // the plane's distance from the corner that is nearest to it in length
    double qa = pir_vec_dot(w[a], w[a]), qb = pir_vec_dot(w[b], w[b]), qc = pir_vec_dot(w[c], w[c]);
    pir_vec3 corner = qa <= qb && qa <= qc ? w[a] : qb <= qc ? w[b] : w[c];
    pir_vec3 v = pir_vec_scale(n, pir_vec_dot(n, corner) / whole);
    double square = pir_vec_dot(v, v);
    if (square < best->square * (1 + 0x1p-20))
        *best = (struct nearest){3, {a, b, c}, {wa / sum, wb / sum, wc / sum}, v, square};
}

/* Of `count` ≤ 4 points, the last new: the nearest point of the faces that hold it, and of the others' vertices for safety. */
static void find_nearest(const pir_vec3 *w, uint32_t count, struct nearest *best) {
    best->square = HUGE_VAL;
    uint32_t last = count - 1;
    for (uint32_t i = 0; i < count; i++)
        take_point(w, i, best);
    for (uint32_t i = 0; i < last; i++)
        take_segment(w, i, last, best);
    if (count >= 3) {
        take_segment(w, 0, 1, best);
        take_triangle(w, 0, 1, last, best);
    }
    if (count == 4) {
        take_segment(w, 0, 2, best);
        take_segment(w, 1, 2, best);
        take_triangle(w, 0, 2, last, best);
        take_triangle(w, 1, 2, last, best);
    }
}

static void keep_nearest(pir_simplex *simplex, pir_vec3 *w, const struct nearest *best) {
    pir_simplex old = *simplex;
    pir_vec3 points[4] = {w[0], w[1], w[2], w[3]};
    simplex->count = best->count;
    for (uint32_t i = 0; i < best->count; i++) {
        simplex->a[i] = old.a[best->index[i]];
        simplex->b[i] = old.b[best->index[i]];
        simplex->weight[i] = best->weight[i];
        w[i] = points[best->index[i]];
    }
}

/*
 * The length of the point that the weights make: a point of D whatever they are, hence an upper bound even where a triangle is so narrow
 * that its normal is rounding alone.
 */
static double held_length(const pir_simplex *simplex, const pir_vec3 *w) {
    pir_vec3 v = {0, 0, 0};
    for (uint32_t i = 0; i < simplex->count; i++)
        v = pir_vec_add(v, pir_vec_scale(w[i], simplex->weight[i]));
    return sqrt(pir_vec_dot(v, v));
}

bool pir_simplex_holds(const pir_simplex *simplex, uint32_t a, uint32_t b) {
    for (uint32_t i = 0; i < simplex->count; i++)
        if (simplex->a[i] == a && simplex->b[i] == b)
            return true;
    return false;
}

/* A first vertex when there is none: that towards x. */
void pir_simplex_start(const pir_query *query, const pir_placement *placement, pir_simplex *simplex) {
    if (simplex->count > 0)
        return;
    double length = sqrt(pir_vec_dot(placement->x, placement->x));
    pir_vec3 n = length > 0 ? pir_vec_scale(placement->x, 1 / length) : (pir_vec3){1, 0, 0};
    simplex->count = 1;
    simplex->a[0] = pir_climb(query->p, pir_mat_apply_transposed(&query->r, n), 0);
    simplex->b[0] = pir_climb(query->q, n, 0);
}

void pir_descend_to_point(pir_query *query, const pir_placement *placement, double cutoff, pir_simplex *simplex,
                          uint32_t *steps) {
    pir_vec3 w[4];
    struct nearest best;
    pir_simplex_start(query, placement, simplex);
    for (uint32_t i = 0; i < simplex->count; i++)
        w[i] = pir_vec_sub(pir_frame_vertex(query, simplex->a[i], simplex->b[i]), placement->x);
    simplex->certain = false;
    simplex->lower = -HUGE_VAL;
    simplex->upper = HUGE_VAL;
    if (simplex->count == 1)
        best = (struct nearest){1, {0, 0, 0}, {1, 0, 0}, w[0], pir_vec_dot(w[0], w[0])};
    else
        find_nearest(w, simplex->count, &best);
    for (uint32_t step = 0; step < PIR_MOST_STEPS; step++) {
        double length = sqrt(best.square);
        if (!(length < simplex->upper) || length == 0)
            return;
        keep_nearest(simplex, w, &best);
        simplex->upper = length;
        simplex->direction = pir_vec_scale(best.v, -1 / length);
        ++*steps;
        uint32_t a = pir_climb(query->p, pir_mat_apply_transposed(&query->r, simplex->direction), simplex->a[0]);
        uint32_t b = pir_climb(query->q, simplex->direction, simplex->b[0]);
        uint32_t n = simplex->count;
        w[n] = pir_vec_sub(pir_frame_vertex(query, a, b), placement->x);
        simplex->lower = -pir_vec_dot(w[n], simplex->direction);
        simplex->certain = length - simplex->lower <= PIR_MEET * placement->reach &&
                           held_length(simplex, w) - simplex->lower <= PIR_MEET * placement->reach;
        if (simplex->certain || simplex->lower > cutoff || pir_simplex_holds(simplex, a, b))
            return;
        simplex->a[n] = a;
        simplex->b[n] = b;
        find_nearest(w, n + 1, &best);
    }
}
