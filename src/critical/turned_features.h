/* SPDX-License-Identifier: MIT */
/*
 * The features of two bodies during a turn of P about an axis, and the planes of the facets that they make, in integers
 * and rounded.
 *
 * κ = k·2^exponent, and u in units of 2^exponent is a vector of integers. R is M/|q|² with a matrix M of quadratics
 * in k with integer coefficients, and |q|² = norm·(k² + |u|²). So a direction or a point of P, turned and times
 * |q|², is a quadratic in k. P is here as it is in the sum: of a difference, −P.
 *
 * The slack of a translation t at a facet of the sum is n·t − h, positive where t is outside. Times |q|² > 0:
 *
 *     facet f of P at vertex b of Q:        Mn_f·(t − b) − h_f |q|²
 *     facet g of Q at vertex a of P:        (n_g·t − h_g) |q|² − n_g·Ma
 *     edge d through a, edge e through b:   ±((Md × e)·(t − b) − M(a × d)·e), and ± is the sign of Mn_l·e
 *
 * with l the facet that the arc of d leads from. The last one is the triple product of the two edges and the line
 * between them, in Plücker coordinates, on which a rotation acts linearly: Ma × Md = |q|² M(a × d). So no slack has
 * a degree above 2. Where Mn_l·e is 0 the edges are parallel, or the plane is that of the facet l: the facet has no
 * area there, and bounds nothing that others do not.
 *
 * Points are in units of 1/unit, in which they are integers; slacks are multiples of the true ones by a positive
 * factor that depends on κ alone.
 */
#ifndef PIR_CRITICAL_TURNED_FEATURES_H
#define PIR_CRITICAL_TURNED_FEATURES_H

#include <pirouette/witness.h>

#include "motion/turning.h"

/* A body in integers. Of P directions and points are turned: nine numbers each, three a power of k, highest first. */
typedef struct pir_body_integers {
    mpz_t *normal, *edge, *point; /* per facet, edge (along edge_half) and vertex */
    mpz_t *offset;                /* per facet: n·x on its plane, n and x as they stand */
    mpz_t *moment;                /* per edge of P: a × d, turned; of Q NULL */
} pir_body_integers;

typedef struct pir_turned {
    pir_allocator allocator;
    const pir_polytope *body[2]; /* P and Q, which the owner holds */
    pir_body_integers exact[2];
    mpz_t axis[3], square, norm; /* u, |u|², and the norm of q₀ on the scale of M */
    mpz_t unit;
    int exponent;
    int width;         /* the bits of the longest component of u */
    pir_scaled length; /* of u in units of 2^exponent */
} pir_turned;

/* A facet's plane: t has the slack Σ k^(2−i)·(a[i]·(unit t) + b[i]), times the sign of Σ o[i]·k^(2−i). */
typedef struct pir_exact_plane {
    mpz_t a[3][3], b[3], o[3];
    bool has_sign; /* else o is 1 */
} pir_exact_plane;

/*
 * A plane rounded, each number within 2^-51 of the exact one relatively, or within 2^-1000 absolutely; all of a and b
 * times one power of two, all of o times another. κ is in units of the power of two just above the longest component
 * of u, and `unit` is taken in.
 */
typedef struct pir_rounded_plane {
    double a[3][3], b[3], o[3];
    bool has_sign;
} pir_rounded_plane;

/* Makes the integers of a turn. On failure there is nothing to finish. PIR_ERR_MEMORY. */
pir_status pir_turned_init(pir_turned *turned, const pir_allocator *allocator, const pir_polytope *const body[2],
                           const pir_turning *turning, pir_quat start);
void pir_turned_finish(pir_turned *turned);

void pir_exact_plane_init(pir_exact_plane *plane);
void pir_exact_plane_clear(pir_exact_plane *plane);

/* The plane of a facet of the sum, told by the faces that make it. */
void pir_turned_plane(const pir_turned *turned, const pir_witness *faces, pir_exact_plane *dst);
pir_rounded_plane pir_turned_round(const pir_turned *turned, const pir_exact_plane *plane);

/* The quadratic Mn·e of a facet of P and a halfedge of Q, or of a halfedge of P and a facet of Q where not `of_p`. */
void pir_turned_sign(const pir_turned *turned, bool of_p, uint32_t facet, uint32_t half, mpz_t dst[3]);

/* dst = x/2^exponent, which must be an integer. */
void pir_integer_of_double(mpz_t dst, double x, int exponent);

#endif
