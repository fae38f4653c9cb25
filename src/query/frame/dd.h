/* SPDX-License-Identifier: MIT */
/*
 * Double-double numbers. A number is an unevaluated sum hi + lo with |lo| ≤ ulp(hi)/2, about 106 bits (Dekker,
 * Numerische Mathematik 18, 1971).
 *
 * Queries use them where large, nearly equal positions are subtracted. Products are split by hand, so that the bits
 * are the same with and without fused hardware. Magnitudes must stay below 2^900.
 */
#ifndef PIR_QUERY_FRAME_DD_H
#define PIR_QUERY_FRAME_DD_H

#include "base/vec.h"

typedef struct pir_dd {
    double hi, lo;
} pir_dd;

typedef struct pir_dd3 {
    pir_dd c[3];
} pir_dd3;

static inline pir_dd pir_dd_quick_sum(double a, double b) {
    double s = a + b;
    return (pir_dd){s, b - (s - a)};
}

static inline pir_dd pir_dd_two_sum(double a, double b) {
    double s = a + b, t = s - a;
    return (pir_dd){s, (a - (s - t)) + (b - t)};
}

static inline pir_dd pir_dd_two_product(double a, double b) {
    double p = a * b, ta = 134217729.0 * a, tb = 134217729.0 * b; // 2^27 + 1
    double ah = ta - (ta - a), bh = tb - (tb - b), al = a - ah, bl = b - bh;
    return (pir_dd){p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

static inline pir_dd pir_dd_add(pir_dd a, pir_dd b) {
    pir_dd s = pir_dd_two_sum(a.hi, b.hi), t = pir_dd_two_sum(a.lo, b.lo);
    s = pir_dd_quick_sum(s.hi, s.lo + t.hi);
    return pir_dd_quick_sum(s.hi, s.lo + t.lo);
}

/* a + b for a double b, at half the work. */
static inline pir_dd pir_dd_add_double(pir_dd a, double b) {
    pir_dd s = pir_dd_two_sum(a.hi, b);
    return pir_dd_quick_sum(s.hi, s.lo + a.lo);
}

static inline pir_dd pir_dd_negate(pir_dd a) {
    return (pir_dd){-a.hi, -a.lo};
}

static inline pir_dd pir_dd_sub(pir_dd a, pir_dd b) {
    return pir_dd_add(a, pir_dd_negate(b));
}

static inline pir_dd pir_dd_scale(pir_dd a, double b) {
    pir_dd p = pir_dd_two_product(a.hi, b);
    return pir_dd_quick_sum(p.hi, p.lo + a.lo * b);
}

static inline pir_dd pir_dd_mul(pir_dd a, pir_dd b) {
    pir_dd p = pir_dd_two_product(a.hi, b.hi);
    return pir_dd_quick_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

static inline pir_dd pir_dd_divide(pir_dd a, pir_dd b) {
    double first = a.hi / b.hi;
    pir_dd rest = pir_dd_sub(a, pir_dd_scale(b, first));
    double second = rest.hi / b.hi;
    rest = pir_dd_sub(rest, pir_dd_scale(b, second));
    return pir_dd_add(pir_dd_quick_sum(first, second), (pir_dd){rest.hi / b.hi, 0});
}

static inline pir_dd3 pir_dd3_add_vec(pir_dd3 a, pir_vec3 b) {
    return (pir_dd3){{pir_dd_add_double(a.c[0], b.x), pir_dd_add_double(a.c[1], b.y), pir_dd_add_double(a.c[2], b.z)}};
}

static inline pir_dd3 pir_dd3_negate(pir_dd3 a) {
    return (pir_dd3){{pir_dd_negate(a.c[0]), pir_dd_negate(a.c[1]), pir_dd_negate(a.c[2])}};
}

/* a + b, rounded: pir_dd3_round of pir_dd3_add_vec, whose last step changes the sum by no bit. */
static inline pir_vec3 pir_dd3_add_rounded(pir_dd3 a, pir_vec3 b) {
    const pir_dd x = pir_dd_two_sum(a.c[0].hi, b.x), y = pir_dd_two_sum(a.c[1].hi, b.y),
                 z = pir_dd_two_sum(a.c[2].hi, b.z);
    return (pir_vec3){x.hi + (x.lo + a.c[0].lo), y.hi + (y.lo + a.c[1].lo), z.hi + (z.lo + a.c[2].lo)};
}

static inline pir_vec3 pir_dd3_round(pir_dd3 a) {
    return (pir_vec3){a.c[0].hi + a.c[0].lo, a.c[1].hi + a.c[1].lo, a.c[2].hi + a.c[2].lo};
}

#endif
