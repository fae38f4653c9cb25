/* SPDX-License-Identifier: MIT */
/* A sum at the relative rotation of two posed bodies. */
#ifndef PIR_DYMSUM_RELATIVE_H
#define PIR_DYMSUM_RELATIVE_H

#include <pirouette/sum.h>

/*
 * Rebuilds a sum by walk at conj(q)·p exactly (exact/rotation.h), and forgets the motion so far. Errors: those of the
 * rotation, with the sum as it was; and PIR_ERR_MEMORY, after which the sum may only be destroyed.
 */
pir_status pir_sum_turn_relative(pir_sum *sum, pir_quat q, pir_quat p);

#endif
