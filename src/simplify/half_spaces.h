/* SPDX-License-Identifier: MIT */
/*
 * A polytope of half-spaces, by doubles: the corners of the body n·x ≤ h about a middle inside of it are the facets
 * of the hull of n/h (polar duality). Coordinates are relative to the middle, each axis in units of the body's half
 * extent along it, so that needles and plates are as round as others.
 *
 * The corners are off by rounding. They are moved outwards from the middle by a part `push` of their distance, and
 * whoever asks proves that the polytope then holds what it must.
 */
#ifndef PIR_SIMPLIFY_HALF_SPACES_H
#define PIR_SIMPLIFY_HALF_SPACES_H

#include "polytope/polytope.h"

typedef struct pir_half_spaces {
    pir_vec3 middle, unit;
    uint32_t count, room;
    pir_vec3 *dual; /* n/h */
} pir_half_spaces;

/* No planes yet, room for `room`, about a body of dimension 3. */
bool pir_half_spaces_init(pir_half_spaces *spaces, const pir_polytope *body, uint32_t room);
void pir_half_spaces_finish(pir_half_spaces *spaces, const pir_polytope *body);

/*
 * Adds the plane with this outward normal, of any length, through a point. False, and nothing added, where the middle
 * is not below it: the body is too thin for doubles.
 */
bool pir_half_spaces_add(pir_half_spaces *spaces, pir_vec3 normal, pir_vec3 through);

/* How far a point is beyond the plane with this normal through another, in units of the frame. */
double pir_half_spaces_beyond(const pir_half_spaces *spaces, pir_vec3 normal, pir_vec3 through, pir_vec3 point);

/* The polytope. PIR_ERR_EMPTY where the planes do not bound one, or where it is beyond the doubles. */
pir_status pir_half_spaces_polytope(const pir_half_spaces *spaces, double push, const pir_allocator *allocator,
                                    pir_polytope **ret_polytope);

#endif
