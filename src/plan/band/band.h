/* SPDX-License-Identifier: MIT */
/*
 * Paths by pushing: a way of poses, in which the robot may meet obstacles, is pushed to where it has more room; and by
 * trees of poses that are free.
 *
 * A *band* is a row of poses at most a spacing apart, its ends held. A pose has the signed distances of all pieces that
 * are within a reach, and their gradients by translation and turn. It is moved, by a step of bounded length and across
 * the band, to where the least of them is greatest to first order; the step is kept where that is so, and halved where
 * it is not. Then the band is spaced anew along straight motions, which shortens it. This is done with a coarse
 * spacing, then with finer ones, as long as the robot comes free: nothing is proven by it, and all of it is doubles.
 *
 * A robot that hangs in an obstacle seldom comes free by that: a coarse band leaps over what it would have to go round.
 * So two *trees* of free poses grow from the ends, toward random poses and each other, until they meet.
 *
 * A path is made of motions between poses of a way. Each goes straight and turns evenly, and is proven to be free by
 * sweeps (pirouette/sweep.h) of all pairs of exact pieces but those whose boxes along the motion are apart. So what is
 * said to be a path is one, however the way came about. Where a motion is not proven the spacing is not fine enough.
 *
 * Sources: elastic bands are those of Quinlan and Khatib, Elastic bands: connecting path planning and control, 1993;
 * rows of states pushed across their tangents those of Jónsson, Mills and Jacobsen, 1998; trees from both ends those
 * of Kuffner and LaValle, RRT-Connect: an efficient approach to single-query path planning, 2000.
 */
#ifndef PIR_PLAN_BAND_BAND_H
#define PIR_PLAN_BAND_BAND_H

#include <pirouette/pose.h>

#include "plan/plan_sums.h"

/* The bodies, borrowed: exact pieces of both, and those of the obstacles that are pushed from, which may overlap. */
typedef struct pir_band_question {
    const pir_plan_pieces *robot, *obstacles, *wide;
    const double *low, *high; /* bounds of translations, of three each */
} pir_band_question;

typedef struct pir_band pir_band;

/* PIR_ERR_LIMIT where there are too many pairs of pieces for this. */
pir_status pir_band_create(const pir_band_question *question, pir_band **ret_band);
void pir_band_destroy(pir_band *band);

/*
 * Pushes a way, whose ends are free, at the first spacing, and keeps it to be tried. `work` is how many distances may
 * be asked for, and is lessened by those that were, and by what takes as long. `ret_room` is how much room all poses
 * have, or, below 0, how deep the robot is in the obstacles, in spacings.
 */
pir_status pir_band_add(pir_band *band, const pir_pose *way, uint32_t count, uint64_t *work, double *ret_room);

/*
 * Pushes the kept way with most room at finer spacings; it is not tried again. The poses of the path are from malloc;
 * NULL where the way does not come free. PIR_ERR_EMPTY where there is no way or work left.
 */
pir_status pir_band_try(pir_band *band, uint64_t *work, pir_pose **ret_step, uint32_t *ret_steps);

/*
 * Grows trees of poses from both ends, the same in each call, until they meet or the work is used up. The path is as
 * that of pir_band_try. PIR_ERR_EMPTY where they do not meet.
 */
pir_status pir_band_grow(pir_band *band, const pir_pose end[2], uint64_t *work, pir_pose **ret_step,
                         uint32_t *ret_steps);

#endif
