/* SPDX-License-Identifier: MIT */
/*
 * Turning, measured along the path and about an axis. See clock.h for what the measures mean.
 *
 * Rounding: unit quaternions are within 2^-50 of what they stand for, so the phase and the drift of a stretch are off by less than 2^-43
 * beside the truncation of the arc sine below, under 2^-30 up to a quarter. All of it is charged to the drift.
 */
#include "dymsum/certificate/epoch.h"

#include "exact/rotation.h"

/* A stretch of an axial epoch ends when its phase passes this: the arc sine below is good for half of it and more. */
#define LONGEST_STRETCH 0.25

/* An epoch without an axis ends when its path passes this, so that phases stay near 0, where floats are fine. */
#define LONGEST_PATH 0.5

/* When an axial epoch of so many steps ends, the axis of the step that ends it is taken to last as well. */
#define LASTING 4

/* Two steps share an axis when one leaves the other's by less than this part of its length. */
#define SAME_AXIS 0x1p-26

/* What a stretch may be off by beside the swing that is measured. */
#define STRETCH_ERROR 0x1p-29

static pir_quat between(pir_quat before, pir_quat now) {
    // now · conjugate(before), of the two signs the one with w ≥ 0
    pir_quat r = {before.w * now.x - now.w * before.x - (now.y * before.z - now.z * before.y),
                  before.w * now.y - now.w * before.y - (now.z * before.x - now.x * before.z),
                  before.w * now.z - now.w * before.z - (now.x * before.y - now.y * before.x),
                  now.w * before.w + now.x * before.x + now.y * before.y + now.z * before.z};
    return r.w < 0 ? (pir_quat){-r.x, -r.y, -r.z, -r.w} : r;
}

/* 2·asin(x) for |x| ≤ 1/4, within 2^-30: the next term is 0.035·x^13. */
static double twice_arc_sine(double x) {
    double y = x * x;
    return 2 * x * (1 + y * (1.0 / 6 + y * (3.0 / 40 + y * (15.0 / 336 + y * (105.0 / 3456 + y * (945.0 / 42240))))));
}

/*
 * The phase and drift of the stretch that led from clock->start to `now`; false when it has left the axis or gone too far. Of swing and twist
 * the swing's half sine is |off| and the twist's along / √(along² + w²); that root is √(1 − |off|²), within 2^-44 of 1 while the swing is
 * within the slack.
 */
static bool measure_stretch(const pir_clock *clock, pir_quat now, double *ret_phase, double *ret_drift) {
    pir_quat r = between(clock->start, now);
    pir_vec3 v = {r.x, r.y, r.z};
    double along = pir_vec_dot(v, clock->axis);
    pir_vec3 off = pir_vec_sub(v, pir_vec_scale(clock->axis, along));
    double swing = sqrt(pir_vec_dot(off, off));
    *ret_drift = clock->carried + 3.1416 * swing + STRETCH_ERROR;
    *ret_phase = twice_arc_sine(along);
    return fabs(along) <= 0.25 && *ret_drift < PIR_DRIFT_SLACK / 2;
}

/* Whether the step goes the way of the last one, or back. */
static bool keeps_axis(pir_vec3 step, pir_vec3 last) {
    pir_vec3 off = pir_vec_cross(step, last);
    double a = pir_vec_dot(step, step), b = pir_vec_dot(last, last);
    return a > 0 && b > 0 && pir_vec_dot(off, off) <= SAME_AXIS * SAME_AXIS * a * b;
}

/* Takes note of the way of the step r. */
static void set_way(pir_clock *clock, pir_quat r, double angle) {
    pir_vec3 step = {r.x, r.y, r.z};
    double length = sqrt(pir_vec_dot(step, step));
    clock->axis = length > 0 ? pir_vec_scale(step, 1 / length) : (pir_vec3){0, 0, 0};
    clock->stride = angle;
}

/* Begins an epoch with the step that has led to clock->at. */
static void begin_epoch(pir_clock *clock, bool axial, double expected) {
    clock->axial = axial;
    clock->start = clock->at;
    clock->carried = 0;
    clock->drift = STRETCH_ERROR;
    clock->phase = clock->path = clock->net = clock->extent = 0;
    clock->swings = false;
    clock->expected = expected;
    clock->steps = 0;
}

/* The step about the epoch's axis to `phase`. */
static pir_clock_event turn_on(pir_clock *clock, double phase, double drift, double *ret_shift) {
    double stride = phase - clock->phase;
    clock->swings |= stride * clock->stride < 0;
    clock->stride = stride;
    clock->phase = phase;
    clock->extent = fmax(clock->extent, fabs(phase));
    clock->drift = fmax(clock->drift, drift);
    if (fabs(phase) <= LONGEST_STRETCH)
        return PIR_CLOCK_RUNS;
    // the next stretch of the same epoch begins here
    *ret_shift = phase;
    clock->phase = 0;
    clock->swings = false;
    clock->start = clock->at;
    clock->carried = drift;
    return PIR_CLOCK_REBASED;
}

pir_clock_event pir_clock_step(pir_clock *clock, pir_quat before, pir_quat now, bool weary, double *ret_shift) {
    // a rotation that this clock has not seen ends the epoch
    bool followed =
        before.x == clock->at.x && before.y == clock->at.y && before.z == clock->at.z && before.w == clock->at.w;
    clock->at = now;
    clock->steps += clock->steps < UINT32_MAX;
    double phase, drift;
    if (clock->axial && followed && measure_stretch(clock, now, &phase, &drift))
        return turn_on(clock, phase, drift, ret_shift);
    pir_quat r = between(before, now);
    double angle = pir_rotation_angle_bound(before, now);
    pir_vec3 step = {r.x, r.y, r.z};
    bool lasted = clock->axial && clock->steps >= LASTING, keeps = keeps_axis(step, clock->step);
    clock->step = step;
    clock->path = (clock->path + angle) * (1 + 0x1p-51);
    set_way(clock, r, angle);
    if (!clock->axial && !keeps && followed && !weary && clock->path < LONGEST_PATH) {
        clock->net = pir_rotation_angle_bound(clock->start, now);
        return PIR_CLOCK_RUNS;
    }
    begin_epoch(clock, (keeps || lasted) && r.w >= 0.9 && pir_vec_dot(step, step) > 0, lasted ? clock->extent : 0);
    return PIR_CLOCK_NEW_EPOCH;
}
