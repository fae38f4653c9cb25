/* SPDX-License-Identifier: MIT */
/*
 * Quadratics with integer coefficients, and the real numbers of degree two that are roots of them, compared exactly.
 *
 * A root is given by its quadratic alone: the exit root of c0·k² + c1·k + c2 is the one at which the quadratic turns
 * from negative to positive while k falls, or its only one where that has multiplicity two. A quadratic has at most
 * one exit root; a linear one has one when c1 < 0.
 *
 * No function here allocates. Coefficients have at most `limbs` limbs, and the scratch PIR_QUADRATIC_SCRATCH(limbs).
 */
#ifndef PIR_MOTION_QUADRATIC_H
#define PIR_MOTION_QUADRATIC_H

#include "exact/integer.h"

/* c[0]·k² + c[1]·k + c[2]. */
typedef struct pir_quadratic {
    pir_int c[3];
} pir_quadratic;

/*
 * Limbs that live at a time in the scratch, for coefficients of l limbs: a derivative of l + 1; in a sign at a root two
 * discriminants of three numbers of 2l + 2, x of 3l + 4, y and three more of 2l + 2; x², y² D and their difference of
 * 6l + 9, y² of 4l + 5, and a product of 3l: below 50 (l + 2).
 */
#define PIR_QUADRATIC_SCRATCH(limbs) (50 * ((limbs) + 2))

/* Three coefficients of `limbs` limbs each from scratch, all zero. */
pir_quadratic pir_quadratic_take(pir_limbs *scratch, uint32_t limbs);

bool pir_quadratic_is_zero(const pir_quadratic *p);

/* Whether there is an exit root. */
bool pir_quadratic_has_exit(const pir_quadratic *p, pir_limbs *scratch);

/* The sign of p at the exit root of `root`. */
int pir_quadratic_sign_at(const pir_quadratic *p, const pir_quadratic *root, pir_limbs *scratch);

/* The sign of p just before (k a hair greater) and just after (a hair less) the exit root; 0 where p is zero. */
int pir_quadratic_sign_before(const pir_quadratic *p, const pir_quadratic *root, pir_limbs *scratch);
int pir_quadratic_sign_after(const pir_quadratic *p, const pir_quadratic *root, pir_limbs *scratch);

/* The sign of p where k is greater than any of its roots. */
int pir_quadratic_sign_first(const pir_quadratic *p);

/* The sign of a − b for the exit roots of two quadratics. */
int pir_quadratic_compare(const pir_quadratic *a, const pir_quadratic *b, pir_limbs *scratch);

/* A double with an exponent of its own: m·2^e. */
typedef struct pir_scaled {
    double m;
    int e;
} pir_scaled;

/* The exit root as sigma/tau with tau ≥ 0, each within 16·2^-53 of its exact value relatively. */
void pir_quadratic_approximate(const pir_quadratic *p, pir_scaled *ret_sigma, pir_scaled *ret_tau, pir_limbs *scratch);

/* dst = the linear quadratic whose exit root is `x`·2^-exponent; room: pir_double_power_limbs of the same. */
void pir_quadratic_of_double(pir_quadratic *dst, double x, int exponent);

/* Limbs that hold m·2^k for the mantissa m of a double and |k| up to 2200 plus that exponent. */
uint32_t pir_double_power_limbs(int exponent);

#endif
