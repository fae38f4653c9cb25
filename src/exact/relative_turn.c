/* SPDX-License-Identifier: MIT */
/* Rotations in doubles for any processor: see relative_turn.h. */
#include "exact/relative_turn.h"

static bool is_ample(double c) {
    return (c == 0) | (fabs(c) >= PIR_RELATIVE_LEAST);
}

static bool is_taken(pir_quat q) {
    return pir_quat_is_fit(q) && is_ample(q.x) && is_ample(q.y) && is_ample(q.z) && is_ample(q.w);
}

static void set(pir_quat given, pir_quat *ret_unit, pir_mat3 *ret_r) {
    const pir_rotation_doubles doubles = pir_doubles_as_given(given);
    *ret_unit = doubles.unit;
    *ret_r = doubles.r;
}

static bool find(const pir_quat *q, const pir_quat *p, pir_quat_product *ret_product, pir_quat *ret_unit,
                 pir_mat3 *ret_r) {
    if (!is_taken(*q) || !is_taken(*p))
        return false;
    *ret_product = pir_quat_conjugate_times(*q, *p);
    // no shorter than 1/4
    set(pir_quat_signed(ret_product->whole), ret_unit, ret_r);
    return true;
}

static bool turn(const pir_quat *q, pir_quat *ret_unit, pir_mat3 *ret_r) {
    const pir_quat given = pir_quat_signed(*q);
    if (!pir_quat_is_near_one(given))
        return false;
    set(given, ret_unit, ret_r);
    return true;
}

const pir_relative_version pir_relative_plain = {find, turn};
