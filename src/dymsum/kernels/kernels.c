/* SPDX-License-Identifier: MIT */
/* The scalar reference of the kernels, and the choice among versions. */
#include "dymsum/kernels/kernels.h"

#include "dymsum/kernels/kernels_versions.h"
#include "polytope/polytope.h"

/* What is seen of a facet in the cell whose ring fills `blocks` blocks. */
static pir_glance see(const float *ring, uint32_t blocks, const pir_moment *moment, const float turned[8]) {
    float highest = -HUGE_VALF, least = 4, ahead = PIR_FARTHEST, behind = PIR_FARTHEST;
    uint64_t touched = 0, above = 0;
    uint32_t which = 0;
    for (uint32_t i = 0; i < blocks * PIR_LANES; i++) {
        const float *at = ring + (size_t)(i / PIR_LANES) * 3 * PIR_LANES + i % PIR_LANES;
        float x = at[0], y = at[PIR_LANES], z = at[2 * PIR_LANES];
        float s = turned[0] * x + turned[1] * y + turned[2] * z;
        float rate = turned[4] * x + turned[5] * y + turned[6] * z;
        if (s > highest)
            highest = s, which = i;
        // seen as a negative value that rises so fast, how long it takes to come to zero, forwards and backwards
        float size = fabsf(s), rising = signbit(s) ? rate : -rate, sure = size - PIR_FLOAT_SLACK;
        float root = sure > 0 ? sqrtf(rising * rising + (sure + sure)) : 0;
        float to = sure > 0 ? root - rising : 0, since = sure > 0 ? root + rising : 0;
        least = size < least ? size : least;
        ahead = to < ahead ? to : ahead;
        behind = since < behind ? since : behind;
        bool clear = to > moment->reach_ahead && since > moment->reach_behind;
        touched = pir_side_mask_add(touched, i / PIR_LANES, (uint32_t)!clear << i % PIR_LANES);
        above = pir_side_mask_add(above, i / PIR_LANES, (uint32_t)(s > PIR_FLOAT_BOUND) << i % PIR_LANES);
    }
    return (pir_glance){highest + 0.0f, which, {least - PIR_FLOAT_BOUND, ahead, behind, 0, touched, above}};
}

static void glance(const pir_facets *facets, const pir_moment *moment, uint32_t cell, const float turned[8],
                   pir_glance *ret_glance) {
    uint32_t block = facets->ring_block[cell];
    *ret_glance =
        see(facets->ring + (size_t)block * 3 * PIR_LANES, facets->ring_block[cell + 1] - block, moment, turned);
}

static inline void turn_facet(const pir_facets *facets, uint32_t f, float ret_turned[8]) {
    const float *n = facets->normal + (size_t)4 * f;
    for (int i = 0; i < 8; i++)
        ret_turned[i] = facets->turn[0][i] * n[0] + facets->turn[1][i] * n[1] + facets->turn[2][i] * n[2];
}

static inline void look_in(const pir_facets *facets, const pir_moment *moment, uint32_t cell, const float turned[8],
                           pir_look *ret_look) {
    pir_glance seen;
    glance(facets, moment, cell, turned, &seen);
    *ret_look = seen.look;
}

#define REVIEW_TARGET
#include "dymsum/kernels/review_body.h"

/* The time that certificates are compared with, by floats. */
struct instant {
    float ahead, behind;
    bool either;
};

static inline bool holds(float ahead, float behind, struct instant now) {
    bool forwards = ahead > now.ahead, backwards = behind < now.behind;
    return now.either ? forwards || backwards : forwards && backwards;
}

/* The certificates of block b. */
static uint32_t collect_block(pir_alarms *alarms, uint32_t b, struct instant now, uint32_t *woken) {
    uint32_t count = 0;
    float least = HUGE_VALF, greatest = -HUGE_VALF;
    for (uint32_t i = b * PIR_ALARM_BLOCK; i < (b + 1) * PIR_ALARM_BLOCK; i++) {
        float ahead = alarms->ahead[i], behind = alarms->behind[i];
        if (holds(ahead, behind, now)) {
            least = ahead < least ? ahead : least;
            greatest = behind > greatest ? behind : greatest;
        } else {
            woken[count++] = i;
        }
    }
    alarms->block_ahead[b] = least;
    alarms->block_behind[b] = greatest;
    return count;
}

static uint32_t collect(pir_alarms *alarms, uint32_t blocks, pir_alarm_time time) {
    const struct instant now = {pir_float_above(time.ahead), pir_float_below(time.behind), time.either};
    uint32_t count = 0;
    for (uint32_t b = 0; b < blocks; b++)
        if (!holds(alarms->block_ahead[b], alarms->block_behind[b], now))
            count += collect_block(alarms, b, now, alarms->woken + count);
    return count;
}

static const pir_kernels scalar = {"scalar", review, glance, collect};

const pir_kernels *pir_kernels_version(unsigned index) {
    const pir_kernels *versions[4] = {&scalar};
    unsigned count = 1;
#if PIR_HAVE_X86_KERNELS
    if (__builtin_cpu_supports("avx2"))
        versions[count++] = &pir_kernels_avx2;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        versions[count++] = &pir_kernels_avx512;
#elif PIR_HAVE_NEON_KERNELS
    versions[count++] = &pir_kernels_neon;
#endif
    return index < count ? versions[index] : NULL;
}

const pir_kernels *pir_kernels_choose(void) {
    const pir_kernels *best = &scalar;
    for (unsigned i = 1; pir_kernels_version(i); i++)
        best = pir_kernels_version(i);
    return best;
}
