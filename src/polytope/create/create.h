/* SPDX-License-Identifier: MIT */
/* Checks of the options of a polytope. */
#ifndef PIR_POLYTOPE_CREATE_CREATE_H
#define PIR_POLYTOPE_CREATE_CREATE_H

#include <pirouette/polytope.h>

/* PIR_ERR_ARGUMENT or PIR_ERR_NOT_FINITE when the merge tolerance is none. */
pir_status pir_polytope_check_options(const pir_polytope_options *options);

#endif
