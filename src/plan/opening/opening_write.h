/* SPDX-License-Identifier: MIT */
/* Proofs that holes of a wall are too narrow, as docs/plan.md has them. */
#ifndef PIR_PLAN_OPENING_OPENING_WRITE_H
#define PIR_PLAN_OPENING_OPENING_WRITE_H

#include <stdio.h>

#include "plan/opening/opening_cells.h"
#include "plan/opening/opening_wall.h"

/* Writes the proof that a piece cannot pass a wall; without cells where that has no holes. */
pir_status pir_opening_write(const pir_opening_parts *parts, const pir_opening_wall *wall, uint32_t piece,
                             const pir_opening_cells *cells, FILE *file);

#endif
