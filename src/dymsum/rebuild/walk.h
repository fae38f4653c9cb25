/* SPDX-License-Identifier: MIT */
/* The rebuild by walk, and one step of an arc from cell to cell. */
#ifndef PIR_DYMSUM_REBUILD_WALK_H
#define PIR_DYMSUM_REBUILD_WALK_H

#include "dymsum/pairing/tracked.h"

/*
 * The halfedge of Q through which the arc along halfedge h of P, rotated to `direction`, leaves the cell of vertex v.
 * `entered` is the halfedge that led into v, or PIR_NO_CROSSING when the arc starts there.
 */
uint32_t pir_leave_cell(pir_tracked *tracked, uint32_t h, pir_vec3 direction, uint32_t v, uint32_t entered);

/*
 * Lists the crossings of `count` edges of P, listed or all, whose ends have cells, in a store that has been forgotten.
 * Notes those of all edges (pir_note_met). False when out of memory.
 */
bool pir_walk_edges(pir_tracked *tracked, const uint32_t *edge, uint32_t count);

/* Crossings found aside of a sum's store: those of an edge stand together, in order. */
#define PIR_WALKED_MOST 2048

typedef struct pir_walked_crossing {
    uint32_t edge, half;
} pir_walked_crossing;

typedef struct pir_walked {
    uint32_t count;
    pir_walked_crossing at[PIR_WALKED_MOST];
} pir_walked;

/*
 * Finds the crossings of `count` edges of P, which stand in the order of the edges then, and changes nothing. False
 * where there are too many.
 */
bool pir_walk_aside(pir_tracked *tracked, const uint32_t *edge, uint32_t count, pir_walked *ret_walked);

/*
 * Makes the whole pairing from nothing and leaves its certificates expired. Crossings have been forgotten. On
 * PIR_ERR_MEMORY the pairing is not usable.
 */
pir_status pir_walk_rebuild(pir_tracked *tracked);

#endif
