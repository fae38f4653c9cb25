/* SPDX-License-Identifier: MIT */
/* Climbs in both bodies of a frame: see supports.h. */
#include "query/frame/supports.h"

static void supports_plain(const pir_frame *frame, pir_vec3 n, uint32_t *a, uint32_t *b, pir_vec3 *ret_back) {
    *ret_back = pir_mat_apply_transposed(&frame->r, n);
    *a = pir_climb(frame->p.polytope, *ret_back, *a);
    *b = pir_climb(frame->q.polytope, n, *b);
}

pir_supports *pir_supports_version(unsigned index) {
    if (index == 0)
        return supports_plain;
#if PIR_HAVE_X86_SUPPORTS
    if (index == 1 && __builtin_cpu_supports("avx2"))
        return pir_supports_avx2;
#endif
    return NULL;
}

pir_supports *pir_supports_best(void) {
    unsigned index = 0;
    while (pir_supports_version(index + 1))
        index++;
    return pir_supports_version(index);
}
