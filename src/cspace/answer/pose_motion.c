/* SPDX-License-Identifier: MIT */
/*
 * Motions, halved until each part is proven.
 *
 * At time s the robot is turned from the first rotation towards the second by s of the angle φ between them, the
 * shorter way, and its translation is (1 − s)·t₀ + s·t₁. A stretch of length h about its middle: no point of a
 * piece of reach ρ is farther from its place at the middle than
 *
 *     h/2·|t₁ − t₀| + h/2·φ·ρ.
 *
 * Where what is proven of the middle holds for all that is moved by no more, it holds all along the stretch. The middle
 * of two rotations of length 1 is their sum, brought to length 1: no angle is computed. Each halving is off by some 8u,
 * so a middle by 2^-46 at the deepest, which the bound is widened by.
 *
 * Stretches are taken from left to right. One that is still open at the greatest depth, or when POSES poses have been
 * asked, is left unproven. That depth is DEEPEST at first, and one less for every OPEN stretches that were left: a
 * motion that slides in contact is then unproven in parts that double, and ends after hundreds of poses, not thousands
 * in a first small part. A stretch that is blocked all along, by the same bound, is not halved.
 */
#include "cspace/answer/pose_motion.h"

#include <math.h>

#include "base/report.h"
#include "base/vec.h"
#include "cspace/grid/angle.h"
#include "exact/rotation.h"

#define DEEPEST  16
#define COARSEST 4
#define OPEN     16
#define POSES    4096
#define WIDER    0x1p-44

/* The motion as far as it is known. */
struct pose_motion {
    pir_answers *answers;
    pir_report *report;
    double length, angle, reach; /* |t₁ − t₀|, φ, and the greatest reach of the robot's pieces */
    uint32_t asked;
    uint32_t left; /* stretches that were left unproven, though not all blocked */
    bool blocked;  /* some pose is */
    bool open;     /* an unproven stretch has begun, */
    bool closed;   /* and has ended */
    double from, to;
};

/* A stretch of it. */
struct stretch {
    double from, to;
    pir_quat q0, q1; /* of length 1, no farther apart than half a turn */
    pir_vec3 t0, t1;
    uint32_t depth;
};

/* The rotation halfway between two of length 1. */
static pir_quat middle_of(pir_quat a, pir_quat b) {
    return pir_quat_unit((pir_quat){a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w});
}

static pir_vec3 mean_of(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){0.5 * a.x + 0.5 * b.x, 0.5 * a.y + 0.5 * b.y, 0.5 * a.z + 0.5 * b.z};
}

/* How far a point of the robot may be from its place at the middle of a stretch. */
static double moved_in(const struct pose_motion *motion, const struct stretch *stretch) {
    double half = 0.5 * (stretch->to - stretch->from);
    double size = fmax(fabs(stretch->t0.x) + fabs(stretch->t0.y) + fabs(stretch->t0.z),
                       fabs(stretch->t1.x) + fabs(stretch->t1.y) + fabs(stretch->t1.z));
    return half * (motion->length + motion->angle * motion->reach) * (1 + WIDER) + WIDER * (motion->reach + size);
}

static void mark_proven(struct pose_motion *motion, const struct stretch *stretch) {
    if (motion->open && !motion->closed) {
        motion->to = stretch->from;
        motion->closed = true;
    }
}

static void mark_unproven(struct pose_motion *motion, const struct stretch *stretch) {
    if (!motion->open)
        motion->from = stretch->from;
    motion->open = true;
}

/* Whether a stretch is left as it is. */
static bool ends_here(const struct pose_motion *motion, const struct stretch *stretch) {
    uint32_t less = motion->left / OPEN;
    uint32_t deepest = less < DEEPEST - COARSEST ? DEEPEST - less : COARSEST;
    return stretch->depth >= deepest || motion->asked >= POSES || (motion->closed && motion->blocked);
}

static pir_status look_at(struct pose_motion *motion, const struct stretch *stretch) {
    if (motion->closed && motion->blocked)
        return PIR_OK;
    const pir_pose middle = {middle_of(stretch->q0, stretch->q1), mean_of(stretch->t0, stretch->t1)};
    pir_configuration configuration;
    double gap;
    motion->asked++;
    pir_status status =
        pir_answers_classify(motion->answers, &middle, PIR_WISH_GAP, motion->report, &configuration, &gap);
    if (status != PIR_OK)
        return status;
    motion->blocked |= configuration.verdict == PIR_VERDICT_BLOCKED;
    const bool all_along = gap > moved_in(motion, stretch);
    if (configuration.verdict == PIR_VERDICT_FREE && all_along) {
        mark_proven(motion, stretch);
        return PIR_OK;
    }
    const bool blocked_all_along = configuration.verdict == PIR_VERDICT_BLOCKED && all_along;
    if (blocked_all_along || ends_here(motion, stretch)) {
        motion->left += !blocked_all_along;
        mark_unproven(motion, stretch);
        return PIR_OK;
    }
    double time = 0.5 * (stretch->from + stretch->to);
    status = look_at(motion, &(struct stretch){stretch->from, time, stretch->q0, middle.rotation, stretch->t0,
                                               middle.translation, stretch->depth + 1});
    if (status == PIR_OK)
        status = look_at(motion, &(struct stretch){time, stretch->to, middle.rotation, stretch->q1, middle.translation,
                                                   stretch->t1, stretch->depth + 1});
    return status;
}

/* The poses at the ends, as given: at the rotation of a slice they are exact. */
static pir_status look_at_end(struct pose_motion *motion, const pir_pose *end) {
    pir_configuration configuration;
    double gap;
    pir_status status =
        pir_answers_classify(motion->answers, end, PIR_WISH_VERDICT, motion->report, &configuration, &gap);
    if (status == PIR_OK)
        motion->blocked |= configuration.verdict == PIR_VERDICT_BLOCKED;
    return status;
}

pir_status pir_answers_segment(pir_answers *answers, const pir_pose *from, const pir_pose *to, pir_report *report,
                               pir_cspace_motion *ret_motion) {
    pir_rotation first, last;
    pir_status status = pir_rotation_set(&first, from->rotation);
    if (status == PIR_OK)
        status = pir_rotation_set(&last, to->rotation);
    if (status == PIR_OK && (!pir_vec_is_finite(from->translation) || !pir_vec_is_finite(to->translation)))
        status = PIR_ERR_NOT_FINITE;
    if (status != PIR_OK)
        return pir_fail(report, status, "the motion: %s", pir_status_text(status));
    struct stretch whole = {0, 1, first.unit, last.unit, from->translation, to->translation, 0};
    if (pir_quat_dot(first.unit, last.unit) < 0)
        whole.q1 = (pir_quat){-last.unit.x, -last.unit.y, -last.unit.z, -last.unit.w};
    pir_vec3 way = pir_vec_sub(to->translation, from->translation);
    struct pose_motion motion = {.answers = answers, .report = report, .to = 1};
    motion.length = pir_safe_length(way);
    motion.angle = pir_rotation_angle_bound(first.unit, whole.q1);
    for (uint32_t k = 0; k < answers->bodies.robot_count; k++)
        motion.reach = fmax(motion.reach, answers->robot[k].reach);
    status = look_at_end(&motion, from);
    if (status == PIR_OK)
        status = look_at_end(&motion, to);
    if (status == PIR_OK)
        status = look_at(&motion, &whole);
    if (status != PIR_OK)
        return status;
    *ret_motion = (pir_cspace_motion){PIR_VERDICT_FREE, 0, 0};
    if (motion.open)
        *ret_motion =
            (pir_cspace_motion){motion.blocked ? PIR_VERDICT_BLOCKED : PIR_VERDICT_UNKNOWN, motion.from, motion.to};
    return PIR_OK;
}
