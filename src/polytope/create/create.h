/* SPDX-License-Identifier: MIT */
/* The check of the merge tolerance of a polytope. */
#ifndef PIR_POLYTOPE_CREATE_CREATE_H
#define PIR_POLYTOPE_CREATE_CREATE_H

#include <pirouette/polytope.h>

/* PIR_ERR_ARGUMENT or PIR_ERR_NOT_FINITE where that is no merge tolerance. */
pir_status pir_polytope_check_tolerance(double merge_tolerance);

#endif
