/* SPDX-License-Identifier: MIT */
/**
 * The persistent Minkowski sum M = R·P ⊕ Q of two polytopes, kept up to date while P rotates.
 *
 * A sum stores the pairing: for every facet of P the vertex of Q that supports it (fv), for every facet of Q the vertex of
 * P (vf), and for every edge of P the edges of Q that its Gaussian arc crosses, in order (ee). Each pair is a facet of the
 * sum. Every pair carries a certificate, the angle through which R may still turn before the pair can fail; an update
 * looks only at those that expire (after Behar and Lien, Dynamic Minkowski Sum of Convex Shapes, GMU-CS-TR-2010-12, made
 * right for steps of any size).
 *
 * Exactness: the pairing is that of the exact rotation M(q)/|q|², ties settled by one symbolic perturbation of q, so it is
 * in general position and unique; a tracked pairing equals a rebuilt one. The mesh is that of the true sum: coplanar pieces merged.
 *
 * Threads: a sum belongs to one thread at a time; different sums are independent, even of the same polytopes.
 */
#ifndef PIROUETTE_SUM_H
#define PIROUETTE_SUM_H

#include <pirouette/base.h>
#include <pirouette/mesh.h>
#include <pirouette/polytope.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_sum pir_sum;

/** How a rotation is brought into a sum. All give the same pairing. */
typedef enum pir_method {
    PIR_METHOD_AUTO = 0, /**< update or walk, whichever the sum's own counters say is cheaper */
    PIR_METHOD_UPDATE,   /**< repair the pairs that failed */
    PIR_METHOD_WALK,     /**< rebuild by walking one Gaussian map through the other */
} pir_method;

typedef struct pir_sum_options {
    const pir_allocator *allocator; /**< NULL for malloc; copied, its context must outlive the sum */
    int difference;                 /**< 1: keep Q ⊕ (−R·P), the difference that placement queries use; 0: R·P ⊕ Q */
} pir_sum_options;

/** malloc, no difference. */
PIR_API pir_sum_options pir_sum_options_default(void);

/**
 * Makes the sum of P, rotated by `rotation`, and Q.
 *
 * p, q      of any dimension, 0 to 3; the sum takes a reference to each (to −P's reflection when options->difference).
 * options   NULL for the defaults.
 *
 * Release with pir_sum_destroy. Cost: a walk, O(result). Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION,
 * PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_sum_create(pir_polytope *p, pir_polytope *q, pir_quat rotation, const pir_sum_options *options,
                                  pir_sum **ret_sum);

/** Frees the sum and its references; NULL is accepted. */
PIR_API void pir_sum_destroy(pir_sum *sum);

/**
 * Brings the sum to `rotation`, any distance away from the last one.
 *
 * Allocates only while the list of crossings grows beyond what it has ever been. When it fails the sum stays at its
 * previous rotation, whole and usable. Cost: PIR_METHOD_UPDATE follows the number of certificates that expire, PIR_METHOD_WALK
 * the size of the sum. Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_sum_rotate(pir_sum *sum, pir_quat rotation, pir_method method);

/** The rotation that the sum is at, as it was given. */
PIR_API pir_quat pir_sum_rotation(const pir_sum *sum);

/** The operands as the sum holds them (P reflected when it keeps the difference); borrowed. */
PIR_API const pir_polytope *pir_sum_p(const pir_sum *sum);
PIR_API const pir_polytope *pir_sum_q(const pir_sum *sum);

/** The vertex of Q paired with each facet of P; pir_polytope_facet_count(P) entries, valid until the next rotation. */
PIR_API const uint32_t *pir_sum_fv(const pir_sum *sum);

/** The vertex of P paired with each facet of Q; pir_polytope_facet_count(Q) entries, valid until the next rotation. */
PIR_API const uint32_t *pir_sum_vf(const pir_sum *sum);

/** The number of ee pairs. */
PIR_API uint32_t pir_sum_ee_count(const pir_sum *sum);

/**
 * Writes the ee pairs: {edge of P, edge of Q}, by rising edge of P and, for each, in order along its arc. Room for
 * pir_sum_ee_count pairs. O(edges of P + pairs).
 */
PIR_API void pir_sum_ee(const pir_sum *sum, uint32_t (*ret_pairs)[2]);

/** 1 when both sums, of the same polytopes, hold the same fv, vf and ee pairs in the same order. */
PIR_API int pir_sum_same_pairing(const pir_sum *a, const pir_sum *b);

/** A check for tests, every pair in exact arithmetic and every crossing list from cell to cell: 1 when all hold. */
PIR_API int pir_sum_is_valid(pir_sum *sum);

/** Which coordinates a mesh of the sum carries. */
typedef enum pir_precision {
    PIR_DOUBLE = 0, /**< doubles, each within a few ulp of the exact coordinate relative to the size of the operands */
    PIR_EXACT,      /**< the same doubles, and exact rationals beside them (exact.h) */
} pir_precision;

/**
 * The true sum as a mesh: coplanar pieces merged, straight corners and pieces without area dropped. The mesh is the
 * caller's and uses the sum's allocator. O(size of the sum), more where many pieces merge.
 */
PIR_API pir_status pir_sum_mesh(pir_sum *sum, pir_precision precision, pir_mesh **ret_mesh);

/**
 * The same mesh by another way: the exact hull of all pairwise sums of vertices. Needs no pairing and shares no code with
 * one: a second opinion. O(nm log nm) for n and m vertices.
 */
PIR_API pir_status pir_hull_sum(const pir_polytope *p, const pir_polytope *q, pir_quat rotation, const pir_sum_options *options,
                                pir_precision precision, pir_mesh **ret_mesh);

/**
 * The brute-force re-check of all pairs (Algorithm 3.1 of Behar and Lien): every facet against every vertex, every edge against
 * every edge. The pairing of `sum` is replaced by what it finds, which is the same. The baseline that updates are measured against.
 * O(nm).
 */
PIR_API pir_status pir_sum_rotate_brute_force(pir_sum *sum, pir_quat rotation);

/** What the sum did since it was made. Plain counters. */
typedef struct pir_sum_statistics {
    uint64_t updates, rebuilds;       /**< rotations brought in by update and by rebuild */
    uint64_t checked;                 /**< certificates that expired and were looked at */
    uint64_t repaired;                /**< pairs that had failed */
    uint64_t by_filter;               /**< signs that the double filter decided */
    uint64_t by_exact;                /**< signs that exact arithmetic decided */
    uint64_t by_perturbation;         /**< signs that were ties */
    uint64_t allocations;             /**< times the sum's memory grew after it was made */
} pir_sum_statistics;

PIR_API pir_sum_statistics pir_sum_get_statistics(const pir_sum *sum);

#ifdef __cplusplus
}
#endif

#endif
