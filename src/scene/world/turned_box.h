/* SPDX-License-Identifier: MIT */
/* The box of turned points: a loop in versions for processors that give the same bits (base/processor.h). */
#ifndef PIR_SCENE_WORLD_TURNED_BOX_H
#define PIR_SCENE_WORLD_TURNED_BOX_H

#include "base/vec.h"

typedef struct pir_turned_box_loops {
    /* The least and the greatest coordinates of r times each point; infinities of none. */
    void (*find)(const pir_mat3 *r, const pir_vec3 *point, uint32_t count, pir_vec3 *ret_low, pir_vec3 *ret_high);
} pir_turned_box_loops;

extern const pir_turned_box_loops pir_turned_box_plain, pir_turned_box_avx2;

#endif
