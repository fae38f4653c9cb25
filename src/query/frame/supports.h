/* SPDX-License-Identifier: MIT */
/* Climbs in both bodies of a frame at once, in versions for processors. */
#ifndef PIR_QUERY_FRAME_SUPPORTS_H
#define PIR_QUERY_FRAME_SUPPORTS_H

#include "query/frame/frame.h"

/*
 * Moves *a and *b to the vertices of P and Q that pir_climb along the unit vector n ends at, and sets n as P has it.
 */
typedef void pir_supports(const pir_frame *frame, pir_vec3 n, uint32_t *a, uint32_t *b, pir_vec3 *ret_back);

/* A version of it, all of which give the same bits: the plain one first; NULL past those that this machine can run. */
pir_supports *pir_supports_version(unsigned index);

/* The last of them. */
pir_supports *pir_supports_best(void);

#if defined(__x86_64__) && defined(__GNUC__)
#define PIR_HAVE_X86_SUPPORTS 1
pir_supports pir_supports_avx2;
#endif

#endif
