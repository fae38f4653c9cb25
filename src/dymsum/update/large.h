/* SPDX-License-Identifier: MIT */
/* Repairs of large sums. */
#ifndef PIR_DYMSUM_UPDATE_LARGE_H
#define PIR_DYMSUM_UPDATE_LARGE_H

#include "dymsum/pairing/tracked.h"

/* Sums with so many facets are large: repairs fetch the memory that later ones read, and edges are derived together. */
#define PIR_LARGE_FACETS 16384

static inline bool pir_sum_is_large(const pir_tracked *tracked) {
    return pir_certificate_count(tracked) >= PIR_LARGE_FACETS;
}

/* An end of the arc of an edge of P, of one of a facet's sides, crosses the arc of halfedge `half` of Q. */
typedef struct pir_move {
    pir_across side;
    uint32_t half;
} pir_move;

/* Between two turns of a move there are so many others, and there is room for those of three turns. */
#define PIR_MOVES_APART 16
#define PIR_MOVES_ROOM  (4 * PIR_MOVES_APART)

/* Moves to be made in a later turn, in order. */
typedef struct pir_moves {
    pir_tracked *tracked;
    uint32_t stamp;         /* of the edges moved, in tracked->touched */
    uint32_t queued, turns; /* in all */
    bool failed;            /* out of memory */
    pir_move at[PIR_MOVES_ROOM];
} pir_moves;

void pir_moves_begin(pir_moves *moves, pir_tracked *tracked, uint32_t stamp);

/* Facet f of P has crossed the arc of halfedge h of Q: the edges that start or end there are to follow. */
void pir_moves_queue(pir_moves *moves, uint32_t f, uint32_t h);

/* Makes those that are left. False when memory has run out for one. */
bool pir_moves_finish(pir_moves *moves);

/*
 * Derives the crossings of `count` different edges of a large sum anew, as pir_derive_edge does of each. False when out
 * of memory.
 */
bool pir_derive_edges(pir_tracked *tracked, const uint32_t *edge, uint32_t count);

#endif
