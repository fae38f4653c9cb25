/* SPDX-License-Identifier: MIT */
/* A sum at the relative rotation of two posed bodies: see relative.h. */
#include "dymsum/relative.h"

#include "dymsum/rotate.h"
#include "dymsum/sum.h"

pir_status pir_sum_turn_relative(pir_sum *sum, pir_quat q, pir_quat p) {
    pir_status status = pir_rotation_set_relative(&sum->tracked.pairing.signs.rotation, q, p);
    if (status != PIR_OK)
        return status;
    pir_sum_changes(sum);
    // an epoch that knows no rotation begins with the next step
    sum->tracked.epoch = (pir_epoch){0};
    return pir_sum_walk(sum);
}
