/* SPDX-License-Identifier: MIT */
/* Apart still by more than the cutoff: see still_apart.h. */
#include "pair/still_apart.h"

/* The most that |q|² of a quaternion may differ from 1, so that none has to be brought to length 1. */
#define NEAR_UNIT 0x1p-20

/*
 * The error of a difference of two such quaternions, brought to length 1: |q| is within 2^-21 and some
 * rounding of 1, so each moves by less than 2^-20, and both by less than 2^-19.
 */
#define BESIDE_UNIT 0x1p-18

/* Distances are known this well, relative to a bound on the reach: more than PIR_DISTANCE_ERROR of the reach. */
#define ERROR 0x1p-40

/* Beyond this reach nothing is decided here. */
#define FARTHEST 0x1p300

static bool is_near_unit(pir_quat q) {
    return fabs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) <= NEAR_UNIT;
}

/* Whether a component may be too small for a relative rotation. */
static bool has_tiny(pir_quat q) {
    const double least = 0x1p-800;
    return (q.x != 0 && fabs(q.x) < least) || (q.y != 0 && fabs(q.y) < least) || (q.z != 0 && fabs(q.z) < least) ||
           (q.w != 0 && fabs(q.w) < least);
}

static double taxicab(pir_vec3 v) {
    return fabs(v.x) + fabs(v.y) + fabs(v.z);
}

/* The square of the distance of two quaternions; of those that are each other's opposite it is far too great. */
static double square_chord(pir_quat a, pir_quat b) {
    double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z, w = a.w - b.w;
    return x * x + y * y + z * z + w * w;
}

/* How much farther P has gone along n, a unit vector in Q's frame, less errors. */
static double gone_along(const pir_workspace *workspace, pir_vec3 n, const pir_pose *from, const pir_pose *to) {
    pir_vec3 way = pir_vec_scale(pir_vec_sub(to->translation, from->translation), workspace->frame.down);
    if (workspace->is_turned)
        way = pir_mat_apply_transposed(&workspace->rotation_q.r, way);
    return pir_vec_dot(n, way) - taxicab(way) * ERROR;
}

/*
 * Whether P's support has changed by less than `room`, in units of the frame, as P turned about its origin; sets *room
 * to what that leaves of it.
 */
static bool leaves_some(const pir_frame *frame, const pir_pose *from, const pir_pose *to, double *room) {
    const double swing = frame->p.swing + frame->p.far;
    // most turns that are too great are so by their chord
    if (!(*room > 0 && 4 * square_chord(from->rotation, to->rotation) * swing * swing < *room * *room))
        return false;
    *room -= pir_rotation_angle_bound_within(from->rotation, to->rotation, BESIDE_UNIT) * swing * (1 + 0x1p-40);
    return *room > 0;
}

bool pir_pair_still_apart(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input) {
    const pir_frame *frame = &workspace->frame;
    const pir_pose *last = workspace->pose, *p = &input->pose_p, *q = &input->pose_q;
    if (!(pair->left > 0) || !pir_pair_is_at(pair, workspace))
        return false;
    double cutoff = (input->cutoff > 0 ? input->cutoff : 0) + input->radius_p + input->radius_q;
    double far = (taxicab(p->translation) + taxicab(q->translation)) * frame->down + frame->p.far + frame->q.far;
    double reach = frame->p.size + frame->q.size + far, least = cutoff * frame->down * (1 + 0x1p-40) + ERROR * reach;
    double room = pair->left - least + gone_along(workspace, pair->axis, &last[0], p);
    // `down` is 0 where units are no normal numbers
    if (!(frame->down > 0 && reach < FARTHEST) || !leaves_some(frame, &last[0], p, &room))
        return false;
    if (!pir_pose_is_same(q, &last[1]) || pir_pair_check(input) != PIR_OK || !is_near_unit(last[0].rotation) ||
        !is_near_unit(p->rotation) || (workspace->posed && has_tiny(p->rotation)))
        return false;
    pir_pair_keep_left(pair, room + least);
    workspace->pose[0] = *p;
    workspace->is_framed = false;
    workspace->moved = (pir_leeway){HUGE_VAL, HUGE_VAL};
    return true;
}
