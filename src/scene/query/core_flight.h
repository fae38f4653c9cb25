/* SPDX-License-Identifier: MIT */
/*
 * A polytope with a radius that moves, against one triangle that stands, in doubles.
 *
 * Invariants
 *   - Before a time that is told the two share no point, proven by planes between them; at that time they are as near
 *     as is asked for, proven by points of both.
 *   - What is told of a triangle depends on it and the flight alone, not on the triangles before it.
 */
#ifndef PIR_SCENE_QUERY_CORE_FLIGHT_H
#define PIR_SCENE_QUERY_CORE_FLIGHT_H

#include "query/proof/parting.h"
#include "scene/query/probe.h"

/* Polytopes with more vertices are left to pairs. */
#define PIR_CORE_POINTS 64

/* All that the flight has in common for all triangles. Places are relative to where the polytope begins. */
typedef struct pir_core_flight {
    const pir_polytope *polytope;
    pir_parted parted;
    pir_pose from;
    bool turns;
    double tolerance;
    pir_vec3 turned[PIR_CORE_POINTS]; /* the vertices at time 0 */
} pir_core_flight;

/* A triangle, relative to where the polytope begins, with a radius; and what rounding of both is relative to. */
typedef struct pir_core_target {
    pir_vec3 corner[3];
    double radius, size;
} pir_core_target;

typedef struct pir_core_impact {
    bool hits;
    double time;
    pir_vec3 normal, point; /* unit, from the triangle to the polytope; on the rounded triangle */
    pir_witness witness;    /* the numbers of the triangle's features are those of a polytope of its corners */
} pir_core_impact;

/* Begins; false where the polytope, or a motion with contacts that are held, is not for doubles. */
bool pir_core_flight_begin(pir_core_flight *flight, const pir_probe *probe, const pir_motion *motion, double tolerance);

/* Whether doubles settle when the polytope meets the triangle, if until a time; *ret_impact is set only then. */
bool pir_core_fly(const pir_core_flight *flight, const pir_core_target *target, double until,
                  pir_core_impact *ret_impact);

#endif
