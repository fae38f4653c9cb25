/* SPDX-License-Identifier: MIT */
/*
 * Epochs: how far R has turned, and about which axis. Certificates expire by these measures.
 *
 * The motion is divided into epochs. In each, one of two measures is used:
 *
 *   - In an axial epoch all steps have one axis k. The phase is the signed angle turned about k since the epoch began:
 *     R is S·Rot(k, phase)·R₀, where R₀ is the rotation at which the epoch began and S a turn by at most `drift`.
 *     A sign can be predicted: s(t) along Rot(k, t) has |s''| ≤ 1, so with s and s' known now it keeps its sign until
 *     a root of s + s't ± t²/2. That is much later than its margin, and it also holds backwards, for a motion that
 *     reverses. The drift may grow to half of PIR_DRIFT_SLACK, which every prediction subtracts. So the rotation now
 *     and the predicted one differ by less than that.
 *   - In any other epoch there are two upper bounds on the turn since its beginning. The path is the sum of all steps'
 *     angles, which only grows. The net turn is the angle from R₀, which stays small for small motions to and fro. A
 *     certificate that was made when they were l and a, with a margin m, holds while the path is below l + m, and while
 *     the net turn is below m − a.
 *
 * When the axis changes, a new epoch begins, and certificates keep what is left of their margins. The new epoch is
 * axial, about the axis of the step that begins it, when the last one was axial and has lasted, or when this is the
 * second step about the same axis. An axial epoch that follows a lasting one is expected to turn as far: `expected`. A
 * certificate with a smaller margin would expire within it anyway. It expires at its beginning instead, when it can be
 * predicted for the rest.
 *
 * Each step is taken as a turn by `stride` about `axis`, within the drift. Between two rotations R is taken to turn
 * that way.
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
    pir_vec3 axis;   /* of the last step, unit; in an axial epoch: of all of its steps */
    double stride;   /* the angle of the last step about it, at most */
    double phase;    /* axial: since the epoch began */
    bool reverses;   /* axial: since phases were last counted from 0, some step has reversed the one before */
    double path;     /* since the epoch began */
    double net;      /* not axial: the angle from R₀ to R, at most */
    double extent;   /* axial: the greatest |phase| so far within one stretch */
    double expected; /* axial: the |phase| that is expected to be reached, 0 where nothing is known */
    pir_quat start;  /* R₀ as a unit quaternion */
    double carried;  /* drift of the stretches of this epoch that are over */
    double drift;    /* the greatest so far in this epoch; of the step itself where it is not axial */
    pir_vec3 step;   /* the vector part of the last step outside of an axial epoch: half its sine, along its axis */
} pir_epoch;

/* A step through a greater angle is not followed: it may have changed nearly everything. */
#define PIR_FOLLOWED_FARTHEST 0.25

/* The angle of the last step, rounded up, or HUGE_VALF where the step is not followed. */
static inline float pir_epoch_reach(const pir_epoch *epoch) {
    double reach = fabs(epoch->stride) * (1 + 0x1p-20);
    return reach <= PIR_FOLLOWED_FARTHEST ? (float)reach : HUGE_VALF;
}

/* The effect of a step on the keys of certificates. */
typedef enum pir_epoch_event {
    PIR_EPOCH_CONTINUES, /* keys stay as they are */
    PIR_EPOCH_REBASED,   /* *ret_shift is to be subtracted from every key: the phase is counted from here */
    PIR_EPOCH_BEGINS     /* every key is to be made anew from what is left of the margin */
} pir_epoch_event;

/*
 * Takes the step from unit quaternion `before` to `now`. many_expired: so many certificates have expired in this epoch
 * that a new one costs little beside that.
 */
pir_epoch_event pir_epoch_take_step(pir_epoch *epoch, pir_quat before, pir_quat now, bool many_expired,
                                    double *ret_shift);

#endif
