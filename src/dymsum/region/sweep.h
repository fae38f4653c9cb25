/* SPDX-License-Identifier: MIT */
/* Which features a cover asks for: see sweep.c. */
#ifndef PIR_DYMSUM_REGION_SWEEP_H
#define PIR_DYMSUM_REGION_SWEEP_H

#include <stdbool.h>

struct pir_sum;

/*
 * Memory for sweeps, filled with what they read of the operands; no feature is a member. False when out of memory:
 * there is none then.
 */
bool pir_sweep_allocate(struct pir_sum *sum);
void pir_sweep_finish(struct pir_sum *sum);

/*
 * Finds the features that the cover of the sum's region asks for: they stand in members->next, as many as
 * members->count says, and the `seen` of each is the number of the sweep. The members are those of before still, in
 * members->at.
 */
void pir_sweep(struct pir_sum *sum);

#endif
