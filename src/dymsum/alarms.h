/* SPDX-License-Identifier: MIT */
/*
 * When certificates wake: a store of two levels, read in order.
 *
 * Each certificate has two keys, `ahead` and `behind`. In an axial epoch it holds at the phases between them, ahead > phase > behind.
 * In any other it holds while ahead > path, and also while behind < −net: the clock tells what these are. For when an epoch ends it also has
 * the rotation at which it was made and a `margin`, the angle between that and R up to which it holds whatever the way: what a body
 * has turned there and back, or about changing axes, costs it only the net turn. Blocks of 16 carry the least `ahead` and the greatest
 * `behind` of theirs. Finding what wakes reads the blocks' bounds, a few cache lines in all, and then the blocks in question; filing one is
 * two comparisons. Against a timing wheel or a heap this reads more and moves nothing: certificates stay where their pair is, a new
 * epoch is one sweep, and an alarm may be set backwards as well as forwards.
 *
 * Keys are kept as floats, rounded so that certificates wake early; a clock counts them from nearby (clock.h).
 *
 * Invariant: a block's bounds are at most, and at least, those of its certificates.
 */
#ifndef PIR_DYMSUM_ALARMS_H
#define PIR_DYMSUM_ALARMS_H

#include <math.h>

#include "base/memory.h"
#include "dymsum/clock.h"

#define PIR_ALARM_BLOCK 16

typedef struct pir_kernels pir_kernels;

typedef struct pir_alarms {
    float *ahead, *behind; /* per certificate */
    float *margin;
    float *at[4]; /* the unit quaternion it was made at */
    float now[4]; /* that of R */
    float *block_ahead, *block_behind;
    uint32_t *woken;   /* what the last collecting found, rising */
    uint32_t capacity; /* a multiple of eight blocks */
} pir_alarms;

/* Room for `capacity` certificates at least; new ones never wake. What was there stays on failure. */
bool pir_alarms_reserve(pir_alarms *alarms, const pir_allocator *allocator, uint32_t capacity);
void pir_alarms_finish(pir_alarms *alarms, const pir_allocator *allocator);

/* Far beyond any turn, and finite, so that subtracting from it stays a number. */
#define PIR_FOR_GOOD 1e30f

/* A float at most x, by little; or at least x. */
static inline float pir_float_below(double x) {
    return x < (double)PIR_FOR_GOOD ? (float)(x - fabs(x) * 0x1p-23) : PIR_FOR_GOOD;
}

static inline float pir_float_above(double x) {
    return -pir_float_below(-x);
}

/* Files certificate i. */
static inline void pir_alarm_set(pir_alarms *alarms, uint32_t i, float margin, float ahead, float behind) {
    uint32_t block = i / PIR_ALARM_BLOCK;
    float least = alarms->block_ahead[block], greatest = alarms->block_behind[block];
    alarms->ahead[i] = ahead;
    alarms->behind[i] = behind;
    alarms->margin[i] = margin;
    for (int k = 0; k < 4; k++)
        alarms->at[k][i] = alarms->now[k];
    alarms->block_ahead[block] = ahead < least ? ahead : least;
    alarms->block_behind[block] = behind > greatest ? behind : greatest;
}

/* Lets certificate i sleep for good: its pair is gone. */
static inline void pir_alarm_clear(pir_alarms *alarms, uint32_t i) {
    alarms->ahead[i] = PIR_FOR_GOOD;
    alarms->behind[i] = -PIR_FOR_GOOD;
    alarms->margin[i] = PIR_FOR_GOOD;
    for (int k = 0; k < 4; k++)
        alarms->at[k][i] = 0;
}

/* What certificates' keys are compared with. */
typedef struct pir_alarm_time {
    double ahead, behind; /* holds: its `ahead` above, its `behind` below */
    bool either;          /* one of the two is enough */
} pir_alarm_time;

static inline pir_alarm_time pir_alarm_time_of(const pir_clock *clock) {
    return clock->axial ? (pir_alarm_time){clock->phase, clock->phase, false}
                        : (pir_alarm_time){clock->path, -clock->net, true};
}

/* Lists in alarms->woken those of the first `used` certificates that do not hold for certain; returns their number. */
uint32_t pir_alarms_collect(pir_alarms *alarms, const pir_kernels *kernels, uint32_t used, pir_alarm_time time);

/* Subtracts `shift` from the phases of the first `used` certificates. */
void pir_alarms_shift(pir_alarms *alarms, uint32_t used, double shift);

/*
 * Files the first `used` certificates anew for an epoch that begins at alarms->now, from what is left of their margins. Those of an axial
 * epoch with less left than `expected` wake at once.
 */
void pir_alarms_new_epoch(pir_alarms *alarms, uint32_t used, bool axial, double expected);

/* Sets alarms->now. */
void pir_alarms_set_now(pir_alarms *alarms, pir_quat unit);

/* Lets the `count` certificates from `first` on wake at once. */
void pir_alarms_wake(pir_alarms *alarms, uint32_t first, uint32_t count);

#endif
