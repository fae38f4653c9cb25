/* SPDX-License-Identifier: MIT */
/*
 * Rotations from quaternions.
 *
 * The bound on r, with u = 2^-53. Unless |q|² is near one, q is first scaled by a power of two, exactly but for parts
 * below 2^-1074, so that its largest component is in [0.5, 1). An entry is a sum of at most four products over n =
 * |q|², the magnitudes of which add up to at most n. Products err by u, three sums by 3u more, n itself by 4u, its
 * reciprocal by u and the last product by u: at most 10.01u, and 9 entries make at most 30.1u in Frobenius norm, hence
 * in what r does to a unit vector (tests/proofs/rotation.g).
 */
#include "exact/rotation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "exact/quat_product.h"
#include "exact/wide.h"

/* The greatest binary exponent among the components, as frexp gives it; INT32_MIN where all are 0. */
static int top_exponent(const double c[4]) {
    double most = fmax(fmax(fabs(c[0]), fabs(c[1])), fmax(fabs(c[2]), fabs(c[3])));
    int top = INT32_MIN;
    if (most > 0)
        frexp(most, &top);
    return top;
}

/* Sets a rotation, the doubles to those of `near`. */
static void set_doubles(pir_rotation *rotation, pir_quat given, pir_quat near) {
    const pir_rotation_doubles doubles = pir_doubles_of(near);
    pir_rotation_set_given(rotation, given);
    rotation->unit = doubles.unit;
    rotation->r = doubles.r;
}

pir_status pir_rotation_set(pir_rotation *rotation, pir_quat given) {
    const pir_quat q = pir_quat_signed(given);
    if (pir_quat_is_near_one(q)) {
        set_doubles(rotation, given, q);
        return PIR_OK;
    }
    const double c[4] = {q.x, q.y, q.z, q.w};
    for (int k = 0; k < 4; k++)
        if (!isfinite(c[k]))
            return PIR_ERR_NOT_FINITE;
    int top = top_exponent(c);
    if (top == INT32_MIN)
        return PIR_ERR_ZERO_QUATERNION;
    set_doubles(rotation, given, (pir_quat){ldexp(q.x, -top), ldexp(q.y, -top), ldexp(q.z, -top), ldexp(q.w, -top)});
    return PIR_OK;
}

/* --- relative rotations --- */

/*
 * q with its components scaled by one power of two, the largest to [0.5, 1). PIR_ERR_LIMIT where one that is not 0
 * would be below 2^-900, so that the integers of a product of two have their room (PIR_QUAT_LIMBS), and nothing is
 * lost here.
 */
static pir_status bring_near_one(pir_quat q, double c[4]) {
    const double given[4] = {q.x, q.y, q.z, q.w};
    memcpy(c, given, sizeof given);
    // most quaternions are there already
    if (pir_quat_is_fit(q))
        return PIR_OK;
    for (int k = 0; k < 4; k++)
        if (!isfinite(given[k]))
            return PIR_ERR_NOT_FINITE;
    int top = top_exponent(given);
    if (top == INT32_MIN)
        return PIR_ERR_ZERO_QUATERNION;
    // as ldexp, but for what falls below 2^-1022 and is refused
    double power = abs(top) <= 1000 ? ldexp(1, -top) : 0;
    for (int k = 0; k < 4; k++) {
        c[k] = power != 0 ? given[k] * power : ldexp(given[k], -top);
        if (given[k] != 0 && fabs(c[k]) < 0x1p-900)
            return PIR_ERR_LIMIT;
    }
    return PIR_OK;
}

/*
 * The effect on r of rounding the product's components, by u each: q is off by u of its length, and so, up to terms of
 * order u², is its direction, which M(q)/|q|² depends on alone. Unit quaternions at a distance c have matrices at
 * 2·√2·c at most: 3u. So r is within 35u (tests/proofs/relative.g), less than the 37u that is promised. Bounds that
 * rest on r take a relative one into account.
 */
pir_status pir_rotation_set_relative(pir_rotation *rotation, pir_quat q, pir_quat p) {
    if (pir_quat_is_identity(q) && q.w != 0 && isfinite(q.w))
        return pir_rotation_set(rotation, p);
    double a[4], b[4];
    pir_status status = bring_near_one(q, a);
    if (status == PIR_OK)
        status = bring_near_one(p, b);
    if (status != PIR_OK)
        return status;
    const pir_quat_product product =
        pir_quat_conjugate_times((pir_quat){a[0], a[1], a[2], a[3]}, (pir_quat){b[0], b[1], b[2], b[3]});
    status = pir_rotation_set(rotation, product.whole);
    if (status != PIR_OK)
        return status;
    rotation->rest = product.rest;
    rotation->relative = true;
    rotation->factor[0] = q;
    rotation->factor[1] = p;
    return PIR_OK;
}

/* The exponent of the lowest set bit of any component, or 1024, which is above all of a double. */
static int low_exponent(const double c[4]) {
    int low = 1024;
    for (int k = 0; k < 4; k++) {
        int e = pir_double_low_bit(c[k]);
        low = e < low ? e : low;
    }
    return low;
}

/* The components as integers on one scale; room: PIR_QUAT_LIMBS each. */
static void set_integers(pir_quat given, pir_int q[4]) {
    const double c[4] = {given.x, given.y, given.z, given.w};
    int low = low_exponent(c);
    for (int k = 0; k < 4; k++)
        pir_int_set_double(&q[k], c[k], low);
}

#if GMP_NUMB_BITS == 64
/* The product, where the components of both factors are short, as they are unless one is far smaller than another. */
static bool set_short_product(const pir_int a[4], const pir_int b[4], pir_int q[4]) {
    int64_t c[4], d[4];
    for (int k = 0; k < 4; k++)
        if (!pir_int_get_short(&a[k], &c[k]) || !pir_int_get_short(&b[k], &d[k]))
            return false;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        pir_int_set_two(&q[i], (pir_two_limbs)c[3] * d[i] - (pir_two_limbs)c[i] * d[3] - (pir_two_limbs)c[j] * d[k] +
                                   (pir_two_limbs)c[k] * d[j]);
    }
    pir_int_set_two(&q[3], (pir_two_limbs)c[0] * d[0] + (pir_two_limbs)c[1] * d[1] + (pir_two_limbs)c[2] * d[2] +
                               (pir_two_limbs)c[3] * d[3]);
    return true;
}
#else
static bool set_short_product(const pir_int a[4], const pir_int b[4], pir_int q[4]) {
    (void)a;
    (void)b;
    (void)q;
    return false;
}
#endif

/* conj(a)·b in integers, each factor in limbs of its own. */
static void set_product(const pir_quat factor[2], pir_int q[4]) {
    // and the product that pir_int_sum makes at a time
    mp_limb_t limbs[10 * PIR_QUAT_LIMBS + 1];
    pir_limbs room = {limbs, 0, 10 * PIR_QUAT_LIMBS + 1};
    pir_int a[4], b[4];
    for (int k = 0; k < 4; k++) {
        a[k] = pir_limbs_take(&room, PIR_QUAT_LIMBS);
        b[k] = pir_limbs_take(&room, PIR_QUAT_LIMBS);
    }
    set_integers(factor[0], a);
    set_integers(factor[1], b);
    if (set_short_product(a, b, q))
        return;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        const pir_term terms[4] = {
            {&a[3], &b[i], false}, {&a[i], &b[3], true}, {&a[j], &b[k], true}, {&a[k], &b[j], false}};
        pir_int_sum(&q[i], terms, 4, &room);
    }
    const pir_term terms[4] = {
        {&a[0], &b[0], false}, {&a[1], &b[1], false}, {&a[2], &b[2], false}, {&a[3], &b[3], false}};
    pir_int_sum(&q[3], terms, 4, &room);
}

/* Gives the integers of a quaternion its sign: see rotation.h. */
static void set_sign(pir_int q[4]) {
    static const int order[4] = {3, 0, 1, 2};
    int first = 0;
    while (first < 3 && q[order[first]].size == 0)
        first++;
    bool reverse = q[order[first]].size < 0;
    for (int k = 0; k < 4; k++)
        q[k].size = reverse ? -q[k].size : q[k].size;
}

/*
 * Components of a relative rotation from here on are within 2^-52 of themselves: rounding leaves less than 2^-100 of
 * factors that are of length 1 but for a power of two.
 */
#define LEAST_COMPONENT 0x1p-40

/* Whether the doubles of a relative rotation are zero where its integers are, and near them elsewhere. */
static bool has_zeros(pir_quat given, const pir_int q[4]) {
    const double c[4] = {given.x, given.y, given.z, given.w};
    bool has = true;
    for (int k = 0; k < 4; k++)
        has &= q[k].size == 0 ? c[k] == 0 : fabs(c[k]) >= LEAST_COMPONENT;
    return has;
}

/* The diagonal of M, w² ± x² ± y² ± z², and |q|², entry 3. */
static void set_diagonal(const pir_int q[4], pir_int *entry, int i, pir_limbs *scratch) {
    pir_term terms[4];
    for (int k = 0; k < 4; k++)
        terms[k] = (pir_term){&q[k], &q[k], i < 3 && k != 3 && k != i};
    pir_int_sum(entry, terms, 4, scratch);
}

/* Off the diagonal, with (i, j, k) cyclic: m_ij = 2 (q_i q_j − w q_k), m_ji = 2 (q_i q_j + w q_k). */
static void set_entry(const pir_int q[4], pir_int *entry, int i, bool transposed, pir_limbs *scratch) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    const pir_term of_v = {&q[i], &q[j], false}, of_w = {&q[3], &q[k], !transposed};
    pir_int_sum(entry, (const pir_term[4]){of_v, of_v, of_w, of_w}, 4, scratch);
}

#if GMP_NUMB_BITS == 64
/* M and |q|² where the components of q are short, as they are unless one is far smaller than another. */
static bool set_short(pir_rotation_integers *to) {
    int64_t q[4];
    for (int k = 0; k < 4; k++)
        if (!pir_int_get_short(&to->q[k], &q[k]))
            return false;
    pir_two_limbs square[4], norm = 0;
    for (int k = 0; k < 4; k++)
        norm += square[k] = (pir_two_limbs)q[k] * q[k];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        pir_two_limbs of_v = (pir_two_limbs)q[i] * q[j], of_w = (pir_two_limbs)q[3] * q[k];
        pir_int_set_two(&to->m[i][i], 2 * (square[i] + square[3]) - norm);
        pir_int_set_two(&to->m[i][j], 2 * (of_v - of_w));
        pir_int_set_two(&to->m[j][i], 2 * (of_v + of_w));
    }
    pir_int_set_two(&to->norm, norm);
    return true;
}

static pir_int256 product_of(pir_two_limbs a, pir_two_limbs b) {
    pir_int256 product = {{0}};
    pir_int256_add_product(&product, a, b);
    return product;
}

/* a + b, or a − b where `minus`. */
static pir_int256 sum_of(pir_int256 a, const pir_int256 *b, bool minus) {
    pir_two_limbs_unsigned carry = minus;
    for (int k = 0; k < 4; k++) {
        carry += (pir_two_limbs_unsigned)a.limb[k] + (minus ? ~b->limb[k] : b->limb[k]);
        a.limb[k] = (mp_limb_t)carry;
        carry >>= 64;
    }
    return a;
}

static pir_int256 twice(const pir_int256 *a) {
    return sum_of(*a, a, false);
}

/* M and |q|² where components are below 2^122, as those of a relative rotation mostly are; sums are below 2^246. */
static bool set_two(pir_rotation_integers *to) {
    pir_two_limbs q[4];
    for (int k = 0; k < 4; k++)
        if (!pir_int_get_two(&to->q[k], 122, &q[k]))
            return false;
    pir_int256 square[4], norm = {{0}};
    for (int k = 0; k < 4; k++) {
        square[k] = product_of(q[k], q[k]);
        norm = sum_of(norm, &square[k], false);
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        const pir_int256 of_v = product_of(q[i], q[j]), of_w = product_of(q[3], q[k]);
        const pir_int256 both = sum_of(square[i], &square[3], false), diagonal = sum_of(twice(&both), &norm, true);
        const pir_int256 less = sum_of(of_v, &of_w, true), more = sum_of(of_v, &of_w, false);
        const pir_int256 upper = twice(&less), lower = twice(&more);
        pir_int_set_wide(&to->m[i][i], &diagonal);
        pir_int_set_wide(&to->m[i][j], &upper);
        pir_int_set_wide(&to->m[j][i], &lower);
    }
    pir_int_set_wide(&to->norm, &norm);
    return true;
}
#else
static bool set_short(pir_rotation_integers *to) {
    (void)to;
    return false;
}

static bool set_two(pir_rotation_integers *to) {
    (void)to;
    return false;
}
#endif

void pir_rotation_make_exact(pir_rotation *rotation) {
    if (pir_rotation_has_integers(rotation))
        return;
    pir_rotation_integers *to = rotation->integers;
    pir_limbs room = {to->limbs, 0, PIR_ROTATION_LIMBS};
    pir_int *q = to->q;
    to->of = rotation;
    for (int k = 0; k < 4; k++)
        q[k] = pir_limbs_take(&room, PIR_QUAT_LIMBS);
    if (rotation->relative) {
        set_product(rotation->factor, q);
        rotation->has_zeros = has_zeros(rotation->given, q);
    } else {
        set_integers(rotation->given, q);
    }
    set_sign(q);
    for (int i = 0; i < 9; i++)
        to->m[i / 3][i % 3] = pir_limbs_take(&room, PIR_MATRIX_LIMBS);
    to->norm = pir_limbs_take(&room, PIR_MATRIX_LIMBS);
    rotation->has_exact = true;
    if (set_short(to) || set_two(to))
        return;
    mp_limb_t product[PIR_MATRIX_LIMBS];
    pir_limbs scratch = {product, 0, PIR_MATRIX_LIMBS};
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        set_diagonal(q, &to->m[i][i], i, &scratch);
        set_entry(q, &to->m[i][j], i, false, &scratch);
        set_entry(q, &to->m[j][i], i, true, &scratch);
    }
    set_diagonal(q, &to->norm, 3, &scratch);
}

void pir_rotation_apply(const pir_rotation *rotation, pir_int3 *dst, const pir_int3 *v, pir_limbs *scratch) {
    for (int i = 0; i < 3; i++) {
        const pir_int3 row = {{rotation->integers->m[i][0], rotation->integers->m[i][1], rotation->integers->m[i][2]}};
        pir_int3_dot(&dst->c[i], &row, v, scratch);
    }
}

void pir_rotation_apply_transposed(const pir_rotation *rotation, pir_int3 *dst, const pir_int3 *v, pir_limbs *scratch) {
    for (int i = 0; i < 3; i++) {
        const pir_int3 column = {
            {rotation->integers->m[0][i], rotation->integers->m[1][i], rotation->integers->m[2][i]}};
        pir_int3_dot(&dst->c[i], &column, v, scratch);
    }
}
