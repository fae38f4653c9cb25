/* SPDX-License-Identifier: MIT */
/*
 * The choice between update and walk, from work that the sum has counted itself. No clock is read, so a run repeats exactly.
 */
#ifndef PIR_DYMSUM_UPDATE_CHOOSE_H
#define PIR_DYMSUM_UPDATE_CHOOSE_H

#include "dymsum/sum.h"

/* The method to use for a turn of at most `angle`. */
pir_method pir_choose_method(pir_sum *sum, double angle);

/* Takes in that an update over `angle` has asked for so many signs. */
void pir_learn_update(pir_sum *sum, double angle, uint64_t signs);

/* Takes in that a walk was made. */
void pir_learn_walk(pir_sum *sum);

#endif
