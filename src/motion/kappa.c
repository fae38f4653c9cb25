/* SPDX-License-Identifier: MIT */
/*
 * The place among events as numbers: κ between doubles, the angle, the quadratic, and short numbers in between.
 *
 * Of a root an approximation is known to a few last bits. Doubles around it are compared with it exactly.
 */
#include <math.h>

#include <pirouette/exact.h>

#include "motion/turn_events.h"

/* The sign of root − x for the exit root of a quadratic. */
static int side_of(pir_movers *movers, const pir_quadratic *root, double x) {
    const uint32_t mark = movers->scratch.used;
    pir_quadratic at = pir_quadratic_take(&movers->scratch, movers->limbs);
    pir_quadratic_of_double(&at, x, movers->turning.exponent);
    const int side = pir_quadratic_compare(root, &at, &movers->scratch);
    movers->scratch.used = mark;
    return side;
}

static double approximation(pir_movers *movers, const pir_quadratic *root) {
    pir_scaled sigma, tau;
    pir_quadratic_approximate(root, &sigma, &tau, &movers->scratch);
    const double kappa = ldexp(sigma.m / tau.m, sigma.e - tau.e + movers->turning.exponent);
    return isfinite(kappa) ? kappa : copysign(0x1.fffffffffffffp1023, kappa);
}

/* The greatest double that is not above the exit root, and the least that is not below it. */
static void bracket(pir_movers *movers, const pir_quadratic *root, double ret_kappa[2]) {
    double x = approximation(movers, root);
    int side = side_of(movers, root, x);
    const int from = side;
    double other = x;
    // on, away from x, until the root is passed or met
    while (side == from && side != 0 && isfinite(x)) {
        other = x;
        x = nextafter(x, side * INFINITY);
        side = isfinite(x) ? side_of(movers, root, x) : -side;
    }
    if (side == 0)
        other = x;
    ret_kappa[0] = (other < x ? other : x) + 0.0;
    ret_kappa[1] = (other < x ? x : other) + 0.0;
}

void pir_events_kappa(pir_events *events, double ret_kappa[2]) {
    pir_movers *movers = &events->movers;
    if (movers->now.first)
        ret_kappa[0] = ret_kappa[1] = INFINITY;
    else
        bracket(movers, pir_movers_now(movers), ret_kappa);
}

void pir_events_angle(pir_events *events, double ret_degrees[2]) {
    const pir_turning *turning = &events->movers.turning;
    double kappa[2];
    pir_events_kappa(events, kappa);
    pir_turning_degrees(turning->length, turning->exponent, kappa, ret_degrees);
}

/* Of the doubles from low to high, both finite, the one with the fewest bits. */
static double shortest_between(double low, double high) {
    if (low <= 0 && high >= 0)
        return 0;
    if (high < 0)
        return -shortest_between(-high, -low);
    for (int bit = ilogb(high);; bit--) {
        // a low that vanishes in these units is above 0 all the same
        const double units = fmax(ceil(ldexp(low, -bit)), 1), x = ldexp(units, bit);
        if (x <= high)
            return x;
    }
}

pir_status pir_events_between(pir_events *events, double *ret_kappa) {
    if (!events || !ret_kappa)
        return PIR_ERR_ARGUMENT;
    pir_movers *movers = &events->movers;
    const double most = 0x1.fffffffffffffp1023;
    double now[2], next[2] = {-INFINITY, -INFINITY};
    pir_events_kappa(events, now);
    if (events->queue.count > 0) {
        const uint32_t mark = movers->scratch.used, m = events->queue.item[0];
        pir_quadratic root = pir_quadratic_take(&movers->scratch, movers->limbs);
        pir_movers_quadratic(movers, m, movers->mover[m].next.half, &root, &movers->scratch);
        bracket(movers, &root, next);
        movers->scratch.used = mark;
    }
    double high = now[0] < now[1] ? now[0] : nextafter(now[0], -INFINITY);
    double low = next[0] < next[1] ? next[1] : nextafter(next[1], INFINITY);
    high = fmin(high, most);
    low = fmax(low, -most);
    if (low > high)
        return PIR_ERR_LIMIT;
    *ret_kappa = shortest_between(low, high);
    return PIR_OK;
}

pir_status pir_events_polynomial_exact(pir_events *events, mpz_t *ret_coefficients) {
    if (!events || !ret_coefficients || events->movers.now.first)
        return PIR_ERR_ARGUMENT;
    pir_movers *movers = &events->movers;
    pir_turning_polynomial(pir_movers_now(movers), movers->turning.exponent, ret_coefficients);
    return PIR_OK;
}
