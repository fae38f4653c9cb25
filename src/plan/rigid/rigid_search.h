/* SPDX-License-Identifier: MIT */
/* Decides a question of rigid_plan.h. */
#ifndef PIR_PLAN_RIGID_RIGID_SEARCH_H
#define PIR_PLAN_RIGID_RIGID_SEARCH_H

#include "plan/rigid/rigid_plan.h"

/* Decides; ret_result->step is to be freed. `proof` is NULL, or where the proof goes that there is no path. */
pir_status pir_rigid_decide(const pir_rigid_question *question, const pir_block_makers *makers, FILE *proof,
                            pir_rigid_result *ret_result);

#endif
