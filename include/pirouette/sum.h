/* SPDX-License-Identifier: MIT */
/**
 * The persistent Minkowski sum M = R·P ⊕ Q of two polytopes, kept up to date while P rotates.
 *
 * A sum stores the pairing: for every facet of P the vertex of Q that supports it (fv), for every facet of Q the vertex
 * of P (vf), and for every edge of P the edges of Q that its Gaussian arc crosses, in order (ee). Each pair is a facet
 * of the sum. Every pair carries a certificate, the turning through which it cannot fail; an ee pair's is those of the
 * four facets at the ends of its two arcs, for one of them has to leave its cell first. An update looks only at those
 * that expire (after Behar and Lien, Dynamic Minkowski Sum of Convex Shapes, GMU-CS-TR-2010-12, made right for steps of
 * any size).
 *
 * Exactness: the pairing is that of the exact rotation M(q)/|q|², ties settled by one symbolic perturbation of q, so it
 * is in general position and unique; a tracked pairing equals a rebuilt one. The mesh is that of the true sum: coplanar
 * pieces merged.
 *
 * Threads: a sum belongs to one thread at a time; different sums are independent, even of the same polytopes.
 *
 * A call that returns no status takes O(1) unless it frees memory or its comment says otherwise.
 */
#ifndef PIROUETTE_SUM_H
#define PIROUETTE_SUM_H

#include <stdio.h>

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
    PIR_METHOD_CGM,      /**< rebuild by overlaying cubical Gaussian maps (cgm.h); allocates */
} pir_method;

typedef struct pir_sum_options {
    const pir_allocator *allocator; /**< NULL for malloc; copied, its context must outlive the sum */
    int difference; /**< 1: keep Q ⊕ (−R·P), the difference that placement queries use; 0: R·P ⊕ Q */
} pir_sum_options;

/** malloc, no difference. */
PIR_API pir_sum_options pir_sum_options_default(void);

/**
 * Makes the sum of P, rotated by `rotation`, and Q.
 *
 * p, q      of any dimension, 0 to 3; the sum takes a reference to each (to −P's reflection when options->difference).
 * options   NULL for the defaults.
 *
 * Release with pir_sum_destroy. Cost: a walk, O(result). Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE,
 * PIR_ERR_ZERO_QUATERNION, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_sum_create(pir_polytope *p, pir_polytope *q, pir_quat rotation, const pir_sum_options *options,
                                  pir_sum **ret_sum);

/**
 * Gives the caller's reference back. The sum is freed, and its references to the operands are given back, once the
 * queries and live meshes that were made on it are destroyed as well. NULL is accepted.
 */
PIR_API void pir_sum_destroy(pir_sum *sum);

/**
 * Brings the sum to `rotation`, any distance away from the last one.
 *
 * Allocates only while the list of crossings grows beyond what it has ever been. When it fails the sum stays at its
 * previous rotation, whole and usable. Cost: PIR_METHOD_UPDATE follows the number of certificates that expire,
 * PIR_METHOD_WALK the size of the sum. Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION,
 * PIR_ERR_MEMORY.
 *
 * method  how; every method gives the same pairing.
 */
PIR_API pir_status pir_sum_rotate(pir_sum *sum, pir_quat rotation, pir_method method);

/**
 * Brings the sum to `rotation` by walk and forgets the motion so far: what follows depends on nothing before. The
 * memory is kept, so this does not allocate unless a larger list of crossings is needed. Errors as pir_sum_rotate.
 *
 * Cost: a walk, O(size of the sum).
 */
PIR_API pir_status pir_sum_reset(pir_sum *sum, pir_quat rotation);

/**
 * Makes a second sum of the same operands at the same rotation, with the same pairing and counters at zero. O(size of
 * the sum). allocator NULL for that of `sum`. Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_sum_clone(const pir_sum *sum, const pir_allocator *allocator, pir_sum **ret_sum);

/** Which operand. */
typedef enum pir_operand {
    PIR_OPERAND_P = 0, /**< the one that rotates */
    PIR_OPERAND_Q,     /**< the one that stands */
} pir_operand;

/**
 * Makes an operand `scale` times as large as the sum was made with, about its own origin: not times its size of now.
 * The scale is taken exactly. No pair changes, so nothing is rebuilt, but a pairing that a tolerance lets stay behind
 * is settled first; pir_sum_p and pir_sum_q, and what is asked of the sum from here on, are of the new size. Queries
 * and live meshes follow. O(n) for the operand's n vertices. Errors: PIR_ERR_NOT_FINITE, PIR_ERR_ARGUMENT (not
 * positive), PIR_ERR_LIMIT (a coordinate beyond the doubles), PIR_ERR_MEMORY; the sum then stays as it was.
 */
PIR_API pir_status pir_sum_set_scale(pir_sum *sum, pir_operand operand, double scale);

/**
 * Lets the pairing stay behind the rotation while that costs no more than `tolerance`, a length (the default is 0:
 * never).
 *
 * Then a rotation by PIR_METHOD_AUTO or PIR_METHOD_UPDATE may leave the pairing as it is. The hull of its vertices,
 * placed by the rotation asked for, lies inside the true sum, and its support function falls short of the true one by
 * at most `tolerance` in every direction; pir_sum_shortfall_bound tells the bound attained. PIR_METHOD_WALK and
 * PIR_METHOD_CGM always bring the pairing along. Mesh vertices are placed by the rotation asked for; which pieces a
 * mesh merges is decided where the pairing is exact, and queries answer for that rotation: settle the sum before asking
 * for the one of now.
 *
 * O(n m) for the n facets and m vertices of each operand, here and in pir_sum_set_scale while there is a tolerance.
 * Brings the pairing to the rotation first. Errors: PIR_ERR_ARGUMENT (negative or NaN), PIR_ERR_NOT_FINITE,
 * PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_sum_set_tolerance(pir_sum *sum, double tolerance);
PIR_API double pir_sum_tolerance(const pir_sum *sum);

/** By how much the support function of the sum as it is kept falls short of the true one at most: 0
    when the pairing is exact. */
PIR_API double pir_sum_shortfall_bound(const pir_sum *sum);

/** The rotation that the pairing is exact at: pir_sum_rotation, unless a tolerance lets it stay behind. */
PIR_API pir_quat pir_sum_pairing_rotation(const pir_sum *sum);

/**
 * Brings the pairing to pir_sum_rotation when it has stayed behind. Errors as pir_sum_rotate.
 *
 * Cost: as of pir_sum_rotate with PIR_METHOD_AUTO.
 */
PIR_API pir_status pir_sum_settle(pir_sum *sum);

/** In pir_sum_fv and pir_sum_vf: a pair that a region leaves out. */
#define PIR_NO_PAIR UINT32_MAX

/**
 * Keeps only the part of the sum whose outward normals are within `half_angle` radians of `axis`, of any length, in the
 * frame of Q. The default, and every half-angle of 3.15 and more, is the whole sphere. Updates then cost what the cone
 * holds, with a skin around it of 1 to 7 degrees, five steps of the motion.
 *
 * All pairs in the cone are there and right, rounding erring towards keeping; of others some may be, depending on how
 * the sum came here, and those are right too. What is left out has PIR_NO_PAIR for its vertex, and no ee pairs. A P of
 * dimension below 3 is kept whole.
 *
 * May be called in every frame: while the axis stays within the skin nothing is looked at. Past it, or with another
 * half-angle, what is kept is chosen anew in O(facets), a few operations each, and what is new is located. The first
 * region allocates its work space, O(size of both operands); later calls only as pir_sum_rotate does. Other calls on a
 * sum with a region: a mesh is that of the whole sum, made for the occasion; pairings are compared as far as both
 * regions reach; a live mesh has slots for what is kept; a clone and a file have the region; queries answer for the
 * region or not at all (query.h). With a tolerance, the bound on the support function holds for the directions of the
 * cone. Errors: PIR_ERR_ARGUMENT (an axis of zeros, a negative angle), PIR_ERR_NOT_FINITE, PIR_ERR_MEMORY; the sum then
 * keeps the region it had.
 */
PIR_API pir_status pir_sum_set_region(pir_sum *sum, pir_vec3 axis, double half_angle);

/**
 * 1 and the cone, its axis of unit length, where a region has been set; 0, and nothing written,
 * where the sum is whole.
 *
 * ret_axis, ret_half_angle  the cone; the angle is in radians.
 */
PIR_API int pir_sum_region(const pir_sum *sum, pir_vec3 *ret_axis, double *ret_half_angle);

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

/**
 * 1 when both sums, of the same polytopes, hold the same fv, vf and ee pairs in the same order: where regions are set,
 * those in both cones, but for ee pairs whose edges are parallel within 2^-30.
 *
 * a, b  two sums.
 *
 * Cost: O(size of the sums).
 */
PIR_API int pir_sum_same_pairing(const pir_sum *a, const pir_sum *b);

/**
 * A check for tests, every pair that is kept in exact arithmetic and every crossing list from cell to
 * cell: 1 when all hold.
 *
 * Cost: O(size of the sum), with exact tests.
 */
PIR_API int pir_sum_is_valid(pir_sum *sum);

/**
 * The true sum as a mesh: coplanar pieces merged, straight corners and pieces without area dropped. The mesh is the
 * caller's and uses the sum's allocator. O(size of the sum). Beside the mesh it takes memory for the facets of the true
 * sum and a bit for each crossing, so that a sum with more pairs than facets, as of two aligned prisms, stays small.
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY, PIR_ERR_LIMIT (2^32 corners of facets or more).
 *
 * precision  PIR_DOUBLE, or PIR_EXACT for rationals beside the doubles.
 */
PIR_API pir_status pir_sum_mesh(pir_sum *sum, pir_precision precision, pir_mesh **ret_mesh);

/**
 * Writes the sum as bytes that any machine reads: both operands in exact coordinates, the scale each is set to, the
 * rotation, the pairing, the tolerance, the region, whether it is a difference; with a version and a checksum. Not its
 * certificates and counters.
 *
 * memory, size  the caller's, of exactly pir_sum_serialised_size bytes. Errors: PIR_ERR_ARGUMENT. O(size of the sum).
 */
PIR_API size_t pir_sum_serialised_size(const pir_sum *sum);
PIR_API pir_status pir_sum_serialise(const pir_sum *sum, void *memory, size_t size);

/**
 * The same to a stream, from its position on; the stream stays open. Errors: as above,
 * PIR_ERR_FILE, PIR_ERR_MEMORY.
 *
 * file, report  a stream open for writing; NULL, or filled when the call fails.
 *
 * Cost: O(size of the sum).
 */
PIR_API pir_status pir_sum_write(const pir_sum *sum, FILE *file, pir_report *report);

/**
 * Makes a sum from such bytes. They are not trusted: the operands are made anew as exact hulls, and the pairing is
 * proven pair by pair in exact arithmetic, so a sum that is restored is right; memory stays in proportion to `size`.
 *
 * allocator  NULL for malloc. report  NULL, or filled with what, where and why.
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_EMPTY, PIR_ERR_FORMAT, PIR_ERR_UNSUPPORTED (another version), PIR_ERR_LIMIT,
 * PIR_ERR_MEMORY.
 *
 * data, size  the bytes, which may come from anyone.
 *
 * Cost: two exact hulls, and O(size of the sum) with exact tests.
 */
PIR_API pir_status pir_sum_restore(const void *data, size_t size, const pir_allocator *allocator, pir_report *report,
                                   pir_sum **ret_sum);

/**
 * The same from a stream, which is left just past the sum; PIR_ERR_FILE when it cannot be read.
 *
 * file               a stream open for reading.
 * allocator, report  as of pir_sum_restore.
 *
 * Cost: as of pir_sum_restore.
 *
 * Errors as of pir_sum_restore, and PIR_ERR_FILE.
 */
PIR_API pir_status pir_sum_read(FILE *file, const pir_allocator *allocator, pir_report *report, pir_sum **ret_sum);

/** What the sum did since it was made. Plain counters. */
typedef struct pir_sum_statistics {
    uint64_t updates, rebuilds; /**< rotations brought in by update and by rebuild */
    uint64_t kept;              /**< rotations that a tolerance let the pairing stay behind of */
    uint64_t checked;           /**< certificates that expired */
    uint64_t repaired;          /**< pairs that had failed */
    uint64_t by_filter;         /**< signs that the double filter decided */
    uint64_t by_exact;          /**< signs that exact arithmetic decided */
    uint64_t by_perturbation;   /**< signs that were ties */
    uint64_t allocations;       /**< times the sum's memory grew after it was made */
} pir_sum_statistics;

PIR_API pir_sum_statistics pir_sum_get_statistics(const pir_sum *sum);

/** Sets all counters to zero. */
PIR_API void pir_sum_reset_statistics(pir_sum *sum);

#ifdef __cplusplus
}
#endif

#endif
