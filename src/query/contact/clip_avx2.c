/* SPDX-License-Identifier: MIT */
/*
 * Where the corners of two outlines of three or four corners are, by AVX2: one vector holds a coordinate of all. Every
 * operation is that of the plain version, never fused, so the bits are the same.
 */
#include "query/contact/clip_versions.h"

#if PIR_HAVE_X86_CLIP
#include <immintrin.h>

#define AVX2 __attribute__((target("avx2")))

/* The corners, the fourth of three being the first again, and the lines along the sides that begin there. */
struct outline {
    __m256d u, v, along_u, along_v, at, clear;
};

AVX2 static inline __m256d magnitude(__m256d x) {
    return _mm256_andnot_pd(_mm256_set1_pd(-0.0), x);
}

/* The same of the corner after each. */
AVX2 static inline __m256d next(__m256d x, bool has_four) {
    return has_four ? _mm256_permute4x64_pd(x, 0x39) : _mm256_permute4x64_pd(x, 0x49);
}

AVX2 static inline struct outline outline_of(pir_outline outline, double snap) {
    const pir_corner *a = outline.at;
    bool has_four = outline.count == 4;
    __m256d first = _mm256_set_m128d(_mm_loadu_pd(&a[2].u), _mm_loadu_pd(&a[0].u));
    __m256d second = _mm256_set_m128d(_mm_loadu_pd(&a[has_four ? 3 : 0].u), _mm_loadu_pd(&a[1].u));
    struct outline o;
    o.u = _mm256_unpacklo_pd(first, second);
    o.v = _mm256_unpackhi_pd(first, second);
    o.along_u = _mm256_sub_pd(next(o.u, has_four), o.u);
    o.along_v = _mm256_sub_pd(next(o.v, has_four), o.v);
    o.at = _mm256_sub_pd(_mm256_mul_pd(o.along_u, o.v), _mm256_mul_pd(o.along_v, o.u));
    o.clear =
        _mm256_mul_pd(_mm256_set1_pd(PIR_CLIP_CLEAR * snap), _mm256_add_pd(magnitude(o.along_u), magnitude(o.along_v)));
    return o;
}

/* How far points are inside of lines, times the lengths of the sides. */
AVX2 static inline __m256d inside_of(__m256d along_u, __m256d along_v, __m256d at, __m256d u, __m256d v) {
    return _mm256_sub_pd(_mm256_sub_pd(_mm256_mul_pd(along_u, v), _mm256_mul_pd(along_v, u)), at);
}

AVX2 static inline uint32_t below_zero(__m256d x) {
    return (uint32_t)_mm256_movemask_pd(_mm256_cmp_pd(x, _mm256_setzero_pd(), _CMP_LT_OQ));
}

AVX2 bool pir_clip_place_avx2(pir_outline p, pir_outline q, double snap, pir_clip_places *places) {
    if (p.count > 4 || q.count > 4)
        return pir_clip_place_version(0)(p, q, snap, places);
    const struct outline of_q = outline_of(q, snap), of_p = outline_of(p, snap);
    const uint32_t all = (1u << q.count) - 1;
    double line[4][4];
    _mm256_storeu_pd(line[0], of_p.along_u);
    _mm256_storeu_pd(line[1], of_p.along_v);
    _mm256_storeu_pd(line[2], of_p.at);
    _mm256_storeu_pd(line[3], of_p.clear);
    __m256d clear = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
    for (uint32_t i = 0; i < p.count; i++) {
        __m256d corner =
            inside_of(of_q.along_u, of_q.along_v, of_q.at, _mm256_set1_pd(p.at[i].u), _mm256_set1_pd(p.at[i].v));
        __m256d corners = inside_of(_mm256_set1_pd(line[0][i]), _mm256_set1_pd(line[1][i]), _mm256_set1_pd(line[2][i]),
                                    of_q.u, of_q.v);
        clear = _mm256_and_pd(clear, _mm256_cmp_pd(magnitude(corner), of_q.clear, _CMP_GT_OQ));
        clear = _mm256_and_pd(clear, _mm256_cmp_pd(magnitude(corners), _mm256_set1_pd(line[3][i]), _CMP_GT_OQ));
        _mm256_storeu_pd(places->inside[i], corner);
        places->outside[i] = below_zero(corner) & all;
        places->beyond[i] = below_zero(corners) & all;
    }
    return _mm256_movemask_pd(clear) == 15;
}
#else
typedef int pir_no_avx2_clip; // a file holds at least a declaration
#endif
