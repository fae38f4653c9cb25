/* SPDX-License-Identifier: MIT */
/*
 * Exact signs of s(a, b), and ties.
 *
 * As a form in q = (x, y, z, w) = (v, w), s = qᵀ·A·q with A symmetric: with c = a × b and d = a·b,
 *
 *     A_kl = a_k b_l + a_l b_k − δ_kl d,   A_kw = c_k,   A_ww = d         (k, l among x, y, z)
 *     (Aq)_k = a_k (b·v) + b_k (a·v) − d v_k + c_k w,   (Aq)_w = c·v + d w.
 *
 * Perturbed, s(q + ε) = s + 2 (Aq)·ε + εᵀAε. Each ε is smaller than every power of the one before, so monomials rank by the power of ε₄
 * first, then of ε₃, and so on, the lower the greater:
 *
 *     1, ε₁, ε₁², ε₂, ε₁ε₂, ε₂², ε₃, ε₁ε₃, ε₂ε₃, ε₃², ε₄, ε₁ε₄, ε₂ε₄, ε₃ε₄, ε₄²
 *
 * and the first coefficient that is not zero gives the sign. One is not: A = 0 means d = 0 and c = 0, hence a = 0 or b = 0.
 */
#include "exact/sign.h"

pir_status pir_signs_init(pir_signs *signs, const pir_allocator *allocator, uint32_t a_limbs, uint32_t b_limbs) {
    // M·a and the sum of its products with b; a tie takes a × b, a·b, two more dot products and a sum: all shorter than six of these
    uint32_t longest = PIR_MATRIX_LIMBS + a_limbs + b_limbs + 4;
    uint32_t capacity = 16 * longest;
    mp_limb_t *base = PIR_NEW(allocator, mp_limb_t, capacity);
    if (!base)
        return PIR_ERR_MEMORY;
    signs->scratch = (pir_limbs){base, 0, capacity};
    signs->rotation.has_exact = false;
    signs->by_filter = signs->by_exact = signs->by_perturbation = 0;
    return PIR_OK;
}

void pir_signs_finish(pir_signs *signs, const pir_allocator *allocator) {
    PIR_FREE(allocator, signs->scratch.base, signs->scratch.capacity);
    signs->scratch = (pir_limbs){0};
}

/* The sign of s at the rotation itself; counts nothing. */
static int exact_sign(pir_signs *signs, const pir_int3 *a, const pir_int3 *b) {
    pir_rotation *rotation = &signs->rotation;
    pir_limbs *scratch = &signs->scratch;
    pir_rotation_make_exact(rotation);
    uint32_t mark = scratch->used;
    uint32_t la = pir_int3_length(a), lb = pir_int3_length(b);
    pir_int row = pir_limbs_take(scratch, PIR_MATRIX_LIMBS + la + 1);
    pir_int s = pir_limbs_take(scratch, PIR_MATRIX_LIMBS + la + lb + 2);
    for (int i = 0; i < 3; i++) {
        if (b->c[i].size == 0)
            continue;
        row.size = 0;
        for (int j = 0; j < 3; j++)
            pir_int_add_mul(&row, &rotation->m[i][j], &a->c[j], scratch);
        pir_int_add_mul(&s, &row, &b->c[i], scratch);
    }
    scratch->used = mark;
    return pir_int_sign(&s);
}

int pir_sign_true(pir_signs *signs, const pir_int3 *a, const pir_int3 *b) {
    signs->by_exact++;
    return exact_sign(signs, a, b);
}

/* What the coefficients of a tie are made of. */
struct tie {
    const pir_int3 *a, *b;
    const pir_int *q; /* x, y, z, w */
    pir_int3 c;       /* a × b */
    pir_int d;        /* a·b */
    pir_int av, bv;   /* a·v, b·v */
    pir_int sum;
};

/* The sign of (Aq)_k, k = 3 for w. */
static int gradient_sign(struct tie *tie, int k, pir_limbs *scratch) {
    const pir_int *q = tie->q;
    tie->sum.size = 0;
    if (k == 3) {
        for (int l = 0; l < 3; l++)
            pir_int_add_mul(&tie->sum, &tie->c.c[l], &q[l], scratch);
        pir_int_add_mul(&tie->sum, &tie->d, &q[3], scratch);
    } else {
        pir_int_add_mul(&tie->sum, &tie->a->c[k], &tie->bv, scratch);
        pir_int_add_mul(&tie->sum, &tie->b->c[k], &tie->av, scratch);
        pir_int_sub_mul(&tie->sum, &tie->d, &q[k], scratch);
        pir_int_add_mul(&tie->sum, &tie->c.c[k], &q[3], scratch);
    }
    return pir_int_sign(&tie->sum);
}

/* The sign of A_kl, l ≤ k. */
static int form_sign(struct tie *tie, int k, int l, pir_limbs *scratch) {
    if (k == 3)
        return pir_int_sign(l == 3 ? &tie->d : &tie->c.c[l]);
    tie->sum.size = 0;
    pir_int_add_mul(&tie->sum, &tie->a->c[k], &tie->b->c[l], scratch);
    pir_int_add_mul(&tie->sum, &tie->a->c[l], &tie->b->c[k], scratch);
    if (k == l)
        pir_int_sub(&tie->sum, &tie->sum, &tie->d);
    return pir_int_sign(&tie->sum);
}

/* The sign of the greatest non-zero monomial of s(q + ε) − s(q). */
static int tie_sign(pir_signs *signs, const pir_int3 *a, const pir_int3 *b) {
    pir_limbs *scratch = &signs->scratch;
    uint32_t mark = scratch->used;
    uint32_t la = pir_int3_length(a), lb = pir_int3_length(b);
    struct tie tie = {.a = a, .b = b, .q = signs->rotation.q};
    pir_int3 v = {{tie.q[0], tie.q[1], tie.q[2]}};
    tie.c = pir_int3_take(scratch, la + lb + 1);
    pir_int3_cross(&tie.c, a, b, scratch);
    tie.d = pir_limbs_take(scratch, la + lb + 1);
    pir_int3_dot(&tie.d, a, b, scratch);
    tie.av = pir_limbs_take(scratch, la + PIR_QUAT_LIMBS + 1);
    pir_int3_dot(&tie.av, a, &v, scratch);
    tie.bv = pir_limbs_take(scratch, lb + PIR_QUAT_LIMBS + 1);
    pir_int3_dot(&tie.bv, b, &v, scratch);
    tie.sum = pir_limbs_take(scratch, la + lb + PIR_QUAT_LIMBS + 4);
    int sign = 0;
    for (int k = 0; k < 4 && sign == 0; k++) {
        sign = gradient_sign(&tie, k, scratch);
        for (int l = 0; l <= k && sign == 0; l++)
            sign = form_sign(&tie, k, l, scratch);
    }
    scratch->used = mark;
    PIR_ASSERT(sign != 0);
    return sign;
}

int pir_sign_perturbed(pir_signs *signs, const pir_int3 *a, const pir_int3 *b) {
    int sign = exact_sign(signs, a, b);
    if (sign != 0) {
        signs->by_exact++;
        return sign;
    }
    signs->by_perturbation++;
    return tie_sign(signs, a, b);
}
