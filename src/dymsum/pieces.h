/* SPDX-License-Identifier: MIT */
/*
 * The pieces of a sum, one polygon of vertex pairs for each pair of the pairing, and which of them make one facet of the true sum.
 */
#ifndef PIR_DYMSUM_PIECES_H
#define PIR_DYMSUM_PIECES_H

#include "dymsum/sum.h"
#include "polytope/mesh.h"

typedef struct pir_corner {
    uint32_t p, q;
} pir_corner;

/*
 * Polygons of corners, counter-clockwise from outside: those of P's facets first, then Q's, then the crossings by rising edge and along
 * each arc. group[i] is the piece that stands for the facet piece i belongs to: itself when it is alone or first; PIR_DROPPED when it has
 * no area.
 */
typedef struct pir_pieces {
    uint32_t count, corner_count;
    uint32_t *start; /* count + 1 */
    pir_corner *corner;
    uint32_t *group;
    bool merged; /* whether any two pieces share a facet or one was dropped */
} pir_pieces;

#define PIR_DROPPED UINT32_MAX

/* The pieces of the sum at its rotation, grouped exactly. PIR_ERR_MEMORY leaves nothing to release. */
pir_status pir_pieces_make(pir_pieces *pieces, pir_sum *sum);
void pir_pieces_finish(pir_pieces *pieces, const pir_allocator *allocator);

#endif
