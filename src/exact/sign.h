/* SPDX-License-Identifier: MIT */
/*
 * The sign of s(a, b) = (M(q)·a)·b for a vector a of P and b of Q. Every combinatorial question about a sum is the
 * sign of such a number.
 *
 * Three stages, each counted: a double filter on unit vectors, exact integers, and for a tie, s = 0, the symbolic
 * perturbation q + (ε₁, ε₂, ε₃, ε₄), ε₁ ≫ ε₂ ≫ ε₃ ≫ ε₄ ≫ 0, which gives every pair of
 * non-zero vectors a sign.
 *
 * Reversing a or b reverses the sign, ties included: the perturbed s is linear in both.
 */
#ifndef PIR_EXACT_SIGN_H
#define PIR_EXACT_SIGN_H

#include <pirouette/base.h>

#include "exact/rotation.h"
#include "exact/vectors.h"

/*
 * With unit vectors â, b̂ (within 8u of a/|a|, b/|b|, u = 2^-53: pir_int3_unit) and r within 37u of R where it is
 * relative, 31u else (rotation.h),
 *
 *     |fl((r·â)·b̂) − (R·a)·b/(|a||b|)| < 64u = 2^-47:
 *
 * r·â is off by 37u from r, 8u from â, and 5.3u from rounding (three products of a row of norm 1 with â, 3.01u a
 * row, over three rows); b̂ brings 8u, the last dot product 3.01u; together 61.3u, and below 62u with terms of order
 * u². tests/proofs/sign.g has the proof for a machine, and others there those of the bounds that rest on this.
 */
#define PIR_SIGN_BOUND 0x1p-47

/* The sign of a value with the error above, or 0 where the error leaves it open. */
static inline int pir_filter_sign(double s) {
    return (s > PIR_SIGN_BOUND) - (s < -PIR_SIGN_BOUND);
}

/* Works out signs for one rotation after another. */
typedef struct pir_signs {
    pir_rotation rotation;
    pir_limbs *scratch;
    uint64_t by_filter, by_exact, by_perturbation;
} pir_signs;

/*
 * Scratch of exact signs, which all signs of a thread may share. It begins as zeros. pir_signs_reserve makes
 * room for vectors of up to `a_limbs` and `b_limbs` a component: PIR_ERR_MEMORY.
 */
typedef struct pir_signs_room {
    pir_rotation_integers rotation;
    pir_limbs scratch;
} pir_signs_room;

pir_status pir_signs_reserve(pir_signs_room *room, const pir_allocator *allocator, uint32_t a_limbs, uint32_t b_limbs);
void pir_signs_room_finish(pir_signs_room *room, const pir_allocator *allocator);

/* Signs that work in a room, which must stay where it is. The rotation is not set yet. */
void pir_signs_init(pir_signs *signs, pir_signs_room *room);

/* The sign of s(a, b) at the true rotation: −1, 0 or 1. */
int pir_sign_true(pir_signs *signs, const pir_int3 *a, const pir_int3 *b);

/* The sign of s(a, b) at the perturbed rotation: −1 or 1. Neither vector may be zero. */
int pir_sign_perturbed(pir_signs *signs, const pir_int3 *a, const pir_int3 *b);

#endif
