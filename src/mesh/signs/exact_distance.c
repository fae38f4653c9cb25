/* SPDX-License-Identifier: MIT */
/*
 * Exact distances of triangles. Every pair of features is tried: this runs where doubles cannot tell, so it is kept
 * plain.
 */
#include "mesh/signs/exact_distance.h"

struct distance_work {
    pir_limbs *limbs;
    pir_exact_square *best;
    bool any;
};

int pir_exact_square_order(pir_limbs *limbs, const pir_exact_square *a, const pir_exact_square *b) {
    uint32_t used = limbs->used;
    pir_int order = pir_num_minor(limbs, &a->num, &b->den, &b->num, &a->den);
    limbs->used = used;
    return pir_int_sign(&order);
}

/* Takes num/den, den > 0, where it is less than the best so far. */
static void offer(struct distance_work *w, const pir_int *num, const pir_int *den) {
    const pir_exact_square square = {*num, *den};
    if (w->any && pir_exact_square_order(w->limbs, &square, w->best) >= 0)
        return;
    pir_int_copy(&w->best->num, num);
    pir_int_copy(&w->best->den, den);
    w->any = true;
}

static bool is_zero(const struct distance_work *w) {
    return w->any && w->best->num.size == 0;
}

static void offer_zero(struct distance_work *w) {
    mp_limb_t one = 1;
    const pir_int zero = {&one, 0, 0}, unit = {&one, 1, 0};
    offer(w, &zero, &unit);
}

static void try_vertices(struct distance_work *w, const pir_int3 *a, const pir_int3 *b) {
    pir_int3 between = pir_num3_sub(w->limbs, a, b);
    pir_int square = pir_num3_dot(w->limbs, &between, &between);
    mp_limb_t one = 1;
    const pir_int unit = {&one, 1, 0};
    offer(w, &square, &unit);
}

/* A vertex and the edge from p to q, where the foot is on it. */
static void try_vertex_edge(struct distance_work *w, const pir_int3 *v, const pir_int3 *p, const pir_int3 *q) {
    pir_limbs *limbs = w->limbs;
    pir_int3 e = pir_num3_sub(limbs, q, p), away = pir_num3_sub(limbs, v, p);
    pir_int along = pir_num3_dot(limbs, &away, &e), length = pir_num3_dot(limbs, &e, &e);
    if (length.size == 0 || along.size < 0 || pir_num_compare(limbs, &along, &length) > 0)
        return;
    pir_int far = pir_num3_dot(limbs, &away, &away), num = pir_num_minor(limbs, &far, &length, &along, &along);
    offer(w, &num, &length);
}

/* Whether 0 ≤ part ≤ whole. */
static bool is_part(pir_limbs *limbs, const pir_int *part, const pir_int *whole) {
    return part->size >= 0 && pir_num_compare(limbs, part, whole) <= 0;
}

/* Two edges, from p to q and from r to s, where the feet of their common perpendicular are on them. */
static void try_edges(struct distance_work *w, const pir_int3 *p, const pir_int3 *q, const pir_int3 *r,
                      const pir_int3 *s) {
    pir_limbs *limbs = w->limbs;
    pir_int3 e = pir_num3_sub(limbs, q, p), f = pir_num3_sub(limbs, s, r), away = pir_num3_sub(limbs, p, r);
    pir_int ee = pir_num3_dot(limbs, &e, &e), ef = pir_num3_dot(limbs, &e, &f), ff = pir_num3_dot(limbs, &f, &f);
    pir_int ew = pir_num3_dot(limbs, &e, &away), fw = pir_num3_dot(limbs, &f, &away);
    pir_int den = pir_num_minor(limbs, &ee, &ff, &ef, &ef);
    if (den.size == 0)
        return;
    pir_int on_first = pir_num_minor(limbs, &ef, &fw, &ff, &ew), on_second = pir_num_minor(limbs, &ee, &fw, &ef, &ew);
    if (!is_part(limbs, &on_first, &den) || !is_part(limbs, &on_second, &den))
        return;
    pir_int3 n = pir_num3_cross(limbs, &e, &f);
    pir_int height = pir_num3_dot(limbs, &away, &n), num = pir_num_mul(limbs, &height, &height);
    offer(w, &num, &den);
}

/* The sign of (e × to) · n for the side of a triangle from p along e. */
static int side_of(pir_limbs *limbs, const pir_int3 *p, const pir_int3 *q, const pir_int3 *v, const pir_int3 *n) {
    uint32_t used = limbs->used;
    pir_int3 e = pir_num3_sub(limbs, q, p), to = pir_num3_sub(limbs, v, p), cross = pir_num3_cross(limbs, &e, &to);
    pir_int side = pir_num3_dot(limbs, &cross, n);
    limbs->used = used;
    return pir_int_sign(&side);
}

/* A vertex and the face of a triangle with the normal n, not 0, where the foot is within. */
static void try_vertex_face(struct distance_work *w, const pir_int3 *v, const pir_int3 tri[3], const pir_int3 *n) {
    pir_limbs *limbs = w->limbs;
    for (int k = 0; k < 3; k++)
        if (side_of(limbs, &tri[k], &tri[(k + 1) % 3], v, n) < 0)
            return;
    pir_int3 away = pir_num3_sub(limbs, v, &tri[0]);
    pir_int height = pir_num3_dot(limbs, &away, n), num = pir_num_mul(limbs, &height, &height);
    pir_int den = pir_num3_dot(limbs, n, n);
    offer(w, &num, &den);
}

static int height_sign(pir_limbs *limbs, const pir_int3 *v, const pir_int3 *p, const pir_int3 *n) {
    uint32_t used = limbs->used;
    pir_int3 away = pir_num3_sub(limbs, v, p);
    pir_int height = pir_num3_dot(limbs, &away, n);
    limbs->used = used;
    return pir_int_sign(&height);
}

/* The sign of (q − p) · ((a − p) × (b − p)). */
static int around(pir_limbs *limbs, const pir_int3 *p, const pir_int3 *q, const pir_int3 *a, const pir_int3 *b) {
    uint32_t used = limbs->used;
    pir_int3 d = pir_num3_sub(limbs, q, p), x = pir_num3_sub(limbs, a, p), y = pir_num3_sub(limbs, b, p);
    pir_int3 cross = pir_num3_cross(limbs, &x, &y);
    pir_int sign = pir_num3_dot(limbs, &d, &cross);
    limbs->used = used;
    return pir_int_sign(&sign);
}

/* An edge whose ends are strictly on either side of a face: whether it goes through. Where an end is on the face, a
 * vertex and the face tell. */
static void try_piercing(struct distance_work *w, const pir_int3 *p, const pir_int3 *q, const pir_int3 tri[3],
                         const pir_int3 *n) {
    pir_limbs *limbs = w->limbs;
    if (height_sign(limbs, p, &tri[0], n) * height_sign(limbs, q, &tri[0], n) >= 0)
        return;
    int least = 1, most = -1;
    for (int k = 0; k < 3; k++) {
        int sign = around(limbs, p, q, &tri[k], &tri[(k + 1) % 3]);
        least = sign < least ? sign : least;
        most = sign > most ? sign : most;
    }
    if (least >= 0 || most <= 0)
        offer_zero(w);
}

/* The features of `a` against the face of `b`. */
static void try_face(struct distance_work *w, const pir_int3 a[3], const pir_int3 b[3]) {
    pir_limbs *limbs = w->limbs;
    uint32_t begin = limbs->used;
    pir_int3 e = pir_num3_sub(limbs, &b[1], &b[0]), f = pir_num3_sub(limbs, &b[2], &b[0]);
    pir_int3 n = pir_num3_cross(limbs, &e, &f);
    uint32_t used = limbs->used;
    for (int i = 0; i < 3 && !pir_int3_is_zero(&n) && !is_zero(w); i++) {
        try_vertex_face(w, &a[i], b, &n);
        limbs->used = used;
        try_piercing(w, &a[i], &a[(i + 1) % 3], b, &n);
        limbs->used = used;
    }
    limbs->used = begin;
}

void pir_exact_distance(pir_limbs *limbs, const pir_int3 a[3], const pir_int3 b[3], pir_exact_square *ret_square) {
    struct distance_work w = {limbs, ret_square, false};
    const uint32_t used = limbs->used;
    try_face(&w, a, b);
    try_face(&w, b, a);
    for (int i = 0; i < 3 && !is_zero(&w); i++)
        for (int j = 0; j < 3; j++) {
            try_vertices(&w, &a[i], &b[j]);
            limbs->used = used;
            try_vertex_edge(&w, &a[i], &b[j], &b[(j + 1) % 3]);
            limbs->used = used;
            try_vertex_edge(&w, &b[j], &a[i], &a[(i + 1) % 3]);
            limbs->used = used;
            try_edges(&w, &a[i], &a[(i + 1) % 3], &b[j], &b[(j + 1) % 3]);
            limbs->used = used;
        }
}
