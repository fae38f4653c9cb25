/* SPDX-License-Identifier: MIT */
/**
 * Placement queries. P is rotated as a sum says and moved by a translation; Q does not move.
 *
 * A query object answers from a tracked difference Q ⊕ (−R·P) (pir_sum_options.difference): P moved by t overlaps
 * Q exactly when t lies in the difference. It follows the sum: rotate the sum, then ask again.
 *
 * Touching, in every call. The state is PIR_BOUNDARY when t lies exactly on the boundary of the difference: the
 * bodies share a point, but no interior points. It is PIR_INSIDE when all translations in some ball around t overlap,
 * and PIR_OUTSIDE when the bodies share no point. States are exact for the doubles given; only rounding radii make
 * them floating (pir_query_input). Numbers are doubles within 1e-12 of the exact ones, relative to the size of the
 * bodies and of the answer.
 *
 * Frame: every point and direction is in the frame of Q, every length in the unit of the bodies' coordinates.
 * `normal` is a unit vector that points from Q to P; moving P along it separates the bodies. In every answer point_p
 * = point_q + distance · normal, also at distance 0. Where the bodies overlap, distance is minus the depth.
 *
 * Regions. A sum with a region (pir_sum_set_region) answers pir_query_penetration and pir_query_directional_depth
 * only, from its facets whose normals lie in the cone. PIR_OUTSIDE with PIR_SEPARATED proves that the bodies are
 * apart. Otherwise the outcome is PIR_NOT_SEPARATED: the state is PIR_BOUNDARY where one of these facets passes
 * through t, else PIR_INSIDE. Overlap is not proven then. The depth is the least over facets in the cone: the true
 * depth if its normal lies there, otherwise an upper bound. Normal and points belong to that facet. The outcome is
 * PIR_NO_HIT where no facet lies in the cone, or where the direction leaves through none of them. All other calls,
 * and rounding radii, give PIR_ERR_REGION. The answer depends on placement and region, not on what else the sum
 * keeps.
 *
 * Determinism: an answer depends on the bodies, the rotation and the input alone. Every number and witness is the
 * same, bit for bit, with any cache or none, after any other queries, and in a batch. Only `steps` depends on the way
 * there.
 *
 * Warm start: a cache belongs to the caller, begins as zeros, and may be passed from pose to pose. It changes only
 * how fast an answer is found.
 *
 * Threads: a query belongs to one thread at a time, that of its sum. Once a query has seen its greatest number of
 * edge pairs, no call allocates; a batch needs memory of its own the first time. Every loop has a bound.
 *
 * Lifetimes: a query holds references to its sum and to the operands, so they may be destroyed before it. It then
 * answers for the sum as it was last. It follows every change of the sum: rotation, scale, region, reset. The first
 * call after pir_sum_set_scale makes again what depends on coordinates, O(size of both operands). It is the scaled
 * polytope's, in memory of that one's allocator; the sum's gives memory only where the scale has more digits than any
 * before. Where that fails (PIR_ERR_MEMORY, or PIR_ERR_LIMIT for a body
 * that is now too far away for its size), the call fails, and the next one tries again.
 *
 * Cost of a query: O(size of the sum) at most. With the cache of a near pose, a distance takes some steps of a
 * descent, and a depth looks at a few groups of facets. `steps` counts both.
 *
 * Errors of a query: PIR_ERR_ARGUMENT (NULL, a radius below 0 or infinite), PIR_ERR_NOT_FINITE (a translation, radius
 * or cutoff), PIR_ERR_LIMIT (a translation farther than 2^400 times the size of the bodies; of two points that is 1, or
 * their largest coordinate where that is beyond 2^300 or below 2^-300), PIR_ERR_REGION (on a sum with a region, as
 * said above), PIR_ERR_MEMORY (room for a sum that has grown). `cache` may be NULL.
 */
#ifndef PIROUETTE_QUERY_H
#define PIROUETTE_QUERY_H

#include <pirouette/base.h>
#include <pirouette/motion.h>
#include <pirouette/polytope.h>
#include <pirouette/sum.h>
#include <pirouette/witness.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_query pir_query;

/** Where a translation lies: see the touching rule above. */
typedef enum pir_state {
    PIR_OUTSIDE = 0,
    PIR_BOUNDARY,
    PIR_INSIDE,
} pir_state;

/** How a query ended. Not finishing is an outcome of its own. */
typedef enum pir_outcome {
    PIR_SEPARATED = 0, /**< the bodies share no point; numbers are those of the separation */
    PIR_TOUCHING,      /**< they share a point, no interiors do; distance is 0 */
    PIR_OVERLAPPING,   /**< interiors meet; numbers are those of the penetration */
    PIR_BEYOND_CUTOFF, /**< separated by more than the cutoff: distance is the cutoff, normal and points are not set */
    PIR_NO_HIT,        /**< a cast or a direction that meets nothing, or recedes */
    PIR_STEP_LIMIT,    /**< the bound on steps was reached; the state is exact, other numbers are the best so far */
    PIR_NOT_SEPARATED, /**< on a sum with a region: none of its facets there separates the bodies; see above */
} pir_outcome;

/**
 * The caller's memory of the last answer. It starts zeroed, and its contents are the library's. Any content is safe.
 */
typedef struct pir_query_cache {
    uint32_t points; /* vertex pairs of the last separation, 0 when cold */
    uint32_t p[3], q[3];
    uint32_t pieces;              /* 1 when the facet below is set, else 0 */
    uint32_t kind, first, second; /* a facet of the difference: that of the least slack, or one that separates */
} pir_query_cache;

typedef struct pir_query_input {
    pir_vec3 translation; /**< of P, after its rotation */
    /** Rounding radii, ≥ 0: each body grows by a ball. The state then follows from the rounded distance. */
    double radius_p, radius_q;
    double cutoff; /**< distances above this need not be computed; HUGE_VAL for none */
    double margin; /**< for pir_query_manifold only, ≥ 0: contacts up to this distance apart are given too */
} pir_query_input;

/** Translation 0, no radii, no cutoff, no margin. O(1). */
PIR_API pir_query_input pir_query_input_default(void);

typedef struct pir_query_result {
    pir_state state;
    pir_outcome outcome;
    double distance; /**< signed: separation, 0, or minus the depth */
    pir_vec3 normal; /**< unit, from Q to P */
    pir_vec3 point_p, point_q;
    pir_witness witness;
    uint32_t steps; /**< support evaluations and groups of facets looked at */
} pir_query_result;

/**
 * Makes a query object on `difference`: a sum made with options.difference = true, its clone, or one restored from its
 * bytes. The query takes a reference to it. Its memory comes from the sum's allocator, scratch from the sum's workspace
 * (pir_sum_options). What depends on one operand alone is made once, O(its size · log), and stays with that polytope;
 * after that O(groups of facets).
 * Errors: PIR_ERR_ARGUMENT, also for a sum that is no difference; PIR_ERR_LIMIT for a body farther from its origin
 * than 2^400 times the size of both; PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_query_create(pir_sum *difference, pir_query **ret_query);

/** Frees a query and gives its references back. NULL is accepted. Cost: the time to free it. */
PIR_API void pir_query_destroy(pir_query *query);

/**
 * Whether the bodies overlap: state and outcome, exact, without a distance, so that no cutoff counts. On the boundary,
 * normal, points and witness are those of the contact. Elsewhere they are not set.
 *
 * input  where P is.
 * cache  NULL, or the caller's memory of an earlier answer.
 *
 * Cost: that of a query.
 *
 * Errors: those of a query.
 */
PIR_API pir_status pir_query_overlap(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                                     pir_query_result *ret_result);

/**
 * The separation distance and the closest points. They come from a descent on the difference that starts at the
 * cached features (after Gilbert, Johnson and Keerthi, IEEE J. Robotics and Automation 4(2), 1988; supports by hill
 * climbing). Where the bodies touch or overlap the distance is 0, and the outcome says which. The points are then
 * those of the contact where they touch, and not set where they overlap.
 *
 * input, cache  as of pir_query_overlap.
 *
 * Cost: that of a query.
 *
 * Errors: those of a query.
 */
PIR_API pir_status pir_query_distance(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                                      pir_query_result *ret_result);

/**
 * The penetration depth: the length of the shortest translation of P that ends the overlap, which is the minimum over
 * every facet of the difference. Which facet is least is decided exactly. Of facets that tie exactly the first wins:
 * those on which a facet of P lies, by its index; then those on which a facet of Q lies, by its index; then those of
 * two edges, by the index of P's edge, then of Q's. Where the bodies do not overlap the distance is 0, and the
 * outcome says why.
 *
 * input, cache  as of pir_query_overlap.
 *
 * Cost: that of a query.
 *
 * Errors: those of a query.
 */
PIR_API pir_status pir_query_penetration(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                                         pir_query_result *ret_result);

/**
 * The separation where the bodies are apart, the penetration where they overlap.
 *
 * input, cache  as of pir_query_overlap.
 *
 * Cost: that of a query.
 *
 * Errors: those of a query.
 */
PIR_API pir_status pir_query_signed_distance(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                                             pir_query_result *ret_result);

/** One way out of an overlap. */
typedef struct pir_escape {
    double depth;
    pir_vec3 normal;
    pir_witness witness;
} pir_escape;

/**
 * Finds every facet of the difference through which P leaves by at most the depth plus `slack` (≥ 0), in the order of
 * the tie rule. There are none unless the bodies overlap. A witness here names the faces of P and Q that make the
 * facet. A facet counts as within `slack` up to 2^-44 of the size of the bodies.
 *
 * input                  where P is.
 * capacity, ret_escapes  room for how many, and that room.
 * ret_count              how many there are, also beyond the capacity.
 *
 * Cost: O(size of the sum) for each facet.
 *
 * Errors: those of a query, and PIR_ERR_ARGUMENT for a slack below 0 or NaN.
 */
PIR_API pir_status pir_query_escapes(pir_query *query, const pir_query_input *input, double slack, size_t capacity,
                                     pir_escape *ret_escapes, size_t *ret_count);

/**
 * The directional penetration depth: how far P moves along `direction`, of any length but zero, until the overlap
 * ends. It is a length, whatever the length of `direction`. result.distance is minus the depth, result.normal is that
 * of the facet that P leaves by, and point_p = point_q is P's contact there. PIR_NO_HIT where the bodies do not
 * overlap.
 *
 * input  where P is; radii do not count.
 *
 * Cost: O(size of the sum).
 *
 * Errors: those of a query, for `direction` as well: PIR_ERR_NOT_FINITE, and PIR_ERR_ARGUMENT when it is zero.
 */
PIR_API pir_status pir_query_directional_depth(pir_query *query, const pir_query_input *input, pir_vec3 direction,
                                               pir_query_result *ret_result);

/**
 * How far P moves along `direction` until it touches Q: 0 where it touches or overlaps already, PIR_NO_HIT where it
 * never does. Whether it does is exact: grazing is touching, sliding along a face with any gap is not.
 *
 * input  where P is; radii do not count.
 *
 * Cost: O(size of the sum).
 *
 * Errors as of pir_query_directional_depth.
 */
PIR_API pir_status pir_query_directional_distance(pir_query *query, const pir_query_input *input, pir_vec3 direction,
                                                  pir_query_result *ret_result);

/**
 * A linear cast: P moves from input->translation by `way`, without turning. The outcome is exact.
 *
 * input, way  where P begins, and how it moves, in the frame of Q; radii do not count.
 *
 * Cost: O(size of the sum).
 *
 * Errors: those of a query, and PIR_ERR_NOT_FINITE for `way`.
 */
PIR_API pir_status pir_query_cast(pir_query *query, const pir_query_input *input, pir_vec3 way, pir_impact *ret_impact);

/**
 * Conservative advancement (Mirtich, 1996): the time of first contact within `tolerance` of P, which begins at the
 * sum's rotation and input->translation. There is no contact before `time`, and at `time` the bodies are apart by at
 * most `tolerance`. Rotates the sum, which is left at the last rotation that was tried.
 *
 * input      where P begins; radii count.
 * motion     over which P moves, at any speed.
 * tolerance  > 0, a length.
 *
 * Cost: at most 256 rotations of the sum, each with a distance query. After so many the outcome is PIR_CAST_STEP_LIMIT.
 *
 * Errors: those of a query and of pir_sum_rotate; PIR_ERR_ARGUMENT for a tolerance not above 0 or `held` below 0;
 * PIR_ERR_LIMIT for a turn beyond 2^20.
 */
PIR_API pir_status pir_query_time_of_impact(pir_query *query, const pir_query_input *input, const pir_motion *motion,
                                            double tolerance, pir_impact *ret_impact);

/**
 * The largest distance between a point of P and a point of Q. Vertices attain it. Normal, points and witness are as
 * in a separation. O(size of the sum).
 *
 * input  where P is.
 *
 * Errors: those of a query; PIR_ERR_LIMIT also where the distance is beyond the largest double.
 */
PIR_API pir_status pir_query_largest_distance(pir_query *query, const pir_query_input *input,
                                              pir_query_result *ret_result);

/** A contact: a point of each body, one over the other along the normal. */
typedef struct pir_contact {
    pir_vec3 point_p, point_q;
    double distance; /**< along the manifold's normal; negative where the bodies overlap */
    uint64_t id;     /**< of the features that meet here, the same from frame to frame while they meet */
} pir_contact;

/**
 * The contact manifold of `answer`, an answer of pir_query_signed_distance at the same rotation and with the same
 * input: where the surface patches that carry the answer lie over each other along its normal.
 *
 * A patch is the vertex, edge or facet that carries the answer, and everything that edges in its plane lead to. An
 * edge is in the plane when it is within 0.056° of it (a sine of 2^-10), so that facets that are coplanar but for
 * rounding are one. Where one body has an area there and the other has none, the other is tilted: its patch is the
 * facet there that faces the first body most. A patch that has a part of such a facet has all of it.
 *
 * The first contact is the answer itself, with its points and its distance. The others are the corners of the region
 * that the patches share, counter-clockwise about the normal. Where the answer lies on a corner, the first contact is
 * that corner. Where it lies elsewhere in the region, both top bits of its id are set, and of no other id. Two
 * parallel edges share a segment, with two corners. Points lie on the surfaces of their bodies, and point_p = point_q
 * + distance · normal, within 1e-12 of the size and distance of the bodies. Where edges are parallel only nearly, the
 * end of one has its point on a facet beside the other edge, and is no contact where it is beside the body.
 *
 * A corner is a contact where its distance is at most the greatest of input->margin, the answer's distance, and 0, or
 * where it rises from the answer's point by at most 2^-20 of the way to it. So a larger margin only adds contacts.
 * Bodies apart by less than the margin have contacts of positive distance, by which a solver may let them approach in
 * a step ("speculative contacts"). Ids are distinct. With radii, points move by them along the normal; where a facet
 * is tilted, that is inside of the rounded body by up to radius · (1 − cosine).
 *
 * There are none where the answer has no points (PIR_BEYOND_CUTOFF, PIR_NO_HIT).
 *
 * capacity, ret_contacts  room for how many contacts, and that room.
 * ret_count               how many there are, also beyond the capacity.
 *
 * Cost: O(p · q) for patches of p and q vertices.
 *
 * Errors: those of a query, PIR_ERR_ARGUMENT also for a margin below 0 and for an answer without a unit normal or
 * with features that these bodies lack, and PIR_ERR_NOT_FINITE for a margin that is not a number.
 */
PIR_API pir_status pir_query_manifold(pir_query *query, const pir_query_input *input, const pir_query_result *answer,
                                      size_t capacity, pir_contact *ret_contacts, size_t *ret_count);

/*
 * --- many translations at one rotation ---
 *
 * The answers are those of single queries. The first batch at a rotation lays out all facets of the difference,
 * O(size of the sum); the first batch of all makes the memory for that. Errors as for single queries; all translations
 * are checked before any is answered.
 */

/**
 * The exact state of each of `count` translations.
 *
 * translations, count  of P, in the frame of Q.
 * ret_states           room for `count` of them.
 *
 * Cost: O(count) queries, after O(size of the sum) once a rotation.
 *
 * Errors: those of a query.
 */
PIR_API pir_status pir_query_batch_states(pir_query *query, const pir_vec3 *translations, size_t count,
                                          pir_state *ret_states);

/**
 * The penetration depth of each translation, 0 unless PIR_INSIDE. ret_states may be NULL.
 *
 * translations, count  as of pir_query_batch_states.
 * ret_depths           room for `count` of them, at least 0.
 *
 * Cost: O(count) queries, after O(size of the sum) once a rotation.
 *
 * Errors: those of a query.
 */
PIR_API pir_status pir_query_batch_depths(pir_query *query, const pir_vec3 *translations, size_t count,
                                          double *ret_depths, pir_state *ret_states);

/**
 * The signed distance of each translation.
 *
 * translations, count        as of pir_query_batch_states.
 * ret_distances, ret_states  room for `count` of them; ret_states may be NULL.
 *
 * Cost: O(count) queries, after O(size of the sum) once a rotation.
 *
 * Errors: those of a query.
 */
PIR_API pir_status pir_query_batch_distances(pir_query *query, const pir_vec3 *translations, size_t count,
                                             double *ret_distances, pir_state *ret_states);

#ifdef __cplusplus
}
#endif

#endif
