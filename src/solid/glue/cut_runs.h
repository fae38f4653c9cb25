/* SPDX-License-Identifier: MIT */
/* Runs of an outline cut at each other's ends, and where they cross. */
#ifndef PIR_SOLID_GLUE_CUT_RUNS_H
#define PIR_SOLID_GLUE_CUT_RUNS_H

#include "solid/glue/union_outline.h"

/* Notes a vertex within the runs of a line. */
void pir_union_outline_touch(pir_union_outline *outline, uint32_t line, uint32_t point);

/* Cuts the runs, once all are there. */
void pir_union_outline_cut(pir_union_outline *outline);

/* Makes the sides in the scratch the runs, by group. */
void pir_union_outline_sort_runs(pir_union_outline *outline);

#endif
