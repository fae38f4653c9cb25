/* SPDX-License-Identifier: MIT */
/*
 * The neighbours of a vertex, counted from 0 by rising number, and the edges to them: how a record names a step from
 * cell to neighbouring cell. The two edges of a segment join the same two vertices; the one of the least number counts.
 */
#ifndef PIR_CSPACE_RECORD_NEIGHBOURS_H
#define PIR_CSPACE_RECORD_NEIGHBOURS_H

#include "polytope/polytope.h"

#define PIR_NO_EDGE UINT32_MAX

/* The edge from one vertex to another, or PIR_NO_EDGE. */
static inline uint32_t pir_edge_between(const pir_polytope *p, uint32_t from, uint32_t to) {
    uint32_t edge = PIR_NO_EDGE;
    for (uint32_t h = p->ring_start[from]; h < p->ring_start[from + 1]; h++)
        if (p->target[h] == to && p->edge[h] < edge)
            edge = p->edge[h];
    return edge;
}

/* How many neighbours of `from` have a smaller number than `to`. */
static inline uint32_t pir_neighbour_rank(const pir_polytope *p, uint32_t from, uint32_t to) {
    uint32_t rank = 0;
    for (uint32_t h = p->ring_start[from]; h < p->ring_start[from + 1]; h++)
        rank += p->target[h] < to;
    return rank;
}

/* The neighbour of that rank, or UINT32_MAX where there are fewer. */
static inline uint32_t pir_neighbour_at(const pir_polytope *p, uint32_t from, uint32_t rank) {
    for (uint32_t h = p->ring_start[from]; h < p->ring_start[from + 1]; h++)
        if (pir_neighbour_rank(p, from, p->target[h]) == rank)
            return p->target[h];
    return UINT32_MAX;
}

#endif
