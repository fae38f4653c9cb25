/* SPDX-License-Identifier: MIT */
/* The cells of facets, from nothing. In every call the kernels know of the rotation. */
#ifndef PIR_DYMSUM_REBUILD_FACET_CELLS_H
#define PIR_DYMSUM_REBUILD_FACET_CELLS_H

#include "dymsum/pairing/tracked.h"

/*
 * Gives facets of P, or of Q, their cells, each from that of vertex `from`. They are PIR_DESCENT_MOST or fewer.
 */
void pir_settle_facets(pir_tracked *tracked, bool of_p, const uint32_t *facet, const uint32_t *from, uint32_t count);

/* The cell of a facet beside f of `own` that has one, or PIR_NO_PAIR. */
static inline uint32_t pir_cell_beside(const pir_polytope *own, const uint32_t *cell, uint32_t f) {
    uint32_t found = PIR_NO_PAIR;
    for (const pir_across *side = own->across + own->loop_start[f], *end = own->across + own->loop_start[f + 1];
         side < end; side++)
        found = cell[side->facet] < found ? cell[side->facet] : found;
    return found;
}

/* Bodies with so many halfedges are larger than a cache of the second level. */
#define PIR_MANY_HALVES 49152

/* Whether walks through a body fetch ahead. */
static inline bool pir_is_large(const pir_polytope *q) {
    return q->half_count >= PIR_MANY_HALVES && q->dimension == 3;
}

/* Fills fv. */
void pir_locate_facets_of_p(pir_tracked *tracked);

/* No arc of Q has a crossing: before those of P are walked. */
void pir_forget_met(pir_tracked *tracked);

/* Edge e of P crosses the arc of an edge of Q between two facets, from one to the other. */
static inline void pir_note_met(pir_tracked *tracked, uint32_t e, uint32_t edge, uint32_t right, uint32_t left) {
    const pir_edge_arc *arc = &tracked->pairing.p->edge_arc[e];
    uint32_t *cell = tracked->work->met[edge].of, many = -(uint32_t)(cell[0] != PIR_ONE_CELL) & PIR_MANY_CELLS;
    // by masks and an index: neither is foreseen
    cell[right < left] = arc->target | many;
    cell[right >= left] = arc->origin | many;
}

/*
 * Notes a passed edge where Q is large. Each crossing of an arc of Q leads from one cell of P to the next, so all of
 * them together add the difference of the numbers at the arc's two ends. It is noted for the facet that is visited from
 * the other.
 */
static inline void pir_note_passed(pir_tracked *tracked, uint32_t e, uint32_t right, uint32_t left) {
    const pir_edge_arc *arc = &tracked->pairing.p->edge_arc[e];
    const uint32_t *beside = tracked->pairing.q->beside;
    uint32_t passed = arc->target - arc->origin, forth = beside[left] == right, back = beside[right] == left;
    tracked->pairing.vf[forth ? left : right] += (passed & -forth) - (passed & -back);
}

/* Fills vf from what has been noted. */
void pir_locate_facets_of_q(pir_tracked *tracked);

#endif
