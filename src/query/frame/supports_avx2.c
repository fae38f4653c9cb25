/* SPDX-License-Identifier: MIT */
/* Climbs in both bodies of a frame by AVX2: most end where they begin. */
#include "query/frame/supports.h"

#if PIR_HAVE_X86_SUPPORTS

#include "query/frame/fours_avx2.h"

PIR_AVX2 static inline uint32_t climb(const pir_body *body, pir_vec3 n, uint32_t from) {
    bool is_top = body->around && !(pir_ring_most(body->around, from, pir_four_of(n)) > PIR_LEAST_SLOPE);
    return is_top ? from : pir_climb(body->polytope, n, from);
}

PIR_AVX2 void pir_supports_avx2(const pir_frame *frame, pir_vec3 n, uint32_t *a, uint32_t *b, pir_vec3 *ret_back) {
    *ret_back = pir_mat_apply_transposed(&frame->r, n);
    *a = climb(&frame->p, *ret_back, *a);
    *b = climb(&frame->q, n, *b);
}

#else
typedef int pir_no_avx2_supports; // a file holds at least a declaration
#endif
