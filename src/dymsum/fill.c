/* SPDX-License-Identifier: MIT */
/* Making a sum from a pairing that is known. See fill.h. */
#include "dymsum/fill.h"

#include "dymsum/pairing/crossings.h"
#include "dymsum/rotate.h"

pir_status pir_fill_begin(const pir_fill_operands *operands, pir_quat rotation, const pir_allocator *allocator,
                          pir_sum **ret_sum) {
    pir_sum *sum = NULL;
    const pir_sum_parts parts = {operands->now[PIR_OPERAND_P], operands->now[PIR_OPERAND_Q], rotation, allocator, NULL};
    pir_status status = pir_sum_new(&parts, &sum);
    if (status != PIR_OK)
        return status;
    for (int i = 0; i < 2; i++) {
        pir_polytope_release(sum->made_of[i]);
        sum->made_of[i] = pir_polytope_retain(operands->made_of[i]);
    }
    sum->tracked.pairing.difference = operands->difference;
    *ret_sum = sum;
    return PIR_OK;
}

uint32_t *pir_fill_cells(pir_sum *sum, pir_operand facets_of) {
    return facets_of == PIR_OPERAND_P ? sum->tracked.pairing.fv : sum->tracked.pairing.vf;
}

bool pir_fill_crossings(pir_sum *sum, uint32_t count) {
    if (!pir_crossings_reserve(&sum->tracked, count))
        return false;
    pir_crossings_clear(&sum->tracked);
    return true;
}

bool pir_fill_crossing(pir_sum *sum, uint32_t e, uint32_t h, uint32_t *last) {
    return pir_crossing_append(&sum->tracked, e, h, last);
}

void pir_fill_end(pir_sum *sum) {
    pir_tracked_expire_all(&sum->tracked);
}

bool pir_fill_region(pir_sum *sum, const pir_cone *cone, const pir_cover *cover, bool *ret_fits) {
    return pir_region_adopt(&sum->region, &sum->tracked, cone, cover, ret_fits);
}

pir_status pir_fill_shown(pir_sum *sum, pir_quat shown, bool *ret_done) {
    return pir_sum_stay_behind(sum, shown, ret_done);
}
