/* SPDX-License-Identifier: MIT */
/* Cones and covers. See cover.h. */
#include "dymsum/region/cover.h"

/*
 * Widens a cone, so that rounding never excludes a facet that is in it. The pairing does not depend on it.
 */
#define CONE_SLACK 0x1p-40

static const pir_arc half_turn = {-1, 0};

pir_arc pir_arc_of(double angle) {
    if (!(angle < PIR_WHOLE_HALF_ANGLE))
        return half_turn;
    double x = angle / 8, y = x * x;
    double s = x * (1 - y / 6 * (1 - y / 20 * (1 - y / 42 * (1 - y / 72 * (1 - y / 110)))));
    double c = 1 - y / 2 * (1 - y / 12 * (1 - y / 30 * (1 - y / 56 * (1 - y / 90))));
    for (int i = 0; i < 3; i++) {
        double twice = 2 * s * c;
        c = c * c - s * s;
        s = twice;
    }
    return s < 0 ? half_turn : (pir_arc){c, s};
}

pir_arc pir_arc_add(pir_arc a, pir_arc b) {
    // cos a ≤ cos (π − b), whose sign no rounding changes: the sine of the sum is −0 for π + π
    if (a.cosine + b.cosine <= 0)
        return half_turn;
    return (pir_arc){a.cosine * b.cosine - a.sine * b.sine, fmax(0, a.sine * b.cosine + a.cosine * b.sine)};
}

pir_arc pir_arc_from_cosine(double cosine) {
    double c = fmin(1, fmax(-1, cosine));
    return (pir_arc){c, sqrt((1 - c) * (1 + c))};
}

pir_status pir_cone_make(pir_vec3 axis, double half_angle, pir_cone *ret_cone) {
    if (!pir_vec_is_finite(axis) || !isfinite(half_angle))
        return PIR_ERR_NOT_FINITE;
    // scaled near 1, so that squares neither vanish nor overflow
    double most = fmax(fabs(axis.x), fmax(fabs(axis.y), fabs(axis.z)));
    if (most == 0 || half_angle < 0)
        return PIR_ERR_ARGUMENT;
    axis = (pir_vec3){axis.x / most, axis.y / most, axis.z / most};
    *ret_cone = (pir_cone){.set = half_angle < PIR_WHOLE_HALF_ANGLE,
                           .axis = pir_vec_scale(axis, 1 / sqrt(pir_vec_dot(axis, axis))),
                           .half_angle = half_angle,
                           .cosine = pir_arc_of(half_angle).cosine - CONE_SLACK};
    return PIR_OK;
}

static double clamp(double x, double least, double most) {
    return fmin(most, fmax(least, x));
}

pir_cover pir_cover_make(const pir_cone *cone, bool whole, pir_vec3 axis_p, pir_vec3 axis_q, double skin_p,
                         double skin_q, double stride) {
    pir_cover cover = {.whole = whole,
                       .axis_p = axis_p,
                       .axis_q = axis_q,
                       .half_angle = pir_arc_of(cone->half_angle),
                       .skin_p = clamp(skin_p, PIR_RESTING_SKIN, PIR_MOST_SKIN),
                       .skin_q = clamp(skin_q, PIR_RESTING_SKIN, PIR_MOST_SKIN),
                       .stride = stride == PIR_NO_STRIDE ? stride : clamp(stride, PIR_LEAST_STRIDE, PIR_MOST_SKIN)};
    cover.cosine_p = pir_arc_of(cover.skin_p).cosine;
    cover.cosine_q = pir_arc_of(cover.skin_q).cosine;
    return cover;
}
