/* SPDX-License-Identifier: MIT */
/*
 * A plan: the question, the sums, the division of the box, which free cells are connected, and the path.
 *
 * Invariant: once it is made nothing of it changes. `cell` are free cells that have the ends.
 */
#ifndef PIR_PLAN_PATH_PLAN_H
#define PIR_PLAN_PATH_PLAN_H

#include <pirouette/plan.h>

#include "plan/way.h"

struct pir_path_plan {
    pir_allocator allocator;
    pir_plan_space space;
    pir_plan_pieces robot, obstacles;
    pir_plan_sums sums;
    pir_plan_tree tree;
    pir_plan_joints joints;
    pir_plan_way way;
    pir_quat rotation;
    bool bounded;
    uint32_t end[2], cell[2]; /* points; free cells */
    pir_path_plan_info info;
};

#endif
