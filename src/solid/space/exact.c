/* SPDX-License-Identifier: MIT */
/* See exact.h. mpz_get_d_2exp cuts off, so that a double of it is within 2^-52 of the number, relative to it. */
#include "solid/space/exact.h"
#include "solid/space/rest.h"

#include <math.h>

void pir_numbers_reduce(mpz_t *number, uint32_t count, mpz_ptr scratch) {
    mpz_set_ui(scratch, 0);
    for (uint32_t k = count; k-- > 0;) {
        mpz_gcd(scratch, scratch, number[k]);
        if (mpz_cmp_ui(scratch, 1) == 0)
            return;
    }
    for (uint32_t k = 0; k < count && mpz_sgn(scratch) != 0; k++)
        mpz_divexact(number[k], number[k], scratch);
}

void pir_numbers_cross(mpz_t *ret, mpz_t *a, mpz_t *b) {
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        mpz_mul(ret[k], a[i], b[j]);
        mpz_submul(ret[k], a[j], b[i]);
    }
}

void pir_numbers_dot(mpz_ptr ret, mpz_t *a, mpz_t *b, uint32_t count) {
    mpz_mul(ret, a[0], b[0]);
    for (uint32_t k = 1; k < count; k++)
        mpz_addmul(ret, a[k], b[k]);
}

void pir_space_round_direction(double ret[3], mpz_t *number) {
    double m[3];
    long e[3], top = 0;
    bool any = false;
    for (int k = 0; k < 3; k++) {
        m[k] = mpz_get_d_2exp(&e[k], number[k]);
        if (m[k] != 0 && (!any || e[k] > top)) {
            top = e[k];
            any = true;
        }
    }
    for (int k = 0; k < 3; k++)
        ret[k] = m[k] == 0 || top - e[k] > 200 ? 0 : ldexp(m[k], (int)(e[k] - top));
    const double length = sqrt(ret[0] * ret[0] + ret[1] * ret[1] + ret[2] * ret[2]);
    for (int k = 0; k < 3; k++)
        ret[k] /= length;
}

/* Each coordinate is off by 3·2^-52 of itself at most, and by as much again from rounding: √3·2^-50 in all. */
void pir_space_round_point(pir_space *space, uint32_t point) {
    pir_space_point *p = &space->point[point];
    mpz_t *x = space->number + p->exact;
    long scale, e;
    bool within = true;
    const double w = mpz_get_d_2exp(&scale, x[3]);
    for (int k = 0; k < 3; k++) {
        const double m = mpz_get_d_2exp(&e, x[k]);
        const long power = e - scale - space->shift;
        p->x[k] = m == 0 || power < -300 ? 0 : ldexp(m / w, power < 300 ? (int)power : 300);
        within = within && fabs(p->x[k]) <= 1 + 0x1p-40;
    }
    p->err = 0x1p-49;
    if (!within)
        pir_space_fault(space);
}

/* The normal is within 2^-49 of the true one, which is worth 2^-48 at |x| ≤ √3; d is off by 2^-50·√3 and its
 * quotient. */
void pir_space_round_plane(pir_space *space, uint32_t plane) {
    pir_space_plane *p = &space->plane[plane];
    mpz_t *a = space->number + p->exact;
    double m[3];
    long e[3], top = 0, scale;
    bool any = false;
    for (int k = 0; k < 3; k++) {
        m[k] = mpz_get_d_2exp(&e[k], a[k]);
        top = m[k] != 0 && (!any || e[k] > top) ? e[k] : top;
        any = any || m[k] != 0;
    }
    for (int k = 0; k < 3; k++)
        p->n[k] = m[k] == 0 || top - e[k] > 200 ? 0 : ldexp(m[k], (int)(e[k] - top));
    const double length = sqrt(p->n[0] * p->n[0] + p->n[1] * p->n[1] + p->n[2] * p->n[2]);
    for (int k = 0; k < 3; k++)
        p->n[k] /= length;
    const double d = mpz_get_d_2exp(&scale, a[3]);
    const long power = scale - top - space->shift;
    p->d = d == 0 || power < -300 ? 0 : ldexp(d / length, (int)power);
    p->err = 0x1p-47;
}

/* ret, four numbers in scratch, becomes the exact sum of two points. */
static void make_sum(pir_space *space, mpz_t *ret, uint32_t a, uint32_t b) {
    mpz_t *x = space->number + a, *y = space->number + b;
    for (int k = 0; k < 3; k++) {
        mpz_mul(ret[k], x[k], y[3]);
        mpz_addmul(ret[k], y[k], x[3]);
    }
    mpz_mul(ret[3], x[3], y[3]);
}

/*
 * ret becomes the point where three planes meet, by Cramer's rule: sum of d_f·(g × h) over the planes, det(f, g, h).
 */
static void make_meet(pir_space *space, mpz_t *ret, const uint32_t exact[3]) {
    mpz_t *cross = space->t + 4;
    for (int k = 0; k < 4; k++)
        mpz_set_ui(ret[k], 0);
    for (int i = 0; i < 3; i++) {
        mpz_t *f = space->number + exact[i];
        pir_numbers_cross(cross, space->number + exact[(i + 1) % 3], space->number + exact[(i + 2) % 3]);
        for (int k = 0; k < 3; k++)
            mpz_addmul(ret[k], f[3], cross[k]);
        if (i == 0)
            pir_numbers_dot(ret[3], f, cross, 3);
    }
    if (mpz_sgn(ret[3]) < 0)
        for (int k = 0; k < 4; k++)
            mpz_neg(ret[k], ret[k]);
}

/* Four numbers in scratch as those of a point or a plane: moved into new ones, or equal ones that are `known`. */
static uint32_t keep(pir_space *space, pir_intern *known, mpz_t *made) {
    pir_numbers_reduce(made, 4, space->t[16]);
    const uint32_t exact = pir_space_numbers(space, 4);
    if (space->status != PIR_OK)
        return 0;
    for (uint32_t k = 0; k < 4; k++)
        mpz_swap(space->number[exact + k], made[k]);
    const uint32_t first = pir_intern_add(known, exact, exact);
    if (first == exact || space->status != PIR_OK)
        return first;
    for (uint32_t k = 0; k < 4; k++)
        mpz_swap(space->number[exact + k], made[k]);
    pir_space_drop_numbers(space, exact);
    return first;
}

uint32_t pir_space_exact_direction(pir_space *space, uint32_t direction) {
    if (space->direction[direction].exact != PIR_SPACE_NONE)
        return space->direction[direction].exact;
    const pir_space_direction d = space->direction[direction];
    const bool of_line = d.rest == PIR_SPACE_NONE;
    const uint32_t f = of_line ? pir_space_exact_plane(space, d.plane[0]) : 0;
    const uint32_t g = of_line ? pir_space_exact_plane(space, d.plane[1]) : 0;
    const uint32_t exact = pir_space_numbers(space, 3);
    if (space->status != PIR_OK)
        return 0;
    if (of_line)
        pir_numbers_cross(space->number + exact, space->number + f, space->number + g);
    else
        pir_rest_turn_direction(space->rest, d.rest, space->number + exact);
    pir_numbers_reduce(space->number + exact, 3, space->t[16]);
    return space->direction[direction].exact = exact;
}

uint32_t pir_space_exact_point(pir_space *space, uint32_t point) {
    if (space->point[point].exact != PIR_SPACE_NONE)
        return space->point[point].exact;
    const pir_space_point p = space->point[point];
    uint32_t of[3] = {0};
    for (int k = 0; k < (p.kind == PIR_POINT_SUM ? 2 : p.kind == PIR_POINT_MEET ? 3 : 0); k++)
        of[k] = p.kind == PIR_POINT_SUM ? pir_space_exact_point(space, p.of[k]) : pir_space_exact_plane(space, p.of[k]);
    if (space->status != PIR_OK)
        return 0;
    if (p.kind == PIR_POINT_SUM)
        make_sum(space, space->t, of[0], of[1]);
    else if (p.kind == PIR_POINT_TURNED)
        pir_rest_turn_point(space->rest, p.of[0], space->t);
    else
        make_meet(space, space->t, of);
    if (mpz_sgn(space->t[3]) == 0) {
        pir_space_fault(space);
        return 0;
    }
    const uint32_t exact = keep(space, &space->known_point, space->t);
    if (space->status != PIR_OK)
        return 0;
    space->point[point].exact = exact;
    pir_space_round_point(space, point);
    return exact;
}

uint32_t pir_space_exact_plane(pir_space *space, uint32_t plane) {
    if (space->plane[plane].exact != PIR_SPACE_NONE)
        return space->plane[plane].exact;
    const pir_space_plane p = space->plane[plane];
    uint32_t at = pir_space_exact_point(space, p.point[0]);
    const uint32_t beside = p.point[1] == PIR_SPACE_NONE ? at : pir_space_exact_point(space, p.point[1]);
    if (space->status != PIR_OK)
        return 0;
    const uint32_t first = pir_space_exact_direction(space, p.direction[0]);
    const uint32_t second = p.direction[1] == PIR_SPACE_NONE ? 0 : pir_space_exact_direction(space, p.direction[1]);
    if (space->status != PIR_OK)
        return 0;
    // the point in t[8..11], the normal in t[0..2], then n·W and n·X
    mpz_t *x = space->t + 8, *n = space->t;
    if (p.point[1] == PIR_SPACE_NONE)
        for (uint32_t k = 0; k < 4; k++)
            mpz_set(x[k], space->number[at + k]);
    else
        make_sum(space, x, at, beside);
    mpz_t *a = space->number + first;
    if (p.direction[1] == PIR_SPACE_NONE)
        for (int k = 0; k < 3; k++)
            mpz_set(n[k], a[k]);
    else
        pir_numbers_cross(n, a, space->number + second);
    if (p.turned)
        for (int k = 0; k < 3; k++)
            mpz_neg(n[k], n[k]);
    if (mpz_sgn(n[0]) == 0 && mpz_sgn(n[1]) == 0 && mpz_sgn(n[2]) == 0) {
        pir_space_fault(space);
        return 0;
    }
    pir_numbers_dot(n[3], n, x, 3);
    for (int k = 0; k < 3; k++)
        mpz_mul(n[k], n[k], x[3]);
    const uint32_t exact = keep(space, &space->known_plane, n);
    if (space->status != PIR_OK)
        return 0;
    space->plane[plane].exact = exact;
    pir_space_round_plane(space, plane);
    return exact;
}
