/* SPDX-License-Identifier: MIT */
/*
 * Sturm's theorem: of a polynomial without double factors the changes of sign along its chain of remainders, at a less
 * those at b, are the number of its roots in (a, b]. A common root of two polynomials is one of their common divisor.
 *
 * Remainders are taken of positive multiples, so that all numbers are integers, and are divided by their content.
 */
#include "impact/cubic.h"

/* A polynomial without double factors, and its remainders. */
typedef struct chain {
    pir_cubic f[4];
    int count;
} chain;

/* --- polynomials --- */

void pir_cubic_init(pir_cubic *f) {
    mpz_inits(f->c[0], f->c[1], f->c[2], f->c[3], NULL);
    f->degree = -1;
}

void pir_cubic_clear(pir_cubic *f) {
    mpz_clears(f->c[0], f->c[1], f->c[2], f->c[3], NULL);
}

void pir_cubic_trim(pir_cubic *f) {
    f->degree = 3;
    while (f->degree >= 0 && mpz_sgn(f->c[f->degree]) == 0)
        f->degree--;
}

static void copy(pir_cubic *dst, const pir_cubic *f) {
    for (int i = 0; i < 4; i++)
        mpz_set(dst->c[i], f->c[i]);
    dst->degree = f->degree;
}

static void divide_by_content(pir_cubic *f) {
    mpz_t common;
    mpz_init(common);
    for (int i = 0; i <= f->degree; i++)
        mpz_gcd(common, common, f->c[i]);
    for (int i = 0; i <= f->degree; i++)
        mpz_divexact(f->c[i], f->c[i], common);
    mpz_clear(common);
}

/* a becomes the remainder of a positive multiple of it by b; `quotient` that quotient, where it is asked for. */
static void divide(pir_cubic *a, const pir_cubic *b, pir_cubic *quotient) {
    mpz_t by, leading;
    mpz_inits(by, leading, NULL);
    mpz_abs(by, b->c[b->degree]);
    while (a->degree >= b->degree) {
        const int off = a->degree - b->degree;
        mpz_set(leading, a->c[a->degree]);
        if (mpz_sgn(b->c[b->degree]) < 0)
            mpz_neg(leading, leading);
        for (int i = 0; i < 4; i++) {
            mpz_mul(a->c[i], a->c[i], by);
            if (quotient)
                mpz_mul(quotient->c[i], quotient->c[i], by);
        }
        for (int i = 0; i <= b->degree; i++)
            mpz_submul(a->c[i + off], leading, b->c[i]);
        if (quotient)
            mpz_set(quotient->c[off], leading);
        pir_cubic_trim(a);
    }
    mpz_clears(by, leading, NULL);
}

static void derivative(pir_cubic *dst, const pir_cubic *f) {
    for (int i = 0; i < 3; i++)
        mpz_mul_ui(dst->c[i], f->c[i + 1], (unsigned long)i + 1);
    mpz_set_ui(dst->c[3], 0);
    pir_cubic_trim(dst);
}

/* a becomes the greatest common divisor of a and b, up to a constant; b is lost. */
static void common_divisor(pir_cubic *a, pir_cubic *b) {
    while (b->degree >= 0) {
        if (a->degree >= b->degree) {
            divide(a, b, NULL);
            divide_by_content(a);
        }
        const pir_cubic other = *a;
        *a = *b;
        *b = other;
    }
}

/* f without double factors. */
static void make_simple(pir_cubic *f) {
    pir_cubic divisor, other;
    if (f->degree < 2)
        return;
    pir_cubic_init(&divisor);
    pir_cubic_init(&other);
    copy(&divisor, f);
    derivative(&other, f);
    common_divisor(&divisor, &other);
    if (divisor.degree > 0) {
        for (int i = 0; i < 4; i++)
            mpz_set_ui(other.c[i], 0);
        divide(f, &divisor, &other);
        copy(f, &other);
        pir_cubic_trim(f);
    }
    divide_by_content(f);
    pir_cubic_clear(&divisor);
    pir_cubic_clear(&other);
}

/* --- signs and counts --- */

/* The sign at x·2^-bits. */
static int sign_of(const pir_cubic *f, const mpz_t x, mp_bitcnt_t bits) {
    mpz_t value, term;
    mpz_inits(value, term, NULL);
    for (int i = f->degree; i >= 0; i--) {
        mpz_mul(value, value, x);
        mpz_mul_2exp(term, f->c[i], bits * (mp_bitcnt_t)(f->degree - i));
        mpz_add(value, value, term);
    }
    const int sign = mpz_sgn(value);
    mpz_clears(value, term, NULL);
    return sign;
}

static void make_chain(chain *s, const pir_cubic *f) {
    for (int i = 0; i < 4; i++)
        pir_cubic_init(&s->f[i]);
    copy(&s->f[0], f);
    derivative(&s->f[1], f);
    s->count = f->degree > 0 ? 2 : 1;
    while (s->count < 4 && s->f[s->count - 1].degree > 0) {
        pir_cubic *next = &s->f[s->count];
        copy(next, &s->f[s->count - 2]);
        divide(next, &s->f[s->count - 1], NULL);
        divide_by_content(next);
        for (int i = 0; i < 4; i++)
            mpz_neg(next->c[i], next->c[i]);
        s->count++;
    }
}

static void clear_chain(chain *s) {
    for (int i = 0; i < 4; i++)
        pir_cubic_clear(&s->f[i]);
}

static int changes_at(const chain *s, const mpz_t x, mp_bitcnt_t bits) {
    int changes = 0, last = 0;
    for (int i = 0; i < s->count; i++) {
        const int sign = sign_of(&s->f[i], x, bits);
        changes += sign * last < 0;
        last = sign != 0 ? sign : last;
    }
    return changes;
}

static int count_roots(const chain *s, const mpz_t low, const mpz_t high, mp_bitcnt_t bits) {
    return mpz_cmp(low, high) < 0 ? changes_at(s, low, bits) - changes_at(s, high, bits) : 0;
}

/* --- roots --- */

void pir_cubic_root_init(pir_cubic_root *root) {
    pir_cubic_init(&root->of);
    mpz_inits(root->low, root->high, NULL);
    root->bits = 0;
}

void pir_cubic_root_clear(pir_cubic_root *root) {
    pir_cubic_clear(&root->of);
    mpz_clears(root->low, root->high, NULL);
}

/* The middle becomes one of the ends, on `bits` one more. */
static void halve(pir_cubic_root *root, bool upper) {
    mpz_t middle;
    mpz_init(middle);
    mpz_add(middle, root->low, root->high);
    mpz_mul_2exp(root->low, root->low, 1);
    mpz_mul_2exp(root->high, root->high, 1);
    root->bits++;
    mpz_set(upper ? root->low : root->high, middle);
    mpz_clear(middle);
}

/* How many roots are in the lower half. */
static int count_lower(const pir_cubic_root *root, const chain *s) {
    mpz_t low, middle;
    mpz_inits(low, middle, NULL);
    mpz_mul_2exp(low, root->low, 1);
    mpz_add(middle, root->low, root->high);
    const int count = count_roots(s, low, middle, root->bits + 1);
    mpz_clears(low, middle, NULL);
    return count;
}

void pir_cubic_root_halve(pir_cubic_root *root) {
    mpz_t middle;
    mpz_init(middle);
    mpz_add(middle, root->low, root->high);
    // the root is simple: signs after it differ from those before it
    const int sign = sign_of(&root->of, middle, root->bits + 1), last = sign_of(&root->of, root->high, root->bits);
    if (last != 0 || sign == 0) {
        halve(root, sign != 0 && sign != last);
    } else {
        chain s;
        make_chain(&s, &root->of);
        halve(root, count_lower(root, &s) == 0);
        clear_chain(&s);
    }
    mpz_clear(middle);
}

bool pir_cubic_root_within(pir_cubic_root *dst, const pir_cubic *f, const mpz_t low, const mpz_t high, mp_bitcnt_t bits,
                           int ordinal) {
    if (f->degree < 1)
        return false;
    copy(&dst->of, f);
    make_simple(&dst->of);
    mpz_set(dst->low, low);
    mpz_set(dst->high, high);
    dst->bits = bits;
    chain s;
    make_chain(&s, &dst->of);
    int count = count_roots(&s, low, high, bits);
    ordinal = ordinal == PIR_LAST_ROOT ? count : ordinal;
    const bool found = count > 0 && count >= ordinal;
    while (found && count > 1) {
        const int lower = count_lower(dst, &s);
        const bool upper = ordinal > lower;
        halve(dst, upper);
        ordinal -= upper ? lower : 0;
        count = upper ? count - lower : lower;
    }
    clear_chain(&s);
    return found;
}

int pir_cubic_root_ordinal(const pir_cubic_root *root) {
    mpz_t zero;
    mpz_init(zero);
    chain s;
    make_chain(&s, &root->of);
    const int count = count_roots(&s, zero, root->high, root->bits);
    clear_chain(&s);
    mpz_clear(zero);
    return count;
}

/* Makes the interval smaller until f, without double factors, has no root there; the root is none of f. */
static void part_from(pir_cubic_root *root, const pir_cubic *f) {
    chain s;
    make_chain(&s, f);
    while (count_roots(&s, root->low, root->high, root->bits) > 0)
        pir_cubic_root_halve(root);
    clear_chain(&s);
}

/* Whether f and g share a root in (low, high]·2^-bits; f has no double factors. */
static bool share_root(const pir_cubic *f, const pir_cubic *g, const mpz_t low, const mpz_t high, mp_bitcnt_t bits) {
    pir_cubic divisor, other;
    pir_cubic_init(&divisor);
    pir_cubic_init(&other);
    copy(&divisor, f);
    copy(&other, g);
    common_divisor(&divisor, &other);
    bool found = false;
    if (divisor.degree > 0) {
        chain s;
        make_chain(&s, &divisor);
        found = count_roots(&s, low, high, bits) > 0;
        clear_chain(&s);
    }
    pir_cubic_clear(&divisor);
    pir_cubic_clear(&other);
    return found;
}

int pir_cubic_sign_at(const pir_cubic *f, pir_cubic_root *root) {
    if (f->degree < 1)
        return f->degree < 0 ? 0 : mpz_sgn(f->c[0]);
    if (share_root(&root->of, f, root->low, root->high, root->bits))
        return 0;
    pir_cubic simple;
    pir_cubic_init(&simple);
    copy(&simple, f);
    make_simple(&simple);
    part_from(root, &simple);
    pir_cubic_clear(&simple);
    return sign_of(f, root->high, root->bits);
}

/* Brings two intervals to the same bits. */
static void align(pir_cubic_root *a, pir_cubic_root *b) {
    pir_cubic_root *coarse = a->bits < b->bits ? a : b;
    const mp_bitcnt_t bits = a->bits < b->bits ? b->bits : a->bits;
    mpz_mul_2exp(coarse->low, coarse->low, bits - coarse->bits);
    mpz_mul_2exp(coarse->high, coarse->high, bits - coarse->bits);
    coarse->bits = bits;
}

int pir_cubic_root_compare(pir_cubic_root *a, pir_cubic_root *b) {
    align(a, b);
    // a root of both within both intervals is the one of each
    mpz_t *low = mpz_cmp(a->low, b->low) > 0 ? &a->low : &b->low;
    mpz_t *high = mpz_cmp(a->high, b->high) < 0 ? &a->high : &b->high;
    if (share_root(&a->of, &b->of, *low, *high, a->bits))
        return 0;
    while (mpz_cmp(a->low, b->high) < 0 && mpz_cmp(b->low, a->high) < 0) {
        pir_cubic_root_halve(a);
        pir_cubic_root_halve(b);
    }
    return mpz_cmp(a->low, b->high) >= 0 ? 1 : -1;
}

bool pir_cubic_first_after(pir_cubic_root *dst, const pir_cubic *f, pir_cubic_root *now, const mpz_t high,
                           mp_bitcnt_t bits) {
    if (f->degree < 1)
        return false;
    mpz_t from, to;
    mpz_inits(from, to, NULL);
    mpz_set(to, high);
    if (now) {
        pir_cubic simple;
        pir_cubic_init(&simple);
        copy(&simple, f);
        make_simple(&simple);
        part_from(now, &simple);
        pir_cubic_clear(&simple);
        mpz_mul_2exp(from, now->high, bits);
        mpz_mul_2exp(to, high, now->bits);
        bits += now->bits;
    }
    const bool found = pir_cubic_root_within(dst, f, from, to, bits, 1);
    mpz_clears(from, to, NULL);
    return found;
}
