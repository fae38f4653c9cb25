/* SPDX-License-Identifier: MIT */
/* The store of alarms. Its design and its invariant stand in alarms.h. */
#include "dymsum/alarms.h"

#include "dymsum/kernels.h"

static void free_alarms(const pir_alarms *alarms, const pir_allocator *allocator) {
    uint32_t blocks = alarms->capacity / PIR_ALARM_BLOCK;
    PIR_FREE(allocator, alarms->margin, alarms->capacity);
    for (int k = 0; k < 4; k++)
        PIR_FREE(allocator, alarms->at[k], alarms->capacity);
    PIR_FREE(allocator, alarms->ahead, alarms->capacity);
    PIR_FREE(allocator, alarms->behind, alarms->capacity);
    PIR_FREE(allocator, alarms->block_ahead, blocks);
    PIR_FREE(allocator, alarms->block_behind, blocks);
    PIR_FREE(allocator, alarms->woken, alarms->capacity);
}

bool pir_alarms_reserve(pir_alarms *alarms, const pir_allocator *allocator, uint32_t capacity) {
    uint32_t old = alarms->capacity, blocks = (capacity + 8 * PIR_ALARM_BLOCK - 1) / (8 * PIR_ALARM_BLOCK) * 8;
    capacity = blocks * PIR_ALARM_BLOCK;
    if (capacity <= old)
        return true;
    pir_alarms grown = {.margin = PIR_NEW(allocator, float, capacity),
                        .ahead = PIR_NEW(allocator, float, capacity),
                        .behind = PIR_NEW(allocator, float, capacity),
                        .block_ahead = PIR_NEW(allocator, float, blocks),
                        .block_behind = PIR_NEW(allocator, float, blocks),
                        .woken = PIR_NEW(allocator, uint32_t, capacity),
                        .capacity = capacity};
    bool all = grown.margin && grown.ahead && grown.behind && grown.block_ahead && grown.block_behind && grown.woken;
    for (int k = 0; k < 4; k++) {
        grown.at[k] = PIR_NEW(allocator, float, capacity);
        grown.now[k] = alarms->now[k];
        all = all && grown.at[k];
    }
    if (!all) {
        free_alarms(&grown, allocator);
        return false;
    }
    // what was there, then alarms that never ring; `woken` may be in use: a repair may need room while it is read
    for (uint32_t i = 0; i < capacity; i++) {
        if (i >= old) {
            pir_alarm_clear(&grown, i);
            continue;
        }
        grown.margin[i] = alarms->margin[i];
        for (int k = 0; k < 4; k++)
            grown.at[k][i] = alarms->at[k][i];
        grown.ahead[i] = alarms->ahead[i];
        grown.behind[i] = alarms->behind[i];
        grown.woken[i] = alarms->woken[i];
    }
    for (uint32_t b = 0; b < blocks; b++) {
        grown.block_ahead[b] = b < old / PIR_ALARM_BLOCK ? alarms->block_ahead[b] : PIR_FOR_GOOD;
        grown.block_behind[b] = b < old / PIR_ALARM_BLOCK ? alarms->block_behind[b] : -PIR_FOR_GOOD;
    }
    free_alarms(alarms, allocator);
    *alarms = grown;
    return true;
}

void pir_alarms_finish(pir_alarms *alarms, const pir_allocator *allocator) {
    free_alarms(alarms, allocator);
    *alarms = (pir_alarms){0};
}

/* Makes the bounds of block b anew from its certificates. */
static void bound_block(pir_alarms *alarms, uint32_t b) {
    float ahead = HUGE_VALF, behind = -HUGE_VALF;
    for (uint32_t i = b * PIR_ALARM_BLOCK; i < (b + 1) * PIR_ALARM_BLOCK; i++) {
        ahead = alarms->ahead[i] < ahead ? alarms->ahead[i] : ahead;
        behind = alarms->behind[i] > behind ? alarms->behind[i] : behind;
    }
    alarms->block_ahead[b] = ahead;
    alarms->block_behind[b] = behind;
}

uint32_t pir_alarms_collect(pir_alarms *alarms, const pir_kernels *kernels, uint32_t used, pir_alarm_time time) {
    return kernels->collect(alarms, (used + PIR_ALARM_BLOCK - 1) / PIR_ALARM_BLOCK, time);
}

void pir_alarms_shift(pir_alarms *alarms, uint32_t used, double shift) {
    for (uint32_t i = 0; i < used; i++) {
        alarms->ahead[i] = pir_float_below((double)alarms->ahead[i] - shift);
        alarms->behind[i] = pir_float_above((double)alarms->behind[i] - shift);
    }
    for (uint32_t b = 0; b * PIR_ALARM_BLOCK < used; b++)
        bound_block(alarms, b);
}

/*
 * Unit quaternions at distance 2y (up to sign) turn by at most 4 (y + 0.2215 y³): see pir_rotation_angle_bound. Two of them in floats are
 * off by less than 2^-23 together, 2^-22 of angle for small ones and in proportion for large; what floats round of the rest is less.
 */
#define NET_ERROR    0x1p-20f
#define NET_RELATIVE (1 + 0x1p-19f)

/* What is left of certificate i's margin, at most, never mind the epoch. */
static inline float left_of(const pir_alarms *alarms, uint32_t i) {
    const float *now = alarms->now;
    float apart = 0, across = 0;
    for (int k = 0; k < 4; k++) {
        float minus = alarms->at[k][i] - now[k], plus = alarms->at[k][i] + now[k];
        apart += minus * minus;
        across += plus * plus;
    }
    float y = 0.5f * sqrtf(apart < across ? apart : across);
    return alarms->margin[i] - 4 * (y + 0.2215f * (y * y * y)) * NET_RELATIVE - NET_ERROR;
}

void pir_alarms_new_epoch(pir_alarms *alarms, uint32_t used, bool axial, double expected) {
    const float slack = axial ? (float)PIR_DRIFT_SLACK : 0, enough = axial ? (float)expected : -HUGE_VALF;
    for (uint32_t b = 0; b * PIR_ALARM_BLOCK < used; b++) {
        float left[PIR_ALARM_BLOCK];
        for (uint32_t i = 0; i < PIR_ALARM_BLOCK; i++)
            left[i] = left_of(alarms, b * PIR_ALARM_BLOCK + i) - slack;
        float least = HUGE_VALF;
        for (uint32_t i = 0; i < PIR_ALARM_BLOCK; i++) {
            float ahead = left[i] >= enough ? left[i] : -PIR_FOR_GOOD;
            alarms->ahead[b * PIR_ALARM_BLOCK + i] = ahead;
            alarms->behind[b * PIR_ALARM_BLOCK + i] = -ahead;
            least = ahead < least ? ahead : least;
        }
        alarms->block_ahead[b] = least;
        alarms->block_behind[b] = -least;
    }
}

void pir_alarms_set_now(pir_alarms *alarms, pir_quat unit) {
    const double q[4] = {unit.x, unit.y, unit.z, unit.w};
    for (int k = 0; k < 4; k++)
        alarms->now[k] = (float)q[k];
}

void pir_alarms_wake(pir_alarms *alarms, uint32_t first, uint32_t count) {
    for (uint32_t i = first; i < first + count; i++)
        pir_alarm_set(alarms, i, -1, -PIR_FOR_GOOD, PIR_FOR_GOOD);
}
