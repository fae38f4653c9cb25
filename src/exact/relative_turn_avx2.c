/* SPDX-License-Identifier: MIT */
/*
 * Rotations in doubles by AVX2 and FMA: see relative_turn.h.
 *
 * The rest that rounding leaves of a product a·b is a double, where it is not below 2^-1074. A fused
 * a·b − round(a·b) is that double, as Dekker's product of halves is. All else is the operations of `rotation` and
 * `quat_product` in their order, never fused, so the bits are the same.
 *
 * Lanes are x, y, z and w.
 */
#define PIR_LANES_AVX2 1
#include "exact/relative_turn.h"

#include "base/lane_text.h"

#define TARGET __attribute__((target("avx2,fma")))
#define INLINE TARGET static inline __attribute__((always_inline))

#define LANES(v, x, y, z, w) _mm256_permute4x64_pd(v, _MM_SHUFFLE(w, z, y, x))
#define SIGNS(x, y, z, w)    ((pir_lane){x, y, z, w})

/* Two numbers at a time, as they are mostly stored. */
INLINE pir_lane lanes_of(const pir_quat *q) {
    return _mm256_set_m128d(_mm_loadu_pd(&q->z), _mm_loadu_pd(&q->x));
}

INLINE void store(pir_quat *to, pir_lane v) {
    _mm256_storeu_pd(&to->x, v);
}

INLINE bool is_taken(pir_lane q) {
    const pir_lane size = pir_size(q);
    const pir_lane_bits is_zero = q == pir_all(0), is_ample = size >= pir_all(PIR_RELATIVE_LEAST),
                        is_most = size >= pir_all(PIR_RELATIVE_MOST);
    return _mm256_movemask_pd((pir_lane)((is_zero | is_ample) & (size < pir_all(1)))) == 15 &&
           _mm256_movemask_pd((pir_lane)is_most) != 0;
}

/* The one of q and −q that stands for their rotation: see pir_quat_signed. */
INLINE pir_lane with_sign(pir_lane q) {
    // w is to come first
    const pir_lane c = LANES(q, 3, 0, 1, 2);
    const int other = _mm256_movemask_pd((pir_lane)(c != pir_all(0))), below = _mm256_movemask_pd(c);
    const double sign = other & -other & below ? -1 : 1;
    return q * pir_all(sign) + pir_all(0);
}

/*
 * The doubles of a quaternion with its sign, of the given squares and |q|²: see pir_doubles_as_given. The quaternion
 * of the other sign has the same matrix, but for signs of zeros, and is there sooner.
 */
INLINE void set(pir_lane given, pir_lane square, double n, pir_quat *ret_unit, pir_mat3 *ret_r) {
    const pir_lane with = with_sign(given);
    const pir_lane q = _mm256_movemask_pd((pir_lane)(given == pir_all(0))) ? with : given;
    const double by = 1 / n, shrink = fabs(n - 1) <= 0x1p-50 ? 1 : 1 / sqrt(n);
    const pir_lane one = pir_all(by), two = pir_all(2);
    const pir_lane diagonal =
        (LANES(square, 3, 3, 3, 3) + LANES(square, 0, 0, 0, 0) * SIGNS(1, -1, -1, 0) +
         LANES(square, 1, 1, 1, 1) * SIGNS(-1, 1, -1, 0) + LANES(square, 2, 2, 2, 2) * SIGNS(-1, -1, 1, 0)) *
        one;
    // yz, xz, xy, and wx, wy, wz
    const pir_lane of_v = LANES(q, 1, 0, 0, 3) * LANES(q, 2, 2, 1, 3), of_w = q * LANES(q, 3, 3, 3, 3);
    // entries 21, 02 and 10, then 12, 20 and 01
    const pir_lane plus = two * (of_v + of_w) * one, minus = two * (of_v - of_w) * one;
    const pir_lane first = _mm256_blend_pd(diagonal, LANES(minus, 2, 2, 2, 2), 2);
    const pir_lane second = _mm256_blend_pd(LANES(minus, 0, 0, 1, 1), LANES(diagonal, 1, 1, 1, 1), 1);
    store(ret_unit, with * pir_all(shrink));
    // entries in pairs as they lie, as readers take them
    _mm256_storeu_pd(&ret_r->m[0][0], _mm256_blend_pd(first, LANES(plus, 1, 2, 1, 2), 12));
    _mm256_storeu_pd(&ret_r->m[1][1], _mm256_blend_pd(second, LANES(plus, 0, 0, 0, 0), 8));
    ret_r->m[2][2] = diagonal[2];
}

INLINE double norm_of(pir_lane square) {
    return square[0] + square[1] + square[2] + square[3];
}

/* Sums of products lane by lane, and what rounding leaves of them: see pir_two_sums. */
struct sums {
    pir_lane sum, rest;
};

INLINE struct sums add(struct sums to, pir_lane p, pir_lane q) {
    const pir_lane product = p * q, lost = _mm256_fmsub_pd(p, q, product);
    const pir_lane s = to.sum + product, t = s - to.sum;
    to.rest += ((to.sum - (s - t)) + (product - t)) + lost;
    to.sum = s;
    return to;
}

TARGET static bool find(const pir_quat *of_q, const pir_quat *of_p, pir_quat_product *ret_product, pir_quat *ret_unit,
                        pir_mat3 *ret_r) {
    const pir_lane q = lanes_of(of_q), p = lanes_of(of_p), zero = pir_all(0);
    if (!is_taken(q) || !is_taken(p))
        return false;
    const pir_lane w = LANES(q, 3, 3, 3, 3), first = w * p;
    struct sums sums = {zero + first, zero + _mm256_fmsub_pd(w, p, first)};
    sums = add(sums, LANES(q, 0, 1, 2, 1) * SIGNS(-1, -1, -1, 1), LANES(p, 3, 3, 3, 1));
    sums = add(sums, LANES(q, 1, 2, 0, 2) * SIGNS(-1, -1, -1, 1), LANES(p, 2, 0, 1, 2));
    sums = add(sums, LANES(q, 2, 0, 1, 0), LANES(p, 1, 2, 0, 0));
    const pir_lane whole = sums.sum + sums.rest, square = whole * whole;
    store(&ret_product->whole, whole);
    store(&ret_product->rest, sums.rest - (whole - sums.sum));
    set(whole, square, norm_of(square), ret_unit, ret_r);
    return true;
}

TARGET static bool turn(const pir_quat *of_q, pir_quat *ret_unit, pir_mat3 *ret_r) {
    const pir_lane q = lanes_of(of_q), square = q * q;
    const double n = norm_of(square);
    if (!(n >= PIR_NORM_NEAR_ONE && n <= 1 / PIR_NORM_NEAR_ONE))
        return false;
    set(q, square, n, ret_unit, ret_r);
    return true;
}

const pir_relative_version pir_relative_avx2 = {find, turn};
