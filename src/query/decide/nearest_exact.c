/* SPDX-License-Identifier: MIT */
/*
 * The descent to the nearest point in integers, for what doubles leave open: parallel features, feet on the rim of a
 * face, bodies that nearly touch.
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
#include "query/decide/nearest.h"

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

bool pir_nearest_faces(pir_exact *exact, const pir_placement *placement, const pir_simplex *simplex,
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
