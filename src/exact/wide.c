/* SPDX-License-Identifier: MIT */
/*
 * Integers of fixed length: see wide.h. Loops have fixed counts, so nothing branches.
 *
 * A product of limbs i and k goes in halves into columns i + k and i + k + 1, of 128 bits each, and once all are there
 * what is above 64 bits in a column is carried to the next. The top limb of a factor has its sign, the others have
 * none. So a product of top limbs has a sign, in columns in two's complement. A column gets at most 64 halves.
 */
#include "exact/wide.h"

#if PIR_HAVE_WIDE

/* column += a·b for factors of `na` and `nb` limbs; columns from `count` on are left out. */
static inline void add_columns(pir_two_limbs_unsigned *column, int count, const mp_limb_t *a, int na,
                               const mp_limb_t *b, int nb) {
    for (int k = 0; k < nb; k++)
        for (int i = 0; i < na && i + k < count; i++) {
            const bool of_a = i == na - 1, of_b = k == nb - 1;
            const pir_two_limbs_unsigned product =
                of_a && of_b ? (pir_two_limbs_unsigned)((pir_two_limbs)(int64_t)a[i] * (int64_t)b[k])
                : of_a       ? (pir_two_limbs_unsigned)((pir_two_limbs)(int64_t)a[i] * (pir_two_limbs)b[k])
                : of_b       ? (pir_two_limbs_unsigned)((pir_two_limbs)a[i] * (int64_t)b[k])
                             : (pir_two_limbs_unsigned)a[i] * b[k];
            column[i + k] += (mp_limb_t)product;
            if (i + k + 1 < count)
                column[i + k + 1] +=
                    of_a || of_b ? (pir_two_limbs_unsigned)((pir_two_limbs)product >> 64) : product >> 64;
        }
}

/*
 * Products of the lengths that are used. Most calls are rare, and their code comes from memory. So each has one copy,
 * and sums of three products go round a loop.
 */
__attribute__((noinline)) static void add_two_by_two(pir_two_limbs_unsigned *column, pir_two_limbs a, pir_two_limbs b) {
    const mp_limb_t x[2] = {(mp_limb_t)a, (mp_limb_t)(a >> 64)}, y[2] = {(mp_limb_t)b, (mp_limb_t)(b >> 64)};
    add_columns(column, 4, x, 2, y, 2);
}

__attribute__((noinline)) static void add_four_by_two(pir_two_limbs_unsigned *column, const mp_limb_t *a,
                                                      pir_two_limbs b) {
    const mp_limb_t y[2] = {(mp_limb_t)b, (mp_limb_t)(b >> 64)};
    add_columns(column, 6, a, 4, y, 2);
}

__attribute__((noinline)) static void add_four_by_four(pir_two_limbs_unsigned *column, const mp_limb_t *a,
                                                       const mp_limb_t *b) {
    add_columns(column, 8, a, 4, b, 4);
}

/* Carries from column to column. */
__attribute__((noinline)) static void set_of_columns(mp_limb_t *to, const pir_two_limbs_unsigned *column, int count) {
    pir_two_limbs carry = 0;
    for (int k = 0; k < count; k++) {
        const pir_two_limbs_unsigned sum = column[k] + (pir_two_limbs_unsigned)carry;
        to[k] = (mp_limb_t)sum;
        carry = (pir_two_limbs)sum >> 64;
    }
}

/* The limbs of a sum as columns. */
static inline void get_columns(const mp_limb_t *sum, pir_two_limbs_unsigned *column, int count) {
    for (int k = 0; k < count; k++)
        column[k] = sum[k];
}

void pir_int256_add_product(pir_int256 *sum, pir_two_limbs a, pir_two_limbs b) {
    pir_two_limbs_unsigned column[4];
    get_columns(sum->limb, column, 4);
    add_two_by_two(column, a, b);
    set_of_columns(sum->limb, column, 4);
}

void pir_int256_add_scaled(pir_int256 *sum, const pir_int256 *a, pir_two_limbs b) {
    // two columns more than count
    pir_two_limbs_unsigned column[6] = {0};
    get_columns(sum->limb, column, 4);
    add_four_by_two(column, a->limb, b);
    set_of_columns(sum->limb, column, 4);
}

void pir_int512_add_product(pir_int512 *sum, const pir_int256 *a, const pir_int256 *b) {
    pir_two_limbs_unsigned column[8];
    get_columns(sum->limb, column, 8);
    add_four_by_four(column, a->limb, b->limb);
    set_of_columns(sum->limb, column, 8);
}

void pir_int512_add_scaled(pir_int512 *sum, const pir_int512 *a, int64_t b) {
    const mp_limb_t y = (mp_limb_t)b;
    pir_two_limbs_unsigned column[8];
    get_columns(sum->limb, column, 8);
    add_columns(column, 8, a->limb, 8, &y, 1);
    set_of_columns(sum->limb, column, 8);
}

void pir_int512_set(pir_int512 *to, const pir_int256 *a) {
    const mp_limb_t above = 0 - (a->limb[3] >> 63);
    for (int k = 0; k < 8; k++)
        to->limb[k] = k < 4 ? a->limb[k] : above;
}

pir_int256 pir_two_dot(const pir_two_limbs a[3], const pir_two_limbs b[3]) {
    pir_two_limbs_unsigned column[4] = {0};
    pir_int256 sum;
    for (int k = 0; k < 3; k++)
        add_two_by_two(column, a[k], b[k]);
    set_of_columns(sum.limb, column, 4);
    return sum;
}

pir_int512 pir_int256_dot(const pir_int256 a[3], const pir_int256 b[3]) {
    pir_two_limbs_unsigned column[8] = {0};
    pir_int512 sum;
    for (int k = 0; k < 3; k++)
        add_four_by_four(column, a[k].limb, b[k].limb);
    set_of_columns(sum.limb, column, 8);
    return sum;
}

pir_int512 pir_int256_dot_two(const pir_int256 a[3], const pir_two_limbs b[3]) {
    pir_two_limbs_unsigned column[8] = {0};
    pir_int512 sum;
    for (int k = 0; k < 3; k++)
        add_four_by_two(column, a[k].limb, b[k]);
    // what is carried into the last two has the sign
    set_of_columns(sum.limb, column, 8);
    return sum;
}

pir_int512 pir_two_square(const pir_two_limbs a[3]) {
    const pir_int256 square = pir_two_dot(a, a);
    pir_int512 sum;
    pir_int512_set(&sum, &square);
    return sum;
}

double pir_int512_to_double(const pir_int512 *a, int *ret_exponent) {
    mp_limb_t limb[8];
    pir_int whole = {limb, 0, 8};
    pir_int_set_limbs(&whole, a->limb, 8);
    return pir_int_to_double(&whole, ret_exponent);
}

#else
typedef int pir_no_wide_integers; // a file holds at least a declaration
#endif
