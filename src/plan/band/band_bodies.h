/* SPDX-License-Identifier: MIT */
/*
 * The pairs of pieces of a band, each with what it keeps from pose to pose.
 *
 * A pose is a unit quaternion and a translation, in doubles. Steps of it are six numbers: how the robot's middle moves,
 * and how the robot turns about it, as half the rotation vector times twice the robot's radius about its middle. So
 * all are lengths, and a step of length d moves no vertex by much more than d.
 */
#ifndef PIR_PLAN_BAND_BODIES_H
#define PIR_PLAN_BAND_BODIES_H

#include <pirouette/pair.h>

#include "plan/band/band.h"

#define PIR_BAND_STEP 6

/* The most pieces that a pose is pushed from. */
#define PIR_BAND_NEAR 64

typedef struct pir_band_pose {
    double q[4], t[3];
    double room; /* the least distance when it was looked at, up to the reach then; -INFINITY before */
} pir_band_pose;

/* A pair within reach: its signed distance, and the gradient of that by a step. */
typedef struct pir_band_near {
    double distance, gradient[PIR_BAND_STEP];
} pir_band_near;

/* A piece of the robot, by a ball about a point of it and one about the origin; an obstacle, by its box. */
typedef struct pir_band_ball {
    double at[3], radius, arm;
} pir_band_ball;

typedef struct pir_band_box {
    double low[3], high[3];
} pir_band_box;

/* Pairs of the robot's pieces and of some obstacles. */
typedef struct pir_band_pairs {
    pir_pair **pair; /* of robot piece i and obstacle k at i·obstacles + k */
    pir_band_ball *ball;
    pir_band_box *box;
    uint32_t robots, obstacles;
} pir_band_pairs;

typedef struct pir_band_bodies {
    pir_band_pairs push, prove;
    double middle[3], radius; /* of the robot, in its frame */
    const double *low, *high;
    pir_workspace *workspace;
    uint64_t work; /* distances that were asked for, and what takes as long */
} pir_band_bodies;

/* To be finished also where it fails. PIR_ERR_LIMIT where there are too many pairs. */
pir_status pir_band_bodies_open(const pir_band_question *question, pir_band_bodies *bodies);
void pir_band_bodies_finish(pir_band_bodies *bodies);

/*
 * The least distance at a pose, up to a reach, and of the pairs within that those that are no more than `more` farther
 * than the nearest: at most PIR_BAND_NEAR, and some beyond.
 */
pir_status pir_band_look(pir_band_bodies *bodies, const pir_band_pose *pose, double reach, double more,
                         pir_band_near *ret_near, uint32_t *ret_count, double *ret_least);

/* Moves a pose by a step; its translation stays within the bounds. */
void pir_band_move(const pir_band_bodies *bodies, const double step[PIR_BAND_STEP], pir_band_pose *pose);

/* The step from one pose to another, short where turns are small, and its length. */
double pir_band_step(const pir_band_bodies *bodies, const pir_band_pose *from, const pir_band_pose *to,
                     double ret_step[PIR_BAND_STEP]);

/* Whether the motion from one pose to another is proven to be free. */
pir_status pir_band_prove(pir_band_bodies *bodies, const pir_pose *from, const pir_pose *to, bool *ret_free);

#endif
