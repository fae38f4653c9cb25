/* SPDX-License-Identifier: MIT */
/*
 * The signs that solids ask for, by doubles where their errors allow it, else by the exact numbers.
 *
 * The filters' bounds: with u = 2^-53, |n| ≤ 1 + 2^-49, |x|, |d| ≤ √3 + 2^-40, n·x − d in doubles is within
 * 20u < 2^-48 of its value. A determinant of three unit directions is within 3·2^-49 + 12u of the true one, a dot
 * product within 2·2^-49 + 4u: both below 2^-46.
 */
#include <math.h>

#include "solid/space/exact.h"
#include "solid/space/space.h"

int pir_space_exact_side(pir_space *space, uint32_t plane, uint32_t point) {
    const uint32_t a = pir_space_exact_plane(space, plane), x = pir_space_exact_point(space, point);
    if (space->status != PIR_OK)
        return 0;
    space->by_exact++;
    mpz_t *n = space->number + a, *p = space->number + x;
    pir_numbers_dot(space->t[17], n, p, 3);
    mpz_submul(space->t[17], n[3], p[3]);
    return mpz_sgn(space->t[17]);
}

static double det_of(const double a[3], const double b[3], const double c[3]) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

int pir_space_det(pir_space *space, uint32_t a, uint32_t b, uint32_t c) {
    const pir_space_direction *d = space->direction;
    const double det = det_of(d[a].n, d[b].n, d[c].n);
    if (fabs(det) > 0x1p-46)
        return det > 0 ? 1 : -1;
    mpz_t *cross = space->t;
    pir_numbers_cross(cross, space->number + d[b].exact, space->number + d[c].exact);
    pir_numbers_dot(space->t[17], space->number + d[a].exact, cross, 3);
    return mpz_sgn(space->t[17]);
}

int pir_space_dot(pir_space *space, uint32_t a, uint32_t b) {
    const pir_space_direction *d = space->direction;
    const double dot = d[a].n[0] * d[b].n[0] + d[a].n[1] * d[b].n[1] + d[a].n[2] * d[b].n[2];
    if (fabs(dot) > 0x1p-46)
        return dot > 0 ? 1 : -1;
    pir_numbers_dot(space->t[17], space->number + d[a].exact, space->number + d[b].exact, 3);
    return mpz_sgn(space->t[17]);
}

/* b·W_a − a·W_b into three numbers: the vector from a to b, times a positive number. */
static void exact_difference(mpz_t *ret, mpz_t *a, mpz_t *b) {
    for (int k = 0; k < 3; k++) {
        mpz_mul(ret[k], b[k], a[3]);
        mpz_submul(ret[k], a[k], b[3]);
    }
}

int pir_space_turn(pir_space *space, uint32_t half, uint32_t a, uint32_t b, uint32_t c) {
    const pir_space_point *p[3] = {&space->point[a], &space->point[b], &space->point[c]};
    const pir_space_plane *f = &space->plane[half >> 1];
    const int turn = half & 1 ? -1 : 1;
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = p[1]->x[k] - p[0]->x[k];
        v[k] = p[2]->x[k] - p[0]->x[k];
    }
    // u and v, no longer than 4, are each wrong by two errors; the normal is wrong by less than the plane's own
    const double det = det_of(f->n, u, v), bound = 16 * (p[0]->err + p[1]->err + p[2]->err + f->err) + 0x1p-44;
    if (fabs(det) > bound)
        return det > 0 ? turn : -turn;
    uint32_t at[3] = {0};
    const uint32_t number[3] = {a, b, c};
    for (int k = 0; k < 3; k++)
        at[k] = pir_space_exact_point(space, number[k]);
    const uint32_t normal = pir_space_exact_plane(space, half >> 1);
    if (space->status != PIR_OK)
        return 0;
    mpz_t *t = space->t;
    exact_difference(t, space->number + at[0], space->number + at[1]);
    exact_difference(t + 3, space->number + at[0], space->number + at[2]);
    pir_numbers_cross(t + 6, t, t + 3);
    pir_numbers_dot(t[17], space->number + normal, t + 6, 3);
    return turn * mpz_sgn(t[17]);
}

int pir_space_orient(pir_space *space, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    const uint32_t number[4] = {a, b, c, d};
    double v[3][3], err = space->point[a].err;
    for (int i = 0; i < 3; i++) {
        const pir_space_point *p = &space->point[number[i + 1]];
        err += p->err;
        for (int k = 0; k < 3; k++)
            v[i][k] = p->x[k] - space->point[a].x[k];
    }
    // each vector, no longer than 4, is wrong by less than all errors together
    const double det = det_of(v[0], v[1], v[2]);
    if (fabs(det) > 64 * err + 0x1p-42)
        return det > 0 ? 1 : -1;
    uint32_t at[4];
    for (int i = 0; i < 4; i++)
        at[i] = pir_space_exact_point(space, number[i]);
    if (space->status != PIR_OK)
        return 0;
    for (int i = 0; i < 3; i++)
        exact_difference(space->t + 3 * i, space->number + at[0], space->number + at[i + 1]);
    pir_numbers_cross(space->t + 9, space->t, space->t + 3);
    pir_numbers_dot(space->t[17], space->t + 9, space->t + 6, 3);
    return mpz_sgn(space->t[17]);
}

int pir_space_order(pir_space *space, uint32_t direction, uint32_t a, uint32_t b) {
    const pir_space_point *p = &space->point[a], *q = &space->point[b];
    const double *n = space->direction[direction].n;
    const double s = n[0] * (q->x[0] - p->x[0]) + n[1] * (q->x[1] - p->x[1]) + n[2] * (q->x[2] - p->x[2]);
    if (fabs(s) > p->err + q->err + 0x1p-46)
        return s > 0 ? 1 : -1;
    const uint32_t i = pir_space_exact_point(space, a), j = pir_space_exact_point(space, b);
    if (space->status != PIR_OK)
        return 0;
    exact_difference(space->t, space->number + i, space->number + j);
    pir_numbers_dot(space->t[17], space->number + space->direction[direction].exact, space->t, 3);
    return mpz_sgn(space->t[17]);
}
