/* SPDX-License-Identifier: MIT */
/* How far a point is from a convex polytope, bounded from above by doubles alone. */
#ifndef PIR_SOLID_PIECES_CONVEX_DISTANCE_H
#define PIR_SOLID_PIECES_CONVEX_DISTANCE_H

#include "base/vec.h"
#include "polytope/polytope.h"

/*
 * The least distance of the point from the facets that it is not certainly below, or 0 where there are none. These hold
 * the nearest point, and all are parts of the polytope, so that the distance is no less than the true one but for
 * rounding: at most 2^-47 of `reach`, a bound on all coordinates. A polytope has dimension 2 at least.
 */
double pir_convex_distance(const pir_polytope *polytope, pir_vec3 point, double reach);

#endif
