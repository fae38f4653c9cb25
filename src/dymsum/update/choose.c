/* SPDX-License-Identifier: MIT */
/*
 * The cost model. Work is counted in signs, most of which both methods ask for by rings of sides. A sign asked for in
 * an update took 1.3 to 2 times as long as one in a walk on bodies of 6 to 20 facets, and 1.9 to 2.6 times on bodies of
 * 500 to 2,400, wherever the two methods were close. Far from break-even the factor hardly matters. The work of an
 * update is taken to be proportional to the angle. That holds while few certificates expire, and overstates large
 * angles, where a walk is right anyway. Facets that return to their previous cells ask for no signs and count as no
 * work, since a walk is never right for them.
 *
 * Where a region keeps a part of the features, the work of both is scaled up to all of them, so that another region
 * changes neither. A walk within a region asks for cheaper signs, since all its facets descend from a grid.
 *
 * After a walk the first update has to check every facet, and only the third can find facets that return. So nothing is
 * learnt from the first, each of the next two sets the slope anew, and a switch to updating lasts for at least three. A
 * sum that walks must expect a clear gain before it switches. It tries an update once in a while nevertheless, because
 * its slope may be out of date: the first time soon, since a pose with many ties costs more to leave than any other,
 * then at longer and longer intervals.
 *
 * One update over many steps is no cheaper than an update for each of them: what certificates predict is lost. A
 * tolerance saves work from where the turn that it allows would cost more to follow than a walk does. Steps differ, so
 * that is judged by many updates together, and a sum that follows its rotation must expect a clear gain before it stays
 * behind.
 */
#include "dymsum/update/choose.h"

#include <math.h>

/* The time of a sign asked for in an update, by that of one in a walk: between the ratios above. */
#define WORK_OF_SIGN 2.0

/* The time of a sign in a walk within a region, by that of one in a walk of everything: half to three quarters. */
#define WORK_IN_REGION 0.65

/* A sum that walks changes to updates when one is expected to cost at most this part of a walk. */
#define CLEAR_GAIN 0.8

/* A change to updates lasts for at least so many. */
#define TRIAL_LENGTH 3

/* How many walks come before the first trial of an update, and before the latest: the number doubles. */
#define FIRST_TRIAL_AFTER  4
#define LATEST_TRIAL_AFTER 64

/* The weight of the last update in the slope. */
#define MEMORY 0.125

/*
 * The least slope kept, in signs per radian; 0 means that nothing is known. It decides no choice: half a turn at this
 * slope asks for four signs, and a walk of two bodies with facets for more.
 */
#define LEAST_SLOPE 1

/* The work and radians of recent updates lose this share with each update. */
#define FORGETTING 0x1p-7

/* Staying behind begins to pay where following is expected to cost so many walks; it goes on down to one. */
#define CLEAR_LOSS 1.5

pir_method pir_choose_method(const pir_cost_model *cost, double angle) {
    bool on_trial = cost->updates_in_a_row > 0 && cost->updates_in_a_row < TRIAL_LENGTH;
    if (cost->per_radian == 0 || on_trial || cost->walks_in_a_row >= cost->trial_after)
        return PIR_METHOD_UPDATE;
    double expected = cost->per_radian * angle,
           allowed = cost->walks_in_a_row > 0 ? CLEAR_GAIN * cost->walk : cost->walk;
    return expected <= allowed ? PIR_METHOD_UPDATE : PIR_METHOD_WALK;
}

bool pir_pays_to_lag(pir_cost_model *cost, double angle) {
    if (cost->turned > 0)
        cost->lags = (double)cost->work * angle >= (cost->lags ? 1 : CLEAR_LOSS) * cost->walk * (double)cost->turned;
    return cost->lags || cost->turned == 0;
}

void pir_learn_update(pir_cost_model *cost, double angle, uint64_t signs, double share) {
    if (cost->updates_in_a_row > 0 && angle > 0) {
        double slope = signs > 0 ? WORK_OF_SIGN * (double)signs / angle / share : 0;
        bool afresh = cost->per_radian == 0 || cost->updates_in_a_row < TRIAL_LENGTH;
        cost->work += (float)(WORK_OF_SIGN * (double)signs / share - FORGETTING * (double)cost->work);
        cost->turned += (float)(angle - FORGETTING * (double)cost->turned);
        cost->per_radian = fmax(afresh ? slope : cost->per_radian + MEMORY * (slope - cost->per_radian), LEAST_SLOPE);
    }
    // a trial that leads back to walking makes the next one later; one that lasts makes it early again
    if (cost->updates_in_a_row == 0)
        cost->trial_after = cost->trial_after < LATEST_TRIAL_AFTER / 2 ? 2 * cost->trial_after : LATEST_TRIAL_AFTER;
    else if (cost->updates_in_a_row == TRIAL_LENGTH)
        cost->trial_after = FIRST_TRIAL_AFTER;
    cost->updates_in_a_row += cost->updates_in_a_row < UINT32_MAX;
    cost->walks_in_a_row = 0;
}

void pir_learn_walk_work(pir_cost_model *cost, uint64_t signs, bool in_region, double share) {
    cost->walk = (in_region ? WORK_IN_REGION : 1) * (double)signs / share;
}

void pir_learn_walk(pir_cost_model *cost) {
    if (cost->trial_after == 0)
        cost->trial_after = FIRST_TRIAL_AFTER;
    cost->walks_in_a_row++;
    cost->updates_in_a_row = 0;
}
