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

/* Walks the arc of edge e between two different cells, and lists its crossings. False when out of memory. */
bool pir_walk_arc(pir_tracked *tracked, uint32_t e, uint32_t from, uint32_t to);

/*
 * Lists the crossings of edge e, whose ends have cells, in a store that has been emptied. False when out of memory.
 */
static inline bool pir_walk_edge(pir_tracked *tracked, uint32_t e) {
    const pir_arc_ends ends = tracked->pairing.p->arc_ends[e];
    uint32_t from = tracked->pairing.fv[ends.from], to = tracked->pairing.fv[ends.to];
    // an arc whose ends are in one cell stays in it
    return from == to || pir_walk_arc(tracked, e, from, to);
}

/*
 * Makes the whole pairing from nothing and leaves its certificates expired. There are no crossings before. On
 * PIR_ERR_MEMORY the pairing is not usable.
 */
pir_status pir_walk_rebuild(pir_tracked *tracked);

#endif
