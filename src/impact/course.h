/* SPDX-License-Identifier: MIT */
/*
 * Two bodies, one of which turns about an axis or goes along a way, and the conditions that hold on its course.
 *
 * κ falls from +∞: of a turn by θ it is |u|·cot(θ/2), of a way it is 1/λ at the fraction λ. Points are relative
 * to the pivot. A point x of P is then at (κ² x + 2κ (u × x) + 2u (u·x) − |u|² x)/(κ² + |u|²), or at
 * x + way/κ. A screw has the first of these and way·κ₁/κ besides, with the κ₁ of its end.
 *
 * A condition is a number that is negative while it holds. All are quadratics in κ, after multiplication by
 * κ² + |u|² or κ². For planes this follows from the above. Of two edges, with directions e and f through a and b,
 * the triple product (Re × f)·(Ra − b) is f·R(a × e) − Re·(f × b): the edges' Plücker coordinates, on which
 * a rotation acts linearly. So no contact about an axis has a degree above 2. A screw adds a number that is linear
 * in the rotation, times κ₁/κ: its conditions, times κ, are cubics.
 *
 * In doubles u has length 1 and κ stands for (σ, τ) of length 1 with σ/τ = cot(θ/2), or κ itself for a way; φ
 * in [0, π) is its angle. Error of a coefficient, with v = 2^-53 and the size of bodies, poses, pivot and way together
 * as 1: a unit vector is turned within 45v, a point is placed within 48v, the axis is within 4v. The product of two is
 * off by 105v then, with the cross product and its rounding by 230v, with the reflection and its own by 290v, and the
 * constant of a plane, another product, is off by 105v. Together below 400v. Conditions on edges have two such terms:
 * below 800v, PIR_COURSE_BOUND is 1024v. A screw's way, times cot(θ₁/2) of the end within 8v, counts towards the
 * size; its terms are single products, which are off by less.
 */
#ifndef PIR_IMPACT_COURSE_H
#define PIR_IMPACT_COURSE_H

#include <pirouette/impact.h>

#include "base/vec.h"
#include "exact/vectors.h"
#include "impact/cubic.h"
#include "motion/quadratic.h"
#include "polytope/polytope.h"

#define PIR_COURSE_BOUND 0x1p-43

typedef enum pir_condition_kind {
    PIR_Q_PLANE,  /* vertex of P outside of a facet of Q */
    PIR_P_PLANE,  /* vertex of Q outside of a facet of P */
    PIR_Q_SIDE,   /* vertex of P on the inner side of a halfedge of Q, within its left facet */
    PIR_P_SIDE,   /* vertex of Q on the inner side of a halfedge of P */
    PIR_CROSSING, /* one of four: the arcs of two edges cross */
    PIR_EDGES,    /* P and Q on their sides of the plane that is parallel to two edges */
} pir_condition_kind;

typedef struct pir_condition {
    pir_condition_kind kind;
    uint32_t p, q;  /* the two features; of PIR_CROSSING and PIR_EDGES edges */
    int8_t side;    /* of edges: 1 where Re × f points from Q to P, else −1 */
    uint8_t corner; /* of PIR_CROSSING: facet left and right of P's edge, left and right of Q's */
} pir_condition;

/*
 * c[0]·σ² + c[1]·στ + c[2]·τ², each within `bound`; of a screw c[0]·σ³ + c[1]·σ²τ + c[2]·στ² +
 * c[3]·τ³.
 */
typedef struct pir_course_form {
    double c[4], bound;
} pir_course_form;

/* Numbers that conditions are computed in, kept for the next one; of mpz_t alone. */
typedef struct pir_course_work {
    mpz_t first[3], second[3], turned[3], a[3], b[3], other[3], rest[3], x, y, z, h;
} pir_course_work;

/* Exact numbers, made when a filter fails first; GMP's, for they are rationals on one scale. */
typedef struct pir_course_integers {
    pir_vectors points[2];
    mpz_t *point[2]; /* views of these, per body three a vertex */
    mpz_t way[3], axis[3], square;
    int exponent; /* κ = k·2^exponent */
    mpz_t end;    /* of a screw: the k of its end, times 2^end_shift */
    mp_bitcnt_t end_shift;
    pir_cubic cubic;
    pir_cubic_root cubic_root;
    mpz_t root[3], best[3], other[3];
    bool has_best; /* `best` is the quadratic of the first exit found so far */
    pir_course_work work;
    mp_limb_t *limbs;
    uint32_t double_limbs; /* of a double as a quadratic */
    pir_limbs scratch;
} pir_course_integers;

typedef struct pir_course {
    const pir_allocator *allocator;
    const pir_polytope *body[2];
    pir_pose pose[2];
    pir_vec3 pivot, axis, way;
    bool turns, screws;
    double end_kappa;   /* of the end, −∞ for a full turn */
    pir_vec3 unit;      /* the axis */
    pir_vec3 advance;   /* of a screw: the way times cot(θ/2) of the end */
    double size;        /* of points and the way */
    pir_vec3 *point[2]; /* placed, relative to the pivot */
    pir_vec3 *normal[2];
    pir_vec3 *edge[2]; /* directions of edge_half */
    bool has_integers;
    pir_course_integers exact;
    uint64_t by_exact; /* questions that integers decided */
} pir_course;

/* On failure there is nothing to finish. PIR_ERR_MEMORY. */
pir_status pir_course_init(pir_course *course, const pir_polytope *const body[2], const pir_pose pose[2]);
void pir_course_finish(pir_course *course);

/* Where a point of P, and a direction of P, is at a φ. */
pir_vec3 pir_course_point(const pir_course *course, pir_vec3 x, double phi);
pir_vec3 pir_course_direction(const pir_course *course, pir_vec3 x, double phi);

/* Forms of all conditions of a facet's plane: a coefficient is its row times the other body's vertex, and h. */
typedef struct pir_plane_rows {
    pir_vec3 row[3];
    double h[4], bound;
    const pir_vec3 *point; /* of the other body */
} pir_plane_rows;

pir_plane_rows pir_course_rows(const pir_course *course, const pir_condition *plane);

static inline pir_course_form pir_rows_form(const pir_plane_rows *rows, uint32_t v) {
    const pir_vec3 x = rows->point[v];
    return (pir_course_form){{pir_vec_dot(rows->row[0], x) + rows->h[0], pir_vec_dot(rows->row[1], x) + rows->h[1],
                              pir_vec_dot(rows->row[2], x) + rows->h[2], rows->h[3]},
                             rows->bound};
}

/* The form of a condition. */
pir_course_form pir_course_form_of(const pir_course *course, const pir_condition *condition);

/*
 * The quadratic in k, into three integers, and its view, which ends with them. PIR_ERR_MEMORY of the first call, when
 * integers are made.
 */
pir_status pir_course_integers_make(pir_course *course);
void pir_course_exact(pir_course *course, const pir_condition *condition, mpz_t dst[3]);
pir_quadratic pir_course_view(mpz_t c[3]);

/* Of a screw: the cubic in 1/k. */
void pir_course_cubic(pir_course *course, const pir_condition *condition, pir_cubic *dst);

/*
 * The polynomial in κ, without a common divisor; its exit root is that of the condition. Three coefficients, of a
 * screw four.
 */
pir_status pir_course_polynomial(pir_course *course, const pir_condition *condition, mpz_t *dst);

#endif
