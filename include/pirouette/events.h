/* SPDX-License-Identifier: MIT */
/**
 * Critical angles: when, exactly, the sum R·P ⊕ Q changes while P makes a full turn about an axis.
 *
 * P starts at the rotation q₀ and turns on by θ about the axis u, counter-clockwise seen from where u points to.
 * Its quaternion then is (u, κ)·q₀ with κ = |u|·cot(θ/2), which falls from +∞ to −∞ as θ goes from 0 to
 * a full turn; both ends are left out. Every question that the sum rests on is the sign of a quadratic in κ with
 * rational coefficients. So each critical angle is a root of one, and is found, ordered and told exactly.
 *
 * An event is a κ at which the facets of the true sum change: those just before it are not those just after it.
 * Changes at the same κ are one event. What lasts for a while, such as the contact of a box that turns on a table,
 * is not one, nor is what only touches at κ. Facets are told by the faces of P and Q that make them: a facet and the
 * vertex, edge or facet that it meets, or two edges.
 *
 * The walk: a facet's normal moves over the other body's Gaussian map, and leaves its cell at a root of one of the
 * cell's sides. A queue holds the next root of every facet. After kinetic data structures (Basch, Guibas and
 * Hershberger, Data Structures for Mobile Data, 1997), and the critical rotations of Mayer, Fogel and Halperin (Fast
 * and Robust Retrieval of Minkowski Sums of Rotating Convex Polyhedra in 3-Space, 2011).
 *
 * Threads: events belong to one thread at a time. They hold references to the polytopes.
 */
#ifndef PIROUETTE_EVENTS_H
#define PIROUETTE_EVENTS_H

#include <pirouette/base.h>
#include <pirouette/polytope.h>
#include <pirouette/sum.h>
#include <pirouette/witness.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The events of one turn, and a place among them: at the beginning, at a κ, or at an event. */
typedef struct pir_events pir_events;

typedef struct pir_events_options {
    size_t size;                    /**< of this struct, which pir_events_options_default sets (base.h) */
    const pir_allocator *allocator; /**< NULL for malloc; copied, its context must outlive the events */
    bool difference;                /**< true: of Q ⊕ (−R·P); false: of R·P ⊕ Q */
} pir_events_options;

/** malloc, no difference. O(1). */
static inline pir_events_options pir_events_options_default(void) {
    const pir_events_options options = {sizeof(pir_events_options), NULL, false};
    return options;
}

/**
 * Makes the events of a turn, at its beginning.
 *
 * p, q     of dimension 2 or 3.
 * start    q₀, of any length but 0.
 * axis     u, of any length but 0, in the frame of Q.
 * options  NULL for the defaults.
 *
 * Cost: O(n) for the n facets and edges of both, as long as neighbouring facets lie near each other.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_VERSION, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_events_create(pir_polytope *p, pir_polytope *q, pir_quat start, pir_vec3 axis,
                                     const pir_events_options *options, pir_events **ret_events);

/**
 * Makes the events of a sum whose P turns on from the rotation that its pairing is exact at. The sum is not needed, and
 * not changed, afterwards.
 *
 * axis       u, of any length but 0, in the frame of Q.
 * allocator  NULL for malloc.
 *
 * Cost: that of pir_events_create.
 *
 * Errors: those of pir_events_create.
 */
PIR_API pir_status pir_sum_events(const pir_sum *sum, pir_vec3 axis, const pir_allocator *allocator,
                                  pir_events **ret_events);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_events_destroy(pir_events *events);

/** An event. The lists are those of the events object, until the next call that changes it. */
typedef struct pir_event {
    const pir_witness *lost;   /**< facets of the sum that end here, facets of P first, then edges, then vertices */
    const pir_witness *gained; /**< and those that begin, likewise */
    uint32_t lost_count, gained_count;
} pir_event;

/**
 * Goes on to the next event.
 *
 * ret_found  false where the turn has no more events; `*ret_event` is untouched then, and the place is behind the last.
 *
 * Allocates only where more facets change together than ever before.
 *
 * Cost: O(d + log n) for an event that is one facet's, with d sides around its cell and n facets; what changes together
 * is compared pair by pair.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY; the place is then at or before the event.
 */
PIR_API pir_status pir_events_next(pir_events *events, pir_event *ret_event, bool *ret_found);

/**
 * Goes to a κ, so that the events that follow are those at a lesser κ.
 *
 * kappa  finite, or INFINITY for the beginning.
 *
 * Cost: as of pir_events_create.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE.
 */
PIR_API pir_status pir_events_seek(pir_events *events, double kappa);

/**
 * The κ of the place, an event's as a rule: the greatest double that is not above it and the least that is not below
 * it, which are one where κ is a double. Infinite where no double is; both are INFINITY at the beginning.
 *
 * Cost: O(1), in exact arithmetic.
 */
PIR_API void pir_events_kappa(pir_events *events, double ret_kappa[2]);

/**
 * The angle θ of the place in degrees, rounded outwards: from 0 to 360, at most 2·10^-12 apart.
 *
 * Cost: as of pir_events_kappa.
 */
PIR_API void pir_events_angle(pir_events *events, double ret_degrees[2]);

/**
 * How many facets the true sum has just after the place.
 *
 * Cost: O(e f) for the e and f edges of the operands in the first call and after pir_events_seek; O(1) otherwise.
 */
PIR_API uint32_t pir_events_facet_count(pir_events *events);

/**
 * A double κ after the place and before the next event, of those the one with the fewest bits: at (u, κ)·q₀ the
 * sum has the facets of the interval between. Doubles hold that quaternion exactly where u and q₀ have few bits as
 * well.
 *
 * Cost: as of pir_events_kappa.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_LIMIT (no double lies between).
 */
PIR_API pir_status pir_events_between(pir_events *events, double *ret_kappa);

#ifdef __cplusplus
}
#endif

#endif
