/* SPDX-License-Identifier: MIT */
/*
 * Integers of any size over GMP's mpn layer, in memory that the caller has reserved.
 *
 * mpn works on bare limbs and never asks for memory of its own at the sizes used here, so the hot paths do not allocate
 * and running out of memory is a status, not GMP's abort. An integer is a sign, a length, a pointer and the room there.
 * Code that makes an integer reserves its room, derived from the lengths of its operands; the derivation stands beside
 * the reservation.
 *
 * Every call that writes limbs, and every reservation from scratch, first compares what it needs with the room there
 * is, in every build. Where a derivation is wrong the process ends with a line on stderr, and nothing is overwritten.
 *
 * Invariants: the top limb, limb[|size| − 1], is not zero; zero has size 0; |size| ≤ room, unless room is 0: such
 * an integer is a view, to be read only.
 */
#ifndef PIR_EXACT_INTEGER_H
#define PIR_EXACT_INTEGER_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include <gmp.h>

#include "base/assert.h"

typedef struct pir_int {
    mp_limb_t *limb; /* least significant first */
    int32_t size;    /* the number of limbs, negative for a negative integer */
    uint32_t room;   /* limbs that may be written; 0 for a view */
} pir_int;

typedef struct pir_int3 {
    pir_int c[3];
} pir_int3;

/* Scratch: a stack of limbs. Callers note `used`, take limbs, and set `used` back when done. */
typedef struct pir_limbs {
    mp_limb_t *base;
    uint32_t used, capacity;
} pir_limbs;

/* Ends the process because an integer would outgrow its room: a bug in the library, which no input can cause. */
_Noreturn void pir_int_outgrown(void);

/* Ends the process unless `room` limbs hold `need`. */
static inline void pir_int_check_room(uint32_t room, size_t need) {
    if (need > room)
        pir_int_outgrown();
}

static inline pir_int pir_limbs_take(pir_limbs *limbs, uint32_t count) {
    pir_int_check_room(limbs->capacity - limbs->used, count);
    pir_int taken = {limbs->base + limbs->used, 0, count};
    limbs->used += count;
    return taken;
}

static inline uint32_t pir_int_length(const pir_int *a) {
    return (uint32_t)(a->size < 0 ? -a->size : a->size);
}

static inline int pir_int_sign(const pir_int *a) {
    return (a->size > 0) - (a->size < 0);
}

static inline void pir_int_negate(pir_int *a) {
    a->size = -a->size;
}

/* dst = a; room: |a|. */
void pir_int_copy(pir_int *dst, const pir_int *a);

/* dst = a·b; room: |a| + |b|; dst must overlap neither. */
void pir_int_mul(pir_int *dst, const pir_int *a, const pir_int *b);

/* dst = a ± b; room: max(|a|, |b|) + 1; dst may be a or b. */
void pir_int_add(pir_int *dst, const pir_int *a, const pir_int *b);
void pir_int_sub(pir_int *dst, const pir_int *a, const pir_int *b);

/* dst += a·b and dst −= a·b, the product in scratch; room: max(|dst|, |a| + |b|) + 1. */
void pir_int_add_mul(pir_int *dst, const pir_int *a, const pir_int *b, pir_limbs *scratch);
void pir_int_sub_mul(pir_int *dst, const pir_int *a, const pir_int *b, pir_limbs *scratch);

#if GMP_NUMB_BITS == 64
/* Holds sums of products of two limbs below 2^61. */
__extension__ typedef __int128 pir_two_limbs;

/* The integer, where it is below 2^61. */
static inline bool pir_int_get_short(const pir_int *a, int64_t *ret_value) {
    uint64_t size = a->size != 0 ? a->limb[0] : 0;
    if (a->size < -1 || a->size > 1 || size >> 61)
        return false;
    *ret_value = a->size < 0 ? -(int64_t)size : (int64_t)size;
    return true;
}

/* dst = a; room: two limbs. */
static inline void pir_int_set_two(pir_int *dst, pir_two_limbs a) {
    pir_two_limbs size = a < 0 ? -a : a;
    pir_int_check_room(dst->room, 2);
    dst->limb[0] = (mp_limb_t)size;
    dst->limb[1] = (mp_limb_t)(size >> 64);
    int32_t length = dst->limb[1] != 0 ? 2 : dst->limb[0] != 0;
    dst->size = a < 0 ? -length : length;
}
#endif

/* One product of a sum: a·b, or −a·b where `minus`. */
typedef struct pir_term {
    const pir_int *a, *b;
    bool minus;
} pir_term;

/* The most terms that pir_int_sum takes. */
#define PIR_MOST_TERMS 4

/*
 * dst = the sum of `count` terms, which dst must not overlap; room: one limb more than the longest product. `scratch`
 * has that much too.
 */
void pir_int_sum(pir_int *dst, const pir_term *terms, uint32_t count, pir_limbs *scratch);

/* dst = a·2^bits; room: |a| + bits / GMP_NUMB_BITS + 1; dst may be a. */
void pir_int_shift_left(pir_int *dst, const pir_int *a, uint32_t bits);

/* a /= 2^bits, which must divide it. */
void pir_int_shift_right(pir_int *a, uint32_t bits);

/* The number of trailing zero bits; UINT32_MAX for zero. */
uint32_t pir_int_trailing_zeros(const pir_int *a);

/* The number of bits of |a|. */
uint32_t pir_int_bits(const pir_int *a);

/* x as ±mantissa · 2^*ret_exponent, the mantissa below 2^53; x is finite. */
static inline uint64_t pir_double_split(double x, int *ret_exponent) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    int field = (int)(bits >> 52 & 0x7ff);
    uint64_t fraction = bits & (((uint64_t)1 << 52) - 1);
    *ret_exponent = field > 0 ? field - 1075 : -1074;
    return field > 0 ? fraction | (uint64_t)1 << 52 : fraction;
}

/* The exponent of the lowest set bit of x; INT32_MAX for zero. */
static inline int pir_double_low_bit(double x) {
    int e;
    uint64_t mantissa = pir_double_split(x, &e);
    return mantissa != 0 ? e + __builtin_ctzll(mantissa) : INT32_MAX;
}

/* dst = x / 2^exponent, which must be an integer; room: pir_double_limbs of the same. */
void pir_int_set_double(pir_int *dst, double x, int exponent);

/* Limbs that hold any finite double of binary exponent up to `top` (as frexp gives it) in units of 2^exponent. */
uint32_t pir_double_limbs(int top, int exponent);

/* m in ±[0.5, 1) and *ret_exponent with |m·2^e − a| ≤ 1.001·2^-53·|a|; 0 and 0 for zero. */
double pir_int_to_double(const pir_int *a, int *ret_exponent);

/* dst = a × b; room for each component: |a| + |b| + 1. */
void pir_int3_cross(pir_int3 *dst, const pir_int3 *a, const pir_int3 *b, pir_limbs *scratch);

/* dst = a · b; room: |a| + |b| + 1 for the longest components. */
void pir_int3_dot(pir_int *dst, const pir_int3 *a, const pir_int3 *b, pir_limbs *scratch);

/* The longest component, in limbs. */
uint32_t pir_int3_length(const pir_int3 *a);

/* Three integers of `limbs` limbs each from scratch. */
static inline pir_int3 pir_int3_take(pir_limbs *scratch, uint32_t limbs) {
    pir_int3 v;
    for (int k = 0; k < 3; k++)
        v.c[k] = pir_limbs_take(scratch, limbs);
    return v;
}

static inline bool pir_int3_is_zero(const pir_int3 *a) {
    return a->c[0].size == 0 && a->c[1].size == 0 && a->c[2].size == 0;
}

#endif
