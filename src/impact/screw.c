/* SPDX-License-Identifier: MIT */
/*
 * The first root of a condition after now: of a form of degree three in (σ, τ).
 *
 * Between two directions less than 90 degrees apart a form has Bernstein coefficients, its polar values at them. Where
 * all are surely negative so is the form; where their signs surely change once there is one root. Else the piece is
 * halved, and the first half is looked at first. So the root that is found is the first one.
 *
 * Doubles: with coefficients off by ε, and directions by the slack of now and a few 2^-53, polar values are off by
 * 2ε and 4 size·slack; points between are averages, shorter than 1. ERROR_OF has more than twice that. A root's
 * slack ends where the form surely has a sign, and is then made wider by 2^-47; within that a form changes by less than
 * the error. So the root is the only one of its form within its slack, which is how it is made an exact number.
 *
 * Exactly: cubics in t = 1/k, which grows from 0.
 */
#include "impact/screw.h"

#include <float.h>

/* φ from its functions, and directions from φ, are within this. */
#define ANGLE_ERROR 0x1p-49
#define WIDER       0x1p-47
/* A root is found by integers where doubles know it no better. */
#define MOST_SLACK  0x1p-18
#define MOST_HALVED 12

typedef struct form_piece {
    double b[4], low, high; /* polar values; the part of the way from now to the end */
} form_piece;

/* --- in doubles --- */

static double error_of(const pir_impact_search *search, const pir_course_form *form) {
    const double size = fabs(form->c[0]) + fabs(form->c[1]) + fabs(form->c[2]) + fabs(form->c[3]);
    return 4 * form->bound + 16 * size * (search->now.slack + WIDER);
}

/* The form's polar value at three directions. */
static double polar(const double c[4], const double p[2], const double q[2], const double r[2]) {
    const double one = p[1] * q[0] * r[0] + p[0] * q[1] * r[0] + p[0] * q[0] * r[1];
    const double two = p[0] * q[1] * r[1] + p[1] * q[0] * r[1] + p[1] * q[1] * r[0];
    return c[0] * p[0] * q[0] * r[0] + c[1] * one / 3 + c[2] * two / 3 + c[3] * p[1] * q[1] * r[1];
}

static double value_of(const double b[4], double w) {
    const double v = 1 - w;
    return v * v * (v * b[0] + 3 * w * b[1]) + w * w * (3 * v * b[2] + w * b[3]);
}

static void split(const form_piece *piece, form_piece half[2]) {
    const double *b = piece->b, middle = 0.5 * (piece->low + piece->high);
    const double ab = 0.5 * (b[0] + b[1]), bc = 0.5 * (b[1] + b[2]), cd = 0.5 * (b[2] + b[3]);
    const double abc = 0.5 * (ab + bc), bcd = 0.5 * (bc + cd), all = 0.5 * (abc + bcd);
    half[0] = (form_piece){{b[0], ab, abc, all}, piece->low, middle};
    half[1] = (form_piece){{all, bcd, cd, b[3]}, middle, piece->high};
}

/* 1 and the piece that has the first root alone, 0 where there surely is none, −1 where doubles cannot tell. */
static int find_piece(const form_piece *piece, double error, int halved, form_piece *ret_piece) {
    const double *b = piece->b;
    if (b[0] < -error && b[1] < -error && b[2] < -error && b[3] < -error)
        return 0;
    if (!(b[0] < -error) || halved == MOST_HALVED)
        return -1;
    if (b[3] > error && (b[1] < -error || b[2] > error)) {
        *ret_piece = *piece;
        return 1;
    }
    form_piece half[2];
    split(piece, half);
    const int found = find_piece(&half[0], error, halved + 1, ret_piece);
    return found != 0 ? found : find_piece(&half[1], error, halved + 1, ret_piece);
}

/* The last part of a piece at which the form surely is negative, or the first at which it surely is positive. */
static double edge_of(const form_piece *piece, double error, bool positive) {
    double low = 0, high = 1;
    for (double middle = 0.5; middle > low && middle < high; middle = 0.5 * (low + high)) {
        const double value = value_of(piece->b, middle);
        if (positive ? value > error : value >= -error)
            high = middle;
        else
            low = middle;
    }
    return piece->low + (positive ? high : low) * (piece->high - piece->low);
}

/* As find_piece, with the root in place of a piece. */
static int exit_by_filter(const pir_impact_search *search, const pir_course_form *form, const pir_moment *best,
                          pir_moment *moment) {
    const double phi = fmin(best->phi + best->slack, search->end.phi + search->end.slack),
                 error = error_of(search, form);
    const double p[2] = {search->sigma, search->tau}, q[2] = {cos(phi), sin(phi)}, *c = form->c;
    const form_piece all = {{polar(c, p, p, p), polar(c, p, p, q), polar(c, p, q, q), polar(c, q, q, q)}, 0, 1};
    form_piece piece;
    const int found = find_piece(&all, error, 0, &piece);
    if (found != 1)
        return found;
    double at[2];
    for (int k = 0; k < 2; k++) {
        const double w = edge_of(&piece, error, k == 1);
        at[k] = atan2((1 - w) * p[1] + w * q[1], (1 - w) * p[0] + w * q[0]);
    }
    moment->phi = 0.5 * (at[0] + at[1]);
    moment->slack = 0.5 * (at[1] - at[0]) + WIDER;
    return moment->slack < MOST_SLACK ? 1 : -1;
}

/* --- as integers --- */

/* dst·2^-ret_bits is tan(φ)/|u| in units of 1/k, moved by a few last bits. */
static void set_bound(const pir_course *course, double phi, double moved, mpz_t dst, mp_bitcnt_t *ret_bits) {
    int e, length_e;
    const double length = frexp(pir_vec_length(course->axis), &length_e);
    const double m = frexp(fmax(tan(phi), 0) / length * (1 + moved), &e);
    mpz_set_d(dst, ldexp(m, 53));
    e += course->exact.exponent - length_e - 53;
    if (e > 0)
        mpz_mul_2exp(dst, dst, (mp_bitcnt_t)e);
    *ret_bits = (mp_bitcnt_t)(e < 0 ? -e : 0);
}

/* A number above the t of the end, as set_bound. */
static void set_limit(const pir_impact_search *search, mpz_t dst, mp_bitcnt_t *ret_bits) {
    set_bound(&search->course, search->end.phi, 0x1p-20, dst, ret_bits);
}

/* The root of a moment. */
static void make_root(pir_impact_search *search, const pir_moment *of, pir_cubic_root *dst) {
    pir_course *course = &search->course;
    mpz_t low, high;
    mp_bitcnt_t bits[2] = {0, 0};
    mpz_inits(low, high, NULL);
    pir_course_cubic(course, &of->root, &course->exact.cubic);
    if (of->ordinal > 0) {
        set_limit(search, high, &bits[1]);
    } else {
        set_bound(course, of->phi - of->slack, -0x1p-50, low, &bits[0]);
        set_bound(course, of->phi + of->slack, 0x1p-50, high, &bits[1]);
    }
    mpz_mul_2exp(low, low, bits[1]);
    mpz_mul_2exp(high, high, bits[0]);
    const int ordinal = of->ordinal > 0 ? of->ordinal : 1;
    if (!pir_cubic_root_within(dst, &course->exact.cubic, low, high, bits[0] + bits[1], ordinal))
        search->status = PIR_ERR_INTERNAL;
    mpz_clears(low, high, NULL);
}

static pir_cubic_root *root_of_now(pir_impact_search *search) {
    pir_cubic_root *root = &search->course.exact.cubic_root;
    if (!search->has_root)
        make_root(search, &search->now, root);
    search->has_root = true;
    return root;
}

int pir_screw_sign(pir_impact_search *search, const pir_condition *on, pir_sign_when when) {
    pir_course *course = &search->course;
    pir_cubic *cubic = &course->exact.cubic;
    if (search->now.kind != PIR_MOMENT_FIRST) {
        pir_cubic_root *now = root_of_now(search);
        if (search->status != PIR_OK)
            return 1;
        pir_course_cubic(course, on, cubic);
        return pir_cubic_sign_at(cubic, now);
    }
    pir_course_cubic(course, on, cubic);
    int i = 0;
    while (when == PIR_SIGN_SOON && i < 3 && mpz_sgn(cubic->c[i]) == 0)
        i++;
    return mpz_sgn(cubic->c[i]);
}

/* Whether a root comes no later than the end, t = 2^end_shift/end. */
static bool is_in_time(const pir_impact_search *search, pir_cubic_root *root) {
    const pir_course_integers *exact = &search->course.exact;
    pir_cubic end;
    pir_cubic_init(&end);
    mpz_set(end.c[1], exact->end);
    mpz_setbit(end.c[0], exact->end_shift);
    mpz_neg(end.c[0], end.c[0]);
    pir_cubic_trim(&end);
    const bool in_time = pir_cubic_sign_at(&end, root) <= 0;
    pir_cubic_clear(&end);
    return in_time;
}

static bool comes_before(pir_impact_search *search, pir_cubic_root *root, const pir_moment *best) {
    if (best->kind != PIR_MOMENT_ROOT)
        return is_in_time(search, root);
    pir_cubic_root other;
    pir_cubic_root_init(&other);
    make_root(search, best, &other);
    const bool before = search->status == PIR_OK && pir_cubic_root_compare(root, &other) < 0;
    pir_cubic_root_clear(&other);
    return before;
}

/* φ of a root: its interval is halved until it is narrower than doubles can tell. */
static double phi_of(const pir_course *course, pir_cubic_root *root) {
    mpz_t width;
    mpz_init(width);
    for (;;) {
        mpz_sub(width, root->high, root->low);
        mpz_mul_2exp(width, width, 60);
        if (mpz_cmp(width, root->high) <= 0)
            break;
        pir_cubic_root_halve(root);
    }
    mpz_clear(width);
    long e;
    int length_e;
    const double m = mpz_get_d_2exp(&e, root->high), length = frexp(pir_vec_length(course->axis), &length_e);
    return atan(ldexp(m * length, (int)(e - (long)root->bits) - course->exact.exponent + length_e));
}

static void exit_exactly(pir_impact_search *search, const pir_condition *on, pir_moment *best) {
    pir_course *course = &search->course;
    if (search->status == PIR_OK)
        search->status = pir_course_integers_make(course);
    pir_cubic_root *now = search->status == PIR_OK && search->now.kind == PIR_MOMENT_ROOT ? root_of_now(search) : NULL;
    if (search->status != PIR_OK)
        return;
    mpz_t limit;
    mp_bitcnt_t bits;
    pir_cubic_root root;
    mpz_init(limit);
    pir_cubic_root_init(&root);
    set_limit(search, limit, &bits);
    pir_course_cubic(course, on, &course->exact.cubic);
    if (pir_cubic_first_after(&root, &course->exact.cubic, now, limit, bits) && comes_before(search, &root, best)) {
        *best = (pir_moment){.kind = PIR_MOMENT_ROOT, .root = *on, .slack = 0x1p-46};
        best->ordinal = pir_cubic_root_ordinal(&root);
        best->phi = phi_of(course, &root);
    }
    pir_cubic_root_clear(&root);
    mpz_clear(limit);
}

void pir_screw_take_exit(pir_impact_search *search, const pir_course_form *form, const pir_condition *on,
                         pir_moment *best) {
    pir_moment at = {.kind = PIR_MOMENT_ROOT, .root = *on};
    const int found = exit_by_filter(search, form, best, &at);
    if (found == 0 || (found == 1 && at.phi - at.slack > best->phi + best->slack))
        return;
    if (found == 1 && at.phi + at.slack < best->phi - best->slack)
        *best = at;
    else
        exit_exactly(search, on, best);
}

void pir_screw_refine(pir_impact_search *search) {
    pir_cubic_root *root = root_of_now(search);
    if (search->status != PIR_OK)
        return;
    search->now.phi = phi_of(&search->course, root);
    search->now.slack = 0x1p-46 * fmin(1, search->now.phi);
}
