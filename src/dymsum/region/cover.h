/* SPDX-License-Identifier: MIT */
/*
 * Cones of directions, and covers, which say what a region keeps. region.c has the idea.
 *
 * An angle is a pair of cosine and sine, made by sums and products alone, so that it is the same on every machine.
 */
#ifndef PIR_DYMSUM_REGION_COVER_H
#define PIR_DYMSUM_REGION_COVER_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include <pirouette/base.h>

#include "base/vec.h"

/* An angle from 0 to π by its cosine and sine. */
typedef struct pir_arc {
    double cosine, sine;
} pir_arc;

/* The angle of so many radians, at least 0; π from π on. */
pir_arc pir_arc_of(double angle);

/* The sum of two, at most π. */
pir_arc pir_arc_add(pir_arc a, pir_arc b);

/* The angle of a cosine, which is clamped to its range. */
pir_arc pir_arc_from_cosine(double cosine);

/* A cone of directions in the frame of Q, or all of them. */
typedef struct pir_cone {
    bool set;                  /* false: all directions */
    pir_vec3 axis;             /* unit */
    double half_angle, cosine; /* cosine: rounded down */
} pir_cone;

/*
 * A half-angle of at least this is the whole sphere. It is above π by more than π is rounded anywhere, in degrees or
 * as a float.
 */
#define PIR_WHOLE_HALF_ANGLE 3.15

/*
 * Whether a direction of any length is in the cone. Rounding errs towards yes, and a vector of zero is in every cone.
 */
static inline bool pir_cone_has(const pir_cone *cone, pir_vec3 n) {
    return !cone->set || pir_vec_dot(n, cone->axis) >= cone->cosine * sqrt(pir_vec_dot(n, n));
}

/* The cone about an axis of any length. Errors as pir_sum_set_region. */
pir_status pir_cone_make(pir_vec3 axis, double half_angle, pir_cone *ret_cone);

/* Bounds of skins and of the stride, in radians. */
#define PIR_LEAST_SKIN   0x1p-6
#define PIR_RESTING_SKIN 0x1p-12 /* of a walk that follows a walk, while the axis rests in Q */
#define PIR_MOST_SKIN    0x1p-3
#define PIR_LEAST_STRIDE 0x1p-7

/* In place of a stride, in the cover of a walk: an update chooses anew whatever its step. */
#define PIR_NO_STRIDE 0.0

/*
 * The axis that a region had when its features were chosen, and how far it may move from there. What is kept is a
 * function of these fields, up to `stride`, alone.
 */
typedef struct pir_cover {
    bool whole;              /* all is kept */
    pir_vec3 axis_p, axis_q; /* the region's axis then, unit, in the frames of P and of Q */
    pir_arc half_angle;      /* of the region */
    double skin_p, skin_q;   /* radians: how far the axis may move in either frame */
    double cosine_p, cosine_q;
    double stride; /* radians: the longest step that may lead out of the cover or into it; or PIR_NO_STRIDE */

    /* the motion since, from which the next cover is made; what is kept does not depend on it */
    uint32_t steps; /* updates */
    double step;    /* radians: the last step, at most */
} pir_cover;

/* The greatest that `step` can be. */
#define PIR_MOST_STEP 4.0

/* A cover of the cone, with no motion yet. Skins are clamped to their bounds, and so is a stride where there is one. */
pir_cover pir_cover_make(const pir_cone *cone, bool whole, pir_vec3 axis_p, pir_vec3 axis_q, double skin_p,
                         double skin_q, double stride);

#endif
