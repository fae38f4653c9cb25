/* SPDX-License-Identifier: MIT */
/**
 * Slower ways to the same results, which sums and queries are measured and checked against. pirouette.h does not
 * include this header; programs that use the library have no need of it.
 */
#ifndef PIROUETTE_BASELINE_H
#define PIROUETTE_BASELINE_H

#include <pirouette/sum.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * The mesh of the true sum, or of the difference as `options` say, by another way than pir_sum_mesh: the exact hull of
 * all pairwise sums of vertices. It needs no pairing and shares no code with one, so that it is a second opinion. The
 * mesh is the caller's and uses the allocator of `options`. O(nm log nm) for n and m vertices.
 *
 * p, q, rotation  as of pir_sum_create.
 * options         NULL for the defaults.
 * precision       PIR_DOUBLE, or PIR_EXACT for rationals beside the doubles.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT (2^30 pairs of vertices or
 * more), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_hull_sum(const pir_polytope *p, const pir_polytope *q, pir_quat rotation,
                                const pir_sum_options *options, pir_precision precision, pir_mesh **ret_mesh);

/**
 * The mesh of a sum by the object-space method (Diktaş and Şahiner, An Object-Space Method for Calculating the
 * Minkowski Sums of Simple 3D Objects, 2006): along each normal that a facet of the sum can have, of a facet of P, a
 * facet of Q or an edge of each, the farthest vertices of both, and Euler's condition in the end. It keeps nothing and
 * needs no pairing. It serves simple bodies, of some tens of vertices; all comparisons are exact, so that aligned and
 * flat ones are no exception. The mesh is the caller's and uses the allocator of `options`.
 *
 * p, q, rotation      as of pir_sum_create.
 * options, precision  as of pir_hull_sum.
 *
 * Cost: O(v·e²) for two bodies of v vertices and e edges each, mostly far less: a pair of edges is given up at the
 * first vertex beyond it.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT (normals times vertices of both
 * are more than 2^32: from about 600 vertices each), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_object_sum(const pir_polytope *p, const pir_polytope *q, pir_quat rotation,
                                  const pir_sum_options *options, pir_precision precision, pir_mesh **ret_mesh);

/**
 * Brings `sum` to `rotation` by the brute-force re-check of all pairs (Algorithm 3.1 of Behar and Lien, Dynamic
 * Minkowski Sum of Convex Shapes, 2010): every facet against every vertex, every edge against every edge. The pairing
 * that it finds is the one that pir_sum_rotate finds. O(nm) for n and m vertices.
 *
 * rotation  of any length but 0.
 *
 * Errors as of pir_sum_rotate.
 */
PIR_API pir_status pir_sum_rotate_brute_force(pir_sum *sum, pir_quat rotation);

/**
 * At how many queries per rotation a tracked sum pays, by measured costs in one unit: the least number, HUGE_VAL when
 * it never does, NaN when a cost is negative or not a number. O(1).
 *
 * cost_rotation   per rotation of the sum: its update and the preparation of queries.
 * cost_query      per query on the sum.
 * cost_stateless  per query of an alternative that keeps no state.
 */
PIR_API double pir_query_break_even(double cost_rotation, double cost_query, double cost_stateless);

#ifdef __cplusplus
}
#endif

#endif
