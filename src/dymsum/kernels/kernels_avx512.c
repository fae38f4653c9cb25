/* SPDX-License-Identifier: MIT */
/*
 * The kernels for AVX-512 (F, DQ and VL): a block of eight floats at a time, with masks. Vectors of sixteen are slower:
 * processors lower their clock for them.
 */
#include "dymsum/kernels/kernels.h"

#include <immintrin.h>

#define TARGET __attribute__((target("avx512f,avx512dq,avx512vl")))

/* The lanes in which a and b are equal. */
#define EQUAL(a, b) ((uint32_t)_mm256_cmp_ps_mask((a), (b), _CMP_EQ_OQ))

/* Lanes of equal integers. */
#define SAME(a, b) ((uint32_t)_mm256_cmpeq_epi32_mask((a), (b)))

#define AT_LEAST(a, b) ((uint32_t)_mm256_cmp_ps_mask((a), (b), _CMP_GE_OQ))

/* All eight lanes are written. */
TARGET static inline uint32_t list_lanes(uint32_t lanes, __m256i number, uint32_t *ret_number) {
    _mm256_storeu_si256((__m256i *)(void *)ret_number, _mm256_maskz_compress_epi32((__mmask8)lanes, number));
    return (uint32_t)__builtin_popcount(lanes);
}

#include "dymsum/kernels/kernels_eight_body.h"

TARGET static inline void see_block(const pir_ring *ring, const struct turned *t, const pir_step *step,
                                    struct ring_extremes *seen, uint32_t *ret_touched, uint32_t *ret_above) {
    const __m256 sign = _mm256_set1_ps(-0.0f), zero = _mm256_setzero_ps();
    __m256 x = _mm256_loadu_ps(ring->x), y = _mm256_loadu_ps(ring->y), z = _mm256_loadu_ps(ring->z);
    __m256 s = dot(t->x, t->y, t->z, x, y, z), rate = dot(t->dx, t->dy, t->dz, x, y, z);
    __m256 size = _mm256_andnot_ps(sign, s), rising = _mm256_xor_ps(rate, _mm256_andnot_ps(s, sign));
    __m256 sure = _mm256_sub_ps(size, _mm256_set1_ps(PIR_FLOAT_SLACK));
    __mmask8 is_sure = _mm256_cmp_ps_mask(sure, zero, _CMP_GT_OQ);
    __m256 root = _mm256_sqrt_ps(_mm256_add_ps(_mm256_mul_ps(rising, rising), _mm256_add_ps(sure, sure)));
    __m256 to = _mm256_maskz_sub_ps(is_sure, root, rising), since = _mm256_maskz_add_ps(is_sure, root, rising);
    __mmask8 clear = _mm256_mask_cmp_ps_mask(_mm256_cmp_ps_mask(to, _mm256_set1_ps(step->reach_ahead), _CMP_GT_OQ),
                                             since, _mm256_set1_ps(step->reach_behind), _CMP_GT_OQ);
    *ret_touched = (uint8_t)~clear;
    *ret_above = _mm256_cmp_ps_mask(s, _mm256_set1_ps(PIR_FLOAT_BOUND), _CMP_GT_OQ);
    seen->highest = _mm256_max_ps(seen->highest, s);
    seen->least = _mm256_min_ps(seen->least, size);
    seen->ahead = _mm256_min_ps(seen->ahead, to);
    seen->behind = _mm256_min_ps(seen->behind, since);
}

/* How far R has turned, as certificates' keys are compared with it. */
struct turned_avx512 {
    __m256 ahead, behind;
    bool either;
};

/* Which of eight certificates or blocks hold. */
TARGET static inline __mmask8 holding(__m256 ahead, __m256 behind, struct turned_avx512 now) {
    __mmask8 forwards = _mm256_cmp_ps_mask(ahead, now.ahead, _CMP_GT_OQ);
    if (now.either)
        return forwards | _mm256_cmp_ps_mask(behind, now.behind, _CMP_LT_OQ);
    return _mm256_mask_cmp_ps_mask(forwards, behind, now.behind, _CMP_LT_OQ);
}

/* Collects the certificates of block b. */
TARGET static inline uint32_t collect_block(pir_certificates *certificates, uint32_t b, struct turned_avx512 now,
                                            uint32_t *expired) {
    const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    __m256 least = _mm256_set1_ps(HUGE_VALF), greatest = _mm256_set1_ps(-HUGE_VALF);
    uint32_t count = 0;
    for (uint32_t i = b * PIR_CERTIFICATE_BLOCK; i < (b + 1) * PIR_CERTIFICATE_BLOCK; i += 8) {
        __m256 ahead = _mm256_loadu_ps(certificates->ahead + i), behind = _mm256_loadu_ps(certificates->behind + i);
        __mmask8 holds = holding(ahead, behind, now);
        least = _mm256_mask_min_ps(least, holds, least, ahead);
        greatest = _mm256_mask_max_ps(greatest, holds, greatest, behind);
        // all eight lanes are written: there is room, for no more are listed than compared
        __m256i number = _mm256_add_epi32(lanes, _mm256_set1_epi32((int)i));
        _mm256_storeu_si256((__m256i *)(void *)(expired + count),
                            _mm256_maskz_compress_epi32((__mmask8)~holds, number));
        count += (uint32_t)__builtin_popcount((uint8_t)~holds);
    }
    __m256 minus = _mm256_xor_ps(greatest, _mm256_set1_ps(-0.0f));
    float bounds[4];
    _mm_storeu_ps(bounds, least_of_each(least, minus, minus));
    certificates->block_ahead[b] = bounds[0];
    certificates->block_behind[b] = -bounds[1];
    return count;
}

TARGET static inline __attribute__((always_inline)) uint32_t collect_at(pir_certificates *certificates, uint32_t blocks,
                                                                        struct turned_avx512 now) {
    uint32_t count = 0;
    // eight blocks at a time; those past the last in use always hold
    for (uint32_t b = 0; b < blocks; b += 8) {
        __m256 ahead = _mm256_loadu_ps(certificates->block_ahead + b),
               behind = _mm256_loadu_ps(certificates->block_behind + b);
        for (uint32_t expired_blocks = (uint8_t)~holding(ahead, behind, now); expired_blocks;
             expired_blocks &= expired_blocks - 1)
            count += collect_block(certificates, b + (uint32_t)__builtin_ctz(expired_blocks), now,
                                   certificates->expired + count);
    }
    return count;
}

/* A loop for each of the two kinds of epoch. */
TARGET static uint32_t collect(pir_certificates *certificates, uint32_t blocks, pir_turned_angle time) {
    __m256 ahead = _mm256_set1_ps(pir_float_above(time.ahead)), behind = _mm256_set1_ps(pir_float_below(time.behind));
    return time.either ? collect_at(certificates, blocks, (struct turned_avx512){ahead, behind, true})
                       : collect_at(certificates, blocks, (struct turned_avx512){ahead, behind, false});
}

const pir_kernels pir_kernels_avx512 = {"avx512",      review,  probe,     descend,     find_starts, find_sides,
                                        measure_sides, collect, list_caps, list_points, list_arcs};
