/* SPDX-License-Identifier: MIT */
/* The proof that there is no path, or a path, as docs/plan.md has them; check/motions.py checks them. */
#ifndef PIR_PLAN_RIGID_RIGID_WRITE_H
#define PIR_PLAN_RIGID_RIGID_WRITE_H

#include <stdio.h>

#include "plan/rigid/rigid_plan.h"

/*
 * Writes it: `start` is the root of the nodes that are connected with the start. PIR_ERR_FORMAT where parts of a box
 * are not those that it has when they are made again.
 */
pir_status pir_rigid_write(pir_rigid_job *job, uint32_t start, FILE *file);

/* Writes a path with the question, for one that holds it against pieces by itself. PIR_ERR_FILE, PIR_ERR_MEMORY. */
pir_status pir_rigid_write_path(const pir_rigid_question *question, const pir_rigid_result *result, FILE *file);

#endif
