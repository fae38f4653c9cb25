/* SPDX-License-Identifier: MIT */
/* How far a point is from a convex polytope, bounded from above by doubles alone. */
#ifndef PIR_SOLID_PIECES_CONVEX_DISTANCE_H
#define PIR_SOLID_PIECES_CONVEX_DISTANCE_H

#include "base/vec.h"
#include "polytope/polytope.h"

/*
 * The least distance of the point from the facets that it is not certainly below, or 0 where there are none. These hold
 * the nearest point, and all are parts of the polytope, so that the distance is no less than the true one but for
 * rounding: at most 2^-47 of `reach`, a bound on all coordinates. A polytope has dimension 2 at least. Squares and
 * cubes of what coordinates differ by must neither overflow nor matter where they underflow: `reach` is about 1.
 *
 * With u = 2^-53 and R = reach, a difference w of two points is at most 2 √3 R long and off by u |w|; a unit normal
 * is off by 4 u at most. So n·w is off by (4 + 1 + 3) u |w| < 28 u R, and (n × s)·w, where s is a side, by (4 + 1 +
 * 4 + 1 + 3) u |s| |w| < 46 u R |s|. Both are less than 2^-47 R = 64 u R, and as much of |s|. Beyond that a sign is
 * certain: above 2^-47 R |s| for all sides, the foot of the point is in the facet, and |n·w| its distance. Where that
 * is not certain the sides alone are asked, which are farther; beside a sharp corner, the difference is no rounding.
 */
double pir_convex_distance(const pir_polytope *polytope, pir_vec3 point, double reach);

#endif
