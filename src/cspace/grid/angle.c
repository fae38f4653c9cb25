/* SPDX-License-Identifier: MIT */
/*
 * Angles. An angle is brought to the first eighth of the circle by integers, without rounding; there Taylor's series
 * of sine and cosine, cut where terms are below 2^-57, are evaluated in a fixed order.
 */
#include "cspace/grid/angle.h"

#include <math.h>

#include <pirouette/grid.h>

#define EIGHTH (PIR_FULL_TURN / 8)

/* Σ c[k]·y^k. */
static double series(const double *c, int count, double y) {
    double sum = c[count - 1];
    for (int k = count - 2; k >= 0; k--)
        sum = sum * y + c[k];
    return sum;
}

/* Cosine and sine of x in [0, π/4]. */
static pir_circle_point in_first_eighth(double x) {
    // ±1/n! for even n, and for odd n, beyond the first term
    static const double even[] = {-1.0 / 2,         1.0 / 24,          -1.0 / 720,           1.0 / 40320,
                                  -1.0 / 3628800.0, 1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0};
    static const double odd[] = {-1.0 / 6,
                                 1.0 / 120,
                                 -1.0 / 5040,
                                 1.0 / 362880.0,
                                 -1.0 / 39916800.0,
                                 1.0 / 6227020800.0,
                                 -1.0 / 1307674368000.0,
                                 1.0 / 355687428096000.0};
    double y = x * x;
    return (pir_circle_point){1 + y * series(even, 8, y), x + x * (y * series(odd, 8, y))};
}

pir_circle_point pir_circle_at(uint64_t num, uint64_t den) {
    // the eighth that the angle lies in, and how far it is in it; in odd eighths, how far from its end
    uint64_t scaled = 8 * (num % den), eighth = scaled / den, rest = scaled % den;
    if (eighth & 1)
        rest = den - rest;
    pir_circle_point p;
    if (rest == den)
        p = (pir_circle_point){sqrt(0.5), sqrt(0.5)};
    else
        p = in_first_eighth((double)rest / (double)den * EIGHTH);
    // from there by reflections: 0 and 7, 3 and 4 are near the axis of cosines
    double along = p.cos, across = p.sin;
    bool swap = eighth == 1 || eighth == 2 || eighth == 5 || eighth == 6;
    double cosine = swap ? across : along, sine = swap ? along : across;
    return (pir_circle_point){eighth >= 2 && eighth <= 5 ? 0 - cosine : cosine, eighth >= 4 ? 0 - sine : sine};
}

/* The arc tangent of t in [0, 1]. */
static double arc_tangent(double t) {
    // tan π/8 and tan π/16 as points to subtract: what is left is below 0.2
    static const double points[] = {0, 0.19891236737965800, 0.41421356237309505, 0.66817863791929892, 1};
    static const double angles[] = {0, EIGHTH / 4, EIGHTH / 2, EIGHTH * 0.75, EIGHTH};
    static const double terms[] = {-1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11, 1.0 / 13, -1.0 / 15, 1.0 / 17};
    int nearest = 0;
    for (int k = 1; k < 5; k++)
        if (fabs(t - points[k]) < fabs(t - points[nearest]))
            nearest = k;
    double left = (t - points[nearest]) / (1 + t * points[nearest]), y = left * left;
    return angles[nearest] + (left + left * (y * series(terms, 8, y)));
}

double pir_turn_part(double x, double y) {
    double a = fabs(x), b = fabs(y);
    if (a == 0 && b == 0)
        return 0;
    double part = a >= b ? arc_tangent(b / a) / PIR_FULL_TURN : 0.25 - arc_tangent(a / b) / PIR_FULL_TURN;
    if (x < 0)
        part = 0.5 - part;
    if (y < 0)
        part = 1 - part;
    return part < 1 ? part : 0;
}

pir_quat pir_quat_unit(pir_quat q) {
    double top = fmax(fmax(fabs(q.x), fabs(q.y)), fmax(fabs(q.z), fabs(q.w)));
    int exponent;
    frexp(top, &exponent);
    q = (pir_quat){ldexp(q.x, -exponent), ldexp(q.y, -exponent), ldexp(q.z, -exponent), ldexp(q.w, -exponent)};
    double by = 1 / sqrt(pir_quat_dot(q, q));
    return (pir_quat){q.x * by, q.y * by, q.z * by, q.w * by};
}

bool pir_quat_is_rotation(pir_quat q) {
    bool finite = isfinite(q.x) && isfinite(q.y) && isfinite(q.z) && isfinite(q.w);
    return finite && (q.x != 0 || q.y != 0 || q.z != 0 || q.w != 0);
}

double pir_grid_turn(pir_quat a, pir_quat b) {
    if (!pir_quat_is_rotation(a) || !pir_quat_is_rotation(b))
        return NAN;
    a = pir_quat_unit(a);
    b = pir_quat_unit(b);
    // half the angle has the real part of conj(a)·b for cosine and the length of its vector part for sine
    double x = a.w * b.x - a.x * b.w + a.z * b.y - a.y * b.z, y = a.w * b.y - a.y * b.w + a.x * b.z - a.z * b.x;
    double z = a.w * b.z - a.z * b.w + a.y * b.x - a.x * b.y;
    return 2 * PIR_FULL_TURN * pir_turn_part(fabs(pir_quat_dot(a, b)), sqrt(x * x + y * y + z * z));
}
