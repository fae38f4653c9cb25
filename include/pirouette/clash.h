/* SPDX-License-Identifier: MIT */
/**
 * Clashes: what two solids that stand where they are have in common, as people who check buildings name it.
 *
 * Kinds are decided exactly: no tolerance has a part in them. docs/clash.md defines each. Lengths are in units of the
 * models, in their common frame.
 *
 * Threads: a body is immutable and may be read by several threads; a workspace belongs to one at a time.
 */
#ifndef PIROUETTE_CLASH_H
#define PIROUETTE_CLASH_H

#include <pirouette/base.h>
#include <pirouette/solid.h>
#include <pirouette/workspace.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A solid made ready for verdicts: its convex pieces, its volume, its bounds. */
typedef struct pir_clash_body pir_clash_body;

/**
 * Makes a solid ready.
 *
 * solid     borrowed for the call.
 * options   NULL for the defaults. Their memory bounds each later verdict as well; their report is for this call.
 * ret_body  to be freed with pir_clash_body_destroy.
 *
 * Cost: that of pir_solid_decompose by facets, and a hull for each piece.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_VERSION, PIR_ERR_LIMIT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_clash_body_create(const pir_solid *solid, const pir_solid_options *options,
                                         pir_clash_body **ret_body);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_clash_body_destroy(pir_clash_body *body);

/** Of two bodies A and B. The kinds after PIR_CLASH_TOUCHING are those of bodies whose insides meet. */
typedef enum pir_clash_kind {
    PIR_CLASH_APART,      /**< they share no point */
    PIR_CLASH_TOUCHING,   /**< they share points, but none within both */
    PIR_CLASH_PROTRUSION, /**< one reaches into the other, and neither cuts the other into more parts */
    PIR_CLASH_PIERCING,   /**< one less the other has more connected parts than it has itself */
    PIR_CLASH_ENVELOPE,   /**< one is within the other, its boundary included, and smaller */
    PIR_CLASH_DUPLICATE   /**< both are the same set of points */
} pir_clash_kind;

/** The verdict on A and B. */
typedef struct pir_clash_verdict {
    pir_clash_kind kind;
    int dimension;             /**< of what they share: −1 nothing, 0 points, 1 segments, 2 facets, 3 a volume */
    double distance;           /**< 0 unless they are apart */
    pir_vec3 point_a, point_b; /**< their nearest points, where they are apart; else 0 */
    double depth;              /**< the least length of a way out of B for A, as of pir_solid_query_depth */
    pir_vec3 direction;        /**< of unit length: A moved by depth · direction shares no inner point with B */
    double volume;             /**< of what they share, nearest to the exact one */
    double volume_a, volume_b; /**< of each body, likewise */
    bool a_in_b, b_in_a;       /**< whether one is within the other: both of a duplicate */
    bool a_is_cut, b_is_cut;   /**< whether the other one cuts it into more parts than it has */
} pir_clash_verdict;

/**
 * The verdict on two bodies.
 *
 * a, b         both may be the same.
 * workspace    scratch.
 * ret_verdict  what they are to each other.
 *
 * Cost: for p and q pieces of bounded size O(p · q), and O(k²) for the k convex pieces that each leaves of the other
 * where their insides meet; that of pir_solid_query_depth or pir_solid_query_distance.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_LIMIT (the memory of A's options, or numbers too long), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_clash(const pir_clash_body *a, const pir_clash_body *b, pir_workspace *workspace,
                             pir_clash_verdict *ret_verdict);

/** Two of several bodies, by their numbers, the lower one first. */
typedef struct pir_clash_pair {
    uint32_t a, b;
} pir_clash_pair;

/**
 * The pairs of several bodies whose bounding boxes are within a distance along each axis, by a tree: those that can be
 * anything but farther apart than that.
 *
 * bodies     `count` of them.
 * within     a length, 0 or more.
 * capacity   how many pairs fit into ret_pairs, which may be NULL where that is 0.
 * ret_pairs  the first of them, by rising a, then b.
 * ret_count  how many there are, also beyond the capacity.
 *
 * Cost: O((n + k) log n) for k pairs.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE for the length, PIR_ERR_LIMIT for 2^30 bodies, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_clash_pairs(pir_clash_body *const *bodies, size_t count, double within, size_t capacity,
                                   pir_clash_pair *ret_pairs, size_t *ret_count);

#ifdef __cplusplus
}
#endif

#endif
