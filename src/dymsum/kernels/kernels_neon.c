/* SPDX-License-Identifier: MIT */
/* The kernels for NEON (AArch64): four floats at a time. */
#include "dymsum/kernels/kernels.h"

#include <arm_neon.h>

#include "polytope/polytope.h"

/* (u.x·x + u.y·y) + u.z·z, rounded as the scalar reference rounds: no fused operation. */
static inline float32x4_t dot(float32x4_t u, float32x4_t x, float32x4_t y, float32x4_t z) {
    float32x4_t xy = vaddq_f32(vmulq_laneq_f32(x, u, 0), vmulq_laneq_f32(y, u, 1));
    return vaddq_f32(xy, vmulq_laneq_f32(z, u, 2));
}

static inline float32x4_t masked(uint32x4_t mask, float32x4_t v) {
    return vreinterpretq_f32_u32(vandq_u32(mask, vreinterpretq_u32_f32(v)));
}

/* Checks a facet in a cell; returns the greatest value of s. */
static inline float check(const pir_ring *ring, uint32_t blocks, const pir_step *step, const float turned[8],
                          pir_check *ret_check) {
    const uint32_t bits[4] = {1, 2, 4, 8};
    const uint32x4_t bit = vld1q_u32(bits), sign = vdupq_n_u32(0x80000000);
    const float32x4_t zero = vdupq_n_f32(0), bound = vdupq_n_f32(PIR_FLOAT_BOUND);
    const float32x4_t u = vld1q_f32(turned), w = vld1q_f32(turned + 4);
    float32x4_t high = vdupq_n_f32(-HUGE_VALF), least = vdupq_n_f32(4), ahead = vdupq_n_f32(PIR_FARTHEST_PREDICTION),
                behind = ahead;
    uint64_t touched = 0, above = 0;
    for (uint32_t i = 0; i < blocks * PIR_LANES; i += 4) {
        const pir_ring *at = ring + i / PIR_LANES;
        float32x4_t x = vld1q_f32(at->x + i % PIR_LANES), y = vld1q_f32(at->y + i % PIR_LANES),
                    z = vld1q_f32(at->z + i % PIR_LANES);
        float32x4_t s = dot(u, x, y, z), rate = dot(w, x, y, z);
        high = vmaxq_f32(high, s);
        // taken as a negative value that rises at `rising`
        float32x4_t size = vabsq_f32(s);
        uint32x4_t flip = vbicq_u32(sign, vreinterpretq_u32_f32(s));
        float32x4_t rising = vreinterpretq_f32_u32(veorq_u32(vreinterpretq_u32_f32(rate), flip));
        float32x4_t sure = vsubq_f32(size, vdupq_n_f32(PIR_FLOAT_SLACK));
        uint32x4_t is_sure = vcgtq_f32(sure, zero);
        float32x4_t root = vsqrtq_f32(vaddq_f32(vmulq_f32(rising, rising), vaddq_f32(sure, sure)));
        float32x4_t to = masked(is_sure, vsubq_f32(root, rising)), since = masked(is_sure, vaddq_f32(root, rising));
        least = vminq_f32(least, size);
        ahead = vminq_f32(ahead, to);
        behind = vminq_f32(behind, since);
        uint32x4_t clear =
            vandq_u32(vcgtq_f32(to, vdupq_n_f32(step->reach_ahead)), vcgtq_f32(since, vdupq_n_f32(step->reach_behind)));
        touched = pir_side_mask_add(touched, i / PIR_LANES, vaddvq_u32(vbicq_u32(bit, clear)) << i % PIR_LANES);
        above =
            pir_side_mask_add(above, i / PIR_LANES, vaddvq_u32(vandq_u32(bit, vcgtq_f32(s, bound))) << i % PIR_LANES);
    }
    *ret_check =
        (pir_check){vminvq_f32(least) - PIR_FLOAT_BOUND, vminvq_f32(ahead), vminvq_f32(behind), 0, touched, above};
    return vmaxvq_f32(high);
}

static void probe(const pir_facets *facets, const pir_step *step, uint32_t cell, const float turned[8],
                  pir_cell_probe *ret_probe) {
    uint32_t blocks;
    const pir_ring *ring = pir_rings_of(facets, cell, &blocks);
    const float highest = check(ring, blocks, step, turned, &ret_probe->check);
    ret_probe->highest = highest + 0.0f;
    ret_probe->which = 0;
    for (uint32_t i = 0; i < blocks * PIR_LANES; i += 4) {
        const pir_ring *at = ring + i / PIR_LANES;
        float s[4];
        vst1q_f32(s, dot(vld1q_f32(turned), vld1q_f32(at->x + i % PIR_LANES), vld1q_f32(at->y + i % PIR_LANES),
                         vld1q_f32(at->z + i % PIR_LANES)));
        for (uint32_t k = 0; k < 4; k++)
            if (s[k] == highest) {
                ret_probe->which = i + k;
                return;
            }
    }
}

static inline void turn_facet(const pir_facets *facets, uint32_t f, float ret_turned[8]) {
    const float(*t)[8] = facets->turn;
    float32x4_t n = vld1q_f32(facets->normal + (size_t)4 * f);
    vst1q_f32(ret_turned, dot(n, vld1q_f32(t[0]), vld1q_f32(t[1]), vld1q_f32(t[2])));
    vst1q_f32(ret_turned + 4, dot(n, vld1q_f32(t[0] + 4), vld1q_f32(t[1] + 4), vld1q_f32(t[2] + 4)));
}

static inline void check_in(const pir_ring *ring, uint32_t blocks, const pir_step *step, const float turned[8],
                            pir_check *ret_check) {
    check(ring, blocks, step, turned, ret_check);
}

static inline float32x4_t values(const pir_ring *ring, uint32_t i, const float turned[8]) {
    const pir_ring *at = ring + i / PIR_LANES;
    return dot(vld1q_f32(turned), vld1q_f32(at->x + i % PIR_LANES), vld1q_f32(at->y + i % PIR_LANES),
               vld1q_f32(at->z + i % PIR_LANES));
}

static inline float steepest(const pir_ring *ring, uint32_t blocks, const float turned[8], uint32_t *ret_which) {
    float highest = -HUGE_VALF;
    for (uint32_t i = 0; i < blocks * PIR_LANES; i += 4) {
        float32x4_t here = values(ring, i, turned);
        float most = vmaxvq_f32(here), lane[4];
        if (!(most > highest))
            continue;
        highest = most;
        vst1q_f32(lane, here);
        for (uint32_t k = 4; k-- > 0;)
            *ret_which = lane[k] == most ? i + k : *ret_which;
    }
    return highest;
}

#define DESCEND_TARGET
#include "dymsum/kernels/descend_body.h"
#define REVIEW_TARGET
#include "dymsum/kernels/review_body.h"

/* How far R has turned, as certificates' keys are compared with it; either: all bits or none. */
struct turned_neon {
    float32x4_t ahead, behind;
    uint32x4_t either;
};

/* Which of four certificates or blocks hold. */
static inline uint32x4_t holding(float32x4_t ahead, float32x4_t behind, struct turned_neon now) {
    uint32x4_t forwards = vcgtq_f32(ahead, now.ahead), backwards = vcltq_f32(behind, now.behind);
    return vorrq_u32(vandq_u32(forwards, backwards), vandq_u32(vorrq_u32(forwards, backwards), now.either));
}

/* Collects the certificates of block b. */
static inline uint32_t collect_block(pir_certificates *certificates, uint32_t b, struct turned_neon now,
                                     uint32_t *expired) {
    const float32x4_t most = vdupq_n_f32(HUGE_VALF), fewest = vdupq_n_f32(-HUGE_VALF);
    float32x4_t least = most, greatest = fewest;
    uint32_t count = 0;
    for (uint32_t i = b * PIR_CERTIFICATE_BLOCK; i < (b + 1) * PIR_CERTIFICATE_BLOCK; i += 4) {
        float32x4_t ahead = vld1q_f32(certificates->ahead + i), behind = vld1q_f32(certificates->behind + i);
        uint32x4_t holds = holding(ahead, behind, now);
        least = vminq_f32(least, vbslq_f32(holds, ahead, most));
        greatest = vmaxq_f32(greatest, vbslq_f32(holds, behind, fewest));
        uint32_t held[4];
        vst1q_u32(held, holds);
        for (uint32_t k = 0; k < 4; k++) {
            expired[count] = i + k;
            count += !held[k];
        }
    }
    certificates->block_ahead[b] = vminvq_f32(least);
    certificates->block_behind[b] = vmaxvq_f32(greatest);
    return count;
}

static uint32_t collect(pir_certificates *certificates, uint32_t blocks, pir_turned_angle time) {
    const struct turned_neon now = {vdupq_n_f32(pir_float_above(time.ahead)), vdupq_n_f32(pir_float_below(time.behind)),
                                    vdupq_n_u32(time.either ? UINT32_MAX : 0)};
    uint32_t count = 0;
    // four blocks at a time; those past the last in use always hold
    for (uint32_t b = 0; b < blocks; b += 4) {
        float32x4_t ahead = vld1q_f32(certificates->block_ahead + b),
                    behind = vld1q_f32(certificates->block_behind + b);
        uint32_t held[4];
        vst1q_u32(held, holding(ahead, behind, now));
        for (uint32_t k = 0; k < 4; k++)
            if (!held[k])
                count += collect_block(certificates, b + k, now, certificates->expired + count);
    }
    return count;
}

const pir_kernels pir_kernels_neon = {
    "neon",  review,        probe,           descend,      pir_find_starts, pir_arcs_find_sides, pir_arcs_measure_sides,
    collect, pir_list_caps, pir_list_points, pir_list_arcs};
