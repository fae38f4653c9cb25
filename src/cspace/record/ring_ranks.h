/* SPDX-License-Identifier: MIT */
/*
 * How a record names a step from cell to neighbouring cell, and where it looks for a facet's cell first.
 *
 * The edges at a vertex are counted from 0 by rising number: a step from a vertex is named by the edge that leads on.
 * The two edges of a segment join the same two vertices; of such edges that of the least number is meant where only the
 * vertices are named.
 *
 * A facet's guide is the facet beside it of the least number, where that is less than its own: its cell is mostly that
 * of its guide or next to it.
 */
#ifndef PIR_CSPACE_RECORD_RING_RANKS_H
#define PIR_CSPACE_RECORD_RING_RANKS_H

#include "polytope/polytope.h"

#define PIR_NO_EDGE UINT32_MAX

/* In place of a halfedge, or of a facet: there is none. */
#define PIR_NO_HALF  UINT32_MAX
#define PIR_NO_GUIDE UINT32_MAX

typedef struct pir_ring_ranks {
    const pir_polytope *of; /* borrowed */
    uint32_t *rank;         /* per halfedge: the number of its edge among those at its origin */
    uint32_t *guide;        /* per facet: its guide, or PIR_NO_GUIDE */
} pir_ring_ranks;

/* O(edges). False when out of memory; pir_ring_ranks_finish releases whatever is there. */
bool pir_ring_ranks_init(pir_ring_ranks *ranks, const pir_polytope *of, const pir_allocator *allocator);
void pir_ring_ranks_finish(pir_ring_ranks *ranks, const pir_allocator *allocator);

/* The edges at a vertex. */
static inline uint32_t pir_ring_size(const pir_ring_ranks *ranks, uint32_t v) {
    return ranks->of->ring_start[v + 1] - ranks->of->ring_start[v];
}

/* The halfedge from one vertex to another, or PIR_NO_HALF. */
static inline uint32_t pir_half_between(const pir_ring_ranks *ranks, uint32_t from, uint32_t to) {
    const pir_polytope *p = ranks->of;
    const uint32_t *target = p->target, end = p->ring_start[from + 1];
    uint32_t found = PIR_NO_HALF;
    // a ring is short, and where in it the vertex stands is not foreseen: all of it is read
    for (uint32_t h = p->ring_start[from]; h < end; h++)
        found = target[h] == to ? h : found;
    if (p->vertex_count == 2 && found != PIR_NO_HALF && ranks->rank[found] != 0)
        found = p->ring_start[from] + (found == p->ring_start[from]);
    return found;
}

/* The halfedge of that rank at a vertex, or PIR_NO_HALF where there are fewer. */
static inline uint32_t pir_half_of_rank(const pir_ring_ranks *ranks, uint32_t from, uint32_t rank) {
    const pir_polytope *p = ranks->of;
    for (uint32_t h = p->ring_start[from]; h < p->ring_start[from + 1]; h++)
        if (ranks->rank[h] == rank)
            return h;
    return PIR_NO_HALF;
}

#endif
