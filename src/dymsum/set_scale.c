/* SPDX-License-Identifier: MIT */
/*
 * Another size for an operand, with the same pairing.
 *
 * Every certificate is the sign of s(n, e) for a facet normal n and an edge vector e, and scaling a body by a positive
 * number changes the direction of neither (the invariance that Diktas and Sahiner, Parametric Minkowski Sums in Object
 * Space, 2006, use). So the operand is replaced by the same polytope on another scale, its features under the same
 * numbers, and all else stays: the pairing, the certificates, the epoch. Only the shortfall of a pairing that stays
 * behind grows with the body, so such a pairing is settled first.
 */
#include <pirouette/exact.h>

#include "dymsum/sum.h"

/* Puts `scaled` in the operand's place, and takes the reference. Errors as pir_sum_settle. */
static pir_status replace(pir_sum *sum, pir_operand operand, pir_polytope *scaled) {
    pir_status status = pir_sum_settle(sum);
    if (status != PIR_OK) {
        pir_polytope_release(scaled);
        return status;
    }
    pir_polytope **place = operand == PIR_OPERAND_P ? &sum->tracked.pairing.p : &sum->tracked.pairing.q;
    PIR_ASSERT(scaled->half_count == (*place)->half_count && scaled->facet_count == (*place)->facet_count);
    pir_sum_changes(sum);
    pir_polytope_release(*place);
    *place = scaled;
    pir_tracked_link_facets(&sum->tracked);
    pir_lag_measure(&sum->lag, sum->tracked.pairing.p, sum->tracked.pairing.q);
    return PIR_OK;
}

pir_status pir_sum_set_scale(pir_sum *sum, pir_operand operand, double scale) {
    if (!sum || (operand != PIR_OPERAND_P && operand != PIR_OPERAND_Q))
        return PIR_ERR_ARGUMENT;
    pir_polytope *scaled;
    pir_status status = pir_polytope_scale(sum->made_of[operand], scale, &scaled);
    return status == PIR_OK ? replace(sum, operand, scaled) : status;
}

pir_status pir_sum_set_scale_exact(pir_sum *sum, pir_operand operand, const mpq_t scale) {
    if (!sum || (operand != PIR_OPERAND_P && operand != PIR_OPERAND_Q))
        return PIR_ERR_ARGUMENT;
    pir_polytope *scaled;
    pir_status status = pir_polytope_scale_exact(sum->made_of[operand], scale, &scaled);
    return status == PIR_OK ? replace(sum, operand, scaled) : status;
}
