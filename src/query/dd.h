/* SPDX-License-Identifier: MIT */
/*
 * Double-double numbers: an unevaluated sum hi + lo with |lo| ≤ ulp(hi)/2, about 106 bits (Dekker, Numerische Mathematik 18, 1971).
 *
 * Used where a difference of large, nearly equal positions is the answer. Products are split by hand, so that the bits are the same
 * with and without fused hardware. Magnitudes must stay below 2^900.
 */
#ifndef PIR_QUERY_DD_H
#define PIR_QUERY_DD_H

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

static inline bool pir_dd_less(pir_dd a, pir_dd b) {
    return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo);
}

static inline pir_dd pir_dd_divide(pir_dd a, pir_dd b) {
    double first = a.hi / b.hi;
    pir_dd rest = pir_dd_sub(a, pir_dd_scale(b, first));
    double second = rest.hi / b.hi;
    rest = pir_dd_sub(rest, pir_dd_scale(b, second));
    return pir_dd_add(pir_dd_quick_sum(first, second), (pir_dd){rest.hi / b.hi, 0});
}

static inline pir_dd3 pir_dd3_from(pir_vec3 v) {
    return (pir_dd3){{{v.x, 0}, {v.y, 0}, {v.z, 0}}};
}

static inline pir_dd3 pir_dd3_add(pir_dd3 a, pir_dd3 b) {
    return (pir_dd3){{pir_dd_add(a.c[0], b.c[0]), pir_dd_add(a.c[1], b.c[1]), pir_dd_add(a.c[2], b.c[2])}};
}

static inline pir_dd3 pir_dd3_add_vec(pir_dd3 a, pir_vec3 b) {
    return (pir_dd3){{pir_dd_add_double(a.c[0], b.x), pir_dd_add_double(a.c[1], b.y), pir_dd_add_double(a.c[2], b.z)}};
}

static inline pir_dd3 pir_dd3_negate(pir_dd3 a) {
    return (pir_dd3){{pir_dd_negate(a.c[0]), pir_dd_negate(a.c[1]), pir_dd_negate(a.c[2])}};
}

static inline pir_dd3 pir_dd3_sub(pir_dd3 a, pir_dd3 b) {
    return (pir_dd3){{pir_dd_sub(a.c[0], b.c[0]), pir_dd_sub(a.c[1], b.c[1]), pir_dd_sub(a.c[2], b.c[2])}};
}

static inline pir_vec3 pir_dd3_round(pir_dd3 a) {
    return (pir_vec3){a.c[0].hi + a.c[0].lo, a.c[1].hi + a.c[1].lo, a.c[2].hi + a.c[2].lo};
}

static inline pir_dd3 pir_dd3_times(pir_dd3 a, pir_dd s) {
    return (pir_dd3){{pir_dd_mul(a.c[0], s), pir_dd_mul(a.c[1], s), pir_dd_mul(a.c[2], s)}};
}

static inline pir_dd pir_dd3_product(pir_dd3 a, pir_dd3 b) {
    return pir_dd_add(pir_dd_add(pir_dd_mul(a.c[0], b.c[0]), pir_dd_mul(a.c[1], b.c[1])), pir_dd_mul(a.c[2], b.c[2]));
}

static inline pir_dd3 pir_dd3_cross(pir_dd3 a, pir_dd3 b) {
    pir_dd3 r;
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        r.c[k] = pir_dd_sub(pir_dd_mul(a.c[i], b.c[j]), pir_dd_mul(a.c[j], b.c[i]));
    }
    return r;
}

/* a·b for a vector of doubles b. */
static inline pir_dd pir_dd3_dot(pir_dd3 a, pir_vec3 b) {
    return pir_dd_add(pir_dd_add(pir_dd_scale(a.c[0], b.x), pir_dd_scale(a.c[1], b.y)), pir_dd_scale(a.c[2], b.z));
}

#endif
