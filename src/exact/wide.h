/* SPDX-License-Identifier: MIT */
/*
 * Integers of 256 and 512 bits on the stack, for sums of products whose lengths are known beforehand. They take a
 * quarter of the instructions of pir_int there: nothing has a length, a room or a place in a scratch.
 *
 * Invariants: an integer is in two's complement, its lowest limb first. Nothing tells an overflow: whoever adds
 * products has bounded their sum by 2^255 or 2^511.
 *
 * Only where limbs have 64 bits: PIR_HAVE_WIDE.
 */
#ifndef PIR_EXACT_WIDE_H
#define PIR_EXACT_WIDE_H

#include "exact/integer.h"

#if GMP_NUMB_BITS == 64
#define PIR_HAVE_WIDE 1

__extension__ typedef unsigned __int128 pir_two_limbs_unsigned;

typedef struct pir_int256 {
    mp_limb_t limb[4];
} pir_int256;

typedef struct pir_int512 {
    mp_limb_t limb[8];
} pir_int512;

static inline int pir_int512_sign(const pir_int512 *a) {
    mp_limb_t any = 0;
    for (int k = 0; k < 8; k++)
        any |= a->limb[k];
    return a->limb[7] >> 63 ? -1 : any != 0;
}

/* sum += a·b. */
void pir_int256_add_product(pir_int256 *sum, pir_two_limbs a, pir_two_limbs b);

/* sum += a·b, where the product is within 255 bits. */
void pir_int256_add_scaled(pir_int256 *sum, const pir_int256 *a, pir_two_limbs b);

/* sum += a·b. */
void pir_int512_add_product(pir_int512 *sum, const pir_int256 *a, const pir_int256 *b);

/* sum += a·b, where the product is within 511 bits. */
void pir_int512_add_scaled(pir_int512 *sum, const pir_int512 *a, int64_t b);

/* to = a. */
void pir_int512_set(pir_int512 *to, const pir_int256 *a);

/* a·b for vectors of two limbs. */
pir_int256 pir_two_dot(const pir_two_limbs a[3], const pir_two_limbs b[3]);

/* a·b for vectors. */
pir_int512 pir_int256_dot(const pir_int256 a[3], const pir_int256 b[3]);

/* The dot product where one vector has components of two limbs. */
pir_int512 pir_int256_dot_two(const pir_int256 a[3], const pir_two_limbs b[3]);

/* a·a for a vector of integers below 2^126. */
pir_int512 pir_two_square(const pir_two_limbs a[3]);

/* The double and exponent that pir_int_to_double gives. */
double pir_int512_to_double(const pir_int512 *a, int *ret_exponent);

/* The integer, where it is below 2^bits, bits ≤ 126. */
static inline bool pir_int_get_two(const pir_int *a, uint32_t bits, pir_two_limbs *ret_value) {
    if (a->size < -2 || a->size > 2 || pir_int_bits(a) > bits)
        return false;
    pir_two_limbs_unsigned size = a->size != 0 ? a->limb[0] : 0;
    if (a->size == 2 || a->size == -2)
        size |= (pir_two_limbs_unsigned)a->limb[1] << 64;
    *ret_value = a->size < 0 ? -(pir_two_limbs)size : (pir_two_limbs)size;
    return true;
}

/* dst = a, of `count` limbs in two's complement; room: as many. */
static inline void pir_int_set_limbs(pir_int *dst, const mp_limb_t *a, int32_t count) {
    const bool minus = a[count - 1] >> 63;
    pir_int_check_room(dst->room, (uint32_t)count);
    if (minus)
        mpn_neg(dst->limb, a, count);
    else
        mpn_copyi(dst->limb, a, count);
    int32_t length = count;
    while (length > 0 && dst->limb[length - 1] == 0)
        length--;
    dst->size = minus ? -length : length;
}

static inline void pir_int_set_wide(pir_int *dst, const pir_int256 *a) {
    pir_int_set_limbs(dst, a->limb, 4);
}
#endif

#endif
