/* SPDX-License-Identifier: MIT */
/*
 * The facets and edges of a convex polytope by brute force: every plane through three vertices that supports all others
 * is a facet's. Signs are exact: a filter in doubles skips what is plain, GMP integers decide the rest. Only the
 * vertices of the polytope are read.
 */
#ifndef PIR_ORACLE_SOLID_H
#define PIR_ORACLE_SOLID_H

#include <pirouette/query.h>

#include "oracle/points.h"

/* A set of vertices: bit i % 64 of word i / 64. */
typedef uint64_t oracle_set;

typedef struct oracle_solid {
    uint32_t count, words; /* vertices; words of a set of them */
    int dimension;
    long unit;         /* integers below are in units of 2^unit */
    oracle_vec first;  /* vertex 0 */
    oracle_vec *at;    /* vertex i less vertex 0 */
    double (*near)[3]; /* the same times a power of two: below 1, each coordinate within 2^-52 of itself */
    uint32_t facet_count, facet_room, edge_count, edge_room;
    oracle_vec *normal; /* outward, of any length; a polygon has both of its sides, a segment and a point have none */
    oracle_set *facet;  /* `words` for each */
    uint32_t (*edge)[2];
} oracle_solid;

/* Of vertices that are doubles. The program ends when memory runs out. */
oracle_solid *oracle_solid_make(const pir_polytope *polytope);
void oracle_solid_free(oracle_solid *solid);

/* NULL when the facets and edges of the polytope are those found here, otherwise what differs. */
const char *oracle_solid_compare(const oracle_solid *solid, const pir_polytope *polytope);

/* The vertices of a feature of the polytope as a set; 0 when it has no such feature. */
int oracle_solid_feature(const oracle_solid *solid, const pir_polytope *polytope, pir_feature feature,
                         oracle_set *ret_set);

int oracle_set_has(const oracle_set *set, uint32_t i);
void oracle_set_put(oracle_set *set, uint32_t i);

/* --- what the oracle of placements shares --- */

/* The greatest e so that all `count` doubles are multiples of 2^e; `most` when they are 0. */
long oracle_unit(const double *x, size_t count, long most);

/* x / 2^unit, which is an integer. */
void oracle_set_double(mpz_t r, double x, long unit);

/*
 * v times the power of two that brings the largest coordinate into [1/2, 1), truncated; its exponent, or LONG_MIN for
 * zero.
 */
long oracle_near(double ret_near[3], oracle_vec v);

/* `from` times 2^-exponent. */
void oracle_near_at(double ret_near[3], oracle_vec from, long exponent);

/* Room for one more of `size` bytes each, or the end of the program. */
void *oracle_grow(void *at, uint32_t count, uint32_t *room, size_t size);
void *oracle_new(size_t count, size_t size);

#endif
