/* SPDX-License-Identifier: MIT */
/*
 * The choice between update and walk, from work that the sum has counted itself. No clock is read, so a run repeats
 * exactly.
 */
#ifndef PIR_DYMSUM_UPDATE_CHOOSE_H
#define PIR_DYMSUM_UPDATE_CHOOSE_H

#include <stdbool.h>
#include <stdint.h>

#include <pirouette/sum.h>

/* The inputs of the choice. Work is counted in signs. */
typedef struct pir_cost_model {
    double walk;       /* work of the last walk */
    double per_radian; /* work of recent updates per radian turned, 0 while none is known */
    uint32_t walks_in_a_row, updates_in_a_row;
    uint32_t trial_after; /* how many walks in a row before an update is tried */
    bool lags;            /* whether staying behind a rotation was found to pay */
    float work, turned;   /* of the last hundred updates or so, and the radians that they went through */
} pir_cost_model;

/* The method to use for a turn of at most `angle`. */
pir_method pir_choose_method(const pir_cost_model *cost, double angle);

/*
 * Whether it costs less to stay behind for a turn of `angle`, and then to bring the pairing there at once, than to
 * follow the turn step by step.
 */
bool pir_pays_to_lag(pir_cost_model *cost, double angle);

/* Notes that an update over `angle`, of a `share` of all features, has asked for so many signs. */
void pir_learn_update(pir_cost_model *cost, double angle, uint64_t signs, double share);

/* Notes that a walk of a `share` of all features has asked for so many signs. in_region: of those of a region. */
void pir_learn_walk_work(pir_cost_model *cost, uint64_t signs, bool in_region, double share);

/* Notes a walk that was chosen or asked for. */
void pir_learn_walk(pir_cost_model *cost);

#endif
