/* SPDX-License-Identifier: MIT */
/*
 * The product conj(a)·b of two quaternions of doubles: for each component four products, in rows, with what rounding
 * leaves of them and of their sums added up beside (Ogita, Rump and Oishi, SIAM J. Scientific Computing 26, 2005). Off
 * by u of itself and by some u² of |a||b|. Component x is aw bx − ax bw − ay bz + az by, and so on round.
 * Component w is aw bw + ax bx + ay by + az bz.
 *
 * Components lie in pairs, x and y, z and w, as registers hold them: a number that is stored alone and read in a pair
 * would have to reach the cache before.
 */
#ifndef PIR_EXACT_QUAT_PRODUCT_H
#define PIR_EXACT_QUAT_PRODUCT_H

#include "exact/rotation.h"

/* A product, and what it leaves, rounded. */
typedef struct pir_quat_product {
    pir_quat whole, rest;
} pir_quat_product;

typedef double pir_two_doubles __attribute__((vector_size(16)));

/* Numbers with their halves, of 26 bits each, for products without loss (Dekker, 1971). */
typedef struct pir_two_halved {
    pir_two_doubles whole, high, low;
} pir_two_halved;

static inline pir_two_halved pir_two_halve(double c, double d) {
    const pir_two_doubles whole = {c, d}, t = 134217729.0 * whole, high = t - (t - whole); // 2^27 + 1
    return (pir_two_halved){whole, high, whole - high};
}

/* Number i of a beside number j of b. */
static inline pir_two_halved pir_two_beside(const pir_two_halved *a, int i, const pir_two_halved *b, int j) {
    return (pir_two_halved){{a->whole[i], b->whole[j]}, {a->high[i], b->high[j]}, {a->low[i], b->low[j]}};
}

/* Two sums, and what rounding leaves of them. */
typedef struct pir_two_sums {
    pir_two_doubles sum, rest;
} pir_two_sums;

/* The rest that rounding leaves of a product. */
static inline pir_two_doubles pir_two_lost(const pir_two_halved *p, const pir_two_halved *q, pir_two_doubles product) {
    return ((p->high * q->high - product) + p->high * q->low + p->low * q->high) + p->low * q->low;
}

/* The sums of one product each; added to 0, so that none is -0. */
static inline pir_two_sums pir_two_begin(pir_two_halved p, pir_two_halved q) {
    const pir_two_doubles product = p.whole * q.whole, zero = {0, 0};
    return (pir_two_sums){zero + product, zero + pir_two_lost(&p, &q, product)};
}

/* Adds a product, times signs, to each of two sums, and what rounding leaves of it and of the sum to the rest. */
static inline void pir_two_add(pir_two_sums *to, pir_two_halved p, pir_two_doubles sign, pir_two_halved q) {
    p.whole *= sign;
    p.high *= sign;
    p.low *= sign;
    const pir_two_doubles product = p.whole * q.whole, lost = pir_two_lost(&p, &q, product);
    const pir_two_doubles s = to->sum + product, t = s - to->sum;
    to->rest += ((to->sum - (s - t)) + (product - t)) + lost;
    to->sum = s;
}

/* Components of quaternions that are finite, and whose product is below 2^900. */
static inline pir_quat_product pir_quat_conjugate_times(pir_quat a, pir_quat b) {
    const pir_two_halved p = pir_two_halve(a.x, a.y), p_zw = pir_two_halve(a.z, a.w);
    const pir_two_halved q = pir_two_halve(b.x, b.y), q_zw = pir_two_halve(b.z, b.w);
    const pir_two_doubles plus = {1, 1}, minus = {-1, -1}, last = {-1, 1};
    pir_two_sums xy = pir_two_begin(pir_two_beside(&p_zw, 1, &p_zw, 1), q);
    pir_two_sums zw = pir_two_begin(pir_two_beside(&p_zw, 1, &p_zw, 1), q_zw);
    pir_two_add(&xy, p, minus, pir_two_beside(&q_zw, 1, &q_zw, 1));
    pir_two_add(&zw, pir_two_beside(&p_zw, 0, &p, 1), last, pir_two_beside(&q_zw, 1, &q, 1));
    pir_two_add(&xy, pir_two_beside(&p, 1, &p_zw, 0), minus, pir_two_beside(&q_zw, 0, &q, 0));
    pir_two_add(&zw, pir_two_beside(&p, 0, &p_zw, 0), last, pir_two_beside(&q, 1, &q_zw, 0));
    pir_two_add(&xy, pir_two_beside(&p_zw, 0, &p, 0), plus, pir_two_beside(&q, 1, &q_zw, 0));
    pir_two_add(&zw, pir_two_beside(&p, 1, &p, 0), plus, pir_two_beside(&q, 0, &q, 0));
    const pir_two_doubles low = xy.sum + xy.rest, high = zw.sum + zw.rest;
    const pir_two_doubles rest_low = xy.rest - (low - xy.sum), rest_high = zw.rest - (high - zw.sum);
    return (pir_quat_product){{low[0], low[1], high[0], high[1]},
                              {rest_low[0], rest_low[1], rest_high[0], rest_high[1]}};
}

/* Sets a relative rotation whose doubles are kept elsewhere, as pir_rotation_set_given does. */
static inline void pir_rotation_set_factors(pir_rotation *rotation, const pir_quat_product *product, pir_quat q,
                                            pir_quat p) {
    rotation->given = product->whole;
    rotation->rest = product->rest;
    rotation->relative = true;
    rotation->factor[0] = q;
    rotation->factor[1] = p;
    rotation->has_exact = false;
}

#endif
