/* SPDX-License-Identifier: MIT */
/*
 * Incidences that hold at every rotation, since they hold between bodies at rest: a vertex of P in the plane of a
 * facet of P is so with the same vertex of Q added to both, however P is turned. Such a zero, told by numbers at one
 * rotation, would take the longest of them; at rest they are short.
 *
 * Invariant: where a function says yes it is so at every rotation at which the points and planes named are there.
 * Where it says no, nothing is known.
 */
#ifndef PIR_SOLID_SPACE_IDENTITY_H
#define PIR_SOLID_SPACE_IDENTITY_H

#include "solid/space/space.h"

/* Whether a plane holds a point. */
bool pir_identity_holds(pir_space *space, uint32_t plane, uint32_t point);

/* Whether two points are one. */
bool pir_identity_of_points(pir_space *space, uint32_t a, uint32_t b);

/* Whether two planes are one, however they are turned. */
bool pir_identity_of_planes(pir_space *space, uint32_t f, uint32_t g);

/* Whether the lines where planes f[0] and f[1], g[0] and g[1] meet are one. */
bool pir_identity_of_lines(pir_space *space, const uint32_t f[2], const uint32_t g[2]);

/* Whether the way between two points of one body leads along a direction of it, either way; or they are one. */
bool pir_identity_of_way(pir_space *space, uint32_t direction, uint32_t a, uint32_t b);

#endif
