/* SPDX-License-Identifier: MIT */
/*
 * Paths as poses. Those that are found by pushing have motions that sweeps prove. Of those through hubs each motion
 * keeps the rotation or the translation: a translation is held against all sums at its rotation, in integers, and a
 * turn was proven by outer pieces when it was found.
 */
#ifndef PIR_PLAN_RIGID_RIGID_PATH_H
#define PIR_PLAN_RIGID_RIGID_PATH_H

#include "plan/rigid/rigid_plan.h"

/* The path between the ends, which hubs join. Leaves `result` as it was where a motion cannot be rounded to doubles. */
pir_status pir_rigid_path_make(const pir_rigid_job *job, pir_rigid_result *result);

/*
 * Pushes ways to where the robot has room (plan/band): straight ones between the ends, each at one rotation. Leaves
 * `result` as it was where none comes free. Of several processes the first one does it. PIR_PLAN_ERR_CALLER where the
 * caller ends it.
 */
pir_status pir_rigid_path_push(const pir_rigid_question *question, const pir_plan_ranks *ranks,
                               pir_rigid_result *result);

#endif
