/* SPDX-License-Identifier: MIT */
/*
 * Sweeps of pairs: from plane to plane while the bodies are apart, then forward to an overlap.
 *
 * Seen from Q's origin, which goes straight, Q turns about it. P turns about its own origin, or the pivot of a screw,
 * and that goes straight too. A plane between the bodies that stands still there has P above and Q below until a point
 * of either comes down to it (query/proof/parting.h). Each has its share of the gap, by how fast its points can be.
 *
 * Invariants: up to `time` the bodies share no point, but for stretches between `from` and `to`, of which nothing is
 * proven; `is_open` says whether there is one. All of it is of the exact motion.
 *
 * Rounding, with u = 2^-53, relative to `size`, the sum of both reaches, all coordinates and the ways. The relative
 * rotation is off by 8u, its vector by 100u more (turn_of), brought to the world by as much; the pose at a time, a turn
 * by its series and squarings, by 160u, and a few u of the coordinates. A height above a plane is off by 32u, its
 * course by 2^-44, times by u of the ways. This is below 2^-42 in all, for either body. ERROR is four times that, and
 * each body stays farther from its plane than 2·ERROR. A depth is off by 1e-12 (pair.h) and the poses by 2^-41, so an
 * overlap deeper than DEEP, 2^-38, is one of the exact motion.
 *
 * A screw's vector is off by 8u of its angle θ instead. Its pivot, as the body sees it, is off by 40u, and brought to
 * the world by as much. The pose at a time is off by 250u for each half turn, and so is the course for each half turn
 * by 2^-48 of its way. All together is below 1100u for each half turn that is begun; `size` is multiplied by those.
 */
#include <pirouette/sweep.h>

#include "exact/rotation.h"
#include "pair/pair.h"
#include "polytope/polytope.h"
#include "query/proof/parting.h"

#define ERROR 0x1p-40
#define DEEP  0x1p-38
/* Planes are looked for where the gap is wider than this, so that each body has more than 4·ERROR of it. */
#define WIDE 9

/* Components of a relative rotation from here on have the sign of the exact ones: see rotation.c. */
#define LEAST_COMPONENT 0x1p-40

#define RADIANS_A_DEGREE 0x1.1df46a2529d39p-6

/* A body on its way. */
typedef struct sweep_mover {
    pir_parted parted; /* `way` of P's is that relative to Q's, of Q's 0 */
    pir_vec3 way;
    pir_pose pose[2]; /* at times 0 and 1 */
    bool is_exact;    /* whether the second pose is that of the motion, and not rounded */
    double fastest;   /* no point moves farther, as `parted` goes */
} sweep_mover;

typedef struct sweep_job {
    pir_pair *pair;
    pir_workspace *workspace;
    uint32_t budget, queries;
    sweep_mover p, q;
    double size;
    bool rounded; /* the bodies have radii */

    /* at the time that was looked at last */
    pir_pair_input at;
    pir_query_result answer;
    pir_vec3 normal;     /* unit, from Q to P */
    double low_p, low_q; /* P's height along the normal, and Q's along its opposite */

    double time;
    bool is_open, meets;
    double from, to;
} sweep_job;

/* --- the motion --- */

/* A turn of length 1 with the sign that makes it the shorter way. */
static pir_quat shorter_way(pir_rotation *rotation) {
    const pir_quat q = rotation->unit;
    if (q.w >= LEAST_COMPONENT)
        return q;
    pir_rotation_integers integers;
    rotation->integers = &integers;
    pir_rotation_make_exact(rotation);
    // the largest of x, y and z is far from 0, and its sign is sure
    const double c[3] = {q.x, q.y, q.z};
    int most = fabs(c[0]) >= fabs(c[1]) ? 0 : 1;
    most = fabs(c[most]) >= fabs(c[2]) ? most : 2;
    const bool same = (c[most] > 0) == (integers.q[most].size > 0);
    return same ? q : (pir_quat){-q.x, -q.y, -q.z, -q.w};
}

/*
 * The turn as a vector along its axis, as long as the angle. Half of the angle is halved four times, by the sine of
 * the half, s/2c, which multiplies errors by no more than 1/2 each; then the series of asin x over x, for x² below
 * 0.0097, where terms beyond the eighth are below 2^-56.
 */
static pir_vec3 turn_of(pir_quat q) {
    double w = fmax(q.w, 0), scale = 1;
    for (int i = 0; i < 4; i++) {
        w = sqrt(0.5 + 0.5 * w);
        scale *= 2 * w;
    }
    const pir_vec3 v = pir_vec_scale((pir_vec3){q.x, q.y, q.z}, 1 / scale);
    const double square = pir_vec_dot(v, v);
    double series = 1;
    for (int k = 8; k > 0; k--)
        series = 1 + square * ((2 * k - 1) * (2 * k - 1)) / (2 * k * (2 * k + 1)) * series;
    return pir_vec_scale(v, 32 * series);
}

static pir_status set_mover(sweep_mover *mover, const pir_polytope *body, const pir_pose pose[2], double radius) {
    pir_rotation relative;
    if (!pir_vec_is_finite(pose[0].translation) || !pir_vec_is_finite(pose[1].translation))
        return PIR_ERR_NOT_FINITE;
    pir_status status = pir_rotation_set_relative(&relative, pose[0].rotation, pose[1].rotation);
    if (status != PIR_OK)
        return status;
    mover->pose[0] = pose[0];
    mover->pose[1] = pose[1];
    mover->is_exact = true;
    mover->way = pir_vec_sub(pose[1].translation, pose[0].translation);
    pir_vec3 turn = {0, 0, 0};
    if (!pir_quat_is_identity(relative.unit))
        turn = pir_pose_rotate(pose[0], turn_of(shorter_way(&relative)));
    const pir_vec3 centre = {0, 0, 0};
    mover->parted = (pir_parted){.point = body->vertex,
                                 .count = body->vertex_count,
                                 .radius = radius,
                                 .reach = pir_parted_reach(body->vertex, body->vertex_count, centre),
                                 .turn = turn};
    return PIR_OK;
}

static pir_pose pose_at(const sweep_mover *mover, double time) {
    if (time == 0 || (time == 1 && mover->is_exact))
        return mover->pose[time == 1];
    const pir_vec3 centre = mover->parted.centre;
    const pir_vec3 from = pir_vec_add(mover->pose[0].translation, pir_pose_rotate(mover->pose[0], centre));
    pir_pose pose = pir_pose_integrate((pir_pose){mover->pose[0].rotation, from}, mover->way, mover->parted.turn, time);
    pose.translation = pir_vec_sub(pose.translation, pir_pose_rotate(pose, centre));
    return pose;
}

static bool rests(const sweep_mover *mover) {
    return mover->is_exact && pir_pose_is_same(&mover->pose[0], &mover->pose[1]);
}

/* --- screws --- */

/* The turn along its axis, as long as the angle. */
static pir_vec3 turn_of_screw(const pir_exact_motion *motion) {
    const double angle = motion->degrees * RADIANS_A_DEGREE;
    return angle == 0 ? (pir_vec3){0, 0, 0} : pir_vec_scale(motion->axis, angle / pir_vec_length(motion->axis));
}

/* Makes a mover that rests at its first pose one that goes along a screw. */
static void screw_on(sweep_mover *mover, const pir_polytope *body, const pir_exact_motion *motion) {
    pir_parted *parted = &mover->parted;
    const pir_pose first = mover->pose[0];
    mover->way = motion->way;
    parted->turn = turn_of_screw(motion);
    if (motion->degrees != 0) {
        parted->centre = pir_pose_rotate_inverse(first, pir_vec_sub(motion->pivot, first.translation));
        parted->reach = pir_parted_reach(body->vertex, body->vertex_count, parted->centre);
    }
    mover->is_exact = motion->degrees == 0 && pir_vec_size(motion->way) == 0;
    mover->pose[1] = pose_at(mover, 1);
}

/* --- what is known at a time --- */

/* The height of the lowest point along a unit vector. */
static double lowest(const sweep_mover *mover, pir_pose pose, pir_vec3 n) {
    const pir_vec3 in_body = pir_pose_rotate_inverse(pose, n);
    double least = HUGE_VAL;
    for (uint32_t v = 0; v < mover->parted.count; v++)
        least = fmin(least, pir_vec_dot(in_body, mover->parted.point[v]));
    return least + pir_vec_dot(n, pose.translation) - mover->parted.radius;
}

static pir_status look_at(sweep_job *job, double time) {
    job->at.pose_p = pose_at(&job->p, time);
    job->at.pose_q = pose_at(&job->q, time);
    job->queries++;
    const pir_status status = pir_pair_distance(job->pair, job->workspace, &job->at, &job->answer);
    if (status == PIR_OK && job->answer.state == PIR_OUTSIDE) {
        const pir_vec3 given = job->answer.normal, n = pir_vec_scale(given, 1 / pir_vec_length(given));
        job->normal = n;
        job->low_p = lowest(&job->p, job->at.pose_p, n);
        job->low_q = lowest(&job->q, job->at.pose_q, pir_vec_scale(n, -1));
    }
    return status;
}

/* The gap between the bodies along the normal at hand, where it is wide; else 0. */
static double gap_of(const sweep_job *job) {
    const double gap = job->low_p + job->low_q;
    return job->answer.state == PIR_OUTSIDE && gap > WIDE * ERROR * job->size ? gap : 0;
}

/* Whether the bodies share a point at the time at hand, proven. */
static pir_status prove_meeting(sweep_job *job, double time, bool *ret_meets) {
    const bool is_exact = time == 0 || (time == 1 && job->p.is_exact);
    *ret_meets = job->answer.state != PIR_OUTSIDE && !job->rounded && is_exact;
    if (*ret_meets || job->answer.state != PIR_INSIDE)
        return PIR_OK;
    pir_query_result depth;
    const pir_status status = pir_pair_penetration(job->pair, job->workspace, &job->at, &depth);
    *ret_meets = status == PIR_OK && -depth.distance > DEEP * job->size;
    return status;
}

/* --- from time to time --- */

/* The time to which a plane parts P and Q, of which each has its share of the gap; HUGE_VAL beyond the end. */
static double part_until(const sweep_job *job, double gap) {
    const sweep_mover *p = &job->p, *q = &job->q;
    const double error = ERROR * job->size, spare = gap - 8 * error, all = p->fastest + q->fastest;
    const double share_q = q->fastest > 0 ? 4 * error + spare * (q->fastest / all) : 0, share_p = gap - share_q;
    const pir_vec3 n = job->normal, back = pir_vec_scale(n, -1);
    const pir_parting above = {n, pir_vec_scale(n, job->low_p - share_p), 3 * error, 2 * error};
    double until = pir_part_until(&p->parted, &above, job->at.pose_p, share_p, job->time, 1);
    if (q->fastest > 0) {
        const pir_parting below = {back, pir_vec_scale(back, job->low_q - share_q), 3 * error, 2 * error};
        until = fmin(until, pir_part_until(&q->parted, &below, job->at.pose_q, share_q, job->time, 1));
    }
    return until;
}

static void open_stretch(sweep_job *job) {
    if (!job->is_open)
        job->from = job->time;
    job->is_open = true;
}

/*
 * Forward, in steps that double, from a time at which the bodies are hardly apart, to one at which they have met, or
 * are apart again, or to the end.
 */
static pir_status probe(sweep_job *job) {
    open_stretch(job);
    const double fastest = job->p.fastest + job->q.fastest;
    double step = fastest > 0 ? fmax(ERROR * job->size / fastest, 0x1p-50) : 1;
    for (double start = job->time; job->queries < job->budget; step *= 2) {
        job->time = job->to = fmin(start + step, 1);
        if (job->time == 1)
            return PIR_OK;
        pir_status status = look_at(job, job->time);
        if (status == PIR_OK)
            status = prove_meeting(job, job->time, &job->meets);
        if (status != PIR_OK || job->meets || gap_of(job) > 0)
            return status;
    }
    job->time = job->to = 1;
    return PIR_OK;
}

/* All the way from time 0, which has been looked at. */
static pir_status go_on(sweep_job *job) {
    while (job->time < 1 && !job->meets) {
        const double gap = gap_of(job);
        // late, steps that would not come to the end are no use
        const double least = job->queries > job->budget / 2 ? 1.0 / job->budget : 0x1p-52;
        const double until = gap > 0 ? part_until(job, gap) : job->time;
        pir_status status = PIR_OK;
        if (until > 1) {
            job->time = 1;
        } else if (!(until > job->time + least)) {
            status = probe(job);
        } else if (job->queries >= job->budget) {
            job->time = until;
            open_stretch(job);
            job->time = job->to = 1;
        } else {
            job->time = until;
            status = look_at(job, until);
        }
        if (status != PIR_OK)
            return status;
    }
    return PIR_OK;
}

static pir_status run(sweep_job *job, pir_sweep_result *sweep) {
    bool meets_last = false;
    pir_status status = look_at(job, 1);
    if (status == PIR_OK)
        status = prove_meeting(job, 1, &meets_last);
    if (status == PIR_OK)
        status = look_at(job, 0);
    if (status == PIR_OK)
        status = prove_meeting(job, 0, &job->meets);
    if (status != PIR_OK)
        return status;
    if (job->meets) {
        *sweep = (pir_sweep_result){PIR_SWEEP_MEETS, 0, 0, job->queries};
        return PIR_OK;
    }
    *sweep = (pir_sweep_result){PIR_SWEEP_FREE, 1, 1, job->queries};
    if (!job->rounded && rests(&job->p) && rests(&job->q))
        return PIR_OK;
    status = go_on(job);
    sweep->queries = job->queries;
    if (!job->is_open)
        return status;
    sweep->outcome = job->meets || meets_last ? PIR_SWEEP_MEETS : PIR_SWEEP_UNDECIDED;
    sweep->from = job->from;
    sweep->to = job->meets || !meets_last ? job->to : 1;
    return status;
}

/* Sets P's way relative to Q's, how fast both are, and the size. PIR_ERR_LIMIT where that is not finite. */
static pir_status set_size(sweep_job *job) {
    sweep_mover *const mover[2] = {&job->p, &job->q};
    job->p.parted.way = pir_vec_sub(job->p.way, job->q.way);
    for (int k = 0; k < 2; k++) {
        sweep_mover *m = mover[k];
        m->fastest = pir_vec_length(m->parted.way) + pir_vec_length(m->parted.turn) * m->parted.reach;
        job->size += m->parted.reach + m->parted.radius + pir_vec_length(m->pose[0].translation) +
                     pir_vec_length(m->pose[1].translation) + pir_vec_length(m->way);
    }
    return isfinite(job->size) ? PIR_OK : PIR_ERR_LIMIT;
}

static pir_status init(sweep_job *job, const pir_pair_input *first, const pir_pair_input *second, uint32_t budget) {
    job->budget = budget > 0 ? budget : PIR_SWEEP_BUDGET;
    job->at = *first;
    job->at.cutoff = HUGE_VAL;
    job->at.margin = 0;
    job->rounded = first->radius_p > 0 || first->radius_q > 0;
    pir_status status = pir_pair_check(&job->at);
    if (status == PIR_OK)
        status = set_mover(&job->p, job->pair->p, (const pir_pose[]){first->pose_p, second->pose_p}, first->radius_p);
    if (status == PIR_OK)
        status = set_mover(&job->q, job->pair->q, (const pir_pose[]){first->pose_q, second->pose_q}, first->radius_q);
    return status;
}

pir_status pir_pair_sweep(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *first,
                          const pir_pair_input *second, uint32_t budget, pir_sweep_result *ret_sweep) {
    if (!pair || !workspace || !first || !second || !ret_sweep)
        return PIR_ERR_ARGUMENT;
    sweep_job job = {.pair = pair, .workspace = workspace};
    pir_status status = init(&job, first, second, budget);
    if (status == PIR_OK)
        status = set_size(&job);
    return status == PIR_OK ? run(&job, ret_sweep) : status;
}

pir_status pir_pair_sweep_screw(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                const pir_exact_motion *motion, uint32_t budget, pir_sweep_result *ret_sweep) {
    if (!pair || !workspace || !input || !motion || !ret_sweep)
        return PIR_ERR_ARGUMENT;
    sweep_job job = {.pair = pair, .workspace = workspace};
    pir_status status = pir_screw_check(motion, PIR_SWEEP_DEGREES);
    if (status == PIR_OK)
        status = init(&job, input, input, budget);
    if (status != PIR_OK)
        return status;
    screw_on(&job.p, pair->p, motion);
    job.size = motion->degrees != 0 ? pir_vec_length(motion->pivot) : 0;
    status = set_size(&job);
    job.size *= fmax(1, ceil(fabs(motion->degrees) / 180));
    return status == PIR_OK ? run(&job, ret_sweep) : status;
}
