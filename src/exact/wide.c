/* SPDX-License-Identifier: MIT */
/* Integers of fixed length: see wide.h. Signs are masks, and loops have fixed counts, so nothing branches. */
#include "exact/wide.h"

#if PIR_HAVE_WIDE

/* to = a, or −a where `mask` is all ones. */
static inline void negate_if(mp_limb_t *to, const mp_limb_t *a, int count, mp_limb_t mask) {
    mp_limb_t carry = mask & 1;
    for (int k = 0; k < count; k++) {
        pir_two_limbs_unsigned t = (pir_two_limbs_unsigned)(a[k] ^ mask) + carry;
        to[k] = (mp_limb_t)t;
        carry = (mp_limb_t)(t >> 64);
    }
}

/* sum += a, or sum −= a where `mask` is all ones. */
static inline void add_if(mp_limb_t *sum, const mp_limb_t *a, int count, mp_limb_t mask) {
    mp_limb_t carry = mask & 1;
    for (int k = 0; k < count; k++) {
        pir_two_limbs_unsigned t = (pir_two_limbs_unsigned)sum[k] + (a[k] ^ mask) + carry;
        sum[k] = (mp_limb_t)t;
        carry = (mp_limb_t)(t >> 64);
    }
}

/* to[0 … count] = a·b for a magnitude of `count` limbs; `add`: on top of what is in the first `count`. */
static inline void multiply_row(mp_limb_t *to, const mp_limb_t *a, int count, mp_limb_t b, bool add) {
    mp_limb_t carry = 0;
    for (int i = 0; i < count; i++) {
        pir_two_limbs_unsigned t = (pir_two_limbs_unsigned)a[i] * b + carry;
        t += add ? to[i] : 0;
        to[i] = (mp_limb_t)t;
        carry = (mp_limb_t)(t >> 64);
    }
    to[count] = carry;
}

/* All ones for a negative number. */
static inline mp_limb_t mask_of(const pir_int256 *a) {
    return 0 - (a->limb[3] >> 63);
}

static inline pir_two_limbs_unsigned size_of(pir_two_limbs a) {
    return a < 0 ? 0 - (pir_two_limbs_unsigned)a : (pir_two_limbs_unsigned)a;
}

void pir_int256_add_product(pir_int256 *sum, pir_two_limbs a, pir_two_limbs b) {
    mp_limb_t of_a = a < 0 ? ~(mp_limb_t)0 : 0, of_b = b < 0 ? ~(mp_limb_t)0 : 0, product[4];
    pir_two_limbs_unsigned x = size_of(a), y = size_of(b);
    const mp_limb_t size[2] = {(mp_limb_t)x, (mp_limb_t)(x >> 64)};
    multiply_row(product, size, 2, (mp_limb_t)y, false);
    multiply_row(product + 1, size, 2, (mp_limb_t)(y >> 64), true);
    add_if(sum->limb, product, 4, of_a ^ of_b);
}

void pir_int256_add_scaled(pir_int256 *sum, const pir_int256 *a, pir_two_limbs b) {
    mp_limb_t of_a = mask_of(a), of_b = b < 0 ? ~(mp_limb_t)0 : 0, size[4], product[6];
    pir_two_limbs_unsigned y = size_of(b);
    negate_if(size, a->limb, 4, of_a);
    multiply_row(product, size, 4, (mp_limb_t)y, false);
    multiply_row(product + 1, size, 4, (mp_limb_t)(y >> 64), true);
    add_if(sum->limb, product, 4, of_a ^ of_b);
}

void pir_int512_add_product(pir_int512 *sum, const pir_int256 *a, const pir_int256 *b) {
    mp_limb_t of_a = mask_of(a), of_b = mask_of(b), x[4], y[4], product[8];
    negate_if(x, a->limb, 4, of_a);
    negate_if(y, b->limb, 4, of_b);
    multiply_row(product, x, 4, y[0], false);
    multiply_row(product + 1, x, 4, y[1], true);
    multiply_row(product + 2, x, 4, y[2], true);
    multiply_row(product + 3, x, 4, y[3], true);
    add_if(sum->limb, product, 8, of_a ^ of_b);
}

pir_int512 pir_int256_dot(const pir_int256 a[3], const pir_int256 b[3]) {
    pir_int512 sum = {{0}};
    for (int k = 0; k < 3; k++)
        pir_int512_add_product(&sum, &a[k], &b[k]);
    return sum;
}

pir_int512 pir_int256_dot_two(const pir_int256 a[3], const pir_two_limbs b[3]) {
    pir_int512 sum = {{0}};
    for (int k = 0; k < 3; k++) {
        mp_limb_t of_a = mask_of(&a[k]), of_b = b[k] < 0 ? ~(mp_limb_t)0 : 0, x[4], product[8] = {0};
        pir_two_limbs_unsigned y = size_of(b[k]);
        negate_if(x, a[k].limb, 4, of_a);
        multiply_row(product, x, 4, (mp_limb_t)y, false);
        multiply_row(product + 1, x, 4, (mp_limb_t)(y >> 64), true);
        add_if(sum.limb, product, 8, of_a ^ of_b);
    }
    return sum;
}

pir_int512 pir_two_square(const pir_two_limbs a[3]) {
    pir_int512 sum = {{0}};
    for (int k = 0; k < 3; k++) {
        pir_two_limbs_unsigned x = size_of(a[k]);
        const mp_limb_t size[2] = {(mp_limb_t)x, (mp_limb_t)(x >> 64)};
        mp_limb_t product[4];
        multiply_row(product, size, 2, size[0], false);
        multiply_row(product + 1, size, 2, size[1], true);
        add_if(sum.limb, product, 4, 0);
    }
    return sum;
}

double pir_int512_to_double(const pir_int512 *a, int *ret_exponent) {
    mp_limb_t limb[8], mask = 0 - (a->limb[7] >> 63);
    negate_if(limb, a->limb, 8, mask);
    int32_t size = 8;
    while (size > 0 && limb[size - 1] == 0)
        size--;
    pir_int whole = {limb, mask ? -size : size, 0};
    return pir_int_to_double(&whole, ret_exponent);
}

#else
typedef int pir_no_wide_integers; // a file holds at least a declaration
#endif
