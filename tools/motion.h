/* SPDX-License-Identifier: MIT */
/*
 * The motion of P in a tracked run: one step of 1/steps of a turn from frame to frame, about a fixed axis or about
 * random axes in turn. Frame 0 is the identity.
 */
#ifndef TOOLS_MOTION_H
#define TOOLS_MOTION_H

#include <stdbool.h>
#include <stdint.h>

#include <pirouette/base.h>

/* Frames that a random axis is kept for. */
#define MOTION_AXIS_FRAMES 50

struct motion {
    bool random;
    pir_vec3 axis;  /* the one that is turned about now */
    uint64_t steps; /* frames to a full turn */
    uint64_t frame; /* the frame that comes next */
    uint64_t state; /* of the random numbers */
    pir_quat now;   /* the rotation of the last frame, for random axes */
};

/* `axis` NULL: random axes from `seed`. */
struct motion motion_new(const pir_vec3 *axis, uint64_t steps, uint64_t seed);

/* The rotation one step before frame 0. */
pir_quat motion_before(const struct motion *motion);

/*
 * The rotation of the next frame. About a fixed axis it is made from the frame's number alone, so that it recurs
 * exactly turn after turn; about random axes it is the last one turned once more, brought back to length 1.
 */
pir_quat motion_next(struct motion *motion);

#endif
