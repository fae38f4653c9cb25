/* SPDX-License-Identifier: MIT */
/* See turning.h. */
#include "motion/turning.h"

#include <string.h>

#include "base/memory.h"
#include "base/vec.h"

/* --- integers --- */

struct turning_integers {
    pir_rotation_integers rotation;
    pir_limbs scratch;
    pir_int3 u;
    pir_int square; /* |u|² */
};

/* u as integers without a common power of two, and the exponent of their unit. */
static void make_axis(pir_turning *turning, pir_int3 *u) {
    const double c[3] = {turning->axis.x, turning->axis.y, turning->axis.z};
    int low = INT32_MAX;
    for (int k = 0; k < 3; k++) {
        const int bit = pir_double_low_bit(c[k]);
        low = bit < low ? bit : low;
    }
    for (int k = 0; k < 3; k++)
        pir_int_set_double(&u->c[k], c[k], low);
    turning->exponent = low;
}

/* C1 = 2 [u]×·M: row j is twice u_{j+1} M_{j+2} − u_{j+2} M_{j+1}. */
static void make_cross(const struct turning_integers *integers, int j, int i, pir_int *dst, pir_limbs *scratch) {
    const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    dst->size = 0;
    pir_int_add_mul(dst, &integers->u.c[j1], &integers->rotation.m[j2][i], scratch);
    pir_int_sub_mul(dst, &integers->u.c[j2], &integers->rotation.m[j1][i], scratch);
    pir_int_add(dst, dst, dst);
}

/* C2 = 2 u·(uᵀM) − |u|² M. */
static void make_reflected(const struct turning_integers *integers, int j, int i, pir_int *dst, pir_limbs *scratch) {
    const uint32_t mark = scratch->used;
    pir_int along = pir_limbs_take(scratch, dst->room);
    for (int k = 0; k < 3; k++)
        pir_int_add_mul(&along, &integers->u.c[k], &integers->rotation.m[k][i], scratch);
    pir_int_add(&along, &along, &along);
    dst->size = 0;
    pir_int_add_mul(dst, &integers->u.c[j], &along, scratch);
    pir_int_sub_mul(dst, &integers->square, &integers->rotation.m[j][i], scratch);
    scratch->used = mark;
}

static void make_matrices(pir_turning *turning, struct turning_integers *integers) {
    pir_limbs *scratch = &integers->scratch;
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            pir_int_copy(&turning->matrix[0][j][i], &integers->rotation.m[j][i]);
            make_cross(integers, j, i, &turning->matrix[1][j][i], scratch);
            make_reflected(integers, j, i, &turning->matrix[2][j][i], scratch);
        }
    turning->entry_limbs = 1;
    for (int n = 0; n < 27; n++) {
        const uint32_t length = pir_int_length(&turning->matrix[n / 9][n / 3 % 3][n % 3]);
        turning->entry_limbs = length > turning->entry_limbs ? length : turning->entry_limbs;
    }
}

/* √|u|² in doubles. */
static pir_scaled length_of(const pir_int *square) {
    pir_scaled s;
    s.m = pir_int_to_double(square, &s.e);
    if (s.e % 2 != 0) {
        s.m *= 2;
        s.e--;
    }
    return (pir_scaled){sqrt(s.m), s.e / 2};
}

/* Rooms: an entry of C2 is a sum of six products of u, u and M, one of C1 of two of u and M. */
static bool make_integers(pir_turning *turning, const pir_allocator *a) {
    const uint32_t axis_limbs = PIR_QUAT_LIMBS;
    const size_t own = 3 * axis_limbs + 2 * axis_limbs + 1 + 6 * (2 * axis_limbs + PIR_MATRIX_LIMBS + 3);
    struct turning_integers *integers = PIR_NEW(a, struct turning_integers, 1);
    mp_limb_t *limbs = PIR_NEW(a, mp_limb_t, own);
    bool done = false;
    if (integers && limbs) {
        turning->rotation.integers = &integers->rotation;
        turning->rotation.has_exact = false;
        integers->rotation.of = NULL;
        pir_rotation_make_exact(&turning->rotation);
        integers->scratch = (pir_limbs){limbs, 0, (uint32_t)own};
        integers->u = pir_int3_take(&integers->scratch, axis_limbs);
        make_axis(turning, &integers->u);
        integers->square = pir_limbs_take(&integers->scratch, 2 * axis_limbs + 1);
        pir_int3_dot(&integers->square, &integers->u, &integers->u, &integers->scratch);
        turning->length = length_of(&integers->square);
        uint32_t longest = 0;
        for (int n = 0; n < 9; n++) {
            const uint32_t length = pir_int_length(&integers->rotation.m[n / 3][n % 3]);
            longest = length > longest ? length : longest;
        }
        const uint32_t room = longest + pir_int_length(&integers->square) + pir_int3_length(&integers->u) + 3;
        turning->limb_count = (size_t)27 * room;
        turning->limbs = PIR_NEW(a, mp_limb_t, turning->limb_count);
        for (int n = 0; turning->limbs && n < 27; n++)
            turning->matrix[n / 9][n / 3 % 3][n % 3] = (pir_int){turning->limbs + (size_t)n * room, 0, room};
        if (turning->limbs)
            make_matrices(turning, integers);
        done = turning->limbs != NULL;
    }
    PIR_FREE(a, limbs, own);
    PIR_FREE(a, integers, 1);
    turning->rotation.integers = NULL;
    turning->rotation.has_exact = false;
    return done;
}

pir_status pir_turning_init(pir_turning *turning, const pir_allocator *allocator, pir_vec3 axis,
                            const pir_rotation *rotation) {
    if (!pir_vec_is_finite(axis))
        return PIR_ERR_NOT_FINITE;
    const double most = fmax(fabs(axis.x), fmax(fabs(axis.y), fabs(axis.z)));
    if (most == 0)
        return PIR_ERR_ARGUMENT;
    *turning = (pir_turning){.axis = axis, .rotation = *rotation};
    int top;
    frexp(most, &top);
    const pir_vec3 scaled = {ldexp(axis.x, -top), ldexp(axis.y, -top), ldexp(axis.z, -top)};
    turning->unit = pir_vec_scale(scaled, 1 / pir_vec_length(scaled));
    return make_integers(turning, allocator) ? PIR_OK : PIR_ERR_MEMORY;
}

void pir_turning_finish(pir_turning *turning, const pir_allocator *allocator) {
    PIR_FREE(allocator, turning->limbs, turning->limb_count);
    turning->limbs = NULL;
}

void pir_turning_quadratic(const pir_turning *turning, const pir_int3 *x, const pir_int3 *y, pir_quadratic *dst,
                           pir_limbs *scratch) {
    for (int n = 0; n < 3; n++)
        dst->c[n].size = 0;
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            if (y->c[j].size == 0 || x->c[i].size == 0)
                continue;
            const uint32_t mark = scratch->used;
            pir_int product = pir_limbs_take(scratch, pir_int_length(&y->c[j]) + pir_int_length(&x->c[i]));
            pir_int_mul(&product, &y->c[j], &x->c[i]);
            for (int n = 0; n < 3; n++)
                pir_int_add_mul(&dst->c[n], &turning->matrix[n][j][i], &product, scratch);
            scratch->used = mark;
        }
}

/* --- doubles --- */

/* Of x' and u, both of length 1: x', ±2 u × x', 2 (u·x') u − x'. */
static pir_form form_of(pir_vec3 turned, pir_vec3 u, double way) {
    return (pir_form){{turned, pir_vec_scale(pir_vec_cross(u, turned), 2 * way),
                       pir_vec_sub(pir_vec_scale(u, 2 * pir_vec_dot(u, turned)), turned)}};
}

pir_form pir_turning_form_p(const pir_turning *turning, pir_vec3 x) {
    return form_of(pir_mat_apply(&turning->rotation.r, x), turning->unit, 1);
}

pir_form pir_turning_form_q(const pir_turning *turning, pir_vec3 y) {
    // (u × x')·y = −(u × y)·x'
    return form_of(y, turning->unit, -1);
}

void pir_turning_degrees(pir_scaled length, int exponent, const double kappa[2], double ret_degrees[2]) {
    for (int k = 0; k < 2; k++) {
        // the axis's length is m·2^e, off by less than 2^-51, and so the angle; libm adds a few last bits
        const double scaled = ldexp(kappa[1 - k], -(length.e + exponent));
        const double degrees = 2 * atan2(length.m, scaled) * (180 / 3.14159265358979323846);
        ret_degrees[k] = degrees * (k == 0 ? 1 - 0x1p-49 : 1 + 0x1p-49);
    }
    ret_degrees[0] = fmax(ret_degrees[0], 0);
    ret_degrees[1] = fmin(ret_degrees[1], 360);
}

/* to = a·2^bits. */
static void set_mpz(mpz_t to, const pir_int *a, int bits) {
    mpz_import(to, pir_int_length(a), -1, sizeof(mp_limb_t), 0, 0, a->limb);
    if (a->size < 0)
        mpz_neg(to, to);
    mpz_mul_2exp(to, to, (mp_bitcnt_t)bits);
}

void pir_turning_polynomial(const pir_quadratic *root, int exponent, mpz_t *ret_coefficients) {
    // k = κ·2^-e: c0·2^-2e·κ² + c1·2^-e·κ + c2
    const int e = exponent;
    for (int i = 0; i < 3; i++)
        set_mpz(ret_coefficients[i], &root->c[i], e < 0 ? (2 - i) * -e : i * e);
    mpz_t divisor;
    mpz_init(divisor);
    for (int i = 0; i < 3; i++)
        mpz_gcd(divisor, divisor, ret_coefficients[i]);
    if (mpz_sgn(ret_coefficients[0]) < 0 || (mpz_sgn(ret_coefficients[0]) == 0 && mpz_sgn(ret_coefficients[1]) < 0))
        mpz_neg(divisor, divisor);
    for (int i = 0; i < 3; i++)
        mpz_divexact(ret_coefficients[i], ret_coefficients[i], divisor);
    mpz_clear(divisor);
}
