/* SPDX-License-Identifier: MIT */
/*
 * The clock that certificates sleep by: how far R has turned, and about which axis.
 *
 * A certificate is good until the turning since it was made adds up to its margin. Two measures of turning are kept:
 *
 *   - the path: an upper bound on the sum of all steps' angles. It only grows.
 *   - the phase: while steps keep one axis k, the signed angle about k since the epoch began. R then is S·Rot(k, phase)·R₀, R₀ the
 *     rotation at which the epoch began, and S a turn by at most `drift`.
 *
 * In an axial epoch a sign's way can be foretold: s(t) along Rot(k, t) has |s''| ≤ 1, so with s and s' known now it holds until a root of
 * s + s't ± t²/2. That is far later than the path allows, and it holds backwards too, for a body that swings. The drift is allowed up to
 * half of PIR_DRIFT_SLACK, which every foretelling gives away, so the rotation now and the one foretold differ by less.
 *
 * When the axis changes, a new epoch begins, and certificates fall back on what the path says. It is axial, about the axis of the step
 * that begins it, when the last epoch has lasted or this is the second step of the kind; steps that keep no axis make an epoch that is not
 * axial, whose phase is the path.
 *
 * The step itself is a way too, the one that the sum is carried along: in an axial epoch from phase − stride to phase, within the drift;
 * otherwise all that is known of it is its angle.
 */
#ifndef PIR_DYMSUM_CLOCK_H
#define PIR_DYMSUM_CLOCK_H

#include <stdbool.h>

#include "base/vec.h"

#define PIR_DRIFT_SLACK 0x1p-20

typedef struct pir_clock {
    pir_quat at;    /* the unit quaternion that the last step led to */
    double angle;   /* of the last step, at most */
    double stride;  /* axial: the part of the phase that the last step went through */
    uint32_t steps; /* in this epoch */
    double path;    /* since the epoch began */
    double phase;   /* since the epoch began; not axial: the path */
    bool axial;
    pir_vec3 axis;  /* of the epoch, unit */
    pir_quat start; /* R₀ as a unit quaternion */
    double carried; /* drift of the stretches of this epoch that are over */
    pir_vec3 step;  /* the vector part of the last step: half its sine, along its axis */
} pir_clock;

/* What a step means for the keys that certificates are filed under. */
typedef enum pir_clock_event {
    PIR_CLOCK_RUNS,     /* keys stay */
    PIR_CLOCK_REBASED,  /* subtract *ret_shift from every key: the phase is counted from here */
    PIR_CLOCK_NEW_EPOCH /* every key is to be made anew from the path */
} pir_clock_event;

/* Takes the step from unit quaternion `before` to `now`, whose angle is at most `angle`. */
pir_clock_event pir_clock_step(pir_clock *clock, pir_quat before, pir_quat now, double angle, double *ret_shift);

#endif
