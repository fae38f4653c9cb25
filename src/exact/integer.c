/* SPDX-License-Identifier: MIT */
/*
 * Integers over mpn. Signs and lengths are handled here; the limbs are GMP's. See integer.h for the invariant.
 */
#include "exact/integer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void pir_int_outgrown(void) {
    fputs("pirouette: an integer would outgrow the memory that is reserved for it: a bug, please report it\n", stderr);
    abort();
}

/* Drops zero limbs from the top of n limbs. */
static int32_t normal_size(const mp_limb_t *limb, uint32_t n) {
    while (n > 0 && limb[n - 1] == 0)
        n--;
    return (int32_t)n;
}

void pir_int_copy(pir_int *dst, const pir_int *a) {
    pir_int_check_room(dst->room, pir_int_length(a));
    memcpy(dst->limb, a->limb, pir_int_length(a) * sizeof(mp_limb_t));
    dst->size = a->size;
}

void pir_int_mul(pir_int *dst, const pir_int *a, const pir_int *b) {
    uint32_t na = pir_int_length(a), nb = pir_int_length(b);
    if (na == 0 || nb == 0) {
        dst->size = 0;
        return;
    }
    pir_int_check_room(dst->room, (size_t)na + nb);
    if (nb == 1)
        dst->limb[na] = mpn_mul_1(dst->limb, a->limb, na, b->limb[0]);
    else if (na == 1)
        dst->limb[nb] = mpn_mul_1(dst->limb, b->limb, nb, a->limb[0]);
    else if (na == nb && a->limb == b->limb)
        mpn_sqr(dst->limb, a->limb, na);
    else if (na >= nb)
        mpn_mul(dst->limb, a->limb, na, b->limb, nb);
    else
        mpn_mul(dst->limb, b->limb, nb, a->limb, na);
    int32_t size = (int32_t)(na + nb) - (dst->limb[na + nb - 1] == 0);
    dst->size = (a->size < 0) != (b->size < 0) ? -size : size;
}

/* dst = a + b with b's sign replaced by that of `size_b`. */
static void add_signed(pir_int *dst, const pir_int *a, const pir_int *b, int32_t size_b) {
    uint32_t na = pir_int_length(a), nb = pir_int_length(b);
    const mp_limb_t *la = a->limb, *lb = b->limb;
    int32_t size_a = a->size;
    // let a be the longer
    if (na < nb) {
        const mp_limb_t *l = la;
        la = lb;
        lb = l;
        uint32_t n = na;
        na = nb;
        nb = n;
        int32_t s = size_a;
        size_a = size_b;
        size_b = s;
    }
    pir_int_check_room(dst->room, na);
    if (nb == 0) {
        if (dst->limb != la)
            memcpy(dst->limb, la, na * sizeof(mp_limb_t));
        dst->size = size_a;
        return;
    }
    if ((size_a < 0) == (size_b < 0)) {
        mp_limb_t carry = mpn_add(dst->limb, la, na, lb, nb);
        if (carry) {
            pir_int_check_room(dst->room, (size_t)na + 1);
            dst->limb[na] = carry;
        }
        int32_t size = (int32_t)(na + (carry != 0));
        dst->size = size_a < 0 ? -size : size;
        return;
    }
    // opposite signs: the larger magnitude less the smaller
    if (na == nb && mpn_cmp(la, lb, na) < 0) {
        mpn_sub_n(dst->limb, lb, la, na);
        size_a = -size_a;
    } else {
        mpn_sub(dst->limb, la, na, lb, nb);
    }
    int32_t size = normal_size(dst->limb, na);
    dst->size = size_a < 0 ? -size : size;
}

void pir_int_add(pir_int *dst, const pir_int *a, const pir_int *b) {
    add_signed(dst, a, b, b->size);
}

void pir_int_sub(pir_int *dst, const pir_int *a, const pir_int *b) {
    add_signed(dst, a, b, -b->size);
}

void pir_int_add_mul(pir_int *dst, const pir_int *a, const pir_int *b, pir_limbs *scratch) {
    if (a->size == 0 || b->size == 0)
        return;
    uint32_t mark = scratch->used;
    pir_int product = pir_limbs_take(scratch, pir_int_length(a) + pir_int_length(b));
    pir_int_mul(&product, a, b);
    add_signed(dst, dst, &product, product.size);
    scratch->used = mark;
}

void pir_int_sub_mul(pir_int *dst, const pir_int *a, const pir_int *b, pir_limbs *scratch) {
    pir_int minus = {a->limb, -a->size, 0};
    pir_int_add_mul(dst, &minus, b, scratch);
}

/* --- sums of products --- */

/* Sums of products up to this many limbs are made in one go. */
#define SHORT_LIMBS 16

/* Holds a product of two limbs. */
#if GMP_NUMB_BITS == 64
__extension__ typedef unsigned __int128 two_limbs;
#else
typedef uint64_t two_limbs;
#endif

/* sum += a·b, the sum having room for what is carried. */
static inline void add_row(mp_limb_t *sum, const mp_limb_t *a, uint32_t na, mp_limb_t b) {
    mp_limb_t carry = 0;
    for (uint32_t i = 0; i < na; i++) {
        two_limbs t = (two_limbs)a[i] * b + sum[i] + carry;
        sum[i] = (mp_limb_t)t;
        carry = (mp_limb_t)(t >> GMP_NUMB_BITS);
    }
    for (sum += na; carry; sum++) {
        *sum += carry;
        carry = *sum < carry;
    }
}

/* dst = a − b for a ≥ b of `length` limbs. Returns how many limbs it has. */
static inline int32_t subtract(mp_limb_t *dst, const mp_limb_t *a, const mp_limb_t *b, uint32_t length) {
    mp_limb_t borrow = 0;
    int32_t size = 0;
    for (uint32_t i = 0; i < length; i++) {
        mp_limb_t less = a[i] - b[i], limb = less - borrow;
        borrow = (a[i] < b[i]) | (less < borrow);
        if (limb != 0) {
            // limbs below that are written, and those above the last that is not zero are not
            for (; size < (int32_t)i; size++)
                dst[size] = 0;
            dst[size++] = limb;
        }
    }
    return size;
}

/* The limbs of the longest product. */
static inline uint32_t longest_product(const pir_term *terms, uint32_t count) {
    uint32_t longest = 0;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t length = pir_int_length(terms[k].a) + pir_int_length(terms[k].b);
        longest = length > longest ? length : longest;
    }
    return longest;
}

/*
 * The sum as the difference of those that count and those that count against it, each in `room` limbs. Four products of
 * a length need one limb more. Short operands are the common case, and calls of mpn take longer than their work there.
 */
static inline void sum_short(pir_int *dst, const pir_term *terms, uint32_t count, uint32_t length, mp_limb_t *sums,
                             uint32_t room) {
    for (uint32_t k = 0; k < count; k++) {
        const pir_int *a = terms[k].a, *b = terms[k].b;
        uint32_t na = pir_int_length(a), nb = pir_int_length(b);
        mp_limb_t *sum = sums + (((a->size < 0) != (b->size < 0)) != terms[k].minus ? room : 0);
        for (uint32_t j = 0; j < nb; j++)
            add_row(sum + j, a->limb, na, b->limb[j]);
    }
    uint32_t top = length;
    while (top > 0 && sums[top - 1] == sums[room + top - 1])
        top--;
    bool negative = top > 0 && sums[top - 1] < sums[room + top - 1];
    pir_int_check_room(dst->room, top);
    int32_t size = subtract(dst->limb, negative ? sums + room : sums, negative ? sums : sums + room, top);
    dst->size = negative ? -size : size;
}

void pir_int_sum(pir_int *dst, const pir_term *terms, uint32_t count, pir_limbs *scratch) {
    uint32_t length = longest_product(terms, count) + 1;
    if (length <= SHORT_LIMBS / 2) {
        mp_limb_t sums[SHORT_LIMBS] = {0};
        sum_short(dst, terms, count, length, sums, SHORT_LIMBS / 2);
        return;
    }
    if (length <= SHORT_LIMBS) {
        mp_limb_t sums[2 * SHORT_LIMBS] = {0};
        sum_short(dst, terms, count, length, sums, SHORT_LIMBS);
        return;
    }
    dst->size = 0;
    for (uint32_t k = 0; k < count; k++)
        if (terms[k].minus)
            pir_int_sub_mul(dst, terms[k].a, terms[k].b, scratch);
        else
            pir_int_add_mul(dst, terms[k].a, terms[k].b, scratch);
}

void pir_int_shift_left(pir_int *dst, const pir_int *a, uint32_t bits) {
    uint32_t n = pir_int_length(a), whole = bits / GMP_NUMB_BITS, rest = bits % GMP_NUMB_BITS;
    if (n == 0) {
        dst->size = 0;
        return;
    }
    pir_int_check_room(dst->room, (size_t)n + whole);
    mp_limb_t carry = 0;
    if (rest)
        carry = mpn_lshift(dst->limb + whole, a->limb, n, rest);
    else
        memmove(dst->limb + whole, a->limb, n * sizeof(mp_limb_t));
    memset(dst->limb, 0, whole * sizeof(mp_limb_t));
    n += whole;
    if (carry) {
        pir_int_check_room(dst->room, (size_t)n + 1);
        dst->limb[n++] = carry;
    }
    dst->size = a->size < 0 ? -(int32_t)n : (int32_t)n;
}

void pir_int_shift_right(pir_int *a, uint32_t bits) {
    uint32_t n = pir_int_length(a), whole = bits / GMP_NUMB_BITS, rest = bits % GMP_NUMB_BITS;
    if (n == 0 || bits == 0)
        return;
    n -= whole;
    if (rest)
        mpn_rshift(a->limb, a->limb + whole, n, rest);
    else
        memmove(a->limb, a->limb + whole, n * sizeof(mp_limb_t));
    int32_t size = normal_size(a->limb, n);
    a->size = a->size < 0 ? -size : size;
}

uint32_t pir_int_trailing_zeros(const pir_int *a) {
    if (a->size == 0)
        return UINT32_MAX;
    // most are odd, or end within a limb; the top limb is not zero, so the scan ends
    return a->limb[0] != 0 ? (uint32_t)__builtin_ctzll(a->limb[0]) : (uint32_t)mpn_scan1(a->limb, GMP_NUMB_BITS);
}

uint32_t pir_int_bits(const pir_int *a) {
    uint32_t n = pir_int_length(a);
    // limbs are of GMP_NUMB_BITS, counted as 64
    return n ? n * GMP_NUMB_BITS - (uint32_t)(__builtin_clzll(a->limb[n - 1]) - (64 - GMP_NUMB_BITS)) : 0;
}

uint32_t pir_double_limbs(int top, int exponent) {
    return top <= exponent ? 1 : (uint32_t)(top - exponent + GMP_NUMB_BITS - 1) / GMP_NUMB_BITS + 1;
}

void pir_int_set_double(pir_int *dst, double x, int exponent) {
    if (x == 0) {
        dst->size = 0;
        return;
    }
    int shift;
    uint64_t mantissa = pir_double_split(x, &shift);
    shift -= exponent;
    if (shift < 0) {
        PIR_ASSERT(shift > -64 && (mantissa & (((uint64_t)1 << -shift) - 1)) == 0);
        mantissa >>= -shift;
        shift = 0;
    }
    mp_limb_t limbs[2] = {(mp_limb_t)mantissa, 0};
#if GMP_NUMB_BITS < 64
    limbs[1] = (mp_limb_t)(mantissa >> GMP_NUMB_BITS);
#endif
    int32_t length = limbs[1] != 0 ? 2 : 1;
    pir_int whole = {limbs, x < 0 ? -length : length, 0};
    pir_int_shift_left(dst, &whole, (uint32_t)shift);
}

double pir_int_to_double(const pir_int *a, int *ret_exponent) {
    uint32_t n = pir_int_length(a), bits = pir_int_bits(a);
    if (n == 0) {
        *ret_exponent = 0;
        return 0;
    }
    // the top 64 bits: what is cut off is below 2^-63 of the value
    uint32_t top = bits - (n - 1) * GMP_NUMB_BITS;
    int at = 64 - (int)top;
    uint64_t head = (uint64_t)a->limb[n - 1] << at;
    for (uint32_t i = n - 1; i > 0 && at > 0; i--) {
        uint64_t limb = a->limb[i - 1];
        at -= GMP_NUMB_BITS;
        head |= at >= 0 ? limb << at : limb >> -at;
    }
    // head has its top bit, so m is in [0.5, 1]
    double m = (double)head * 0x1p-64;
    bool rounded_up = m == 1;
    m = rounded_up ? 0.5 : m;
    *ret_exponent = (int)bits + rounded_up;
    return a->size < 0 ? -m : m;
}

void pir_int3_cross(pir_int3 *dst, const pir_int3 *a, const pir_int3 *b, pir_limbs *scratch) {
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        const pir_term terms[2] = {{&a->c[i], &b->c[j], false}, {&a->c[j], &b->c[i], true}};
        pir_int_sum(&dst->c[k], terms, 2, scratch);
    }
}

void pir_int3_dot(pir_int *dst, const pir_int3 *a, const pir_int3 *b, pir_limbs *scratch) {
    const pir_term terms[3] = {{&a->c[0], &b->c[0], false}, {&a->c[1], &b->c[1], false}, {&a->c[2], &b->c[2], false}};
    pir_int_sum(dst, terms, 3, scratch);
}

uint32_t pir_int3_length(const pir_int3 *a) {
    uint32_t longest = 0;
    for (int k = 0; k < 3; k++)
        if (pir_int_length(&a->c[k]) > longest)
            longest = pir_int_length(&a->c[k]);
    return longest;
}
