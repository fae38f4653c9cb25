/* SPDX-License-Identifier: MIT */
/**
 * Placement queries of two bodies in convex pieces (pir_solid_decompose), both posed in the world.
 *
 * No union is built: the state of two bodies is that of any pair of pieces, their distance the least of all pairs,
 * their first contact the first of all. Their depth is not that of any pair: it is searched among the facets of all
 * sums of pieces. The insides of two bodies meet exactly where those of two pieces do, so a wall
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
#include <pirouette/gradient.h>
#include <pirouette/impact.h>
#include <pirouette/motion.h>
#include <pirouette/pair.h>
#include <pirouette/solid.h>
#include <pirouette/sweep.h>
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
 * The distance of two bodies in convex pieces, as pir_solid_query_distance gives it, with its derivatives: those of the
 * two pieces that it names, whose features they are of. All are 0, without features, where the bodies overlap, for
 * their depth is not that of two pieces. Where several pairs of pieces have the distance they are those of the first.
 *
 * workspace, input  scratch, poses, radii and cutoff.
 * ret_distance      the answer.
 * ret_gradient      its first derivatives.
 * ret_curvature     NULL where second derivatives are not wanted.
 *
 * Cost: that of pir_solid_query_distance, and of a query of a pair.
 *
 * Errors: those of a query.
 */
PIR_API pir_status pir_solid_query_gradient(pir_solid_query *query, pir_workspace *workspace,
                                            const pir_pair_input *input, pir_solid_distance *ret_distance,
                                            pir_gradient *ret_gradient, pir_curvature *ret_curvature);

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

/**
 * When P first touches Q in a turn about an axis, on a way, or in a screw, exactly: the first contact of all pairs of
 * pieces, as pir_pair_impact tells it. Contacts of two pairs are compared as algebraic numbers; of equal ones that of
 * the lowest piece of P, then of Q, is told, with its pieces, and with its planes as `steps`.
 *
 * PIR_CAST_START_INSIDE is told without a witness, pieces, point and normal, for overlaps are not those of two pieces.
 * Bodies that touch at the start are told by a pair that overlaps just after it, PIR_CAST_HIT at time 0, or, where
 * there is none, by one that touches, PIR_CAST_RECEDING.
 *
 * workspace, input  scratch, and the poses at the start; radii, cutoff and margin do not count.
 * motion            P's; Q rests.
 * ret_impact        features are those of the pieces.
 *
 * Cost: that of pir_solid_query_overlap, and of pir_pair_impact for each pair of pieces that is no farther apart at the
 * start than a point of P goes until the contact; for each tie of two pairs O(1) of these again, in exact arithmetic.
 *
 * Errors: those of a query and of pir_pair_impact.
 */
PIR_API pir_status pir_solid_query_impact(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *input,
                                          const pir_exact_motion *motion, pir_exact_impact *ret_impact);

/**
 * Whether two bodies are free all along a motion of both from poses to poses, or meet, as pir_pair_sweep: of all pairs
 * of pieces that may come to each other. `from` is the least of those that are not free. `to` is the first time at
 * which a pair is proven to share a point, or else the last of what is undecided; `queries` are those of all pairs.
 *
 * workspace      scratch.
 * first, second  the poses at times 0 and 1, in the world; the radii of `first` count, cutoff and margin do not.
 * budget         the most distances that are asked for of a pair of pieces; 0 for PIR_SWEEP_BUDGET.
 *
 * Cost: that of pir_pair_sweep for each pair of pieces that is no farther apart at the start than points of both go
 * until they meet.
 *
 * Errors: those of pir_pair_sweep.
 */
PIR_API pir_status pir_solid_query_sweep(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *first,
                                         const pir_pair_input *second, uint32_t budget, pir_sweep_result *ret_sweep);

/**
 * Whether two bodies are free all along a turn, a way or a screw of P, as pir_pair_sweep_screw: of all pairs of pieces
 * that may come to each other. The result is as that of pir_solid_query_sweep.
 *
 * workspace  scratch.
 * input      the poses at time 0, in the world; the radii count, cutoff and margin do not.
 * motion     P's, its way proportional to the angle; Q rests.
 * budget     the most distances that are asked for of a pair of pieces; 0 for PIR_SWEEP_BUDGET.
 *
 * Cost: that of pir_pair_sweep_screw for each pair of pieces that may meet, as of pir_solid_query_sweep.
 *
 * Errors: those of pir_pair_sweep_screw.
 */
PIR_API pir_status pir_solid_query_sweep_screw(pir_solid_query *query, pir_workspace *workspace,
                                               const pir_pair_input *input, const pir_exact_motion *motion,
                                               uint32_t budget, pir_sweep_result *ret_sweep);

/** A facet of the sum of two pieces, which P may not move into: a facet of one and a vertex of the other, or an edge
 * of each. */
typedef struct pir_solid_facet {
    uint32_t piece_p, piece_q;
    pir_witness witness; /**< features of the pieces (pir_pieces_polytope) */
} pir_solid_facet;

/** How deep a body is in another. But for the state all is 0 unless that is PIR_INSIDE. */
typedef struct pir_solid_depth {
    pir_state state;
    double depth; /**< the length of a translation of P after which the insides share no point */
    pir_vec3 normal;
    /** Where the bodies touch after that translation, the middle of what the pieces of facet[0] then share: on Q, and
     * the same point of P where P is now. */
    pir_vec3 point_p, point_q;
    /** How many facets determine the place: 1 within a facet, 2 on an edge where facets meet, 3 at a corner. */
    uint32_t facets;
    pir_solid_facet facet[3]; /**< P leaves by the first */
    uint32_t pairs;           /**< of pieces that were looked at; depends on what was asked before */
} pir_solid_depth;

/**
 * The depth: the length of the shortest translation of P that ends the overlap, over all ways out, those into cavities
 * and pockets too. It is that of the bodies, not of any pair of pieces: the nearest point of the boundary of the union
 * of all sums of pieces, which is never built.
 *
 * Free is where the insides share no point: touching is free, and so is a passage that P fits through exactly, as it is
 * to pir_solid_query_overlap. The least facet is decided exactly. Of places that are equally near the one on the first
 * facet counts: by the piece of P, then of Q, then as in pir_query_penetration; then the one with the least
 * coordinates as Q sees them.
 *
 * workspace, input  scratch, and the poses of both; radii, cutoff and margin do not count.
 * ret_depth         `normal` is the unit vector along which P is moved by `depth`.
 *
 * Memory: made when first asked for, 200 bytes for each vertex, edge and facet of a piece, then 120 bytes for each
 * facet of a sum of pieces that was looked at, and exact numbers. It is kept, and grows to what the largest answer
 * needs; then no call allocates but GMP, for exact numbers.
 *
 * Cost: that of pir_solid_query_overlap, and O(k · e · f) for the k pairs of pieces that are nearer than the depth,
 * of e and f edges.
 *
 * Errors: those of a query; PIR_ERR_LIMIT where more than 2^22 facets, parts of facets or points had to be looked at.
 */
PIR_API pir_status pir_solid_query_depth(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *input,
                                         pir_solid_depth *ret_depth);

/**
 * The directional depth: how far P moves along a direction until the insides first share no point; it may meet Q again
 * farther on. Exact as pir_solid_query_depth.
 *
 * workspace, input  as of pir_solid_query_depth.
 * direction         in the world, of any length but zero.
 * ret_depth         `normal` is that of the facet that P leaves by, the first of all that meet there, and `facets` 1.
 *
 * Cost: as of pir_solid_query_depth, with the pairs whose sums the way passes through.
 *
 * Errors: as of pir_solid_query_depth; PIR_ERR_NOT_FINITE and PIR_ERR_ARGUMENT for the direction.
 */
PIR_API pir_status pir_solid_query_directional_depth(pir_solid_query *query, pir_workspace *workspace,
                                                     const pir_pair_input *input, pir_vec3 direction,
                                                     pir_solid_depth *ret_depth);

#ifdef __cplusplus
}
#endif

#endif
