/* SPDX-License-Identifier: MIT */
/* Bringing a sum to a rotation, by one method or another. */
#ifndef PIR_DYMSUM_ROTATE_H
#define PIR_DYMSUM_ROTATE_H

#include "dymsum/sum.h"

/*
 * Makes the pairing of what the sum keeps from nothing, at its rotation. On PIR_ERR_MEMORY the pairing is not usable.
 */
pir_status pir_sum_walk(pir_sum *sum);

/*
 * Whether the pairing may stay where it is for `rotation`, within the tolerance; then that is the rotation shown from
 * here on. Errors as pir_sum_rotate.
 */
pir_status pir_sum_stay_behind(pir_sum *sum, pir_quat rotation, bool *ret_done);

#endif
