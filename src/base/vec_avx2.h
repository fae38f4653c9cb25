/* SPDX-License-Identifier: MIT */
/* Four vectors of three at once by AVX2: one coordinate of each in a register. Nothing is fused, as in plain code. */
#ifndef PIR_BASE_VEC_AVX2_H
#define PIR_BASE_VEC_AVX2_H

#include <immintrin.h>

#include "base/vec.h"

#define PIR_AVX2 __attribute__((target("avx2")))

typedef struct pir_four {
    __m256d x, y, z;
} pir_four;

/* One vector four times. */
PIR_AVX2 static inline pir_four pir_four_of(pir_vec3 v) {
    return (pir_four){_mm256_set1_pd(v.x), _mm256_set1_pd(v.y), _mm256_set1_pd(v.z)};
}

PIR_AVX2 static inline __m256d pir_four_dot(pir_four a, pir_four b) {
    return _mm256_add_pd(_mm256_add_pd(_mm256_mul_pd(a.x, b.x), _mm256_mul_pd(a.y, b.y)), _mm256_mul_pd(a.z, b.z));
}

#endif
