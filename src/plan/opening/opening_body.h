/* SPDX-License-Identifier: MIT */
/*
 * A convex piece of a robot, and what planes cut of it.
 *
 * A plane is u·y = s in the piece's frame, u on the surface of the cube [−1, 1]³. Doubles here are for choices
 * alone: what is concluded of them is decided anew in rationals (opening_block.h).
 */
#ifndef PIR_PLAN_OPENING_OPENING_BODY_H
#define PIR_PLAN_OPENING_OPENING_BODY_H

#include <stdbool.h>
#include <stdint.h>

#include <gmp.h>

#include <pirouette/polytope.h>

#include "plan/opening/opening_polygon.h"

typedef struct pir_opening_body {
    uint32_t vertices, edges;
    double (*at)[3];
    mpq_t (*exact)[3];
    uint32_t (*edge)[2];
    double reach;                   /* a power of two: |u·y| is at most this */
    double (*spot)[2], (*range)[2]; /* scratch: points in a plane, heights of vertices */
    uint32_t *of;                   /* scratch: which edges the points are on, or vertices they are, after the edges */
} pir_opening_body;

/* The smallest circle round points of the scratch: two or three of them hold it. */
typedef struct pir_opening_circle {
    double square;    /* of its radius */
    uint32_t count;   /* of points, 2 or 3; 0 where there are none */
    uint32_t of[3];   /* as the scratch has it */
    double weight[3]; /* with which their mean is the middle: about 0 or more, together 1 */
} pir_opening_circle;

/* Takes a polytope, of dimension 3. */
pir_status pir_opening_body_make(const pir_polytope *piece, pir_opening_body *ret_body);
/* Makes it smaller, by a part of 2^-halvings, about a point within it. */
void pir_opening_body_shrink(pir_opening_body *body, const mpq_t point[3], uint32_t halvings);
void pir_opening_body_finish(pir_opening_body *body);

/* The square of the radius of the smallest circle round what a plane cuts; 0 where it does not cut the inside. */
double pir_opening_body_cut(const pir_opening_body *body, const double u[3], double s);

/*
 * About the square of the radius of the largest circle round what planes of a cell cut, of which these are the corners:
 * that round where edges may meet them, seen along u.
 */
double pir_opening_body_most(const pir_opening_body *body, const double u[3], const double (*corner)[3],
                             const double s[2]);

/*
 * The circle at a plane, for planes at whose heights `range` has all vertices: round where edges meet the plane that
 * have one end below all of the planes and one above, and vertices that are not beside all of them.
 */
void pir_opening_body_cuts(const pir_opening_body *body, const double u[3], double low, double high,
                           pir_opening_circle *ret_circle);

/* About the middle of the smallest circle round polygons in a plane. */
void pir_opening_body_disc(const double n[3], const pir_opening_polygon *polygon, uint32_t count, double ret_middle[3]);

static inline double pir_opening_height(const pir_opening_body *body, uint32_t vertex, const double u[3]) {
    const double *x = body->at[vertex];
    return u[0] * x[0] + u[1] * x[1] + u[2] * x[2];
}

#endif
