/* SPDX-License-Identifier: MIT */
/* The exact convex polygon of coplanar points. */
#ifndef PIR_POLYTOPE_HULL_POLYGON_H
#define PIR_POLYTOPE_HULL_POLYGON_H

#include "polytope/hull/orient.h"

/*
 * The corners of the convex polygon that `count` coplanar points span, seen with coordinate `axis` dropped,
 * counter-clockwise when `direction` > 0, else clockwise. Works in place: `index` holds the points, and on return the
 * corners. Returns their number, or 0 when out of memory. Of equal points the first in `index` stays.
 */
uint32_t pir_polygon_corners(pir_points *points, const pir_allocator *allocator, int axis, int direction,
                             uint32_t *index, uint32_t count);

#endif
