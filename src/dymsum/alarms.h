/* SPDX-License-Identifier: MIT */
/*
 * When certificates wake: a store of two levels, read in order.
 *
 * Each certificate has the span of phases, from `behind` to `ahead`, in which it holds. For when the axis changes it also has the
 * rotation at which it was made and a `margin`, the angle between that and R up to which it holds whatever the way: what a body has
 * turned there and back, or about changing axes, costs it only the net turn. Blocks of 16 carry the least `ahead` and the greatest `behind` of theirs. Finding what wakes reads the blocks'
 * bounds, a few cache lines in all, and then the blocks in question; filing one is two comparisons. Against a timing wheel or a
 * heap this reads more and moves nothing: certificates stay where their pair is, a new epoch is one sweep, and an alarm may be set
 * backwards as well as forwards.
 *
 * Invariant: a block's bounds are at most, and at least, those of its certificates.
 */
#ifndef PIR_DYMSUM_ALARMS_H
#define PIR_DYMSUM_ALARMS_H

#include "base/memory.h"
#include "dymsum/clock.h"

#define PIR_ALARM_BLOCK 16

typedef struct pir_kernels pir_kernels;

typedef struct pir_alarms {
    double *ahead, *behind; /* per certificate */
    float *margin;
    float *at[4]; /* the unit quaternion it was made at */
    float now[4]; /* that of R */
    double *block_ahead, *block_behind;
    uint32_t *woken;   /* what the last collecting found, rising */
    uint32_t capacity; /* a multiple of eight blocks */
} pir_alarms;

/* Room for `capacity` certificates at least; new ones never wake. What was there stays on failure. */
bool pir_alarms_reserve(pir_alarms *alarms, const pir_allocator *allocator, uint32_t capacity);
void pir_alarms_finish(pir_alarms *alarms, const pir_allocator *allocator);

/* Files certificate i. */
static inline void pir_alarm_set(pir_alarms *alarms, uint32_t i, float margin, double ahead, double behind) {
    uint32_t block = i / PIR_ALARM_BLOCK;
    double least = alarms->block_ahead[block], greatest = alarms->block_behind[block];
    alarms->ahead[i] = ahead;
    alarms->behind[i] = behind;
    alarms->margin[i] = margin;
    for (int k = 0; k < 4; k++)
        alarms->at[k][i] = alarms->now[k];
    alarms->block_ahead[block] = ahead < least ? ahead : least;
    alarms->block_behind[block] = behind > greatest ? behind : greatest;
}

/* Far beyond any turn, and finite, so that subtracting from it stays a number. */
#define PIR_FOR_GOOD 1e30f

/* Lets certificate i sleep for good: its pair is gone. */
static inline void pir_alarm_clear(pir_alarms *alarms, uint32_t i) {
    alarms->ahead[i] = PIR_FOR_GOOD;
    alarms->behind[i] = -PIR_FOR_GOOD;
    alarms->margin[i] = PIR_FOR_GOOD;
    for (int k = 0; k < 4; k++)
        alarms->at[k][i] = 0;
}

/* Lists in alarms->woken those of the first `used` certificates that do not hold for certain at `phase`; returns their number. */
uint32_t pir_alarms_collect(pir_alarms *alarms, const pir_kernels *kernels, uint32_t used, double phase);

/* Subtracts `shift` from the phases of the first `used` certificates. */
void pir_alarms_shift(pir_alarms *alarms, uint32_t used, double shift);

/* Files the first `used` certificates anew from what is left of their margins at alarms->now, phases counted from 0. */
void pir_alarms_new_epoch(pir_alarms *alarms, uint32_t used, bool axial);

/* Sets alarms->now. */
void pir_alarms_set_now(pir_alarms *alarms, pir_quat unit);

/* Lets the `count` certificates from `first` on wake at once. */
void pir_alarms_wake(pir_alarms *alarms, uint32_t first, uint32_t count);

#endif
