/* SPDX-License-Identifier: MIT */
/*
 * How a body moves that nothing touches: its centre along a parabola, its rotation by the implicit midpoint rule. Both
 * keep energy and momentum to rounding, whatever the step, so that a contact may end a step at any time.
 *
 * Between two places the centre goes straight, and the body turns about one axis: this is the motion that is held
 * against what is in the way. It bends from the true one by a part of a step, and has the same ends.
 */
#ifndef PHYSICS_MOTION_H
#define PHYSICS_MOTION_H

#include <pirouette/pirouette.h>

#include "vec.h"

/* Where a body is, and how it moves there. */
struct motion_state {
    pir_pose pose;
    pir_vec3 velocity, spin;
};

/* What makes a body move as it does. */
struct motion_law {
    const struct mat3 *inertia, *inverse_inertia; /* in the body's frame */
    pir_vec3 gravity;
};

/* A part of a step. The motion of a cast leads from one pose to the other. */
struct motion_part {
    struct motion_state to;
    pir_motion way;
};

/* How many parts a time is to be divided into, so that the body turns by half a radian in each at most. */
unsigned motion_parts(pir_vec3 spin, double time);

/* The motion over a time that is such a part. */
struct motion_part motion_over(const struct motion_state *from, const struct motion_law *law, double time);

#endif
