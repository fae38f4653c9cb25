/* SPDX-License-Identifier: MIT */
/*
 * The cost model: a walk costs the signs of the last walk; an update costs signs in proportion to the angle, which holds while few
 * certificates expire and overstates large angles, where a walk is right anyway. The slope is a running mean over recent updates.
 *
 * Hysteresis: a sum that walks must expect a clear gain before it updates again, since after a walk the first update has to check every
 * pair; and once in a while it updates all the same, to see whether its slope still holds.
 */
#include "dymsum/choose.h"

#define CLEAR_GAIN   0.8
#define PROBE_PERIOD 64
#define MEMORY       0.125

pir_method pir_choose_method(pir_sum *sum, double angle) {
    pir_cost_model *cost = &sum->cost;
    double expected = cost->per_radian * angle;
    bool walked = cost->walks_in_a_row > 0;
    if (expected <= (walked ? CLEAR_GAIN : 1) * cost->walk || cost->walks_in_a_row >= PROBE_PERIOD)
        return PIR_METHOD_UPDATE;
    return PIR_METHOD_WALK;
}

void pir_learn_update(pir_sum *sum, double angle, double signs) {
    pir_cost_model *cost = &sum->cost;
    // the first update after a walk checks every pair: it says nothing about the slope
    if (cost->walks_in_a_row == 0 && angle > 0) {
        double slope = signs / angle;
        cost->per_radian = cost->per_radian == 0 ? slope : cost->per_radian + MEMORY * (slope - cost->per_radian);
    }
    cost->walks_in_a_row = 0;
}
