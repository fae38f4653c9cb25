/* SPDX-License-Identifier: MIT */
/* Loops over slices: see cspace_loops.h. */
#include "cspace_loops.h"

static pir_pose pose(const double *numbers) {
    return (pir_pose){{numbers[0], numbers[1], numbers[2], numbers[3]}, {numbers[4], numbers[5], numbers[6]}};
}

pir_status py_cspace_segments(pir_cspace *cspace, const double *poses, size_t count, pir_report *report,
                              pir_cspace_motion *ret_motions, size_t *ret_done) {
    pir_status status = PIR_OK;
    size_t i = 0;
    for (; i < count && status == PIR_OK; i += status == PIR_OK) {
        const pir_pose from = pose(poses + 14 * i), to = pose(poses + 14 * i + 7);
        status = pir_cspace_segment(cspace, &from, &to, report, &ret_motions[i]);
    }
    *ret_done = i;
    return status;
}
