/* SPDX-License-Identifier: MIT */
/*
 * The edges around each vertex of a body and the sides around each facet, four at a time, as vector loops read them.
 *
 * Every vertex has the same number of blocks, and so has every facet. What is left of them is no number, which loops
 * for a least or a greatest one pass over.
 */
#ifndef PIR_QUERY_FRAME_AROUND_H
#define PIR_QUERY_FRAME_AROUND_H

#include "base/memory.h"
#include "polytope/polytope.h"

/* A vertex or a facet has at most this many blocks; bodies of more vertices have none at all. */
#define PIR_AROUND_BLOCKS   4
#define PIR_AROUND_VERTICES 4096

/* One coordinate of four vectors beside one another. */
typedef struct pir_fours {
    double x[4], y[4], z[4];
} pir_fours;

/* Sides: the vectors across them that look inwards, n × e of their facet, and where they begin. */
typedef struct pir_sides {
    pir_fours in, from;
} pir_sides;

typedef struct pir_around {
    const pir_fours *rings; /* directions of edges, per vertex */
    const pir_sides *sides; /* per facet */
    uint32_t ring_blocks, side_blocks;
    double *memory; /* what both are in */
} pir_around;

/* Whether it has an inside, and nothing in it is too large: others have none. */
bool pir_around_has(const pir_polytope *p);

/* False when out of memory. `vertex` are those of the body. */
bool pir_around_make(const pir_polytope *p, const pir_vec3 *vertex, pir_around *around);
void pir_around_free(const pir_polytope *p, pir_around *around);

#endif
