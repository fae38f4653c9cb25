/* SPDX-License-Identifier: MIT */
/*
 * A surface's loops for AVX2, four coordinates or four triangles at a time. Every operation is that of the plain loops
 * in inner_surface.c, in their order and never fused, so the bits are the same.
 */
#include "pair/surface/inner_surface.h"

#if PIR_HAVE_X86_SURFACE
#include <immintrin.h>

#define AVX2 __attribute__((target("avx2")))

/* A vector of three, the fourth lane being 0. */
AVX2 static inline __m256d load3(const pir_vec3 *v) {
    return _mm256_maskload_pd(&v->x, _mm256_set_epi64x(0, -1, -1, -1));
}

AVX2 static void corners(const pir_surface *surface, const pir_frame *frame, pir_surface_room *room) {
    const pir_mat3 *r = &frame->r;
    const __m256d x = _mm256_set_pd(0, r->m[2][0], r->m[1][0], r->m[0][0]),
                  y = _mm256_set_pd(0, r->m[2][1], r->m[1][1], r->m[0][1]),
                  z = _mm256_set_pd(0, r->m[2][2], r->m[1][2], r->m[0][2]), centre = load3(&room->centre);
    for (uint32_t rest = surface->used; rest; rest &= rest - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rest);
        const pir_vec3 *a = &frame->p.vertex[surface->a[i]];
        __m256d w = _mm256_add_pd(_mm256_mul_pd(x, _mm256_set1_pd(a->x)), _mm256_mul_pd(y, _mm256_set1_pd(a->y)));
        w = _mm256_add_pd(w, _mm256_mul_pd(z, _mm256_set1_pd(a->z)));
        w = _mm256_sub_pd(_mm256_add_pd(w, load3(&frame->q.vertex[surface->b[i]])), centre);
        _mm256_storeu_pd(room->at[i], w);
    }
}

/* One component of a vector for each of four triangles. */
struct lanes {
    __m256d x, y, z;
};

/* One corner of each of four triangles. */
AVX2 static inline struct lanes corner_of(const pir_surface_room *room, const uint8_t *corner) {
    __m256d a = _mm256_loadu_pd(room->at[corner[0]]), b = _mm256_loadu_pd(room->at[corner[1]]);
    __m256d c = _mm256_loadu_pd(room->at[corner[2]]), d = _mm256_loadu_pd(room->at[corner[3]]);
    __m256d xz_ab = _mm256_unpacklo_pd(a, b), y_ab = _mm256_unpackhi_pd(a, b);
    __m256d xz_cd = _mm256_unpacklo_pd(c, d), y_cd = _mm256_unpackhi_pd(c, d);
    return (struct lanes){_mm256_permute2f128_pd(xz_ab, xz_cd, 0x20), _mm256_permute2f128_pd(y_ab, y_cd, 0x20),
                          _mm256_permute2f128_pd(xz_ab, xz_cd, 0x31)};
}

AVX2 static inline struct lanes less(struct lanes a, struct lanes b) {
    return (struct lanes){_mm256_sub_pd(a.x, b.x), _mm256_sub_pd(a.y, b.y), _mm256_sub_pd(a.z, b.z)};
}

AVX2 static inline __m256d dot(struct lanes a, struct lanes b) {
    __m256d xy = _mm256_add_pd(_mm256_mul_pd(a.x, b.x), _mm256_mul_pd(a.y, b.y));
    return _mm256_add_pd(xy, _mm256_mul_pd(a.z, b.z));
}

/* a·b − c·d. */
AVX2 static inline __m256d minor(__m256d a, __m256d b, __m256d c, __m256d d) {
    return _mm256_sub_pd(_mm256_mul_pd(a, b), _mm256_mul_pd(c, d));
}

AVX2 static uint64_t planes(const pir_surface_room *room, const uint8_t *corner, uint32_t count,
                            pir_surface_planes *ret_planes) {
    const __m256d det_error = _mm256_set1_pd(room->det_error), normal_error = _mm256_set1_pd(room->normal_error);
    uint64_t above = 0;
    for (uint32_t t = 0; t < count; t += 4) {
        struct lanes a = corner_of(room, &corner[t]);
        struct lanes e = less(corner_of(room, &corner[PIR_SURFACE_TRIANGLES + t]), a);
        struct lanes f = less(corner_of(room, &corner[2 * PIR_SURFACE_TRIANGLES + t]), a);
        struct lanes n = {minor(e.y, f.z, e.z, f.y), minor(e.z, f.x, e.x, f.z), minor(e.x, f.y, e.y, f.x)};
        __m256d det = dot(n, a), length = _mm256_sqrt_pd(dot(n, n));
        __m256d low = _mm256_div_pd(_mm256_sub_pd(det, det_error), _mm256_add_pd(length, normal_error));
        _mm256_storeu_pd(&ret_planes->nx[t], n.x);
        _mm256_storeu_pd(&ret_planes->ny[t], n.y);
        _mm256_storeu_pd(&ret_planes->nz[t], n.z);
        _mm256_storeu_pd(&ret_planes->det[t], det);
        _mm256_storeu_pd(&ret_planes->low[t], low);
        above |= (uint64_t)_mm256_movemask_pd(_mm256_cmp_pd(low, _mm256_setzero_pd(), _CMP_GT_OQ)) << t;
    }
    // past the count there are corners of triangles that are gone
    return ~above & pir_surface_first(count);
}

AVX2 static uint64_t below(const pir_surface *surface, const pir_surface_room *room, double limit) {
    const __m256d most = _mm256_set1_pd(limit);
    uint64_t found = 0;
    for (uint32_t t = 0; t < surface->count; t += 4)
        found |= (uint64_t)_mm256_movemask_pd(_mm256_cmp_pd(_mm256_loadu_pd(&room->plane.low[t]), most, _CMP_LE_OQ))
                 << t;
    return found & pir_surface_first(surface->count);
}

AVX2 static double least(const pir_surface *surface, const pir_surface_room *room, uint64_t triangles) {
    const __m256i bit = _mm256_set_epi64x(8, 4, 2, 1);
    const __m256d none = _mm256_set1_pd(HUGE_VAL);
    __m256d low = none;
    triangles &= pir_surface_first(surface->count);
    for (uint32_t t = 0; t < surface->count; t += 4) {
        __m256i some = _mm256_and_si256(_mm256_set1_epi64x((long long)(triangles >> t)), bit);
        __m256d is = _mm256_castsi256_pd(_mm256_cmpeq_epi64(some, bit));
        low = _mm256_min_pd(_mm256_blendv_pd(none, _mm256_loadu_pd(&room->plane.low[t]), is), low);
    }
    __m128d of = _mm_min_pd(_mm256_castpd256_pd128(low), _mm256_extractf128_pd(low, 1));
    return _mm_cvtsd_f64(_mm_min_sd(of, _mm_unpackhi_pd(of, of)));
}

AVX2 static uint64_t seen(const pir_surface *surface, const pir_surface_room *room, pir_vec3 w) {
    const __m256d x = _mm256_set1_pd(w.x), y = _mm256_set1_pd(w.y), z = _mm256_set1_pd(w.z);
    const pir_surface_planes *plane = &room->plane;
    uint64_t found = 0;
    for (uint32_t t = 0; t < surface->count; t += 4) {
        struct lanes n = {_mm256_loadu_pd(&plane->nx[t]), _mm256_loadu_pd(&plane->ny[t]),
                          _mm256_loadu_pd(&plane->nz[t])};
        __m256d beyond = _mm256_cmp_pd(dot(n, (struct lanes){x, y, z}), _mm256_loadu_pd(&plane->det[t]), _CMP_GT_OQ);
        found |= (uint64_t)_mm256_movemask_pd(beyond) << t;
    }
    return found & pir_surface_first(surface->count);
}

AVX2 static uint64_t about(const pir_surface *surface, uint32_t corner) {
    const __m256i c = _mm256_set1_epi8((char)corner);
    uint64_t found = 0;
    for (int half = 0; half < 2; half++) {
        __m256i is = _mm256_setzero_si256();
        for (int k = 0; k < 3; k++)
            is = _mm256_or_si256(
                is, _mm256_cmpeq_epi8(c, _mm256_loadu_si256((const __m256i *)&surface->corner[k][32 * half])));
        found |= (uint64_t)(uint32_t)_mm256_movemask_epi8(is) << 32 * half;
    }
    return found & pir_surface_first(surface->count);
}

/* Which of these corners are in a set: of each, its byte of the set and in that its bit. */
AVX2 static inline __m256i are_in(__m256i set, const uint8_t *corner) {
    const __m256i bits = _mm256_set1_epi64x((long long)0x8040201008040201), low = _mm256_set1_epi8(7);
    __m256i c = _mm256_loadu_si256((const __m256i *)corner);
    __m256i bit = _mm256_shuffle_epi8(bits, _mm256_and_si256(c, low));
    __m256i byte = _mm256_shuffle_epi8(set, _mm256_and_si256(_mm256_srli_epi16(c, 3), low));
    return _mm256_cmpeq_epi8(_mm256_and_si256(byte, bit), bit);
}

AVX2 static uint64_t within(const pir_surface *surface, uint32_t corners) {
    const __m256i set = _mm256_set1_epi32((int)corners);
    uint64_t found = 0;
    for (int half = 0; half < 2; half++) {
        __m256i all = are_in(set, &surface->corner[0][32 * half]);
        for (int k = 1; k < 3; k++)
            all = _mm256_and_si256(all, are_in(set, &surface->corner[k][32 * half]));
        found |= (uint64_t)(uint32_t)_mm256_movemask_epi8(all) << 32 * half;
    }
    return found & pir_surface_first(surface->count);
}

AVX2 static uint32_t either(const uint32_t vertex[PIR_SURFACE_CORNERS], uint32_t u, uint32_t v) {
    const __m256i first = _mm256_set1_epi32((int)u), second = _mm256_set1_epi32((int)v);
    uint32_t found = 0;
    for (uint32_t i = 0; i < PIR_SURFACE_CORNERS; i += 8) {
        __m256i of = _mm256_loadu_si256((const __m256i *)&vertex[i]);
        __m256i is = _mm256_or_si256(_mm256_cmpeq_epi32(of, first), _mm256_cmpeq_epi32(of, second));
        found |= (uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(is)) << i;
    }
    return found;
}

const pir_surface_loops pir_surface_avx2 = {"AVX2", corners, planes, below, least, seen, about, within, either};
#else
typedef int pir_no_avx2_surface; // a file holds at least a declaration
#endif
