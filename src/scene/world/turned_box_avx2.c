/* SPDX-License-Identifier: MIT */
/*
 * The box of turned points for AVX2, three coordinates at a time. Every operation is that of the plain loop in
 * turned_box.c, in its order and never fused, so the bits are the same.
 */
#include "scene/world/turned_box.h"

#if PIR_HAVE_X86_TURNED_BOX
#include <immintrin.h>
#include <math.h>

#define AVX2 __attribute__((target("avx2")))

/* The first three lanes. */
AVX2 static inline pir_vec3 three(__m256d v) {
    double lane[4];
    _mm256_storeu_pd(lane, v);
    return (pir_vec3){lane[0], lane[1], lane[2]};
}

AVX2 void pir_turned_box_avx2(const pir_mat3 *r, const pir_vec3 *point, uint32_t count, pir_vec3 *ret_low,
                              pir_vec3 *ret_high) {
    const __m256d x = _mm256_set_pd(0, r->m[2][0], r->m[1][0], r->m[0][0]);
    const __m256d y = _mm256_set_pd(0, r->m[2][1], r->m[1][1], r->m[0][1]);
    const __m256d z = _mm256_set_pd(0, r->m[2][2], r->m[1][2], r->m[0][2]);
    __m256d low = _mm256_set1_pd(HUGE_VAL), high = _mm256_set1_pd(-HUGE_VAL);
    for (uint32_t i = 0; i < count; i++) {
        __m256d at =
            _mm256_add_pd(_mm256_mul_pd(x, _mm256_set1_pd(point[i].x)), _mm256_mul_pd(y, _mm256_set1_pd(point[i].y)));
        at = _mm256_add_pd(at, _mm256_mul_pd(z, _mm256_set1_pd(point[i].z)));
        low = _mm256_min_pd(at, low);
        high = _mm256_max_pd(at, high);
    }
    *ret_low = three(low);
    *ret_high = three(high);
}
#endif
