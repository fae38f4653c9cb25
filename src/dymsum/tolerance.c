/* SPDX-License-Identifier: MIT */
/* The calls about tolerance. The bound stands in update/lag.c. */
#include "dymsum/sum.h"

pir_status pir_sum_set_tolerance(pir_sum *sum, double tolerance) {
    if (!sum || !(tolerance >= 0))
        return PIR_ERR_ARGUMENT;
    if (!isfinite(tolerance))
        return PIR_ERR_NOT_FINITE;
    pir_status status = pir_sum_settle(sum);
    if (status != PIR_OK)
        return status;
    if (tolerance > 0 && !pir_sum_reserve_lag(sum))
        return PIR_ERR_MEMORY;
    pir_sum_changes(sum);
    sum->lag.tolerance = tolerance;
    pir_lag_measure(&sum->lag, sum->tracked.pairing.p, sum->tracked.pairing.q);
    return PIR_OK;
}

pir_status pir_sum_settle(pir_sum *sum) {
    if (!sum)
        return PIR_ERR_ARGUMENT;
    if (!sum->lag.lagging)
        return PIR_OK;
    double tolerance = sum->lag.tolerance;
    sum->lag.tolerance = 0;
    pir_status status = pir_sum_rotate(sum, sum->lag.knots->now.given, PIR_METHOD_AUTO);
    sum->lag.tolerance = tolerance;
    return status;
}

double pir_sum_tolerance(const pir_sum *sum) {
    return sum->lag.tolerance;
}

double pir_sum_shortfall_bound(const pir_sum *sum) {
    return sum->lag.lagging ? sum->lag.bound : 0;
}

pir_quat pir_sum_rotation(const pir_sum *sum) {
    return sum->lag.lagging ? sum->lag.knots->now.given : sum->tracked.pairing.signs.rotation.given;
}

pir_quat pir_sum_pairing_rotation(const pir_sum *sum) {
    return sum->tracked.pairing.signs.rotation.given;
}
