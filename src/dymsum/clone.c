/* SPDX-License-Identifier: MIT */
/*
 * A second sum with the pairing of a first. Pairs are copied edge by edge, so the copy's crossings stand in a row. Its
 * certificates are not copied but expired, as after a rebuild: its first update checks every facet.
 */
#include "dymsum/fill.h"
#include "dymsum/sum.h"

#include <string.h>

static bool copy_pairing(pir_sum *to, const pir_pairing *from) {
    if (!pir_fill_crossings(to, from->crossings.count))
        return false;
    memcpy(pir_fill_cells(to, PIR_OPERAND_P), from->fv, from->p->facet_count * sizeof *from->fv);
    memcpy(pir_fill_cells(to, PIR_OPERAND_Q), from->vf, from->q->facet_count * sizeof *from->vf);
    for (uint32_t e = 0; e < from->p->edge_count; e++) {
        uint32_t last = PIR_NO_CROSSING;
        for (uint32_t at = pir_crossing_first(from, e); at != PIR_NO_CROSSING; at = pir_crossing_next(from, at))
            if (!pir_fill_crossing(to, e, pir_crossing_half(from, at), &last))
                return false;
    }
    pir_fill_end(to);
    return true;
}

static bool copy_lag(pir_sum *to, const pir_lag *from) {
    if (!from->knots)
        return true;
    if (!pir_sum_reserve_lag(to))
        return false;
    pir_lag_knots *knots = to->lag.knots;
    pir_rotation_integers *integers = knots->now.integers;
    *knots = *from->knots;
    knots->now.integers = integers;
    to->lag = *from;
    to->lag.knots = knots;
    return true;
}

pir_status pir_sum_clone(const pir_sum *sum, const pir_allocator *allocator, pir_sum **ret_sum) {
    if (!sum || !ret_sum)
        return PIR_ERR_ARGUMENT;
    const pir_pairing *pairing = &sum->tracked.pairing;
    const pir_allocator used = allocator ? *allocator : pairing->allocator;
    const pir_fill_operands operands = {.made_of = {sum->made_of[PIR_OPERAND_P], sum->made_of[PIR_OPERAND_Q]},
                                        .now = {pairing->p, pairing->q},
                                        .difference = pairing->difference};
    pir_sum *copy = NULL;
    pir_status status = pir_fill_begin(&operands, pairing->signs.rotation.given, &used, &copy);
    if (status != PIR_OK)
        return status;
    bool done = copy_pairing(copy, pairing) && copy_lag(copy, &sum->lag), fits = true;
    if (done && sum->region.cone.set)
        done = pir_fill_region(copy, &sum->region.cone, &sum->region.cover, &fits);
    PIR_ASSERT(fits);
    if (!done) {
        pir_sum_destroy(copy);
        return PIR_ERR_MEMORY;
    }
    copy->cost = sum->cost;
    copy->tracked.statistics = (pir_sum_statistics){0};
    *ret_sum = copy;
    return PIR_OK;
}
