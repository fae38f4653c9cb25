/* SPDX-License-Identifier: MIT */
/*
 * Arrays of exact vectors.
 *
 * The bound of pir_int3_unit, with u = 2^-53: converting a component errs by 1.001u relative; the sum of squares by
 * 2.01u + 3.01u, its root by half that and another u; the quotient by one more u. Altogether below 1.01u + 3.52u +
 * 1.01u < 6u relative in each component, so below 6u in length. Components below 2^-1000 of the largest may lose more,
 * less than 2^-900 in all. 8u holds both (tests/proofs/unit.g).
 */
#include "exact/vectors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool pir_vectors_init(pir_vectors *vectors, const pir_allocator *allocator, uint32_t count, uint32_t stride) {
    size_t limbs = (size_t)count * 3 * stride;
    mp_limb_t *limb = PIR_NEW(allocator, mp_limb_t, limbs);
    int32_t *size = PIR_ZEROED(allocator, int32_t, (size_t)count * 3);
    if (!limb || !size) {
        PIR_FREE(allocator, limb, limbs);
        PIR_FREE(allocator, size, (size_t)count * 3);
        *vectors = (pir_vectors){0};
        return false;
    }
    *vectors = (pir_vectors){limb, size, count, stride};
    return true;
}

void pir_vectors_finish(pir_vectors *vectors, const pir_allocator *allocator) {
    PIR_FREE(allocator, vectors->limb, (size_t)vectors->count * 3 * vectors->stride);
    PIR_FREE(allocator, vectors->size, (size_t)vectors->count * 3);
    *vectors = (pir_vectors){0};
}

void pir_vectors_set(pir_vectors *vectors, uint32_t index, const pir_int3 *v) {
    pir_int3 to = pir_vectors_at(vectors, index);
    for (int k = 0; k < 3; k++) {
        pir_int_copy(&to.c[k], &v->c[k]);
    }
    pir_vectors_put(vectors, index, &to);
}

uint32_t pir_vectors_bits(const pir_vectors *vectors) {
    uint32_t most = 0;
    for (uint32_t i = 0; i < vectors->count; i++) {
        pir_int3 v = pir_vectors_at(vectors, i);
        for (int k = 0; k < 3; k++) {
            uint32_t bits = pir_int_bits(&v.c[k]);
            most = bits > most ? bits : most;
        }
    }
    return most;
}

void pir_int3_strip(pir_int3 *v) {
    uint32_t zeros = UINT32_MAX;
    for (int k = 0; k < 3; k++) {
        uint32_t z = pir_int_trailing_zeros(&v->c[k]);
        zeros = z < zeros ? z : zeros;
    }
    if (zeros == UINT32_MAX || zeros == 0)
        return;
    for (int k = 0; k < 3; k++)
        pir_int_shift_right(&v->c[k], zeros);
}

/* The longest component of all, in limbs, at least 1. */
static uint32_t longest_of(const pir_vectors *vectors) {
    uint32_t longest = 1;
    for (size_t i = 0; i < (size_t)vectors->count * 3; i++)
        if ((uint32_t)abs(vectors->size[i]) > longest)
            longest = (uint32_t)abs(vectors->size[i]);
    return longest;
}

/* Divides vector `index` by the greatest common divisor of its components. */
static void reduce(pir_vectors *vectors, uint32_t index, mpz_t divisor, mpz_t quotient) {
    pir_int3 v = pir_vectors_at(vectors, index);
    mpz_t view;
    mpz_set_ui(divisor, 0);
    for (int k = 0; k < 3; k++)
        mpz_gcd(divisor, divisor, mpz_roinit_n(view, v.c[k].limb, v.c[k].size));
    if (mpz_cmp_ui(divisor, 1) <= 0)
        return;
    for (int k = 0; k < 3; k++) {
        mpz_divexact(quotient, mpz_roinit_n(view, v.c[k].limb, v.c[k].size), divisor);
        pir_int whole = {(mp_limb_t *)mpz_limbs_read(quotient), mpz_sgn(quotient) * (int32_t)mpz_size(quotient), 0};
        pir_int_copy(&v.c[k], &whole);
    }
    pir_vectors_put(vectors, index, &v);
}

bool pir_vectors_reduce(pir_vectors *vectors, const pir_allocator *allocator) {
    mpz_t divisor, quotient;
    mpz_inits(divisor, quotient, NULL);
    for (uint32_t i = 0; i < vectors->count; i++)
        reduce(vectors, i, divisor, quotient);
    mpz_clears(divisor, quotient, NULL);
    pir_vectors shorter;
    if (!pir_vectors_init(&shorter, allocator, vectors->count, longest_of(vectors)))
        return false;
    for (uint32_t i = 0; i < vectors->count; i++) {
        pir_int3 v = pir_vectors_at(vectors, i);
        pir_vectors_set(&shorter, i, &v);
    }
    pir_vectors_finish(vectors, allocator);
    *vectors = shorter;
    return true;
}

/* x · 2^exponent as ldexp gives it, without a call where the power is a normal number. */
static inline double pir_times_power(double x, int exponent) {
    if (exponent < -1022 || exponent > 1023)
        return ldexp(x, exponent);
    uint64_t bits = (uint64_t)(exponent + 1023) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return x * power;
}

pir_vec3 pir_int3_unit(const pir_int3 *v) {
    // mantissas and exponents, then all on the scale of the largest
    double m[3];
    int e[3], top = 0;
    bool any = false;
    for (int k = 0; k < 3; k++) {
        m[k] = pir_int_to_double(&v->c[k], &e[k]);
        if (m[k] != 0 && (!any || e[k] > top)) {
            top = e[k];
            any = true;
        }
    }
    for (int k = 0; k < 3; k++)
        m[k] = m[k] != 0 ? pir_times_power(m[k], e[k] - top) : 0;
    double length = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    return (pir_vec3){m[0] / length, m[1] / length, m[2] / length};
}

/* A copy of `a` in a block of exactly its length. */
static bool int_duplicate(pir_int *dst, const pir_allocator *allocator, const pir_int *a) {
    dst->room = pir_int_length(a);
    dst->limb = PIR_NEW(allocator, mp_limb_t, dst->room);
    if (!dst->limb)
        return false;
    pir_int_copy(dst, a);
    return true;
}

bool pir_scale_copy(pir_scale *dst, const pir_allocator *allocator, const pir_scale *scale) {
    *dst = (pir_scale){{NULL, 0, 0}, {NULL, 0, 0}};
    if (int_duplicate(&dst->num, allocator, &scale->num) && int_duplicate(&dst->den, allocator, &scale->den))
        return true;
    pir_scale_finish(dst, allocator);
    return false;
}

bool pir_scale_init_power(pir_scale *dst, const pir_allocator *allocator, int exponent) {
    // 2^1100 takes fewer limbs than this
    mp_limb_t power_limbs[1100 / GMP_NUMB_BITS + 2], one_limb = 1;
    pir_int one = {&one_limb, 1, 0}, power = {power_limbs, 0, sizeof power_limbs / sizeof *power_limbs};
    pir_int_shift_left(&power, &one, (uint32_t)abs(exponent));
    pir_scale scale = exponent < 0 ? (pir_scale){one, power} : (pir_scale){power, one};
    return pir_scale_copy(dst, allocator, &scale);
}

void pir_scale_finish(pir_scale *scale, const pir_allocator *allocator) {
    PIR_FREE(allocator, scale->num.limb, pir_int_length(&scale->num));
    PIR_FREE(allocator, scale->den.limb, pir_int_length(&scale->den));
    *scale = (pir_scale){{NULL, 0, 0}, {NULL, 0, 0}};
}

double pir_scaled_nearest_double(const pir_int *a, const pir_int *num, const pir_int *den) {
    if (a->size == 0)
        return 0;
    mpz_t n, d, quotient, rest, view, factor;
    mpz_inits(n, d, quotient, rest, NULL);
    mpz_mul(n, mpz_roinit_n(view, a->limb, pir_int_length(a)), mpz_roinit_n(factor, num->limb, num->size));
    mpz_set(d, mpz_roinit_n(view, den->limb, den->size));
    // A quotient of at least 65 bits with its last bit sticky rounds as the exact number does, unless the result is
    // subnormal.
    long shift = (long)mpz_sizeinbase(d, 2) - (long)mpz_sizeinbase(n, 2) + 66;
    if (shift > 0)
        mpz_mul_2exp(n, n, (mp_bitcnt_t)shift);
    else
        mpz_mul_2exp(d, d, (mp_bitcnt_t)-shift);
    mpz_tdiv_qr(quotient, rest, n, d);
    if (mpz_sgn(rest) != 0)
        mpz_setbit(quotient, 0);
    // round the integer to 53 bits, or to the subnormal grid 2^-1074, half to even
    long bits = (long)mpz_sizeinbase(quotient, 2), drop = bits - 53;
    if (shift - drop > 1074)
        drop = shift - 1074;
    if (drop > 0) {
        bool half = mpz_tstbit(quotient, (mp_bitcnt_t)drop - 1) != 0;
        bool below = drop > 1 && mpz_scan1(quotient, 0) < (mp_bitcnt_t)drop - 1;
        mpz_tdiv_q_2exp(quotient, quotient, (mp_bitcnt_t)drop);
        if (half && (below || mpz_odd_p(quotient)))
            mpz_add_ui(quotient, quotient, 1);
        shift -= drop;
    }
    double value = ldexp(mpz_get_d(quotient), (int)-shift);
    mpz_clears(n, d, quotient, rest, NULL);
    return a->size < 0 ? -value : value;
}

void pir_scale_to_rational(mpq_t to, const pir_int *a, const pir_scale *scale) {
    mpz_t whole, num, den;
    mpz_mul(mpq_numref(to), mpz_roinit_n(whole, a->limb, a->size), mpz_roinit_n(num, scale->num.limb, scale->num.size));
    mpz_set(mpq_denref(to), mpz_roinit_n(den, scale->den.limb, scale->den.size));
    mpq_canonicalize(to);
}
