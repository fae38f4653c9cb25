/* SPDX-License-Identifier: MIT */
/**
 * Placement queries of two bodies in convex pieces (pir_solid_decompose), both posed in the world.
 *
 * No union is built: the state of two bodies is that of any pair of pieces, their distance the least of all pairs,
 * their first contact the first of all. The insides of two bodies meet exactly where those of two pieces do, so a wall
 * between pieces gives no contact: bodies that touch it from within overlap. A tree over boxes finds the pairs that
 * matter.
 *
 * Exactness, frame and numbers are those of pair.h. Answers are the same, bit for bit, whatever was asked before. Where
 * several pairs of pieces have the same distance, the answer is that of the lowest piece of P, then of Q.
 *
 * Threads: a query belongs to one thread at a time, as its workspace does.
 *
 * Memory: a query holds the pieces as polytopes, and up to 256 pairs, which it makes as they are needed.
 *
 * Cost of a query: O(k) queries of a pair for the k pairs of pieces whose boxes are nearer than the answer, and
 * O(k log n) for the tree. Errors of a query: those of a query of a pair.
 */
#ifndef PIROUETTE_SOLID_QUERY_H
#define PIROUETTE_SOLID_QUERY_H

#include <pirouette/base.h>
#include <pirouette/motion.h>
#include <pirouette/pair.h>
#include <pirouette/solid.h>
#include <pirouette/workspace.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_solid_query pir_solid_query;

/**
 * A query of two bodies. `allocator` may be NULL. Both may be the same pieces.
 *
 * p, q       copied.
 * ret_query  to be freed with pir_solid_query_destroy.
 *
 * Cost: that of pir_pieces_polytope for every piece.
 *
 * Errors: PIR_ERR_ARGUMENT, and those of pir_pieces_polytope.
 */
PIR_API pir_status pir_solid_query_create(const pir_pieces *p, const pir_pieces *q, const pir_allocator *allocator,
                                          pir_solid_query **ret_query);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_solid_query_destroy(pir_solid_query *query);

/**
 * The exact state, without numbers: PIR_INSIDE where the insides meet, PIR_BOUNDARY where the bodies only share points
 * of their boundaries, as in a passage that one fits through exactly, PIR_OUTSIDE where they share none.
 *
 * workspace, input  scratch, and the poses of both; cutoff and margin do not count.
 *
 * Cost: that of a query.
 *
 * Errors: those of a query.
 */
PIR_API pir_status pir_solid_query_overlap(pir_solid_query *query, pir_workspace *workspace,
                                           const pir_pair_input *input, pir_state *ret_state);

/** The separation of two bodies. */
typedef struct pir_solid_distance {
    /** That of the pair of pieces with the least distance; its features are those of the pieces. Of bodies that
     * overlap, state and outcome alone count: the distance is 0. */
    pir_query_result result;
    uint32_t piece_p, piece_q; /**< 0 where bodies overlap, or are beyond the cutoff */
    uint32_t pairs;            /**< of pieces that were asked about; depends on what was asked before */
} pir_solid_distance;

/**
 * The separation, its points and its normal.
 *
 * workspace, input  scratch, poses, radii and cutoff.
 *
 * Cost: that of a query.
 *
 * Errors: those of a query.
 */
PIR_API pir_status pir_solid_query_distance(pir_solid_query *query, pir_workspace *workspace,
                                            const pir_pair_input *input, pir_solid_distance *ret_distance);

/**
 * When P first comes within the tolerance of Q, by conservative advancement (Mirtich, 1996) of each pair of pieces
 * that may be first: before that time the bodies share no point. An advance that takes too many steps ends with
 * PIR_CAST_STEP_LIMIT, as of pir_scene_cast.
 *
 * workspace, input  scratch, and the poses at time 0; radii count.
 * motion            P's.
 * tolerance         > 0, a length: bodies this near count as met.
 *
 * Cost: that of a query, for each pair some queries of a pair, and, where P turns, as often O(vertices of its piece).
 *
 * Errors: those of a query; PIR_ERR_NOT_FINITE for the motion; PIR_ERR_ARGUMENT for a tolerance that is not
 * above 0 or `held` below 0; PIR_ERR_LIMIT for a turn beyond 2^20.
 */
PIR_API pir_status pir_solid_query_cast(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *input,
                                        const pir_motion *motion, double tolerance, pir_impact *ret_impact);

#ifdef __cplusplus
}
#endif

#endif
