/* SPDX-License-Identifier: MIT */
/**
 * Pairs by need: two polytopes, both posed in the world, and the answers of placement queries without a sum.
 *
 * A pair keeps what its last answer needed, in levels:
 *
 *   - apart: a direction along which the bodies were apart, by how much, and the poses of both. While the motion since
 *     cannot have used that up, a query with a cutoff, or for the state or the depth alone, looks at neither body.
 *   - near: the vertices that hold the closest points. Distance is found by descent on supports (Gilbert, Johnson and
 *     Keerthi, IEEE J. Robotics and Automation 4(2), 1988), which begins there.
 *   - overlapping: a closed surface of triangles in the difference of the bodies, about the origin, expanded where its
 *     least distance is not yet proven to be the depth (after van den Bergen, Game Developers Conference, 2001).
 *   - whole: the difference itself (sum.h), in the workspace, for what the others leave open.
 *
 * An answer does not depend on the level. It is that of query.h: the state is exact for the very doubles given, witness
 * and ties are decided exactly, and numbers have the same bits whichever way they were found. Where Q's rotation is
 * (0, 0, 0, 1) and its translation 0, they are those of a query on a sum made with options.difference = 1.
 *
 * Frame: points and directions are in the world. `normal` points from Q to P. With Q turned, numbers and points are
 * within 1e-12 of the exact ones, relative to the size of the bodies and of the coordinates.
 *
 * Memory: a pair is one block, and a second one from its first deep overlap on. Scratch is in a pir_workspace, which is
 * given to each call and grows to what the largest pair needs; afterwards no call allocates, but those that take the
 * level `whole` for other bodies than the call before.
 *
 * Threads: a pair and a workspace belong to one thread at a time. Polytopes may be shared.
 *
 * Cost of a query of a pair: O(steps of the descent) when warm, O(√n) of them when cold; O(n log n) with the level
 * `whole`. Errors of a query of a pair: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT (a
 * translation beyond 2^400 times the size of the bodies, or, where Q is turned, a quaternion whose components span more
 * than 2^900), PIR_ERR_MEMORY (the workspace has to grow and cannot), PIR_ERR_LIMIT (see pir_pair_options).
 */
#ifndef PIROUETTE_PAIR_H
#define PIROUETTE_PAIR_H

#include <pirouette/base.h>
#include <pirouette/motion.h>
#include <pirouette/polytope.h>
#include <pirouette/pose.h>
#include <pirouette/query.h>
#include <pirouette/workspace.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_pair pir_pair;

/** How an answer was found. */
typedef enum pir_level {
    PIR_LEVEL_NONE = 0,    /**< nothing has been asked yet */
    PIR_LEVEL_APART,       /**< by an earlier proof of that and the motion since, or along its direction */
    PIR_LEVEL_NEAR,        /**< by descent on supports, or by the facet of the answer before */
    PIR_LEVEL_OVERLAPPING, /**< by a surface inside the difference, or by all its facets where it can have few */
    PIR_LEVEL_WHOLE,       /**< by the difference */
} pir_level;

typedef struct pir_pair_options {
    size_t size;                    /**< of this struct, which pir_pair_options_default sets (base.h) */
    const pir_allocator *allocator; /**< or NULL: malloc's */
    /**
     * The levels that may be used: those from `least` to `most`. PIR_LEVEL_WHOLE for both answers all by the
     * difference. Where none of them finds the answer, the call is PIR_ERR_LIMIT. PIR_LEVEL_NONE for `least` is
     * no bound.
     */
    pir_level least, most;
} pir_pair_options;

/** malloc's memory, all levels. O(1). */
static inline pir_pair_options pir_pair_options_default(void) {
    const pir_pair_options options = {sizeof(pir_pair_options), NULL, PIR_LEVEL_NONE, PIR_LEVEL_WHOLE};
    return options;
}

/**
 * A pair of P and Q, to which it takes references. What depends on one body alone is made once and stays with that
 * polytope, O(its size); after that O(1). `options` may be NULL. Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY,
 * PIR_ERR_LIMIT (a body farther from its origin than 2^400 times the size of both).
 *
 * p, q  of any dimension.
 */
PIR_API pir_status pir_pair_create(pir_polytope *p, pir_polytope *q, const pir_pair_options *options,
                                   pir_pair **ret_pair);

/** Frees, and gives its references back; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_pair_destroy(pir_pair *pair);

/**
 * Begins anew with other bodies, in the memory that is there: for pairs that come and go. Where both polytopes have
 * been in a pair with bodies of this size before, it allocates nothing. Errors as pir_pair_create; the pair is then
 * as it was.
 *
 * p, q  as of pir_pair_create.
 *
 * Cost: as of pir_pair_create.
 */
PIR_API pir_status pir_pair_reset(pir_pair *pair, pir_polytope *p, pir_polytope *q);

typedef struct pir_pair_input {
    pir_pose pose_p, pose_q;
    double radius_p, radius_q; /**< rounding radii, cutoff and margin as in pir_query_input */
    double cutoff, margin;
} pir_pair_input;

/** Both bodies at the origin, not turned; no radii, no cutoff, no margin. O(1). */
PIR_API pir_pair_input pir_pair_input_default(void);

/* --- the queries of query.h by the same names; their comments hold here --- */

/**
 * The exact state, without numbers.
 *
 * workspace, input  scratch, and the poses of both.
 *
 * Cost: that of a query of a pair.
 *
 * Errors: those of a query of a pair.
 */
PIR_API pir_status pir_pair_overlap(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                    pir_query_result *ret_result);

/**
 * The separation.
 *
 * workspace, input  scratch, and the poses of both.
 *
 * Cost: that of a query of a pair.
 *
 * Errors: those of a query of a pair.
 */
PIR_API pir_status pir_pair_distance(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                     pir_query_result *ret_result);

/**
 * The penetration depth.
 *
 * workspace, input  scratch, and the poses of both.
 *
 * Cost: that of a query of a pair.
 *
 * Errors: those of a query of a pair.
 */
PIR_API pir_status pir_pair_penetration(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                        pir_query_result *ret_result);

/**
 * Separation where separated, penetration where overlapping.
 *
 * workspace, input  scratch, and the poses of both.
 *
 * Cost: that of a query of a pair.
 *
 * Errors: those of a query of a pair.
 */
PIR_API pir_status pir_pair_signed_distance(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                            pir_query_result *ret_result);

/**
 * The contact manifold of `answer`, that of pir_pair_signed_distance with the same input; as pir_query_manifold.
 *
 * workspace               scratch.
 * capacity, ret_contacts  room for how many contacts, and that room.
 * ret_count               how many there are, also beyond the capacity.
 *
 * Cost: O(p · q) for patches of p and q vertices.
 *
 * Errors as of pir_query_manifold, and PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_pair_manifold(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                     const pir_query_result *answer, size_t capacity, pir_contact *ret_contacts,
                                     size_t *ret_count);

/* --- of the whole difference; their comments in query.h hold here, directions and ways are in the world --- */

/**
 * The directional penetration depth, as pir_query_directional_depth.
 *
 * workspace, input  scratch, and the poses of both; radii do not count.
 * direction         in the world, of any length but zero.
 *
 * Cost: O(size of the difference), and an update of it to the poses; a walk for other bodies than those of the last
 * call that needed the whole difference in this workspace.
 *
 * Errors: those of a query of a pair, also PIR_ERR_LIMIT without the level `whole`, and as of
 * pir_query_directional_depth for the direction.
 */
PIR_API pir_status pir_pair_directional_depth(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                              pir_vec3 direction, pir_query_result *ret_result);

/**
 * How far P moves along `direction` until it touches Q, as pir_query_directional_distance.
 *
 * workspace, input, direction  as of pir_pair_directional_depth.
 *
 * Cost: as of pir_pair_directional_depth.
 *
 * Errors: as of pir_pair_directional_depth.
 */
PIR_API pir_status pir_pair_directional_distance(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                                 pir_vec3 direction, pir_query_result *ret_result);

/**
 * The largest distance between a point of P and a point of Q, as pir_query_largest_distance.
 *
 * workspace, input  scratch, and the poses of both; radii count.
 *
 * Cost: as of pir_pair_directional_depth.
 *
 * Errors: those of a query of a pair, and PIR_ERR_LIMIT where the distance is beyond the largest double.
 */
PIR_API pir_status pir_pair_largest_distance(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                             pir_query_result *ret_result);

/**
 * Every facet of the difference through which P leaves by at most the depth plus `slack` (≥ 0), as pir_query_escapes.
 *
 * workspace, input       scratch, and the poses of both.
 * capacity, ret_escapes  room for how many, and that room.
 * ret_count              how many there are, also beyond the capacity.
 *
 * Cost: as of pir_pair_directional_depth, for each facet.
 *
 * Errors: those of a query of a pair, and PIR_ERR_ARGUMENT for a slack below 0 or NaN.
 */
PIR_API pir_status pir_pair_escapes(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, double slack,
                                    size_t capacity, pir_escape *ret_escapes, size_t *ret_count);

/**
 * A linear cast: P moves by `way` without turning, as pir_query_cast. The outcome is exact.
 *
 * workspace, input  scratch, and the poses at time 0; radii do not count.
 * way               in the world.
 *
 * Cost: as of pir_pair_directional_depth.
 *
 * Errors: those of a query of a pair, and PIR_ERR_NOT_FINITE for `way`.
 */
PIR_API pir_status pir_pair_cast(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, pir_vec3 way,
                                 pir_impact *ret_impact);

/**
 * When P first comes within `tolerance` of Q, by conservative advancement (Mirtich, 1996): before that time they share
 * no point. It takes no whole difference. The outcome is PIR_CAST_HIT, PIR_CAST_MISS, PIR_CAST_START_INSIDE or
 * PIR_CAST_STEP_LIMIT.
 *
 * workspace, input  scratch, and the poses at time 0; radii count.
 * motion            P's.
 * tolerance         > 0, a length; below 1e-10 of the size of bodies and coordinates it counts as that.
 *
 * Cost: at most 512 queries of a pair, of which most motions take fewer than ten, and, where P turns, as often O(its
 * vertices). After so many the outcome is PIR_CAST_STEP_LIMIT.
 *
 * Errors: those of a query of a pair; PIR_ERR_NOT_FINITE for the motion; PIR_ERR_ARGUMENT for a tolerance that is not
 * above 0 or `held` below 0; PIR_ERR_LIMIT for a turn beyond 2^20.
 */
PIR_API pir_status pir_pair_time_of_impact(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                           const pir_motion *motion, double tolerance, pir_impact *ret_impact);

/** How the last answer was found. O(1). */
PIR_API pir_level pir_pair_level(const pir_pair *pair);

/** Counters of a pair since it was made, or reset. */
typedef struct pir_pair_statistics {
    uint64_t queries;
    uint64_t by_proof;   /**< answers by a direction along which the bodies were apart before: the level `apart` */
    uint64_t by_walk;    /**< answers by the facet of the one before, or from there by a facet near that */
    uint64_t by_nearest; /**< answers by a descent to the nearest point */
    uint64_t by_depth;   /**< answers by facets of a surface in the difference, or by all that small bodies can have */
    uint64_t by_whole;   /**< answers by the difference: the level `whole` */
    uint64_t manifolds;  /**< contact manifolds of more than no contact */
    uint64_t supports;   /**< vertices added to surfaces */
    uint64_t begun;      /**< surfaces begun anew */
} pir_pair_statistics;

/** The counters of `pair`. O(1). */
PIR_API pir_pair_statistics pir_pair_get_statistics(const pir_pair *pair);

#ifdef __cplusplus
}
#endif

#endif
