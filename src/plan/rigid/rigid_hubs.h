/* SPDX-License-Identifier: MIT */
/*
 * Hubs: the free parts at single rotations, and turns between them. The ends are hubs of their own, of which nothing
 * but the end's translation is known.
 */
#ifndef PIR_PLAN_RIGID_RIGID_HUBS_H
#define PIR_PLAN_RIGID_RIGID_HUBS_H

#include "plan/rigid/rigid_plan.h"

/* The two ends. */
void pir_rigid_hubs_begin(pir_rigid_job *job);

/* Gives new leaves hubs of what they are parts of and of leaves that touch, which an end reaches and they lack. */
void pir_rigid_hubs_inherit(pir_rigid_job *job);

/* Has the parts of listed leaves, which are full, be hubs, and joins them with others and the ends. */
void pir_rigid_hubs_join(pir_rigid_job *job);

void pir_rigid_hubs_finish(pir_rigid_job *job);

#endif
