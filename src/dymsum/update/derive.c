/* SPDX-License-Identifier: MIT */
/*
 * The crossings of many edges, derived anew: walked from nothing, side by side, for on a large body the memory that an
 * arc is read from takes longer than finding again what is still crossed. What was crossed before is compared with the
 * result: crossings that are no more count as repaired.
 */
#include "dymsum/update/derive.h"

#include "dymsum/pairing/crossings.h"
#include "dymsum/rebuild/walk.h"
#include "dymsum/update/fetch_ahead.h"

/* So many edges are walked at a time: what is fetched for them stays near the processor. */
#define TOGETHER 512

/* Second crossings are fetched by so many edges ahead. */
#define NEXT_AHEAD 12

/* Fetches what a walk begins with, for `count` edges, and gives their first crossings. */
static void begin(const pir_tracked *tracked, const uint32_t *edge, uint32_t count, uint32_t *ret_first) {
    const pir_edge_arc *arc = tracked->pairing.p->edge_arc;
    const uint32_t *first = tracked->pairing.crossings.first, *fv = tracked->pairing.fv;
    for (uint32_t i = 0; i < count; i++) {
        PIR_FETCH(&arc[edge[i]]);
        PIR_FETCH(&first[edge[i]]);
    }
    for (uint32_t i = 0; i < count; i++) {
        ret_first[i] = first[edge[i]];
        pir_fetch_slot(tracked, ret_first[i]);
        PIR_FETCH(&fv[arc[edge[i]].ends.from]);
        PIR_FETCH(&fv[arc[edge[i]].ends.to]);
    }
}

/* Whether a crossing of the list from slot `at` to slot `end` leaves the cell that halfedge h of Q leaves. */
static bool is_left_before(const pir_pairing *pairing, uint32_t at, uint32_t end, uint32_t h) {
    const uint32_t *origin = pairing->q->origin;
    while (at != end && origin[pir_crossing_half(pairing, at)] != origin[h])
        at = pir_crossing_next(pairing, at);
    return at != end;
}

/*
 * Frees, of the list at *old, which the arc had before, the crossing of halfedge h of Q that it has now: unless it had
 * left that cell by another side first.
 */
static void free_kept(pir_tracked *tracked, uint32_t *old, uint32_t h) {
    pir_crossings *c = &tracked->pairing.crossings;
    uint32_t *at = old;
    while (*at != PIR_NO_CROSSING && c->at[*at].half != h)
        at = &c->at[*at].next;
    uint32_t slot = *at;
    if (slot == PIR_NO_CROSSING || is_left_before(&tracked->pairing, *old, slot, h))
        return;
    *at = c->at[slot].next;
    pir_crossing_free(tracked, slot);
}

/* Frees the crossings that edge e had before, from slot `old` on. */
static void free_old(pir_tracked *tracked, uint32_t e, uint32_t old) {
    const pir_pairing *pairing = &tracked->pairing;
    for (uint32_t at = pir_crossing_first(pairing, e); at != PIR_NO_CROSSING && old != PIR_NO_CROSSING;
         at = pir_crossing_next(pairing, at))
        free_kept(tracked, &old, pir_crossing_half(pairing, at));
    while (old != PIR_NO_CROSSING) {
        uint32_t next = pir_crossing_next(pairing, old);
        pir_crossing_free(tracked, old);
        tracked->statistics.repaired++;
        old = next;
    }
}

bool pir_derive_edges(pir_tracked *tracked, const uint32_t *edge, uint32_t count) {
    pir_tracked_turn_facets(tracked);
    for (uint32_t k = 0; k < count; k += TOGETHER) {
        uint32_t old[TOGETHER], some = count - k < TOGETHER ? count - k : TOGETHER;
        begin(tracked, edge + k, some, old);
        if (!pir_walk_edges_again(tracked, edge + k, some))
            return false;
        for (uint32_t i = 0; i < some; i++) {
            uint32_t next = i + NEXT_AHEAD < some ? old[i + NEXT_AHEAD] : PIR_NO_CROSSING;
            if (next != PIR_NO_CROSSING)
                pir_fetch_slot(tracked, pir_crossing_next(&tracked->pairing, next));
            free_old(tracked, edge[k + i], old[i]);
        }
    }
    return true;
}
