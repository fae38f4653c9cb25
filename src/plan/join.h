/* SPDX-License-Identifier: MIT */
/*
 * Which free cells are connected. With closed sums free space is open in the box, so cells are joined where they share
 * a polygon: a way through an edge or a corner can be moved aside. With open sums free cells are closed, and every
 * point that two have in common joins them.
 *
 * `door` is a point that both cells of a joint have, with closed sums within the polygon that they share. Joints are a
 * forest: each joins two parts that were apart.
 */
#ifndef PIR_PLAN_JOIN_H
#define PIR_PLAN_JOIN_H

#include "plan/divide.h"

typedef struct pir_plan_joint {
    uint32_t cell[2], door;
} pir_plan_joint;

typedef struct pir_plan_joints {
    pir_plan_joint *joint;
    uint32_t *root; /* per cell: equal for those that are connected */
    uint32_t count, room, cells;
    bool without_doors; /* set by who asks: doors are not made */
} pir_plan_joints;

void pir_plan_join(pir_plan_cutter *cutter, const pir_plan_tree *tree, pir_plan_joints *joints);
void pir_plan_joints_finish(pir_plan_space *space, pir_plan_joints *joints);

#endif
