/* SPDX-License-Identifier: MIT */
/**
 * Critical maps: the difference Q ⊕ (−R·P) at *every* angle of a full turn of P about an axis, without gaps.
 *
 * P starts at the rotation q₀ and turns by θ about u; κ = |u|·cot(θ/2) falls from +∞ to −∞ (events.h).
 *
 * Between two events the difference keeps its facets. A map has the events of the whole turn, exactly, and the facets
 * of each interval between them. So a translation t of P is decided at each angle, at those of the events too:
 *
 *     PIR_OUTSIDE   P, turned and moved by t, is apart from Q: free
 *     PIR_BOUNDARY  they touch, and do not overlap
 *     PIR_INSIDE    they overlap: blocked
 *
 * The slack of t at a facet, times a positive number, is a quadratic in κ with rational coefficients, for pairs of
 * edges too. So the states of one t all around the turn change at roots of quadratics, which are found exactly. After
 * Canny's Plücker coordinates of edges (Collision Detection for Moving Polyhedra, 1986).
 *
 * Units are those of the models, frames those of Q. Threads: a map never changes, and threads may read one at the same
 * time. GMP's memory serves exact arithmetic; GMP ends the process when that runs out.
 */
#ifndef PIROUETTE_CRITICAL_H
#define PIROUETTE_CRITICAL_H

#include <stdio.h>

#include <pirouette/base.h>
#include <pirouette/polytope.h>
#include <pirouette/query.h>
#include <pirouette/witness.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The events of a turn and the facets between them. */
typedef struct pir_critical_map pir_critical_map;

/**
 * Makes the map of a turn.
 *
 * p, q       of dimension 2 or 3, one of them 3; held by reference.
 * start      q₀, of any length but 0.
 * axis       u, of any length but 0, in the frame of Q.
 * allocator  NULL for malloc.
 *
 * Cost: that of all events, O(e f) for the e and f edges of the operands, and O(m log m) in m facets that begin or end
 * in the turn. Memory O(m log m).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_critical_map_create(pir_polytope *p, pir_polytope *q, pir_quat start, pir_vec3 axis,
                                           const pir_allocator *allocator, pir_critical_map **ret_map);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_critical_map_destroy(pir_critical_map *map);

/** The operands and the motion of a map: P as it was given, Q, both borrowed, q₀ and u. */
typedef struct pir_critical_turn {
    const pir_polytope *p, *q;
    pir_quat start;
    pir_vec3 axis;
} pir_critical_turn;

/** Cost: O(1). */
PIR_API pir_critical_turn pir_critical_map_turn(const pir_critical_map *map);

/**
 * How many events there are. Interval i lies between events i − 1 and i. Interval 0 begins at the start, θ = 0, and
 * the last one, whose number is the count, ends there.
 *
 * Cost: O(1).
 */
PIR_API uint32_t pir_critical_map_event_count(const pir_critical_map *map);

/** A κ between two doubles, and the angle. */
typedef struct pir_critical_angle {
    double kappa[2];   /**< the greatest double not above it, the least not below it; infinite where no double is */
    double degrees[2]; /**< θ, rounded outwards, from 0 to 360 */
} pir_critical_angle;

/**
 * Where an event is. Events are at falling κ.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT (no such event).
 */
PIR_API pir_status pir_critical_map_event(const pir_critical_map *map, uint32_t event, pir_critical_angle *ret_angle);

/**
 * The facets of the difference in an interval, told as by events (events.h): facets of P first, then edges, then
 * vertices.
 *
 * interval   from 0 to the count of events.
 * ret_faces  NULL, or room for as many facets as the count that a call with NULL tells.
 * ret_count  how many there are.
 *
 * Cost: O(f log f) for f facets.
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_critical_map_facets(const pir_critical_map *map, uint32_t interval, pir_witness *ret_faces,
                                           uint32_t *ret_count);

/** A place among events. */
typedef struct pir_critical_place {
    uint32_t interval; /**< that holds the angle; at an event, the one after it; at the start 0 */
    bool at_event;     /**< at event `interval` − 1 */
} pir_critical_place;

/**
 * The place of a κ, decided exactly.
 *
 * kappa  finite, or INFINITY for the start.
 *
 * Cost: O(log n) for n events.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE.
 */
PIR_API pir_status pir_critical_map_locate(const pir_critical_map *map, double kappa, pir_critical_place *ret_place);

/**
 * The place of a rotation, decided exactly. That is one of the turn where its quaternion is a multiple of
 * (u, κ)·q₀ for some κ, or of q₀. With the start (0, 0, 0, 1) and an axis of one component, doubles hold such
 * quaternions for all angles.
 *
 * rotation  of any length but 0.
 * ret_is_turn  false where it is no rotation of the turn; `*ret_place` is untouched then.
 *
 * Cost: O(log n) for n events, and exact arithmetic.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION.
 */
PIR_API pir_status pir_critical_map_locate_rotation(const pir_critical_map *map, pir_quat rotation, bool *ret_is_turn,
                                                    pir_critical_place *ret_place);

/**
 * The exact state of a translation at a κ, as pir_query decides it at (u, κ)·q₀.
 *
 * kappa        finite, or INFINITY for the start.
 * translation  of P.
 *
 * Cost: O(log n + f) for n events and the f facets of the interval, fewer where t is outside of one of the first.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE.
 */
PIR_API pir_status pir_critical_map_state(const pir_critical_map *map, double kappa, pir_vec3 translation,
                                          pir_state *ret_state);

/**
 * The exact state at a rotation of the turn.
 *
 * rotation, ret_is_turn  as of pir_critical_map_locate_rotation.
 * translation            of P.
 * ret_state              the state, where the rotation is one of the turn.
 *
 * Cost: as of pir_critical_map_state, and exact arithmetic.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION.
 */
PIR_API pir_status pir_critical_map_state_of(const pir_critical_map *map, pir_quat rotation, pir_vec3 translation,
                                             bool *ret_is_turn, pir_state *ret_state);

/**
 * The exact state at an event, which as a rule is no double.
 *
 * event        below the count of events.
 * translation  of P.
 *
 * Cost: as of pir_critical_map_state.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE.
 */
PIR_API pir_status pir_critical_map_state_at_event(const pir_critical_map *map, uint32_t event, pir_vec3 translation,
                                                   pir_state *ret_state);

/**
 * Writes a map as bytes that any machine reads (docs/slices.md), to a stream, from its position on. The stream stays
 * open. Several maps may follow each other.
 *
 * file    a stream open for writing.
 * report  NULL, or filled when the call fails.
 *
 * Cost: that of a sum made anew, and O(m) for the m facets of the turn.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_FILE, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_critical_map_write(const pir_critical_map *map, FILE *file, pir_report *report);

/**
 * Makes a map from a stream, which is left just past it. The bytes are not trusted: the map is made anew from the
 * operands, and held against all that stands there.
 *
 * file               a stream open for reading.
 * allocator, report  NULL for malloc; NULL, or filled with what, where and why.
 *
 * Cost: as of pir_critical_map_create, and that of two exact hulls.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_EMPTY (nothing is left in the stream), PIR_ERR_FORMAT, PIR_ERR_VERSION,
 * PIR_ERR_LIMIT, PIR_ERR_FILE, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_critical_map_read(FILE *file, const pir_allocator *allocator, pir_report *report,
                                         pir_critical_map **ret_map);

/** The states of one translation all around a turn. */
typedef struct pir_critical_states pir_critical_states;

/**
 * Finds all κ at which the state of a translation changes, and where it only touches for a moment: of one pair of
 * bodies, or of all pairs of pieces of a robot and obstacles.
 *
 * At each such contact the state is PIR_BOUNDARY. Between two of them, before the first and after the last one it is
 * constant: boundary too where P slides along Q for a while. Of several pairs the state is that of the pair that
 * overlaps most: inside where one overlaps, outside where all are apart.
 *
 * maps, count  of one axis and one start, as the same doubles; read during the call. At least one.
 * translation  of P, of all of them.
 * allocator    NULL for malloc.
 *
 * Cost: O(m) for the m facets that the turns have, and for each of the few of them that t passes exact arithmetic and
 * the cost of a state of each pair.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_critical_states_create(const pir_critical_map *const *maps, size_t count, pir_vec3 translation,
                                              const pir_allocator *allocator, pir_critical_states **ret_states);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_critical_states_destroy(pir_critical_states *states);

/** How many contacts there are. Cost: O(1). */
PIR_API uint32_t pir_critical_states_count(const pir_critical_states *states);

/**
 * Where a contact is, in order of falling κ. Two contacts may be between the same two doubles.
 *
 * contact  below the count.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_critical_states_contact(const pir_critical_states *states, uint32_t contact,
                                               pir_critical_angle *ret_angle);

/**
 * The state after a number of contacts, up to the next one: 0 for the beginning, the count for the end of the turn.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_critical_states_after(const pir_critical_states *states, uint32_t contacts,
                                             pir_state *ret_state);

/** The state at the start itself, θ = 0, which both ends of the turn lead to. Cost: O(1). */
PIR_API pir_state pir_critical_states_at_start(const pir_critical_states *states);

#ifdef __cplusplus
}
#endif

#endif
