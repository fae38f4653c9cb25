/* SPDX-License-Identifier: MIT */
/* The loops over axes for AVX2. */
#include "pair/axes/axes.h"

#if PIR_HAVE_X86_AXES
#include <immintrin.h>

#define AXES_TARGET        __attribute__((target("avx2")))
#define AXES_WIDTH         4
#define AXES_LESSER(a, b)  ((lane)_mm256_min_pd((__m256d)(a), (__m256d)(b)))
#define AXES_GREATER(a, b) ((lane)_mm256_max_pd((__m256d)(a), (__m256d)(b)))
#define AXES_ROOTS(v)      ((lane)_mm256_sqrt_pd((__m256d)(v)))
#define AXES_NAME          pir_axes_avx2
#define AXES_TEXT          "AVX2"
#include "pair/axes/axes_body.h"
#else
typedef int pir_no_avx2_axes; // a file holds at least a declaration
#endif
