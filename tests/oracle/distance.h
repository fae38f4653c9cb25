/* SPDX-License-Identifier: MIT */
/* Exact distances from points to polytopes of dimension 3, by trying every facet and side. */
#ifndef PIR_ORACLE_DISTANCE_H
#define PIR_ORACLE_DISTANCE_H

#include <gmp.h>

#include <pirouette/polytope.h>

typedef struct oracle_body {
    uint32_t vertices, facets;
    mpq_t (*at)[3];
    uint32_t *start, *corner;
    mpq_t (*normal)[3]; /* outward, of any length */
} oracle_body;

void oracle_body_init(oracle_body *body, const pir_polytope *polytope);
void oracle_body_clear(oracle_body *body);

/*
 * NULL where every facet is planar and all vertices are on it or below, those that are no corners strictly; else what
 * does not hold.
 */
const char *oracle_body_is_convex(const oracle_body *body);

/* The square of the distance from a point to the body, 0 inside. */
void oracle_distance_squared(mpq_t ret_square, const oracle_body *body, mpq_t point[3]);

/* Whether every vertex of `a` is within `bound` of `b`. */
int oracle_is_within(const oracle_body *a, const oracle_body *b, double bound);

#endif
