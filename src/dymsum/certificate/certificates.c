/* SPDX-License-Identifier: MIT */
/* The store of alarms. Its design and its invariant stand in alarms.h. */
#include "dymsum/certificate/certificates.h"

#include "dymsum/kernels/kernels.h"

bool pir_alarms_init(pir_alarms *alarms, const pir_allocator *allocator, uint32_t count) {
    uint32_t blocks = (count + 8 * PIR_ALARM_BLOCK - 1) / (8 * PIR_ALARM_BLOCK) * 8;
    uint32_t capacity = blocks * PIR_ALARM_BLOCK;
    *alarms = (pir_alarms){.margin = PIR_NEW(allocator, float, capacity),
                           .at = PIR_NEW(allocator, pir_float4, capacity),
                           .ahead = PIR_NEW(allocator, float, capacity),
                           .behind = PIR_NEW(allocator, float, capacity),
                           .block_ahead = PIR_NEW(allocator, float, blocks),
                           .block_behind = PIR_NEW(allocator, float, blocks),
                           .back = PIR_NEW(allocator, pir_way_back, capacity),
                           .woken = PIR_NEW(allocator, uint32_t, capacity),
                           .capacity = capacity};
    bool all = alarms->margin && alarms->at && alarms->ahead && alarms->behind && alarms->block_ahead &&
               alarms->block_behind && alarms->back && alarms->woken;
    if (!all) {
        pir_alarms_finish(alarms, allocator);
        return false;
    }
    for (uint32_t i = 0; i < capacity; i++)
        pir_alarm_clear(alarms, i);
    for (uint32_t b = 0; b < blocks; b++) {
        alarms->block_ahead[b] = PIR_FOR_GOOD;
        alarms->block_behind[b] = -PIR_FOR_GOOD;
    }
    return true;
}

void pir_alarms_finish(pir_alarms *alarms, const pir_allocator *allocator) {
    uint32_t blocks = alarms->capacity / PIR_ALARM_BLOCK;
    PIR_FREE(allocator, alarms->margin, alarms->capacity);
    PIR_FREE(allocator, alarms->at, alarms->capacity);
    PIR_FREE(allocator, alarms->ahead, alarms->capacity);
    PIR_FREE(allocator, alarms->behind, alarms->capacity);
    PIR_FREE(allocator, alarms->block_ahead, blocks);
    PIR_FREE(allocator, alarms->block_behind, blocks);
    PIR_FREE(allocator, alarms->back, alarms->capacity);
    PIR_FREE(allocator, alarms->woken, alarms->capacity);
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

/* From here on keys mean other phases: what is kept is of no use. */
static void begin_stretch(pir_alarms *alarms) {
    if (++alarms->stretch != PIR_NO_STRETCH)
        return;
    // numbers have run out: begin again
    for (uint32_t i = 0; i < alarms->capacity; i++)
        pir_alarm_forget(alarms, i);
    alarms->stretch = 0;
}

void pir_alarms_shift(pir_alarms *alarms, uint32_t used, double shift) {
    begin_stretch(alarms);
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
    const float *now = alarms->now.c;
    float apart = 0, across = 0;
    for (int k = 0; k < 4; k++) {
        float minus = alarms->at[i].c[k] - now[k], plus = alarms->at[i].c[k] + now[k];
        apart += minus * minus;
        across += plus * plus;
    }
    float y = 0.5f * sqrtf(apart < across ? apart : across);
    return alarms->margin[i] - 4 * (y + 0.2215f * (y * y * y)) * NET_RELATIVE - NET_ERROR;
}

void pir_alarms_new_epoch(pir_alarms *alarms, uint32_t used, bool axial, double expected) {
    const float slack = axial ? (float)PIR_DRIFT_SLACK : 0, enough = axial ? (float)expected : -HUGE_VALF;
    begin_stretch(alarms);
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
        alarms->now.c[k] = (float)q[k];
}

void pir_alarms_wake(pir_alarms *alarms, uint32_t first, uint32_t count) {
    for (uint32_t i = first; i < first + count; i++) {
        pir_alarm_set(alarms, i, -1, -PIR_FOR_GOOD, PIR_FOR_GOOD);
        pir_alarm_forget(alarms, i);
    }
}
