/* SPDX-License-Identifier: MIT */
/*
 * Memory that repairs will read, fetched while others are under way. On large bodies it is in no cache near the
 * processor, and what is to be repaired is known well ahead. Nothing depends on these calls but time.
 *
 * An edge is fetched in turns: first what has its number, then its first crossing, then what that crosses.
 */
#ifndef PIR_DYMSUM_UPDATE_FETCH_AHEAD_H
#define PIR_DYMSUM_UPDATE_FETCH_AHEAD_H

#include "base/fetching.h"
#include "dymsum/pairing/tracked.h"

/* Sums with so many facets fetch ahead: edges by so many items, crossings by half, and what is crossed by a quarter. */
#define PIR_FETCHING_FACETS 16384
#define PIR_FETCHED_AHEAD   24

static inline bool pir_fetches_ahead(const pir_tracked *tracked) {
    return pir_certificate_count(tracked) >= PIR_FETCHING_FACETS;
}

PIR_FETCHING void pir_fetch_edge(const pir_tracked *tracked, uint32_t e) {
    PIR_FETCH(&tracked->pairing.crossings.first[e]);
    PIR_FETCH(&tracked->touched[e]);
}

/* The slot, or any where there is none: by a mask, since which it is is not foreseen. */
static inline uint32_t pir_some_slot(uint32_t slot) {
    return slot & -(uint32_t)(slot != PIR_NO_CROSSING);
}

/* Fetches a slot, if it is one. */
PIR_FETCHING void pir_fetch_slot(const pir_tracked *tracked, uint32_t slot) {
    PIR_FETCH(&tracked->pairing.crossings.at[pir_some_slot(slot)]);
}

PIR_FETCHING void pir_fetch_crossing(const pir_tracked *tracked, uint32_t e) {
    pir_fetch_slot(tracked, tracked->pairing.crossings.first[e]);
}

/* Fetches the second crossing of edge e. */
PIR_FETCHING void pir_fetch_next_crossing(const pir_tracked *tracked, uint32_t e) {
    const pir_crossings *c = &tracked->pairing.crossings;
    pir_fetch_slot(tracked, c->at[pir_some_slot(c->first[e])].next);
}

PIR_FETCHING void pir_fetch_crossed(const pir_tracked *tracked, uint32_t e) {
    const pir_pairing *pairing = &tracked->pairing;
    uint32_t half = pairing->crossings.at[pir_some_slot(pairing->crossings.first[e])].half;
    PIR_FETCH(&pairing->q->origin[half]);
    PIR_FETCH(&pairing->q->target[half]);
    PIR_FETCH(&pairing->q->left[half]);
    PIR_FETCH(&pairing->q->twin[half]);
}

/* Fetches the halfedges round facet g of Q. */
PIR_FETCHING void pir_fetch_round(const pir_polytope *q, uint32_t g) {
    for (uint32_t i = q->loop_start[g]; i < q->loop_start[g + 1]; i++) {
        uint32_t half = q->loop[i];
        PIR_FETCH(&q->origin[half]);
        PIR_FETCH(&q->target[half]);
        PIR_FETCH(&q->left[half]);
        PIR_FETCH(&q->twin[half]);
    }
}

/* Fetches where the rings of its corners begin. */
PIR_FETCHING void pir_fetch_rings(const pir_polytope *q, uint32_t g) {
    for (uint32_t i = q->loop_start[g]; i < q->loop_start[g + 1]; i++)
        PIR_FETCH(&q->ring_start[q->origin[q->loop[i]]]);
}

#endif
