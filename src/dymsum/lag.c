/* SPDX-License-Identifier: MIT */
/*
 * Tolerance: a pairing that stays behind the rotation while that costs at most τ.
 *
 * Let the pairing be exact at R₀, let R be the rotation asked for, θ the angle between them, and A the hull of the points R·p + q over
 * the pairing's vertices (p, q). A lies in the sum M, so its support function h_A is at most h_M. For a direction n take the vertex (p, q)
 * that supports M at R₀ in the direction
 *
 *   - n: then q supports Q in n, and p supports P in R₀ᵀn, which is at most θ away from Rᵀn. For any vertex w of P,
 *     Rᵀn·(w − p) ≤ (Rᵀn − R₀ᵀn)·(w − p) ≤ 2 sin(θ/2)·|w − p|, so h_M(n) − h_A(n) ≤ 2 sin(θ/2)·diameter(P);
 *   - R₀Rᵀn: then p supports P in Rᵀn, and q supports Q in a direction at most θ away from n: the same with the diameter of Q.
 *
 * Hence |h_M − h_A| ≤ 2 sin(θ/2)·min(diameter(P), diameter(Q)) in every direction there is, those of the pairing among them. While that
 * is at most τ nothing is looked at and nothing changes: a rotation costs a few operations whatever the size. Past it one update
 * covers all the turning since. That is less work than the updates it stands for while the axis stays; where axes change in between, the
 * one long step is not foretold by any epoch (clock.h) and wakes more than the short ones would have: then frames are cheap at
 * the median, and not on average.
 *
 * Rounding errs upwards. The angle is an upper bound (rotation.h), sin x ≤ x, and the diameter is that of a ball around the body.
 */
#include "dymsum/sum.h"

/* Twice the greatest distance of a vertex from the centre of the bounds: at least the diameter. */
static double diameter_bound(const pir_polytope *p) {
    pir_vec3 low, high;
    pir_polytope_bounds(p, &low, &high);
    pir_vec3 centre = {low.x / 2 + high.x / 2, low.y / 2 + high.y / 2, low.z / 2 + high.z / 2};
    double square = 0, far = 0;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        pir_vec3 x = p->vertex[v], d = pir_vec_sub(x, centre);
        square = fmax(square, pir_vec_dot(d, d));
        far = fmax(far, fmax(fabs(x.x), fmax(fabs(x.y), fabs(x.z))));
    }
    // vertices are rounded to doubles, and so is all of this
    return 2 * (sqrt(square) * (1 + 0x1p-40) + far * 0x1p-50);
}

pir_status pir_sum_set_tolerance(pir_sum *sum, double tolerance) {
    if (!sum || !(tolerance >= 0))
        return PIR_ERR_ARGUMENT;
    if (!isfinite(tolerance))
        return PIR_ERR_NOT_FINITE;
    pir_status status = pir_sum_settle(sum);
    if (status != PIR_OK)
        return status;
    sum->lag.tolerance = tolerance;
    pir_lag_measure(sum);
    return PIR_OK;
}

void pir_lag_measure(pir_sum *sum) {
    if (sum->lag.tolerance > 0)
        sum->lag.diameter = fmin(diameter_bound(sum->p), diameter_bound(sum->q));
}

double pir_sum_tolerance(const pir_sum *sum) {
    return sum->lag.tolerance;
}

double pir_sum_shortfall_bound(const pir_sum *sum) {
    return sum->lag.lagging ? sum->lag.bound : 0;
}

pir_quat pir_sum_pairing_rotation(const pir_sum *sum) {
    return sum->signs.rotation.given;
}

pir_status pir_sum_settle(pir_sum *sum) {
    if (!sum)
        return PIR_ERR_ARGUMENT;
    if (!sum->lag.lagging)
        return PIR_OK;
    double tolerance = sum->lag.tolerance;
    sum->lag.tolerance = 0;
    pir_status status = pir_sum_rotate(sum, sum->lag.now.given, PIR_METHOD_AUTO);
    sum->lag.tolerance = tolerance;
    return status;
}

pir_status pir_lag_behind(pir_sum *sum, pir_quat rotation, bool *ret_done) {
    pir_lag *lag = &sum->lag;
    pir_rotation now;
    pir_status status = pir_rotation_set(&now, rotation);
    if (status != PIR_OK)
        return status;
    double angle = pir_rotation_angle_bound(sum->signs.rotation.unit, now.unit);
    double bound = angle * lag->diameter * (1 + 0x1p-50);
    *ret_done = bound <= lag->tolerance;
    if (!*ret_done)
        return PIR_OK;
    pir_rotation_set(&lag->now, rotation);
    lag->bound = bound;
    lag->lagging = true;
    sum->statistics.kept++;
    return PIR_OK;
}
