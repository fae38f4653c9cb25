/* SPDX-License-Identifier: MIT */
/* The functions of pir_single_version that this build has besides the plain ones. */
#ifndef PIR_QUERY_CONTACT_SINGLE_VERSIONS_H
#define PIR_QUERY_CONTACT_SINGLE_VERSIONS_H

#include "query/contact/single.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define PIR_HAVE_X86_SINGLES 1
bool pir_is_sharp_avx2(const pir_polytope *p, pir_feature feature, pir_vec3 m, double sine);
pir_foremost pir_foremost_avx2(const pir_polytope *p, uint32_t v, pir_vec3 out, double sine);
bool pir_singles_place_avx2(pir_patch *p, const pir_single *of_p, pir_patch *q, const pir_single *of_q,
                            const pir_vec3 axis[3], pir_clip_places *places);
#endif

#endif
