/* SPDX-License-Identifier: MIT */
/*
 * Epochs: turning measured along the path and about an axis. epoch.h defines the measures.
 *
 * Rounding: unit quaternions are within 2^-50 of what they stand for. So the phase and the drift of a stretch are off
 * by less than 2^-43, beside the truncation of the arc sine below, which is under 2^-30 up to a quarter. All of it is
 * added to the drift.
 */
#include "dymsum/certificate/epoch.h"

#include "exact/rotation.h"

/* A stretch of an axial epoch ends when its phase passes this: half of it is within the reach of the arc sine below. */
#define LONGEST_STRETCH 0.25

/* An epoch without an axis ends when its path passes this, so that keys stay near 0, where floats are fine. */
#define LONGEST_PATH 0.5

/* When an axial epoch of so many steps ends, the axis of the step that ends it is expected to last as well. */
#define LASTING 4

/* Two steps share an axis when the sine between their axes is at most this. */
#define SAME_AXIS 0x1p-26

/* The arc sine below is good up to here. */
#define ARC_SINE_REACH 0.25

/* π, rounded up: an angle is at most π times its half sine. */
#define PI_ABOVE 3.1416

/*
 * The half cosine of the longest step that may begin an axial epoch, 0.9 radians. Predictions reach one radian, so a
 * step that is much longer expires nearly all of them.
 */
#define LONGEST_FIRST_STEP 0.9

/* The error of a stretch beside the swing that is measured. */
#define STRETCH_ERROR 0x1p-29

static pir_quat between(pir_quat before, pir_quat now) {
    // now · conjugate(before), of the two signs the one with w ≥ 0
    pir_quat r = {before.w * now.x - now.w * before.x - (now.y * before.z - now.z * before.y),
                  before.w * now.y - now.w * before.y - (now.z * before.x - now.x * before.z),
                  before.w * now.z - now.w * before.z - (now.x * before.y - now.y * before.x),
                  now.w * before.w + now.x * before.x + now.y * before.y + now.z * before.z};
    return r.w < 0 ? (pir_quat){-r.x, -r.y, -r.z, -r.w} : r;
}

/* 2·asin(x) for |x| ≤ ARC_SINE_REACH, within 2^-30: the next term is 0.035·x^13. */
static double twice_arc_sine(double x) {
    double y = x * x;
    return 2 * x * (1 + y * (1.0 / 6 + y * (3.0 / 40 + y * (15.0 / 336 + y * (105.0 / 3456 + y * (945.0 / 42240))))));
}

/*
 * The phase and drift of the stretch that led from epoch->start to `now`; false when it has left the axis or gone too
 * far. The turn is a twist about the axis and then a swing. The half sine of the swing is |off|, that of the twist is
 * along / √(along² + w²). That root is √(1 − |off|²), within 2^-44 of 1 while the swing is within the slack.
 */
static bool measure_stretch(const pir_epoch *epoch, pir_quat now, double *ret_phase, double *ret_drift) {
    pir_quat r = between(epoch->start, now);
    pir_vec3 v = {r.x, r.y, r.z};
    double along = pir_vec_dot(v, epoch->axis);
    pir_vec3 off = pir_vec_sub(v, pir_vec_scale(epoch->axis, along));
    double swing = sqrt(pir_vec_dot(off, off));
    *ret_drift = epoch->carried + PI_ABOVE * swing + STRETCH_ERROR;
    *ret_phase = twice_arc_sine(along);
    return fabs(along) <= ARC_SINE_REACH && *ret_drift < PIR_DRIFT_SLACK / 2;
}

/* Whether the step has the axis of the last one, in either direction. */
static bool keeps_axis(pir_vec3 step, pir_vec3 last) {
    pir_vec3 off = pir_vec_cross(step, last);
    double a = pir_vec_dot(step, step), b = pir_vec_dot(last, last);
    return a > 0 && b > 0 && pir_vec_dot(off, off) <= SAME_AXIS * SAME_AXIS * a * b;
}

/* Notes the axis and the angle of step r. */
static void set_way(pir_epoch *epoch, pir_quat r, double angle) {
    pir_vec3 step = {r.x, r.y, r.z};
    double length = sqrt(pir_vec_dot(step, step));
    epoch->axis = length > 0 ? pir_vec_scale(step, 1 / length) : (pir_vec3){0, 0, 0};
    epoch->stride = angle;
}

/* Begins an epoch with the step that has led to epoch->at. */
static void begin_epoch(pir_epoch *epoch, bool axial, double expected) {
    epoch->axial = axial;
    epoch->start = epoch->at;
    epoch->carried = 0;
    epoch->drift = STRETCH_ERROR;
    epoch->phase = epoch->path = epoch->net = epoch->extent = 0;
    epoch->reverses = false;
    epoch->expected = expected;
    epoch->steps = 0;
}

/* Takes a step about the epoch's axis to `phase`. */
static pir_epoch_event turn_on(pir_epoch *epoch, double phase, double drift, double *ret_shift) {
    double stride = phase - epoch->phase;
    epoch->reverses |= stride * epoch->stride < 0;
    epoch->stride = stride;
    epoch->phase = phase;
    epoch->extent = fmax(epoch->extent, fabs(phase));
    epoch->drift = fmax(epoch->drift, drift);
    if (fabs(phase) <= LONGEST_STRETCH)
        return PIR_EPOCH_CONTINUES;
    // the next stretch of the same epoch begins here
    *ret_shift = phase;
    epoch->phase = 0;
    epoch->reverses = false;
    epoch->start = epoch->at;
    epoch->carried = drift;
    return PIR_EPOCH_REBASED;
}

pir_epoch_event pir_epoch_take_step(pir_epoch *epoch, pir_quat before, pir_quat now, bool many_expired,
                                    double *ret_shift) {
    // a rotation that this epoch has not seen ends it
    bool followed =
        before.x == epoch->at.x && before.y == epoch->at.y && before.z == epoch->at.z && before.w == epoch->at.w;
    epoch->at = now;
    epoch->steps += epoch->steps < UINT32_MAX;
    double phase, drift;
    if (epoch->axial && followed && measure_stretch(epoch, now, &phase, &drift))
        return turn_on(epoch, phase, drift, ret_shift);
    pir_quat r = between(before, now);
    double angle = pir_rotation_angle_bound(before, now);
    pir_vec3 step = {r.x, r.y, r.z};
    bool lasted = epoch->axial && epoch->steps >= LASTING, keeps = keeps_axis(step, epoch->step);
    epoch->step = step;
    epoch->path = (epoch->path + angle) * (1 + 0x1p-51);
    set_way(epoch, r, angle);
    if (!epoch->axial && !keeps && followed && !many_expired && epoch->path < LONGEST_PATH) {
        epoch->net = pir_rotation_angle_bound(epoch->start, now);
        return PIR_EPOCH_CONTINUES;
    }
    begin_epoch(epoch, (keeps || lasted) && r.w >= LONGEST_FIRST_STEP && pir_vec_dot(step, step) > 0,
                lasted ? epoch->extent : 0);
    return PIR_EPOCH_BEGINS;
}
