/* SPDX-License-Identifier: MIT */
/*
 * Signs at roots of quadratics.
 *
 * With p = a·k² + b·k + c and the exit root k = (−B − √D)/(2A) of A·k² + B·k + C, where D = B² − 4AC,
 *
 *     2A²·p(k) = X − √D·Y,   X = a (B² − 2AC) − A b B + 2A² c,   Y = A b − a B,
 *
 * whose sign is that of X, of −Y, or of ±(X² − D Y²). Where A = 0 the exit root is −C/B, and B²·p = aC²
 * − bBC + cB².
 */
#include "motion/quadratic.h"

#include <math.h>

static uint32_t length_of(const pir_quadratic *p) {
    uint32_t most = 0;
    for (int i = 0; i < 3; i++)
        if (pir_int_length(&p->c[i]) > most)
            most = pir_int_length(&p->c[i]);
    return most;
}

pir_quadratic pir_quadratic_take(pir_limbs *scratch, uint32_t limbs) {
    pir_quadratic p;
    for (int i = 0; i < 3; i++)
        p.c[i] = pir_limbs_take(scratch, limbs);
    return p;
}

bool pir_quadratic_is_zero(const pir_quadratic *p) {
    return p->c[0].size == 0 && p->c[1].size == 0 && p->c[2].size == 0;
}

/* The product in room taken from scratch. */
static pir_int product_of(const pir_int *a, const pir_int *b, pir_limbs *scratch) {
    pir_int product = pir_limbs_take(scratch, pir_int_length(a) + pir_int_length(b) + 1);
    if (a->size != 0 && b->size != 0)
        pir_int_mul(&product, a, b);
    return product;
}

/* B² − `times`·AC in room taken from scratch, `times` 2 or 4. */
static pir_int square_less(const pir_quadratic *p, uint32_t times, pir_limbs *scratch) {
    pir_int d = pir_limbs_take(scratch, 2 * length_of(p) + 2), square = product_of(&p->c[1], &p->c[1], scratch);
    pir_int product = pir_limbs_take(scratch, 2 * length_of(p) + 2);
    if (p->c[0].size != 0 && p->c[2].size != 0) {
        pir_int_mul(&product, &p->c[0], &p->c[2]);
        pir_int_shift_left(&product, &product, times == 2 ? 1 : 2);
    }
    pir_int_sub(&d, &square, &product);
    return d;
}

bool pir_quadratic_has_exit(const pir_quadratic *p, pir_limbs *scratch) {
    if (p->c[0].size == 0)
        return p->c[1].size < 0;
    const uint32_t mark = scratch->used;
    const pir_int d = square_less(p, 4, scratch);
    scratch->used = mark;
    return d.size >= 0;
}

static int sign_at_linear(const pir_quadratic *p, const pir_quadratic *root, pir_limbs *scratch) {
    const pir_int *b = &root->c[1], *c = &root->c[2];
    const pir_int cc = product_of(c, c, scratch), bc = product_of(b, c, scratch), bb = product_of(b, b, scratch);
    pir_int sum = pir_limbs_take(scratch, 2 * length_of(root) + length_of(p) + 3);
    pir_int_add_mul(&sum, &p->c[0], &cc, scratch);
    pir_int_sub_mul(&sum, &p->c[1], &bc, scratch);
    pir_int_add_mul(&sum, &p->c[2], &bb, scratch);
    return pir_int_sign(&sum);
}

/* The sign of x − √d·y, d ≥ 0. */
static int sign_with_root(const pir_int *x, const pir_int *y, const pir_int *d, pir_limbs *scratch) {
    const int sx = pir_int_sign(x), sy = d->size == 0 ? 0 : -pir_int_sign(y);
    if (sx == 0 || sy == 0 || sx == sy)
        return sx != 0 ? sx : sy;
    const pir_int xx = product_of(x, x, scratch), yy = product_of(y, y, scratch), yyd = product_of(&yy, d, scratch);
    pir_int difference = pir_limbs_take(scratch, (xx.room > yyd.room ? xx.room : yyd.room) + 1);
    pir_int_sub(&difference, &xx, &yyd);
    return sx * pir_int_sign(&difference);
}

static int sign_at_quadratic(const pir_quadratic *p, const pir_quadratic *root, pir_limbs *scratch) {
    const pir_int *a = &root->c[0], *b = &root->c[1];
    const pir_int d = square_less(root, 4, scratch), half = square_less(root, 2, scratch);
    const uint32_t lp = length_of(p), lr = length_of(root);
    pir_int y = pir_limbs_take(scratch, lp + lr + 2), x = pir_limbs_take(scratch, lp + 2 * lr + 4);
    // x is a (B² − 2AC) + 2A (A c) − B (A b)
    pir_int product = product_of(&p->c[2], a, scratch), twice = pir_limbs_take(scratch, lp + lr + 2);
    pir_int_add(&twice, &product, &product);
    pir_int_add_mul(&x, &p->c[0], &half, scratch);
    pir_int_add_mul(&x, &twice, a, scratch);
    product = product_of(a, &p->c[1], scratch);
    pir_int_sub_mul(&x, &product, b, scratch);
    pir_int_add(&y, &y, &product);
    pir_int_sub_mul(&y, &p->c[0], b, scratch);
    return sign_with_root(&x, &y, &d, scratch);
}

int pir_quadratic_sign_at(const pir_quadratic *p, const pir_quadratic *root, pir_limbs *scratch) {
    if (p->c[0].size == 0 && p->c[1].size == 0)
        return pir_int_sign(&p->c[2]);
    const uint32_t mark = scratch->used;
    const int sign = root->c[0].size == 0 ? sign_at_linear(p, root, scratch) : sign_at_quadratic(p, root, scratch);
    scratch->used = mark;
    return sign;
}

/* The sign of the derivative at the exit root of `root`. */
static int slope_at(const pir_quadratic *p, const pir_quadratic *root, pir_limbs *scratch) {
    const uint32_t mark = scratch->used;
    pir_quadratic slope = {{{0}, pir_limbs_take(scratch, pir_int_length(&p->c[0]) + 1), p->c[1]}};
    pir_int_add(&slope.c[1], &p->c[0], &p->c[0]);
    const int sign = pir_quadratic_sign_at(&slope, root, scratch);
    scratch->used = mark;
    return sign;
}

int pir_quadratic_sign_before(const pir_quadratic *p, const pir_quadratic *root, pir_limbs *scratch) {
    int sign = pir_quadratic_sign_at(p, root, scratch);
    if (sign == 0)
        sign = slope_at(p, root, scratch);
    return sign != 0 ? sign : pir_int_sign(&p->c[0]);
}

int pir_quadratic_sign_after(const pir_quadratic *p, const pir_quadratic *root, pir_limbs *scratch) {
    int sign = pir_quadratic_sign_at(p, root, scratch);
    if (sign == 0)
        sign = -slope_at(p, root, scratch);
    return sign != 0 ? sign : pir_int_sign(&p->c[0]);
}

int pir_quadratic_sign_first(const pir_quadratic *p) {
    for (int i = 0; i < 3; i++)
        if (p->c[i].size != 0)
            return pir_int_sign(&p->c[i]);
    return 0;
}

int pir_quadratic_compare(const pir_quadratic *a, const pir_quadratic *b, pir_limbs *scratch) {
    // a falls through its exit root as k rises: where it falls, its sign tells on which side of the root k is
    const int sign = pir_quadratic_sign_at(a, b, scratch), leading = pir_int_sign(&a->c[0]);
    if (leading == 0)
        return sign;
    const int slope = slope_at(a, b, scratch);
    if (slope < 0 || (slope == 0 && sign == 0))
        return sign;
    return -leading;
}

/* --- doubles --- */

static pir_scaled scaled_of(const pir_int *a) {
    pir_scaled x;
    x.m = pir_int_to_double(a, &x.e);
    return x;
}

/* The sum of two of one sign. */
static pir_scaled add_scaled(pir_scaled a, pir_scaled b) {
    if (a.m == 0 || (b.m != 0 && b.e > a.e)) {
        const pir_scaled other = a;
        a = b;
        b = other;
    }
    if (b.m != 0 && a.e - b.e < 200)
        a.m += ldexp(b.m, b.e - a.e);
    return a;
}

static pir_scaled scaled_root(pir_scaled d) {
    if (d.e % 2 != 0) {
        d.m *= 2;
        d.e--;
    }
    return (pir_scaled){sqrt(d.m), d.e / 2};
}

void pir_quadratic_approximate(const pir_quadratic *p, pir_scaled *ret_sigma, pir_scaled *ret_tau, pir_limbs *scratch) {
    const uint32_t mark = scratch->used;
    const pir_int d = square_less(p, 4, scratch);
    pir_scaled root = scaled_root(scaled_of(&d)), b = scaled_of(&p->c[1]), sigma, tau;
    scratch->used = mark;
    // −B − √D over 2A, or the same as 2C over √D − B: the sum of two of one sign
    if (b.m >= 0) {
        sigma = add_scaled(b, root);
        sigma.m = -sigma.m;
        tau = scaled_of(&p->c[0]);
        tau.e++;
    } else {
        b.m = -b.m;
        tau = add_scaled(b, root);
        sigma = scaled_of(&p->c[2]);
        sigma.e++;
    }
    if (tau.m < 0) {
        sigma.m = -sigma.m;
        tau.m = -tau.m;
    }
    *ret_sigma = sigma;
    *ret_tau = tau;
}

uint32_t pir_double_power_limbs(int exponent) {
    return (uint32_t)((exponent < 0 ? -exponent : exponent) + 2300) / GMP_NUMB_BITS + 2;
}

void pir_quadratic_of_double(pir_quadratic *dst, double x, int exponent) {
    int low = pir_double_low_bit(x);
    for (int i = 0; i < 3; i++)
        dst->c[i].size = 0;
    pir_int_set_double(&dst->c[1], -1, 0);
    if (x == 0)
        return;
    pir_int_set_double(&dst->c[2], x, low);
    // x·2^-exponent is an integer times 2^(low − exponent)
    const int shift = low - exponent;
    pir_int *scaled = &dst->c[shift < 0 ? 1 : 2];
    pir_int_shift_left(scaled, scaled, (uint32_t)(shift < 0 ? -shift : shift));
}
