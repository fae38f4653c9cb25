/* SPDX-License-Identifier: MIT */
/* The box of turned points: a plain loop, and one for AVX2 that gives its bits. */
#ifndef PIR_SCENE_WORLD_TURNED_BOX_H
#define PIR_SCENE_WORLD_TURNED_BOX_H

#include "base/vec.h"

/* The least and the greatest coordinates of r times each point; infinities of none. */
typedef void pir_turned_box_loop(const pir_mat3 *r, const pir_vec3 *point, uint32_t count, pir_vec3 *ret_low,
                                 pir_vec3 *ret_high);

/* Version 0 is the plain one; NULL where this machine or build lacks it. */
pir_turned_box_loop *pir_turned_box_version(unsigned index);

/* The fastest version. */
pir_turned_box_loop *pir_turned_box_best(void);

#if defined(__x86_64__) && defined(__GNUC__)
#define PIR_HAVE_X86_TURNED_BOX 1
pir_turned_box_loop pir_turned_box_avx2;
#endif

#endif
