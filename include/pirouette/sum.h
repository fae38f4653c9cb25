/* SPDX-License-Identifier: MIT */
/**
 * The persistent Minkowski sum M = R·P ⊕ Q of two polytopes, kept up to date while P rotates.
 *
 * A sum stores the pairing: for every facet of P the vertex of Q that supports it (fv), for every facet of Q the vertex
 * of P (vf), and for every edge of P the edges of Q that its Gaussian arc crosses, in order (ee). Each pair is a facet
 * of the sum. Each fv and vf pair has a certificate, an angle through which the rotation may turn before the pair can
 * fail. An ee pair has the certificates of the four facets at the ends of its two arcs, because one of them must leave
 * its cell before the pair can fail. An update checks only the certificates that expire (after Behar and Lien, Dynamic
 * Minkowski Sum of Convex Shapes, GMU-CS-TR-2010-12, made right for steps of any size).
 *
 * Exactness: the pairing is that of the exact rotation M(q)/|q|². One symbolic perturbation of q settles all ties, so
 * the pairing is in general position and unique, and a tracked pairing equals a rebuilt one. It depends on the rotation
 * alone: q, −q and multiples have the same. The mesh is that of the true sum: coplanar pieces are merged.
 *
 * Threads: a sum belongs to one thread at a time; different sums are independent, even of the same polytopes.
 */
#ifndef PIROUETTE_SUM_H
#define PIROUETTE_SUM_H

#include <stdio.h>

#include <pirouette/base.h>
#include <pirouette/mesh.h>
#include <pirouette/polytope.h>
#include <pirouette/workspace.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_sum pir_sum;

/** How a sum is brought to a rotation. All methods give the same pairing. */
typedef enum pir_method {
    PIR_METHOD_AUTO = 0, /**< update or walk, whichever is cheaper by the sum's own counters */
    PIR_METHOD_UPDATE,   /**< repair the pairs that failed */
    PIR_METHOD_WALK,     /**< rebuild by walking one Gaussian map through the other */
    PIR_METHOD_CGM,      /**< rebuild by overlaying cubical Gaussian maps (cgm.h); allocates */
} pir_method;

typedef struct pir_sum_options {
    size_t size;                    /**< of this struct, which pir_sum_options_default sets (base.h) */
    const pir_allocator *allocator; /**< NULL for malloc; copied, its context must outlive the sum */
    bool difference; /**< true: keep Q ⊕ (−R·P), the difference that placement queries use; false: R·P ⊕ Q */
    /**
     * Scratch that the sum, and queries on it, share with others of its thread, so that each is small. All that share
     * it belong to one thread at a time. NULL: the sum makes scratch of its own, about 20 KB for small bodies, 120 KB
     * with a query.
     */
    pir_workspace *workspace;
} pir_sum_options;

/** malloc, no difference, scratch of its own. O(1). */
static inline pir_sum_options pir_sum_options_default(void) {
    const pir_sum_options options = {sizeof(pir_sum_options), NULL, false, NULL};
    return options;
}

/**
 * Makes the sum of P, rotated by `rotation`, and Q. Release it with pir_sum_destroy.
 *
 * p, q      of any dimension, 0 to 3; the sum takes a reference to each (to −P, the reflection, when
 *           options->difference).
 * rotation  of any length but 0.
 * options   NULL for the defaults.
 *
 * Cost: a walk, O(size of the sum).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_sum_create(pir_polytope *p, pir_polytope *q, pir_quat rotation, const pir_sum_options *options,
                                  pir_sum **ret_sum);

/**
 * Gives the caller's reference back. The sum is freed, and its references to the operands are given back, once the
 * queries and live meshes that were made on it are destroyed as well. NULL is accepted.
 *
 * Cost: the time to free it.
 */
PIR_API void pir_sum_destroy(pir_sum *sum);

/**
 * Brings the sum to `rotation`, any distance away from the last one.
 *
 * Allocates only while the list of crossings grows beyond what it has ever been. When the call fails the sum stays at
 * its previous rotation, whole and usable.
 *
 * method  how; every method gives the same pairing.
 *
 * Cost: PIR_METHOD_UPDATE follows the number of certificates that expire, PIR_METHOD_WALK the size of the sum.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_sum_rotate(pir_sum *sum, pir_quat rotation, pir_method method);

/**
 * Brings the sum to `rotation` by walk and forgets the motion so far: nothing that follows depends on it. The memory is
 * kept, so this does not allocate unless a longer list of crossings is needed.
 *
 * Cost: a walk, O(size of the sum).
 *
 * Errors as of pir_sum_rotate.
 */
PIR_API pir_status pir_sum_reset(pir_sum *sum, pir_quat rotation);

/**
 * Makes a second sum of the same operands at the same rotation, with the same pairing and counters at zero.
 *
 * allocator  NULL for that of `sum`.
 *
 * Cost: O(size of the sum).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_sum_clone(const pir_sum *sum, const pir_allocator *allocator, pir_sum **ret_sum);

/** Which operand. */
typedef enum pir_operand {
    PIR_OPERAND_P = 0, /**< the one that rotates */
    PIR_OPERAND_Q,     /**< the one that stands */
} pir_operand;

/**
 * Makes an operand `scale` times as large as it was when the sum was made, about its own origin. Scales do not
 * accumulate: each counts from the first size. The scale is taken exactly.
 *
 * No pair changes, so nothing is rebuilt, but a pairing that stays behind within a tolerance is settled first.
 * pir_sum_p, pir_sum_q and all later answers are of the new size. Queries and live meshes follow.
 *
 * Cost: O(n) for the operand's n vertices.
 *
 * Errors: PIR_ERR_NOT_FINITE, PIR_ERR_ARGUMENT (not positive), PIR_ERR_LIMIT (a coordinate beyond the doubles),
 * PIR_ERR_MEMORY; the sum then stays as it was.
 */
PIR_API pir_status pir_sum_set_scale(pir_sum *sum, pir_operand operand, double scale);

/**
 * Lets the pairing stay behind the rotation while that costs no more than `tolerance`, a length. The default is 0:
 * never.
 *
 * With a tolerance a rotation by PIR_METHOD_UPDATE leaves the pairing as it is while it may; by PIR_METHOD_AUTO, where
 * that saves work by the sum's own counters, so that no tolerance takes longer than none. The hull of the pairing's
 * vertices, placed by the rotation asked for, lies inside the true sum, and its support function falls short of the
 * true one by at most `tolerance` in every direction; pir_sum_shortfall_bound gives the bound attained. PIR_METHOD_WALK
 * and PIR_METHOD_CGM always bring the pairing to the rotation. Mesh vertices are placed by the rotation asked for. A
 * mesh merges pieces by the rotation at which the pairing is exact, and queries answer for that rotation. Settle the
 * sum first where the answer must be for the rotation asked for.
 *
 * The call itself brings the pairing to the rotation.
 *
 * Cost: O(n m) for the n facets and m vertices of each operand, here and in pir_sum_set_scale while there is a
 * tolerance.
 *
 * Errors: PIR_ERR_ARGUMENT (negative or NaN), PIR_ERR_NOT_FINITE, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_sum_set_tolerance(pir_sum *sum, double tolerance);
PIR_API double pir_sum_tolerance(const pir_sum *sum);

/**
 * An upper bound of what the support function of the sum as it is kept falls short of the true one by: 0 when the
 * pairing is exact.
 *
 * Cost: O(1).
 */
PIR_API double pir_sum_shortfall_bound(const pir_sum *sum);

/**
 * The rotation that the pairing is exact at: pir_sum_rotation, unless the pairing stays behind within a tolerance.
 * O(1).
 */
PIR_API pir_quat pir_sum_pairing_rotation(const pir_sum *sum);

/**
 * Brings the pairing to pir_sum_rotation when it has stayed behind.
 *
 * Cost: as of pir_sum_rotate with PIR_METHOD_AUTO.
 *
 * Errors as of pir_sum_rotate.
 */
PIR_API pir_status pir_sum_settle(pir_sum *sum);

/** In pir_sum_fv and pir_sum_vf: a pair that a region leaves out. */
#define PIR_NO_PAIR UINT32_MAX

/**
 * Keeps only the part of the sum whose outward normals are within `half_angle` radians of `axis`, in the frame of Q.
 * Without a call the whole sum is kept; pir_sum_clear_region returns to that. Updates then cost in proportion to what
 * the cone holds, with a skin around it of 1 to 7 degrees, five steps of the motion. So do walks, which keep next to no
 * skin while the axis rests.
 *
 * All pairs in the cone are there and right; rounding errs towards keeping a pair. Some other pairs may be there,
 * depending on the history of the sum, and are right too. A facet that is left out has PIR_NO_PAIR for its vertex, an
 * edge that is left out has no ee pairs. A P of dimension below 3 is kept whole.
 *
 * The call may be made in every frame: while the axis stays within the skin it does nothing more. Beyond the skin, or
 * with another half-angle, it chooses anew what is kept, a few operations for each facet, and locates what is new. The
 * first call allocates its work space, O(size of both operands); later ones allocate only as pir_sum_rotate does.
 *
 * On a sum with a region, a mesh is that of the whole sum, rebuilt for the call. Pairings are compared within both
 * regions. A live mesh has slots for what is kept. A clone and a file have the region. Queries answer for the region or
 * return PIR_ERR_REGION (query.h). With a tolerance, the bound on the support function holds for the directions of
 * the cone.
 *
 * axis        of any length but 0.
 * half_angle  from 0 to π. A greater one is the whole sphere.
 *
 * Cost: O(facets of both operands) where what is kept is chosen anew, else O(1).
 *
 * Errors: PIR_ERR_ARGUMENT (an axis of zeros, a negative angle), PIR_ERR_NOT_FINITE, PIR_ERR_MEMORY; the sum then keeps
 * the region it had.
 */
PIR_API pir_status pir_sum_set_region(pir_sum *sum, pir_vec3 axis, double half_angle);

/**
 * Keeps the whole sum again, as before any region. The work space of regions stays for the next one.
 *
 * Cost: O(size of the sum) where there was a region, else O(1).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY; the sum then keeps the region it had.
 */
PIR_API pir_status pir_sum_clear_region(pir_sum *sum);

/**
 * Returns true and the cone where a region has been set. Returns false and writes nothing where the sum is whole.
 *
 * ret_axis, ret_half_angle  the cone: an axis of unit length, and radians.
 *
 * Cost: O(1).
 */
PIR_API bool pir_sum_region(const pir_sum *sum, pir_vec3 *ret_axis, double *ret_half_angle);

/** The rotation that the sum was brought to, as it was given. O(1). */
PIR_API pir_quat pir_sum_rotation(const pir_sum *sum);

/** The operands as the sum holds them (P reflected when it keeps the difference); borrowed. O(1). */
PIR_API const pir_polytope *pir_sum_p(const pir_sum *sum);
PIR_API const pir_polytope *pir_sum_q(const pir_sum *sum);

/**
 * The vertex of Q paired with each facet of P; pir_polytope_facet_count(P) entries, valid until the next rotation.
 * O(1).
 */
PIR_API const uint32_t *pir_sum_fv(const pir_sum *sum);

/**
 * The vertex of P paired with each facet of Q; pir_polytope_facet_count(Q) entries, valid until the next rotation.
 * O(1).
 */
PIR_API const uint32_t *pir_sum_vf(const pir_sum *sum);

/** The number of ee pairs. O(1). */
PIR_API uint32_t pir_sum_ee_count(const pir_sum *sum);

/**
 * Writes the ee pairs: {edge of P, edge of Q}, by rising edge of P and, for each, in order along its arc. The pair of
 * two segments is there twice, for it has two facets. Room for pir_sum_ee_count pairs.
 *
 * Cost: O(edges of P + pairs).
 */
PIR_API void pir_sum_ee(const pir_sum *sum, uint32_t (*ret_pairs)[2]);

/**
 * Returns true when both sums hold the same fv, vf and ee pairs in the same order. Where regions are set, only pairs in
 * both cones are compared, without ee pairs whose edges are parallel within 2^-30.
 *
 * a, b  sums of the same polytopes.
 *
 * Cost: O(size of the sums).
 */
PIR_API bool pir_sum_same_pairing(const pir_sum *a, const pir_sum *b);

/**
 * A check for tests: every pair that is kept in exact arithmetic, every list of crossings from cell to cell. Returns
 * true when all hold.
 *
 * Cost: O(size of the sum), with exact tests.
 */
PIR_API bool pir_sum_is_valid(pir_sum *sum);

/**
 * The true sum as a mesh: coplanar pieces are merged, straight corners and pieces without area are dropped. The mesh is
 * the caller's and uses the sum's allocator. While it is made, memory holds the facets of the true sum and a bit for
 * each crossing, so a sum with many more pairs than facets, as of two aligned prisms, takes little.
 *
 * precision  PIR_DOUBLE, or PIR_EXACT for rationals beside the doubles.
 *
 * Cost: O(size of the sum).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY, PIR_ERR_LIMIT (2^32 corners of facets or more).
 */
PIR_API pir_status pir_sum_mesh(pir_sum *sum, pir_precision precision, pir_mesh **ret_mesh);

/**
 * Writes the sum as bytes that any machine reads: both operands in exact coordinates, the scale each is set to, the
 * rotation, the pairing, the tolerance, the region, whether it is a difference; with a version and a checksum.
 * Certificates and counters are not written.
 *
 * memory, size  the caller's, of exactly pir_sum_serialised_size bytes.
 *
 * Cost: O(size of the sum), for both calls.
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API size_t pir_sum_serialised_size(const pir_sum *sum);
PIR_API pir_status pir_sum_serialise(const pir_sum *sum, void *memory, size_t size);

/**
 * Writes the same bytes to a stream, from its position on. The stream stays open.
 *
 * file    a stream open for writing.
 * report  NULL, or filled when the call fails.
 *
 * Cost: O(size of the sum).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_FILE, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_sum_write(const pir_sum *sum, FILE *file, pir_report *report);

/**
 * Makes a sum from such bytes. They are not trusted: the operands are made anew as exact hulls, and every pair is
 * proven in exact arithmetic, so a sum that is restored is right. Memory stays in proportion to `size`.
 *
 * data, size  the bytes, which may come from anyone.
 * allocator   NULL for malloc.
 * report      NULL, or filled with what, where and why.
 *
 * Cost: two exact hulls, and O(size of the sum) with exact tests.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_EMPTY, PIR_ERR_FORMAT, PIR_ERR_VERSION, PIR_ERR_LIMIT,
 * PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_sum_restore(const void *data, size_t size, const pir_allocator *allocator, pir_report *report,
                                   pir_sum **ret_sum);

/**
 * Makes a sum from a stream, which is left just past the sum.
 *
 * file               a stream open for reading.
 * allocator, report  as of pir_sum_restore.
 *
 * Cost: as of pir_sum_restore.
 *
 * Errors as of pir_sum_restore, and PIR_ERR_FILE when the stream cannot be read.
 */
PIR_API pir_status pir_sum_read(FILE *file, const pir_allocator *allocator, pir_report *report, pir_sum **ret_sum);

/** The work of a sum since it was made, in plain counters. */
typedef struct pir_sum_statistics {
    uint64_t updates, rebuilds; /**< rotations brought in by update, and by rebuild */
    uint64_t kept;              /**< rotations that the pairing stayed behind of, within a tolerance */
    uint64_t checked;           /**< certificates that expired */
    uint64_t repaired;          /**< pairs that had failed */
    uint64_t by_filter;         /**< signs that the double filter decided */
    uint64_t by_exact;          /**< signs that exact arithmetic decided */
    uint64_t by_perturbation;   /**< signs that were ties */
    uint64_t allocations;       /**< times the sum's memory grew after it was made */
} pir_sum_statistics;

/** The counters of `sum`. O(1). */
PIR_API pir_sum_statistics pir_sum_get_statistics(const pir_sum *sum);

/** Sets all counters to zero. O(1). */
PIR_API void pir_sum_reset_statistics(pir_sum *sum);

#ifdef __cplusplus
}
#endif

#endif
