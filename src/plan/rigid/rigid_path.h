/* SPDX-License-Identifier: MIT */
/*
 * The path through hubs, as poses. Each motion keeps the rotation or the translation: a translation is held against
 * all sums at its rotation, in integers, and a turn was proven by outer pieces when it was found.
 */
#ifndef PIR_PLAN_RIGID_RIGID_PATH_H
#define PIR_PLAN_RIGID_RIGID_PATH_H

#include "plan/rigid/rigid_plan.h"

/* The path between the ends, which hubs join. Leaves `result` as it was where a motion cannot be rounded to doubles. */
pir_status pir_rigid_path_make(const pir_rigid_job *job, pir_rigid_result *result);

#endif
