/* SPDX-License-Identifier: MIT */
/* Loops over slices, in modules that have them: see loops.h. */
#ifndef PIR_PYTHON_CSPACE_LOOPS_H
#define PIR_PYTHON_CSPACE_LOOPS_H

#include <pirouette/cspace.h>

/* cffi: begin */
pir_status py_cspace_segments(pir_cspace *cspace, const double *poses, size_t count, pir_report *report,
                              pir_cspace_motion *ret_motions, size_t *ret_done);
/* cffi: end */

#endif
