/* SPDX-License-Identifier: MIT */
/* Where slices come from. */
#ifndef PIR_CSPACE_ANSWER_SOURCE_H
#define PIR_CSPACE_ANSWER_SOURCE_H

#include <pirouette/cspace.h>

/* A grid, the pieces, and slices as sums. All of it is borrowed. */
typedef struct pir_slice_source {
    const pir_grid *grid;
    const pir_polytope *const *robot, *const *obstacle;
    uint32_t robot_count, obstacle_count;
    /* Makes the difference of a pair of pieces at a rotation of the grid; the caller destroys it. */
    pir_status (*sum)(void *context, pir_cspace_place place, pir_report *report, pir_sum **ret_sum);
    void *context;
} pir_slice_source;

#endif
