/* SPDX-License-Identifier: MIT */
/*
 * Exact signs of s(a, b), and ties.
 *
 * As a form in q = (x, y, z, w) = (v, w), s = qᵀ·A·q with A symmetric: with c = a × b and d = a·b,
 *
 *     A_kl = a_k b_l + a_l b_k − δ_kl d,   A_kw = c_k,   A_ww = d         (k, l among x, y, z)
 *     (Aq)_k = a_k (b·v) + b_k (a·v) − d v_k + c_k w,   (Aq)_w = c·v + d w.
 *
 * Perturbed, s(q + ε) = s + 2 (Aq)·ε + εᵀAε. Each ε is smaller than every power of the one before, so monomials
 * rank by the power of ε₄ first, then of ε₃, and so on, the lower the greater:
 *
 *     1, ε₁, ε₁², ε₂, ε₁ε₂, ε₂², ε₃, ε₁ε₃, ε₂ε₃, ε₃², ε₄, ε₁ε₄,
 *     ε₂ε₄, ε₃ε₄, ε₄²
 *
 * and the first coefficient that is not zero gives the sign. One without ε₄ is not: were A_kl = 0 for all k and l
 * among x, y, z, then a bᵀ + b aᵀ = d I, of rank 2 at most, so that d = 0; then a_k b_l = −a_l b_k, and a_k b_k =
 * 0, whence a = 0 or b = 0.
 *
 * In most ties of real scenes every single product in s is zero: a body that turns on a table has two components of q
 * zero, and normals and edges along axes. Doubles settle these first. Then a_k b_k = 0 for every k; hence d = 0, A_kk =
 * 0, and A_kl is a single product, as c_k is. The other coefficients are sums like b·v. Such a sum is 0 when all its
 * products are 0. It has the sign of its double when that is not small beside the sum of the magnitudes of its
 * products. Otherwise the integers decide.
 */
#include "exact/sign.h"

#include <math.h>

pir_status pir_signs_reserve(pir_signs_room *room, const pir_allocator *allocator, uint32_t a_limbs, uint32_t b_limbs) {
    /*
     * No number is longer than `longest`: those of exact_sign are M·a, of PIR_MATRIX_LIMBS + a_limbs + 1 limbs, its
     * products with b, and sums of three of those; those of tie_sign are products of a, b and q with two carries, and q
     * is shorter than M. At a time live in the scratch
     *
     *   exact_sign   a row of M·a, the sum, a product                                     3
     *   tie_sign     a × b, a·b, a·v, b·v, a sum, a product                               8
     *   edge_pair.c  M·e, d × M·e, a product; then, the product gone, M·n and a product  10
     */
    uint32_t longest = PIR_MATRIX_LIMBS + a_limbs + b_limbs + 4;
    uint32_t capacity = 10 * longest;
    if (capacity <= room->scratch.capacity)
        return PIR_OK;
    mp_limb_t *base = PIR_NEW(allocator, mp_limb_t, capacity);
    if (!base)
        return PIR_ERR_MEMORY;
    pir_signs_room_finish(room, allocator);
    room->scratch = (pir_limbs){base, 0, capacity};
    return PIR_OK;
}

void pir_signs_room_finish(pir_signs_room *room, const pir_allocator *allocator) {
    PIR_FREE(allocator, room->scratch.base, room->scratch.capacity);
    room->scratch = (pir_limbs){0};
}

void pir_signs_init(pir_signs *signs, pir_signs_room *room) {
    *signs = (pir_signs){.rotation = {.integers = &room->rotation}, .scratch = &room->scratch};
}

/* The sign of s at the rotation itself; counts nothing. */
static int exact_sign(pir_signs *signs, const pir_int3 *a, const pir_int3 *b) {
    pir_rotation *rotation = &signs->rotation;
    pir_limbs *scratch = signs->scratch;
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
            pir_int_add_mul(&row, &rotation->integers->m[i][j], &a->c[j], scratch);
        pir_int_add_mul(&s, &row, &b->c[i], scratch);
    }
    scratch->used = mark;
    return pir_int_sign(&s);
}

int pir_sign_true(pir_signs *signs, const pir_int3 *a, const pir_int3 *b) {
    signs->by_exact++;
    return exact_sign(signs, a, b);
}

/* The inputs of a tie's coefficients. */
struct tie {
    const pir_int3 *a, *b;
    const pir_int *q; /* x, y, z, w */
    pir_int3 c;       /* a × b */
    pir_int d;        /* a·b */
    pir_int av, bv;   /* a·v, b·v */
    pir_int sum;
};

/* The sign of (Aq)_k, k among x, y, z. */
static int gradient_sign(struct tie *tie, int k, pir_limbs *scratch) {
    const pir_int *q = tie->q;
    tie->sum.size = 0;
    pir_int_add_mul(&tie->sum, &tie->a->c[k], &tie->bv, scratch);
    pir_int_add_mul(&tie->sum, &tie->b->c[k], &tie->av, scratch);
    pir_int_sub_mul(&tie->sum, &tie->d, &q[k], scratch);
    pir_int_add_mul(&tie->sum, &tie->c.c[k], &q[3], scratch);
    return pir_int_sign(&tie->sum);
}

/* The sign of A_kl, l ≤ k, both among x, y, z. */
static int form_sign(struct tie *tie, int k, int l, pir_limbs *scratch) {
    tie->sum.size = 0;
    pir_int_add_mul(&tie->sum, &tie->a->c[k], &tie->b->c[l], scratch);
    pir_int_add_mul(&tie->sum, &tie->a->c[l], &tie->b->c[k], scratch);
    if (k == l)
        pir_int_sub(&tie->sum, &tie->sum, &tie->d);
    return pir_int_sign(&tie->sum);
}

/* The sign of the greatest non-zero monomial of s(q + ε) − s(q). */
static int tie_sign(pir_signs *signs, const pir_int3 *a, const pir_int3 *b) {
    pir_limbs *scratch = signs->scratch;
    uint32_t mark = scratch->used;
    uint32_t la = pir_int3_length(a), lb = pir_int3_length(b);
    struct tie tie = {.a = a, .b = b, .q = signs->rotation.integers->q};
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
    for (int k = 0; k < 3 && sign == 0; k++) {
        sign = gradient_sign(&tie, k, scratch);
        for (int l = 0; l <= k && sign == 0; l++)
            sign = form_sign(&tie, k, l, scratch);
    }
    scratch->used = mark;
    PIR_ASSERT(sign != 0);
    return sign;
}

/* --- ties by doubles --- */

/* Components of q from here to the inverse, and integers below 2^53, have products that neither overflow nor vanish. */
#define SMALLEST 0x1p-200

/* Sums below are off by less than 16u = 2^-49 of what the magnitudes of their terms add up to. */
#define RELATIVE_BOUND 0x1p-48

/* A sum and the sum of the magnitudes. */
struct sized {
    double sum, size;
};

/* 1 or −1 by doubles, 0 for zero, TOO_CLOSE when they cannot say. */
enum { TOO_CLOSE = 2 };

static int sized_sign(struct sized x) {
    if (x.size == 0)
        return 0;
    return fabs(x.sum) > RELATIVE_BOUND * x.size ? (x.sum > 0) - (x.sum < 0) : TOO_CLOSE;
}

static void add_term(struct sized *x, double term, double size) {
    x->sum += term;
    x->size += size;
}

/* a as doubles; false when they do not hold it exactly. */
static bool small_vector(const pir_int3 *a, double ret_small[3]) {
    for (int k = 0; k < 3; k++) {
        if (a->c[k].size < -1 || a->c[k].size > 1 || (a->c[k].size != 0 && (uint64_t)a->c[k].limb[0] >> 53 != 0))
            return false;
        ret_small[k] = a->c[k].size == 0 ? 0 : (double)a->c[k].limb[0] * a->c[k].size;
    }
    return true;
}

static bool is_tame(const double q[4]) {
    for (int k = 0; k < 4; k++)
        if (q[k] != 0 && !(fabs(q[k]) > SMALLEST && fabs(q[k]) < 1 / SMALLEST))
            return false;
    return true;
}

/* Whether every product in s is zero. */
static bool vanishes(const double q[4], const double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            if (a[j] == 0 || b[i] == 0)
                continue;
            int k = 3 - i - j;
            if (i == j || q[i] * q[j] != 0 || q[3] * q[k] != 0)
                return false;
        }
    return true;
}

/* tie_sign by doubles where s vanishes product by product, or TOO_CLOSE. */
static int small_tie_sign(const double q[4], const double a[3], const double b[3]) {
    struct sized av = {0, 0}, bv = {0, 0};
    for (int k = 0; k < 3; k++) {
        add_term(&av, a[k] * q[k], fabs(a[k] * q[k]));
        add_term(&bv, b[k] * q[k], fabs(b[k] * q[k]));
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        double turn = (a[i] * b[j] - a[j] * b[i]) * q[3];
        struct sized x = {0, 0};
        add_term(&x, a[k] * bv.sum, fabs(a[k]) * bv.size);
        add_term(&x, b[k] * av.sum, fabs(b[k]) * av.size);
        add_term(&x, turn, fabs(turn));
        int sign = sized_sign(x);
        for (int l = 0; l < k && sign == 0; l++) {
            double form = a[k] * b[l] + a[l] * b[k];
            sign = (form > 0) - (form < 0);
        }
        if (sign != 0)
            return sign;
    }
    return TOO_CLOSE;
}

/* The sign of a tie that doubles can see and settle, or 0. */
static int small_sign(pir_signs *signs, const pir_int3 *a, const pir_int3 *b) {
    const pir_quat signed_q = pir_quat_signed(signs->rotation.given);
    const double q[4] = {signed_q.x, signed_q.y, signed_q.z, signed_q.w};
    double x[3], y[3];
    if (signs->rotation.relative) {
        // its doubles are rounded, so they tell a zero only where the integers say so too
        pir_rotation_make_exact(&signs->rotation);
        if (!signs->rotation.has_zeros)
            return 0;
    }
    if (!is_tame(q) || !small_vector(a, x) || !small_vector(b, y) || !vanishes(q, x, y))
        return 0;
    int sign = small_tie_sign(q, x, y);
    return sign == TOO_CLOSE ? 0 : sign;
}

int pir_sign_perturbed(pir_signs *signs, const pir_int3 *a, const pir_int3 *b) {
    int sign = small_sign(signs, a, b);
    if (sign != 0) {
        signs->by_perturbation++;
        return sign;
    }
    sign = exact_sign(signs, a, b);
    if (sign != 0) {
        signs->by_exact++;
        return sign;
    }
    signs->by_perturbation++;
    return tie_sign(signs, a, b);
}
