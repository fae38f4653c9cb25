/* SPDX-License-Identifier: MIT */
/* Beginning again in the memory that is there: a sum without a past motion, and counters at zero. */
#include "dymsum/sum.h"

pir_status pir_sum_reset(pir_sum *sum, pir_quat rotation) {
    pir_status status = pir_sum_rotate(sum, rotation, PIR_METHOD_WALK);
    if (status != PIR_OK)
        return status;
    pir_sum_changes(sum);
    // the walk has renewed or expired every certificate, and an epoch of no rotation ends with the next step
    sum->tracked.epoch = (pir_epoch){0};
    sum->cost = (pir_cost_model){.walk = sum->cost.walk};
    return PIR_OK;
}

void pir_sum_reset_statistics(pir_sum *sum) {
    sum->tracked.statistics = (pir_sum_statistics){0};
    sum->tracked.pairing.signs.by_filter = sum->tracked.pairing.signs.by_exact =
        sum->tracked.pairing.signs.by_perturbation = 0;
}
