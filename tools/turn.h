/* SPDX-License-Identifier: MIT */
/* Turns about an axis as quaternions that are exact wherever doubles can be. */
#ifndef TOOLS_TURN_H
#define TOOLS_TURN_H

#include <pirouette/base.h>

/*
 * The turn by part/whole of a full turn, counter-clockwise about `axis`, which is finite and not zero; whole > 0. The
 * length of the quaternion is arbitrary.
 *
 * Exact, as an exact rotation, whenever the angle is a multiple of a half, third, quarter or sixth of a turn and the
 * quaternion is rational up to length: right angles about the coordinate axes or about (3,4,0), thirds about (1,1,1).
 * A turn and its opposite, and turns that differ by whole ones, are exactly inverse and equal.
 */
pir_quat turn_about(pir_vec3 axis, double part, double whole);

/* The turn `b` after the turn `a`, of length 1 up to rounding. */
pir_quat turn_after(pir_quat a, pir_quat b);

#endif
