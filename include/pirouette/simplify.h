/* SPDX-License-Identifier: MIT */
/**
 * Simplified polytopes: one inside and one around a polytope, with fewer vertices, and how far each is from it at most.
 *
 * The inner polytope is the hull of some of the vertices. The vertex that is farthest from it is added until it is near
 * enough. The outer polytope is bounded by planes of some of the facets, and at first by four more planes. Where it is
 * farthest from the body, a facet's plane cuts it off. Its vertices are doubles, moved outwards by what rounding needs.
 *
 * Proven: inner ⊆ polytope ⊆ outer, exactly. The bounds are on the Hausdorff distance, the greatest
 * distance of a point of the larger body from the smaller one. So a distance between simplified bodies bounds that
 * between the bodies: with the outer ones it is at most the true one, with the inner ones at least, each within the sum
 * of both bounds. Overlap of inner bodies proves overlap, outer bodies apart prove the bodies apart.
 */
#ifndef PIROUETTE_SIMPLIFY_H
#define PIROUETTE_SIMPLIFY_H

#include <pirouette/base.h>
#include <pirouette/polytope.h>

#ifdef __cplusplus
extern "C" {
#endif

/** When to stop: at either. One of the two must be set. */
typedef struct pir_simplify_options {
    size_t size;       /**< of this struct, which pir_simplify_options_default sets (base.h) */
    uint32_t vertices; /**< the most that either may have, 4 at least; 0 for no bound */
    double error;      /**< a length: what is this near is near enough; 0 for as near as `vertices` allows */
} pir_simplify_options;

/** No bound on the vertices, no error: one of them must be set. O(1). */
static inline pir_simplify_options pir_simplify_options_default(void) {
    const pir_simplify_options options = {sizeof(pir_simplify_options), 0, 0};
    return options;
}

/** Both polytopes, references of the caller's: release them with pir_simplified_release. */
typedef struct pir_simplified {
    pir_polytope *inner, *outer;
    double inner_error; /**< no point of the polytope is farther than this from `inner`; rounded up */
    double outer_error; /**< no point of `outer` is farther than this from the polytope; rounded up */
} pir_simplified;

/**
 * Simplifies a polytope, with its allocator.
 *
 * polytope  of any dimension. One below dimension 3 is its own outer polytope, whatever number of vertices it has.
 * options   when to stop.
 *
 * Either result is the polytope itself, with the error 0, where that has no more vertices than are allowed and nothing
 * of fewer vertices is as near as asked for. Errors above 0 are at least 10^-12 of the size, which is how well
 * distances are known, wherever the body is. The outer polytope has doubles for coordinates: where those are coarse,
 * far from the origin, it is not near.
 *
 * Cost: O(r · (n + v) · log n) for n vertices, v of them in the results, and r rounds, about 10 · log v.
 *
 * Errors: PIR_ERR_ARGUMENT (fewer than 4 vertices, a negative error, neither set), PIR_ERR_NOT_FINITE, PIR_ERR_LIMIT (a
 * body farther from its origin than 2^400 times its size, or so large that what is around it is beyond the doubles),
 * PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_polytope_simplify(pir_polytope *polytope, const pir_simplify_options *options,
                                         pir_simplified *ret_simplified);

/**
 * Gives both references back, and sets them to NULL. NULL is accepted. O(1), and for the last reference the time to
 * free it.
 */
PIR_API void pir_simplified_release(pir_simplified *simplified);

/* --- coarse bodies --- */

/**
 * Coarse bodies of a polytope, for questions that need no more accuracy (pir_scene_distances): polytopes inside of it,
 * of 8 vertices, 32, 128 and so on, as long as those are half of its own at most. Immutable, with a count of references
 * that threads may change at once.
 */
typedef struct pir_coarse pir_coarse;

/** One of them: a polytope, borrowed, and how far the body reaches beyond it at most. */
typedef struct pir_coarse_body {
    pir_polytope *polytope;
    double error; /**< no point of the body is farther than this from `polytope`; rounded up, 0 for the body itself */
} pir_coarse_body;

/**
 * Makes the coarse bodies of a polytope, with its allocator.
 *
 * polytope  of any dimension; referenced.
 *
 * Cost: that of pir_polytope_simplify without the outer polytope, for each coarse body.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_LIMIT (as of pir_polytope_simplify), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_coarse_create(pir_polytope *polytope, pir_coarse **ret_coarse);

/** Takes a reference, and returns its argument; NULL is accepted. O(1). */
PIR_API pir_coarse *pir_coarse_retain(pir_coarse *coarse);

/**
 * Gives a reference back; the last one frees. NULL is accepted. O(1), and for the last reference the time to free it.
 */
PIR_API void pir_coarse_release(pir_coarse *coarse);

/** How many bodies there are, that of the polytope itself, which is the last one, included: at least 1. O(1). */
PIR_API uint32_t pir_coarse_count(const pir_coarse *coarse);

/** Number `index` of them, which must be below the count; later ones have more vertices. O(1). */
PIR_API pir_coarse_body pir_coarse_get(const pir_coarse *coarse, uint32_t index);

#ifdef __cplusplus
}
#endif

#endif
