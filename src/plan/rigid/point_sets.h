/* SPDX-License-Identifier: MIT */
/*
 * Whether the hulls of two sets of points are apart, by a plane between them.
 *
 * Points are within 2^-50 of the exact ones, relatively in each coordinate, and `room` in all for both sets. The plane
 * is found as that across the nearest point of the hulls' difference to the origin, and holds where it keeps a margin
 * over what rounding can be.
 */
#ifndef PIR_PLAN_RIGID_POINT_SETS_H
#define PIR_PLAN_RIGID_POINT_SETS_H

#include <stdbool.h>
#include <stdint.h>

/*
 * True where they are, proven; false also where they are too near to tell. `shared` may be NULL; else it gets about a
 * point of both hulls where they are not apart.
 */
bool pir_points_apart(const double (*a)[3], uint32_t count_a, const double (*b)[3], uint32_t count_b, double room,
                      double ret_shared[3]);

#endif
