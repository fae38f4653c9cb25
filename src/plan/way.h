/* SPDX-License-Identifier: MIT */
/*
 * The way through joined cells, as points that straight motions join. Each motion is proven free by integers, against
 * every sum. Points are those of the cells' joints, rounded to doubles where the motions to and from them stay free.
 */
#ifndef PIR_PLAN_WAY_H
#define PIR_PLAN_WAY_H

#include "plan/join.h"

typedef struct pir_plan_way {
    uint32_t *point, *exact; /* as it is; of scratch, the points before they were rounded */
    uint32_t count, room, exact_room;
} pir_plan_way;

/* The way from a point of cell `first` to one of cell `last`, which are connected. PIR_ERR_INTERNAL where a motion is
 * not free. */
void pir_plan_way_make(pir_plan_cutter *cutter, const pir_plan_sums *sums, const pir_plan_tree *tree,
                       const pir_plan_joints *joints, const uint32_t cell[2], const uint32_t end[2], pir_plan_way *way);
void pir_plan_way_finish(pir_plan_space *space, pir_plan_way *way);

#endif
