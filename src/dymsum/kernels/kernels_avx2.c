/* SPDX-License-Identifier: MIT */
/* The kernels for AVX2: a block of eight floats at a time. */
#include "dymsum/kernels/kernels.h"

#include <immintrin.h>

#define TARGET __attribute__((target("avx2")))

/* The lanes in which a and b are equal. */
#define EQUAL(a, b) ((uint32_t)_mm256_movemask_ps(_mm256_cmp_ps((a), (b), _CMP_EQ_OQ)))

/* Lanes of equal integers. */
#define SAME(a, b) ((uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32((a), (b)))))

#define AT_LEAST(a, b) ((uint32_t)_mm256_movemask_ps(_mm256_cmp_ps((a), (b), _CMP_GE_OQ)))

/* Without branches: which lanes are listed is not foreseen. */
TARGET static inline uint32_t list_lanes(uint32_t lanes, __m256i number, uint32_t *ret_number) {
    uint32_t from[PIR_LANES], count = 0;
    _mm256_storeu_si256((__m256i *)(void *)from, number);
    for (uint32_t i = 0; i < PIR_LANES; i++) {
        ret_number[count] = from[i];
        count += lanes >> i & 1;
    }
    return count;
}

#include "dymsum/kernels/kernels_eight_body.h"

TARGET static inline void see_block(const pir_ring *ring, const struct turned *t, const pir_step *step,
                                    struct ring_extremes *seen, uint32_t *ret_touched, uint32_t *ret_above) {
    const __m256 sign = _mm256_set1_ps(-0.0f), zero = _mm256_setzero_ps();
    __m256 x = _mm256_loadu_ps(ring->x), y = _mm256_loadu_ps(ring->y), z = _mm256_loadu_ps(ring->z);
    __m256 s = dot(t->x, t->y, t->z, x, y, z), rate = dot(t->dx, t->dy, t->dz, x, y, z);
    __m256 size = _mm256_andnot_ps(sign, s), rising = _mm256_xor_ps(rate, _mm256_andnot_ps(s, sign));
    __m256 sure = _mm256_sub_ps(size, _mm256_set1_ps(PIR_FLOAT_SLACK)), is_sure = _mm256_cmp_ps(sure, zero, _CMP_GT_OQ);
    __m256 root = _mm256_sqrt_ps(_mm256_add_ps(_mm256_mul_ps(rising, rising), _mm256_add_ps(sure, sure)));
    __m256 to = _mm256_and_ps(is_sure, _mm256_sub_ps(root, rising)),
           since = _mm256_and_ps(is_sure, _mm256_add_ps(root, rising));
    __m256 clear = _mm256_and_ps(_mm256_cmp_ps(to, _mm256_set1_ps(step->reach_ahead), _CMP_GT_OQ),
                                 _mm256_cmp_ps(since, _mm256_set1_ps(step->reach_behind), _CMP_GT_OQ));
    *ret_touched = (uint32_t)_mm256_movemask_ps(clear) ^ 0xFF;
    *ret_above = (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(s, _mm256_set1_ps(PIR_FLOAT_BOUND), _CMP_GT_OQ));
    seen->highest = _mm256_max_ps(seen->highest, s);
    seen->least = _mm256_min_ps(seen->least, size);
    seen->ahead = _mm256_min_ps(seen->ahead, to);
    seen->behind = _mm256_min_ps(seen->behind, since);
}

/* How far R has turned, as certificates' keys are compared with it. */
struct turned_avx2 {
    __m256 ahead, behind;
    bool either;
};

/* Which of eight certificates or blocks hold. */
TARGET static inline __m256 holding(__m256 ahead, __m256 behind, struct turned_avx2 now) {
    __m256 forwards = _mm256_cmp_ps(ahead, now.ahead, _CMP_GT_OQ);
    __m256 backwards = _mm256_cmp_ps(behind, now.behind, _CMP_LT_OQ);
    return now.either ? _mm256_or_ps(forwards, backwards) : _mm256_and_ps(forwards, backwards);
}

/* Collects the certificates of block b. */
TARGET static inline uint32_t collect_block(pir_certificates *certificates, uint32_t b, struct turned_avx2 now,
                                            uint32_t *expired) {
    const __m256 most = _mm256_set1_ps(HUGE_VALF), fewest = _mm256_set1_ps(-HUGE_VALF);
    __m256 least = most, greatest = fewest;
    uint32_t count = 0;
    for (uint32_t i = b * PIR_CERTIFICATE_BLOCK; i < (b + 1) * PIR_CERTIFICATE_BLOCK; i += 8) {
        __m256 ahead = _mm256_loadu_ps(certificates->ahead + i), behind = _mm256_loadu_ps(certificates->behind + i);
        __m256 holds = holding(ahead, behind, now);
        least = _mm256_min_ps(least, _mm256_blendv_ps(most, ahead, holds));
        greatest = _mm256_max_ps(greatest, _mm256_blendv_ps(fewest, behind, holds));
        for (uint32_t expires = (uint32_t)_mm256_movemask_ps(holds) ^ 0xFF; expires; expires &= expires - 1)
            expired[count++] = i + (uint32_t)__builtin_ctz(expires);
    }
    certificates->block_ahead[b] = _mm_cvtss_f32(least_of_each(least, least, least));
    certificates->block_behind[b] = greatest_of(greatest);
    return count;
}

TARGET static inline __attribute__((always_inline)) uint32_t collect_at(pir_certificates *certificates, uint32_t blocks,
                                                                        struct turned_avx2 now) {
    uint32_t count = 0;
    // eight blocks at a time; those past the last in use always hold
    for (uint32_t b = 0; b < blocks; b += 8) {
        __m256 ahead = _mm256_loadu_ps(certificates->block_ahead + b),
               behind = _mm256_loadu_ps(certificates->block_behind + b);
        uint32_t expired_blocks = (uint32_t)_mm256_movemask_ps(holding(ahead, behind, now)) ^ 0xFF;
        for (; expired_blocks; expired_blocks &= expired_blocks - 1)
            count += collect_block(certificates, b + (uint32_t)__builtin_ctz(expired_blocks), now,
                                   certificates->expired + count);
    }
    return count;
}

/* A loop for each of the two kinds of epoch. */
TARGET static uint32_t collect(pir_certificates *certificates, uint32_t blocks, pir_turned_angle time) {
    __m256 ahead = _mm256_set1_ps(pir_float_above(time.ahead)), behind = _mm256_set1_ps(pir_float_below(time.behind));
    return time.either ? collect_at(certificates, blocks, (struct turned_avx2){ahead, behind, true})
                       : collect_at(certificates, blocks, (struct turned_avx2){ahead, behind, false});
}

const pir_kernels pir_kernels_avx2 = {"avx2",        review,  probe,     descend,     find_starts, find_sides,
                                      measure_sides, collect, list_caps, list_points, list_arcs};
