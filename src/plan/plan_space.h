/* SPDX-License-Identifier: MIT */
/*
 * Planes and points of one plan, in integers, with doubles beside them that decide most signs.
 *
 * A plane is n·x = d with coprime integers, the first of n that is not 0 being positive, so that equal planes have
 * one number. A half-space is twice a plane's number, plus 1 where it is turned: its points have n·x ≤ d, turned
 * n·x ≥ d. A point is x/w with coprime integers, w > 0. Planes never change once they are made, and
 * points but get their integers.
 *
 * Doubles: those of a plane are n and d over one power of two, each within 2^-52 of the exact one, relatively; those of
 * a point within 2^-50, and `room` more. Then of n·x − d each product is within 2^-49.4 of its own size, and sums
 * add three roundings: PIR_PLAN_ERROR, 2^-48 of the sum of sizes, is a bound, with n times room, and PIR_PLAN_TINY
 * times sizes of coordinates for what underflows. Values that are not finite fail both comparisons, and integers
 * decide.
 *
 * A point where a segment meets a plane is made in doubles alone, with the room that its ends and the signs leave it:
 * of x = (s_b·a − s_a·b) / (s_b − s_a), where s are n·x − d within e, that is at most the greater room of the
 * ends, 2·(e_a + e_b) / (s_b − s_a) of the way from a to b, and 2^-47 of sizes. Its integers are made when they are
 * asked for; then it has no room. Where e are not small beside s, or many such points stand on each other, they are
 * made at once.
 *
 * Failures stay in `status`. The limit counts blocks of the allocator and the limbs of points.
 */
#ifndef PIR_PLAN_PLAN_SPACE_H
#define PIR_PLAN_PLAN_SPACE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include <gmp.h>

#include <pirouette/base.h>

#define PIR_PLAN_ERROR 0x1p-48
#define PIR_PLAN_TINY  0x1p-1000
#define PIR_PLAN_NONE  UINT32_MAX

/*
 * Statuses of plans beside PIR_ERR_LIMIT, which is then that memory ends: more parts are needed than may be made, and
 * the caller has ended it. Callers of the library are never told them.
 */
#define PIR_PLAN_ERR_PARTS  ((pir_status)(PIR_ERR_INTERNAL + 1))
#define PIR_PLAN_ERR_CALLER ((pir_status)(PIR_ERR_INTERNAL + 2))

typedef struct pir_plan_plane {
    mpz_t n[3], d;
    double a[3], b;
    uint32_t next; /* in its list of the table */
} pir_plan_plane;

typedef struct pir_plan_point {
    mpz_t x[3], w; /* where it is exact */
    double at[3], room;
    uint32_t plane, end[2]; /* where it is not: where the segment between the ends meets a plane */
    uint16_t depth;         /* of such points that stand on each other */
    bool is_exact;
} pir_plan_point;

typedef struct pir_plan_space {
    pir_allocator allocator;
    pir_status status;
    size_t used, limit; /* bytes */
    pir_plan_plane *plane;
    pir_plan_point *point;
    uint32_t plane_count, plane_room, point_count, point_room;
    uint32_t *table; /* planes by their numbers: the first of each list */
    uint32_t table_size;
    mpz_t t[6]; /* scratch */
} pir_plan_space;

void pir_plan_space_init(pir_plan_space *space, const pir_allocator *allocator, size_t limit);
void pir_plan_space_finish(pir_plan_space *space);

/* A block of `count` elements, zeroed; NULL once `status` is a failure. */
void *pir_plan_new(pir_plan_space *space, size_t count, size_t size);
void pir_plan_free(pir_plan_space *space, void *block, size_t count, size_t size);

/* Grows *array, of *room elements of a size, to hold `need`. False once `status` is a failure. */
bool pir_plan_grow(pir_plan_space *space, void **array, uint32_t *room, uint32_t need, size_t size);

/* The half-space n·x ≤ d of integers, not all of n 0. Both may be scratch from t[0] on, and are changed. */
uint32_t pir_plan_half(pir_plan_space *space, mpz_t *n, mpz_t d);

/* A point of rationals, canonical; one of doubles. */
uint32_t pir_plan_point_of(pir_plan_space *space, const mpq_t x[3]);
uint32_t pir_plan_point_at(pir_plan_space *space, const double x[3]);

/* The point where the segment from `below` to `above` meets a plane, on whose sides they are, strictly. */
uint32_t pir_plan_point_between(pir_plan_space *space, uint32_t plane, uint32_t below, uint32_t above);

/* The middle of points, as their mean. */
uint32_t pir_plan_point_mean(pir_plan_space *space, const uint32_t *points, uint32_t count);

/* The point with its integers. */
const pir_plan_point *pir_plan_point_exact(pir_plan_space *space, uint32_t point);

/* n·x − d times w, exactly, for a half-space: below 0 within it. */
void pir_plan_excess(pir_plan_space *space, uint32_t half, uint32_t point, mpz_t ret_excess);

/* The sign of n·x − d by integers. */
int pir_plan_exact_side(pir_plan_space *space, uint32_t plane, uint32_t point);

/* n·x − d in doubles, and how far from it the exact one may be. */
static inline double pir_plan_value(const pir_plan_space *space, uint32_t plane, uint32_t point, double *ret_error) {
    const pir_plan_plane *p = &space->plane[plane];
    const double *x = space->point[point].at;
    const double u = p->a[0] * x[0], v = p->a[1] * x[1], w = p->a[2] * x[2];
    const double tiny = (1 + fabs(x[0]) + fabs(x[1]) + fabs(x[2])) * PIR_PLAN_TINY;
    *ret_error = (fabs(u) + fabs(v) + fabs(w) + fabs(p->b)) * PIR_PLAN_ERROR + tiny +
                 (fabs(p->a[0]) + fabs(p->a[1]) + fabs(p->a[2])) * space->point[point].room;
    return u + v + w - p->b;
}

/* The sign of n·x − d. */
static inline int pir_plan_plane_side(pir_plan_space *space, uint32_t plane, uint32_t point) {
    double error;
    const double s = pir_plan_value(space, plane, point, &error);
    if (s > error)
        return 1;
    if (s < -error)
        return -1;
    return pir_plan_exact_side(space, plane, point);
}

/* Where a point is: −1 within a half-space, 0 on its plane, 1 outside. */
static inline int pir_plan_side(pir_plan_space *space, uint32_t half, uint32_t point) {
    const int side = pir_plan_plane_side(space, half >> 1, point);
    return half & 1 ? -side : side;
}

/* About how far a point is outside of a half-space, in lengths; negative within. For choices alone. */
double pir_plan_distance(const pir_plan_space *space, uint32_t half, uint32_t point);

#endif
