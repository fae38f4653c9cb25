/* SPDX-License-Identifier: MIT */
/*
 * The boxes of a plan: which there are, which touch, how their parts are linked.
 *
 * Invariants: leaves that are not divided cover all rotations; the first of an orbit has in its list exactly those that
 * it shares a rotation with, others of its orbit among them. Parts of two that may share a translation are linked: the
 * list of the greater first one has the links, within an orbit both ways.
 */
#ifndef PIR_PLAN_RIGID_RIGID_BOXES_H
#define PIR_PLAN_RIGID_RIGID_BOXES_H

#include "plan/rigid/rigid_plan.h"

/* The first boxes. */
void pir_rigid_boxes_begin(pir_rigid_job *job);

/* Replaces the orbit of a leaf by its eighths. */
void pir_rigid_box_divide(pir_rigid_job *job, uint32_t leaf);

/* Finds translations that the links share of which listed boxes are asked. */
void pir_rigid_boxes_ask(pir_rigid_job *job);

/* Replaces the orbit of a leaf by leaves that are to block these, which take their hubs. */
void pir_rigid_box_refine(pir_rigid_job *job, uint32_t leaf);

/* Whether a box may block more without being divided. */
bool pir_rigid_box_may_refine(const pir_rigid_job *job, uint32_t leaf);

/* Makes the inner parts of all leaves that are new, and the links between them and others. */
void pir_rigid_boxes_make(pir_rigid_job *job);

/* Divides the translations at the middles of the boxes that the job lists. */
void pir_rigid_boxes_fill(pir_rigid_job *job);

/* Numbers the nodes, and joins those that are linked. */
void pir_rigid_boxes_join(pir_rigid_job *job);

void pir_rigid_boxes_finish(pir_rigid_job *job);

#endif
