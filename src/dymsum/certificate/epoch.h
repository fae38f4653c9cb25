/* SPDX-License-Identifier: MIT */
/*
 * The clock that certificates sleep by: how far R has turned, and about which axis.
 *
 * A certificate is good until R has turned by its margin since it was made. Time is divided into epochs, in each of
 * which one of two ways to tell is used:
 *
 *   - in an axial epoch steps keep one axis k. The phase is the signed angle about k since the epoch began: R is
 *     S·Rot(k, phase)·R₀, R₀ the rotation at which the epoch began, and S a turn by at most `drift`. A sign's way can
 *     be foretold: s(t) along Rot(k, t) has |s''| ≤ 1, so with s and s' known now it holds until a root of s + s't ±
 *     t²/2. That is far later than its margin, and it holds backwards too, for a body that swings. The drift is allowed
 *     up to half of PIR_DRIFT_SLACK, which every foretelling gives away, so the rotation now and the one foretold
 *     differ by less.
 *   - in any other, two upper bounds on the turning since: the path, the sum of all steps' angles, which only grows,
 *     and the net turn from R₀, which stays small for a body that trembles. A certificate made when they were l and a,
 *     with a margin m, holds while the path is below l + m, and as long as the net turn is below m − a.
 *
 * When the axis changes, a new epoch begins, and certificates keep what is left of their margins. It is axial, about
 * the axis of the step that begins it, when the last epoch was and has lasted or this is the second step of the kind.
 * An axial epoch that follows one that has lasted is taken to turn as far: `expected`. Certificates whose margin is
 * less would be looked at in the course of it anyway, and are so at its beginning, when they can be foretold for the
 * rest.
 *
 * Each step is a turn about an axis too, the way that the sum is carried along: by `stride` about `axis`, within the
 * drift.
 */
#ifndef PIR_DYMSUM_CERTIFICATE_EPOCH_H
#define PIR_DYMSUM_CERTIFICATE_EPOCH_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/vec.h"

#define PIR_DRIFT_SLACK 0x1p-20

typedef struct pir_epoch {
    pir_quat at;    /* the unit quaternion that the last step led to */
    uint32_t steps; /* in this epoch */
    bool axial;
    pir_vec3 axis;   /* of the last step, unit; axial: of the epoch */
    double stride;   /* the angle about it that the last step went through, at most */
    double phase;    /* axial: since the epoch began */
    bool reverses;   /* axial: since phases were last counted from here, some step went back where another came from */
    double path;     /* since the epoch began */
    double net;      /* not axial: since the epoch began */
    double extent;   /* axial: how far the phase has been from 0, as far as one stretch goes */
    double expected; /* axial: how far it may be expected to go, 0 where nothing is known */
    pir_quat start;  /* R₀ as a unit quaternion */
    double carried;  /* drift of the stretches of this epoch that are over */
    double drift;    /* the greatest so far in this epoch; of the step itself where it is not axial */
    pir_vec3 step;   /* the vector part of the last step that was looked at: half its sine, along its axis */
} pir_epoch;

/* A step through a greater angle is not followed: it may have changed nearly everything. */
#define PIR_FOLLOWED_FARTHEST 0.25

/* The angle of the last step, rounded up, or HUGE_VALF where the step is not followed. */
static inline float pir_epoch_reach(const pir_epoch *epoch) {
    double reach = fabs(epoch->stride) * (1 + 0x1p-20);
    return reach <= PIR_FOLLOWED_FARTHEST ? (float)reach : HUGE_VALF;
}

/* What a step means for the keys that certificates are filed under. */
typedef enum pir_epoch_event {
    PIR_EPOCH_CONTINUES, /* keys stay */
    PIR_EPOCH_REBASED,   /* subtract *ret_shift from every key: the phase is counted from here */
    PIR_EPOCH_BEGINS     /* every key is to be made anew from what is left of the margin */
} pir_epoch_event;

/*
 * Takes the step from unit quaternion `before` to `now`. many_expired: so many certificates have woken that beginning
 * an epoch anew costs little beside.
 */
pir_epoch_event pir_epoch_take_step(pir_epoch *epoch, pir_quat before, pir_quat now, bool many_expired,
                                    double *ret_shift);

#endif
