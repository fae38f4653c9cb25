/* SPDX-License-Identifier: MIT */
/* Where two pieces touch, along a plane of their sum. */
#ifndef PIR_SOLID_DEPTH_SHARED_MIDDLE_H
#define PIR_SOLID_DEPTH_SHARED_MIDDLE_H

#include "solid/depth/obstacle.h"

/* The middle of what the faces of two pieces share that a plane of their sum belongs to, where P is moved to x, which
 * is in that facet: a point of Q's frame, in units of the frame, to rounding. */
void pir_obstacle_shared_middle(const pir_obstacle *obstacle, uint32_t plane, const double x[3], double ret_point[3]);

#endif
