/* SPDX-License-Identifier: MIT */
/*
 * The signs that solids ask for, by doubles where their errors allow it, else by the exact numbers.
 *
 * The filters' bounds: with u = 2^-53, |n| ≤ 1 + 2^-47, |x|, |d| ≤ √3 + 2^-40, n·x − d in doubles is within
 * 20u < 2^-48 of its value. A determinant of three unit directions is within 3·2^-47 + 12u of the true one, a dot
 * product within 2·2^-47 + 4u: both below 2^-45. Along a direction, over a way of 2√3 at most, it is 2√3·2^-47 +
 * 16u.
 */
#include <math.h>

#include "solid/space/exact.h"
#include "solid/space/identity.h"
#include "solid/space/record.h"
#include "solid/space/space.h"

/* Sides that exact numbers told and that are kept at most, 12 bytes each. */
#define MOST_SIDES (1u << 20)

/* --- sides --- */

/* Whether a point is in a plane by what the two were made of. */
static bool is_made_in(const pir_space_plane *f, uint32_t plane, const pir_space_point *p, uint32_t point) {
    switch (p->kind) {
    case PIR_POINT_MEET:
        return p->of[0] == plane || p->of[1] == plane || p->of[2] == plane;
    case PIR_POINT_SUM:
        if ((f->point[0] == p->of[0] && f->point[1] == p->of[1]) ||
            (f->point[0] == p->of[1] && f->point[1] == p->of[0]))
            return true;
        break;
    case PIR_POINT_GIVEN:
    case PIR_POINT_TURNED:
        break;
    }
    return f->point[0] == point && f->point[1] == PIR_SPACE_NONE;
}

/* Twice the room for known sides, which are forgotten. */
static void widen_sides(pir_space *space) {
    const uint32_t room = space->side_room ? 2 * space->side_room : 64;
    struct pir_known_side *side = PIR_ZEROED(&space->allocator, struct pir_known_side, room);
    if (!side) {
        space->status = PIR_ERR_MEMORY;
        return;
    }
    pir_space_shrink(space, space->side, space->side_room, sizeof *space->side);
    space->side = side;
    space->side_room = room;
    space->side_count = 0;
}

/* The place of the side of a plane with exact numbers from a on, for a point with those from x on. */
static struct pir_known_side *known_side(pir_space *space, uint32_t a, uint32_t x) {
    const uint64_t mixed = ((uint64_t)a << 32 | x) * 0x9e3779b97f4a7c15u;
    return &space->side[mixed >> 32 & (space->side_room - 1)];
}

/* The sign; where it is 0 the record of the job at hand may end with this rotation. */
static int note_zero(pir_space *space, int sign) {
    if (space->record && sign == 0)
        space->record->fleeting = true;
    return sign;
}

int pir_space_exact_side(pir_space *space, uint32_t plane, uint32_t point) {
    if (is_made_in(&space->plane[plane], plane, &space->point[point], point) || pir_identity_holds(space, plane, point))
        return 0;
    const uint32_t a = pir_space_exact_plane(space, plane), x = pir_space_exact_point(space, point);
    if (space->side_count >= space->side_room && space->side_room < MOST_SIDES && space->status == PIR_OK)
        widen_sides(space);
    if (space->status != PIR_OK)
        return 0;
    struct pir_known_side *known = known_side(space, a, x);
    if (known->plane == a && known->point == x)
        return note_zero(space, known->sign);
    mpz_t *n = space->number + a, *p = space->number + x;
    pir_numbers_dot(space->t[17], n, p, 3);
    mpz_submul(space->t[17], n[3], p[3]);
    *known = (struct pir_known_side){a, x, mpz_sgn(space->t[17])};
    space->side_count++;
    return note_zero(space, known->sign);
}

/* --- determinants --- */

static double det_of(const double a[3], const double b[3], const double c[3]) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

int pir_space_det(pir_space *space, uint32_t a, uint32_t b, uint32_t c) {
    const pir_space_direction *d = space->direction;
    const double det = det_of(d[a].n, d[b].n, d[c].n);
    if (fabs(det) > 0x1p-45)
        return det > 0 ? 1 : -1;
    const uint32_t i = pir_space_exact_direction(space, a), j = pir_space_exact_direction(space, b);
    const uint32_t k = pir_space_exact_direction(space, c);
    if (space->status != PIR_OK)
        return 0;
    mpz_t *cross = space->t;
    pir_numbers_cross(cross, space->number + j, space->number + k);
    pir_numbers_dot(space->t[17], space->number + i, cross, 3);
    return mpz_sgn(space->t[17]);
}

int pir_space_dot(pir_space *space, uint32_t a, uint32_t b) {
    const pir_space_direction *d = space->direction;
    const double dot = d[a].n[0] * d[b].n[0] + d[a].n[1] * d[b].n[1] + d[a].n[2] * d[b].n[2];
    if (fabs(dot) > 0x1p-45)
        return dot > 0 ? 1 : -1;
    const uint32_t i = pir_space_exact_direction(space, a), j = pir_space_exact_direction(space, b);
    if (space->status != PIR_OK)
        return 0;
    pir_numbers_dot(space->t[17], space->number + i, space->number + j, 3);
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
    if (fabs(s) > p->err + q->err + 0x1p-44)
        return s > 0 ? 1 : -1;
    if (a == b)
        return 0;
    const uint32_t i = pir_space_exact_point(space, a), j = pir_space_exact_point(space, b);
    const uint32_t way = pir_space_exact_direction(space, direction);
    if (space->status != PIR_OK || i == j)
        return 0;
    // n·X_b · W_a against n·X_a · W_b: n is shorter than the points are
    mpz_t *along = space->number + way, *x = space->number + i, *y = space->number + j;
    pir_numbers_dot(space->t[0], along, x, 3);
    pir_numbers_dot(space->t[1], along, y, 3);
    mpz_mul(space->t[2], space->t[1], x[3]);
    mpz_submul(space->t[2], space->t[0], y[3]);
    return mpz_sgn(space->t[2]);
}
