/* SPDX-License-Identifier: MIT */
/*
 * Slacks that differ by a given length: see within.h.
 *
 * In units of W (placed.h) the slacks are A/√a and B/√b, with A = n·W and a = n·n for the integer normals n. The
 * length is δ. For A, B, δ ≥ 0,
 *
 *     A/√a ≤ B/√b + δ   ⇔   L ≤ 2δBa√b   with   L = A²b − B²a − δ²ab
 *
 * which holds where L ≤ 0, and else where L² ≤ 4δ²B²a²b.
 */
#include "query/decide/within.h"

#include <gmp.h>

#include "query/decide/placed.h"

/* A, a, B, b and δ, all times one power of two where δ is no whole number. */
struct terms {
    mpz_t A, a, B, b, delta;
};

static void set_from(mpz_t to, const pir_int *from) {
    mpz_t view;
    mpz_set(to, mpz_roinit_n(view, from->limb, from->size));
}

static void set_slack(pir_exact *exact, const pir_facet *facet, mpz_t dot, mpz_t square) {
    const uint32_t mark = exact->scratch.used;
    pir_int3 normal = pir_exact_normal(exact, facet->piece), corner = pir_exact_corner(exact, facet->a, facet->b);
    pir_int d = pir_exact_dot(exact, &normal, &corner), s = pir_exact_square(exact, &normal);
    set_from(dot, &d);
    set_from(square, &s);
    exact->scratch.used = mark;
}

/* One length is k·norm_q·2^i units of W. */
static void set_length(const pir_exact *exact, double length, struct terms *t) {
    int exponent;
    const double m = frexp(length, &exponent);
    mpz_t k;
    mpz_init(k);
    mpz_set_d(t->delta, ldexp(m, 53));
    set_from(k, &exact->k);
    mpz_mul(t->delta, t->delta, k);
    set_from(k, &exact->norm_q);
    mpz_mul(t->delta, t->delta, k);
    mpz_clear(k);
    const long shift = (long)exponent - 53 + (long)exact->i;
    if (shift >= 0) {
        mpz_mul_2exp(t->delta, t->delta, (mp_bitcnt_t)shift);
        return;
    }
    mpz_mul_2exp(t->A, t->A, (mp_bitcnt_t)-shift);
    mpz_mul_2exp(t->B, t->B, (mp_bitcnt_t)-shift);
}

/* Whether L ≤ 2δBa√b. Uses up the terms. */
static bool is_within(struct terms *t) {
    mpz_t left, right;
    mpz_inits(left, right, NULL);
    // right = 4δ²B²a²b
    mpz_mul(right, t->delta, t->B);
    mpz_mul(right, right, t->a);
    mpz_mul_2exp(right, right, 1);
    mpz_mul(right, right, right);
    mpz_mul(right, right, t->b);
    mpz_mul(left, t->A, t->A);
    mpz_mul(left, left, t->b);
    mpz_mul(t->B, t->B, t->B);
    mpz_submul(left, t->B, t->a);
    mpz_mul(t->delta, t->delta, t->delta);
    mpz_mul(t->delta, t->delta, t->a);
    mpz_submul(left, t->delta, t->b);
    bool within = mpz_sgn(left) <= 0;
    if (!within) {
        mpz_mul(left, left, left);
        within = mpz_cmp(left, right) <= 0;
    }
    mpz_clears(left, right, NULL);
    return within;
}

static bool is_within_exactly(pir_exact *exact, const pir_placement *placement, const pir_facet *facet,
                              const pir_facet *least, double more) {
    struct terms t;
    pir_exact_begin(exact, placement->translation);
    mpz_inits(t.A, t.a, t.B, t.b, t.delta, NULL);
    set_slack(exact, facet, t.A, t.a);
    set_slack(exact, least, t.B, t.b);
    set_length(exact, more, &t);
    const bool within = is_within(&t);
    mpz_clears(t.A, t.a, t.B, t.b, t.delta, NULL);
    return within;
}

bool pir_facet_within(pir_exact *exact, const pir_placement *placement, const pir_facet *facet, const pir_facet *least,
                      double more) {
    if (pir_facet_same(facet, least))
        return true;
    if (!(more > 0))
        return pir_facet_compare(exact, placement, facet, least) <= 0;
    const pir_vec3 x = placement->x;
    const double length = pir_frame_from(exact->frame, more);
    const double slack = facet->h - pir_vec_dot(facet->n, x), limit = least->h - pir_vec_dot(least->n, x) + length;
    // the last term is for the sum of a great length, and for one that the frame rounds to 0
    const double error = placement->error * (facet->err + least->err) + 0x1p-50 * length + 0x1p-1060;
    if (fabs(slack - limit) > error)
        return slack < limit;
    return is_within_exactly(exact, placement, facet, least, more);
}
