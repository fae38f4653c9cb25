/* SPDX-License-Identifier: MIT */
/*
 * Polynomials of degree three at most with integer coefficients, and their positive roots, compared exactly.
 *
 * A root is the only one of its polynomial in (low, high]·2^-bits; the polynomial kept with it has no factor twice.
 */
#ifndef PIR_IMPACT_CUBIC_H
#define PIR_IMPACT_CUBIC_H

#include <stdbool.h>

#include <gmp.h>

/* The sum of c[i]·t^i; of degree −1 when zero. */
typedef struct pir_cubic {
    mpz_t c[4];
    int degree;
} pir_cubic;

typedef struct pir_cubic_root {
    pir_cubic of;
    mpz_t low, high;
    mp_bitcnt_t bits;
} pir_cubic_root;

void pir_cubic_init(pir_cubic *f);
void pir_cubic_clear(pir_cubic *f);

/* Sets the degree from the coefficients. */
void pir_cubic_trim(pir_cubic *f);

void pir_cubic_root_init(pir_cubic_root *root);
void pir_cubic_root_clear(pir_cubic_root *root);

/* Halves the interval. */
void pir_cubic_root_halve(pir_cubic_root *root);

#define PIR_LAST_ROOT 0

/*
 * dst = the `ordinal`-th of the roots of f in (low, high]·2^-bits, from 1 on, or the last one. False where there are
 * fewer, or f is zero.
 */
bool pir_cubic_root_within(pir_cubic_root *dst, const pir_cubic *f, const mpz_t low, const mpz_t high, mp_bitcnt_t bits,
                           int ordinal);

/* How many different roots `of` the root's polynomial are in (0, the root]. */
int pir_cubic_root_ordinal(const pir_cubic_root *root);

/* The sign of f at a root, of which the interval may be made smaller. */
int pir_cubic_sign_at(const pir_cubic *f, pir_cubic_root *root);

/* The sign of a − b; intervals may be made smaller. */
int pir_cubic_root_compare(pir_cubic_root *a, pir_cubic_root *b);

/* The first root of f after 0, or after `now`, and up to high·2^-bits; f is not zero there. False where none is. */
bool pir_cubic_first_after(pir_cubic_root *dst, const pir_cubic *f, pir_cubic_root *now, const mpz_t high,
                           mp_bitcnt_t bits);

#endif
