/* SPDX-License-Identifier: MIT */
/*
 * Exact integers made one from another on a stack of limbs: each result takes as many limbs as it needs at most.
 * Whoever computes notes limbs->used before and sets it back afterwards.
 */
#ifndef PIR_MESH_SIGNS_MESH_NUMBERS_H
#define PIR_MESH_SIGNS_MESH_NUMBERS_H

#include "base/vec.h"
#include "exact/integer.h"

/* Coordinates beyond this are refused, so that no product of three overflows and boxes have an area in floats. */
#define PIR_MESH_FARTHEST 0x1p60

static inline pir_int pir_num_double(pir_limbs *limbs, double x, int exponent) {
    int top = 0;
    (void)frexp(x, &top);
    pir_int r = pir_limbs_take(limbs, pir_double_limbs(top, exponent));
    pir_int_set_double(&r, x, exponent);
    return r;
}

static inline pir_int pir_num_mul(pir_limbs *limbs, const pir_int *a, const pir_int *b) {
    pir_int r = pir_limbs_take(limbs, pir_int_length(a) + pir_int_length(b) + 1);
    pir_int_mul(&r, a, b);
    return r;
}

static inline uint32_t pir_num_longer(const pir_int *a, const pir_int *b) {
    return (pir_int_length(a) > pir_int_length(b) ? pir_int_length(a) : pir_int_length(b)) + 1;
}

static inline pir_int pir_num_add(pir_limbs *limbs, const pir_int *a, const pir_int *b) {
    pir_int r = pir_limbs_take(limbs, pir_num_longer(a, b));
    pir_int_add(&r, a, b);
    return r;
}

static inline pir_int pir_num_sub(pir_limbs *limbs, const pir_int *a, const pir_int *b) {
    pir_int r = pir_limbs_take(limbs, pir_num_longer(a, b));
    pir_int_sub(&r, a, b);
    return r;
}

/* a·b − c·d. */
static inline pir_int pir_num_minor(pir_limbs *limbs, const pir_int *a, const pir_int *b, const pir_int *c,
                                    const pir_int *d) {
    pir_int ab = pir_num_mul(limbs, a, b), cd = pir_num_mul(limbs, c, d);
    return pir_num_sub(limbs, &ab, &cd);
}

static inline int pir_num_compare(pir_limbs *limbs, const pir_int *a, const pir_int *b) {
    uint32_t used = limbs->used;
    pir_int difference = pir_num_sub(limbs, a, b);
    limbs->used = used;
    return pir_int_sign(&difference);
}

static inline pir_int3 pir_num3_sub(pir_limbs *limbs, const pir_int3 *a, const pir_int3 *b) {
    return (pir_int3){{pir_num_sub(limbs, &a->c[0], &b->c[0]), pir_num_sub(limbs, &a->c[1], &b->c[1]),
                       pir_num_sub(limbs, &a->c[2], &b->c[2])}};
}

static inline pir_int3 pir_num3_add(pir_limbs *limbs, const pir_int3 *a, const pir_int3 *b) {
    return (pir_int3){{pir_num_add(limbs, &a->c[0], &b->c[0]), pir_num_add(limbs, &a->c[1], &b->c[1]),
                       pir_num_add(limbs, &a->c[2], &b->c[2])}};
}

static inline pir_int3 pir_num3_scale(pir_limbs *limbs, const pir_int3 *a, const pir_int *by) {
    return (pir_int3){
        {pir_num_mul(limbs, &a->c[0], by), pir_num_mul(limbs, &a->c[1], by), pir_num_mul(limbs, &a->c[2], by)}};
}

static inline pir_int3 pir_num3_cross(pir_limbs *limbs, const pir_int3 *a, const pir_int3 *b) {
    return (pir_int3){{pir_num_minor(limbs, &a->c[1], &b->c[2], &a->c[2], &b->c[1]),
                       pir_num_minor(limbs, &a->c[2], &b->c[0], &a->c[0], &b->c[2]),
                       pir_num_minor(limbs, &a->c[0], &b->c[1], &a->c[1], &b->c[0])}};
}

static inline pir_int pir_num3_dot(pir_limbs *limbs, const pir_int3 *a, const pir_int3 *b) {
    pir_int x = pir_num_mul(limbs, &a->c[0], &b->c[0]), y = pir_num_mul(limbs, &a->c[1], &b->c[1]);
    pir_int z = pir_num_mul(limbs, &a->c[2], &b->c[2]), xy = pir_num_add(limbs, &x, &y);
    return pir_num_add(limbs, &xy, &z);
}

static inline pir_int3 pir_num3_doubles(pir_limbs *limbs, pir_vec3 v, int exponent) {
    return (pir_int3){{pir_num_double(limbs, v.x, exponent), pir_num_double(limbs, v.y, exponent),
                       pir_num_double(limbs, v.z, exponent)}};
}

/* The exponent of the lowest bit set in any of three doubles; INT32_MAX where all are 0. */
static inline int pir_vec_low_bit(pir_vec3 v) {
    int x = pir_double_low_bit(v.x), y = pir_double_low_bit(v.y), z = pir_double_low_bit(v.z);
    int low = x < y ? x : y;
    return low < z ? low : z;
}

#endif
