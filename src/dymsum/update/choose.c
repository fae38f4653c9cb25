/* SPDX-License-Identifier: MIT */
/*
 * The cost model. Work is counted in signs: a walk asks for them one by one, an update by rings of sides and by
 * corners. Per sign asked for, an update takes 1.1 to 1.2 times as long as a walk wherever the two are close, on bodies
 * of 6 to 2,400 facets, and 0.87 where one swings between two places, which processors learn to foresee; far from there
 * it hardly matters. An update's work is taken to be in proportion to the angle, which holds while few certificates
 * expire and overstates large angles, where a walk is right anyway. Facets that swing back ask for no signs, and count
 * as no work: they are so little that a walk is never right for them.
 *
 * Where a region keeps a part of the features, both are reckoned for all of them, so that another region changes
 * neither.
 *
 * After a walk the first update has to look at every pair, and only the third can find facets swung back. So the first
 * teaches nothing, each of the next two makes the slope anew, and a switch to updating lasts for three at least. A sum
 * that walks must expect a clear gain before it switches, and tries it once in a while all the same, for its slope may
 * be out of date: the first time soon, since a pose full of ties costs more to leave than any other, then less and less
 * often.
 */
#include "dymsum/update/choose.h"

#include <math.h>
#include <stdbool.h>

#define WORK_OF_SIGN 1.05
#define CLEAR_GAIN   0.8
#define TRIAL        3
#define FIRST_PROBE  4
#define LATEST_PROBE 64
#define MEMORY       0.125
/*
 * Signs per radian that stand for none, 0 meaning that nothing is known. No bound of any error: a walk asks for more
 * within any angle, and what is chosen here is a way to the pairing, which every way finds alike. A number much smaller
 * would be one that processors are slow with.
 */
#define NO_WORK 1e-6

pir_method pir_choose_method(const pir_cost_model *cost, double angle) {
    bool on_trial = cost->updates_in_a_row > 0 && cost->updates_in_a_row < TRIAL;
    if (cost->per_radian == 0 || on_trial || cost->walks_in_a_row >= cost->probe_after)
        return PIR_METHOD_UPDATE;
    double expected = cost->per_radian * angle,
           allowed = cost->walks_in_a_row > 0 ? CLEAR_GAIN * cost->walk : cost->walk;
    return expected <= allowed ? PIR_METHOD_UPDATE : PIR_METHOD_WALK;
}

void pir_learn_update(pir_cost_model *cost, double angle, uint64_t signs, double share) {
    if (cost->updates_in_a_row > 0 && angle > 0) {
        double slope = signs > 0 ? WORK_OF_SIGN * (double)signs / angle / share : 0;
        bool afresh = cost->per_radian == 0 || cost->updates_in_a_row < TRIAL;
        cost->per_radian = fmax(afresh ? slope : cost->per_radian + MEMORY * (slope - cost->per_radian), NO_WORK);
    }
    // a probe that leads back to walking makes the next one later; one that lasts makes it early again
    if (cost->updates_in_a_row == 0)
        cost->probe_after = cost->probe_after < LATEST_PROBE / 2 ? 2 * cost->probe_after : LATEST_PROBE;
    else if (cost->updates_in_a_row == TRIAL)
        cost->probe_after = FIRST_PROBE;
    cost->updates_in_a_row += cost->updates_in_a_row < UINT32_MAX;
    cost->walks_in_a_row = 0;
}

void pir_learn_walk(pir_cost_model *cost) {
    if (cost->probe_after == 0)
        cost->probe_after = FIRST_PROBE;
    cost->walks_in_a_row++;
    cost->updates_in_a_row = 0;
}
