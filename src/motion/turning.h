/* SPDX-License-Identifier: MIT */
/*
 * A full turn about an axis, from a rotation on, and the quadratics that signs are during it.
 *
 * P's quaternion is (u, κ)·q₀: the rotation of q₀, then the turn by θ about the axis u, κ = |u|·cot(θ/2).
 * With x a vector of P, y one of Q and x' = M(q₀)·x,
 *
 *     s(κ) = (M((u, κ)·q₀)·x)·y = κ² (x'·y) + 2κ (u × x')·y + 2 (u·x') (u·y) − |u|² (x'·y),
 *
 * the sum over j and i of y_j (κ² C0 + κ C1 + C2)_ji x_i with matrices C0, C1, C2 of integers. The integers are in
 * k = κ·2^-exponent, for which u is a vector of integers without a common power of two.
 *
 * In doubles u has length 1, and k stands for a direction (σ, τ) of length 1 with τ ≥ 0, σ/τ = cot(θ/2): the
 * first one is (1, 0), the last (−1, 0). So a quadratic is s on unit vectors, at most 1 in size: a "form", three
 * vectors whose dot products with y are the coefficients of σ², στ and τ².
 *
 * The error of a form, with u = 2^-53: x' is off by 45u (r of 31u, x of 8u, rounding 5.3u), the axis by 4u. σ² has
 * x'·y, off by 56u; στ has 2 (u × x')·y, off by 2·(4 + 45 + 4 + 8 + 4)u = 130u; τ² has the dot product of y
 * with x' reflected, off by 2·(4 + 45 + 4 + 4 + 3)u + 48u + 12u = 180u. Together below 2^-44 = 512u, for any (σ,
 * τ), and likewise where Q's vector has the form and P's are turned by r. Relative rotations,
 * whose r is off by 37u, are within the bound too.
 */
#ifndef PIR_MOTION_TURNING_H
#define PIR_MOTION_TURNING_H

#include "exact/rotation.h"
#include "motion/quadratic.h"
#include "polytope/polytope.h"

#define PIR_FORM_BOUND 0x1p-44

/* s of one vector, as a function of (σ, τ) and of the other vector. */
typedef struct pir_form {
    pir_vec3 c[3];
} pir_form;

typedef struct pir_turning {
    pir_vec3 axis;         /* as given */
    pir_rotation rotation; /* q₀ */
    pir_vec3 unit;         /* the axis, within 4u of length 1 */
    int exponent;          /* of k */
    pir_scaled length;     /* of the axis in units of k */
    uint32_t entry_limbs;  /* the longest entry of a matrix */
    pir_int matrix[3][3][3];
    mp_limb_t *limbs; /* of the matrices */
    size_t limb_count;
} pir_turning;

/*
 * Takes an axis and a rotation of which pir_rotation_set or pir_rotation_set_relative has set the doubles:
 * PIR_ERR_NOT_FINITE, PIR_ERR_ARGUMENT (an axis of length 0), PIR_ERR_MEMORY. On failure there is nothing to finish.
 */
pir_status pir_turning_init(pir_turning *turning, const pir_allocator *allocator, pir_vec3 axis,
                            const pir_rotation *rotation);
void pir_turning_finish(pir_turning *turning, const pir_allocator *allocator);

/* dst = s of x of P and y of Q; room: entry_limbs + |x| + |y| + 2 each. */
void pir_turning_quadratic(const pir_turning *turning, const pir_int3 *x, const pir_int3 *y, pir_quadratic *dst,
                           pir_limbs *scratch);

/* The form of a unit vector of P, as it is in P's own frame, and of one of Q. */
pir_form pir_turning_form_p(const pir_turning *turning, pir_vec3 x);
pir_form pir_turning_form_q(const pir_turning *turning, pir_vec3 y);

/*
 * The angle in degrees, rounded outwards, for κ between two doubles. `length` is the axis's, in units of 2^exponent.
 */
void pir_turning_degrees(pir_scaled length, int exponent, const double kappa[2], double ret_degrees[2]);

/*
 * The quadratic in κ of one in k = κ·2^-exponent, which is not zero: without a common divisor, the first coefficient
 * that is not zero positive.
 */
void pir_turning_polynomial(const pir_quadratic *root, int exponent, mpz_t *ret_coefficients);

#endif
