/* SPDX-License-Identifier: MIT */
/*
 * Repairs of large sums, where the memory that a repair reads takes longer than the repair.
 *
 * Ends of arcs are moved some turns after they have been queued: first the edge is fetched, then its first crossing,
 * then the next. Edges to be derived anew are walked from nothing, side by side, as in a rebuild: that is faster than
 * finding again what is still crossed. What was crossed before is compared with the result, and crossings that are no
 * more count as repaired.
 */
#include "dymsum/update/large.h"

#include "dymsum/pairing/crossings.h"
#include "dymsum/rebuild/walk.h"
#include "dymsum/update/fetch_ahead.h"
#include "dymsum/update/repair.h"

/* --- moves --- */

void pir_moves_begin(pir_moves *moves, pir_tracked *tracked, uint32_t stamp) {
    moves->tracked = tracked;
    moves->stamp = stamp;
    moves->queued = moves->turns = 0;
    moves->failed = false;
}

static inline void make_move(pir_moves *moves, pir_move move) {
    pir_tracked *tracked = moves->tracked;
    uint32_t e = move.side.edge;
    if (tracked->touched[e] == PIR_INACTIVE)
        return;
    moves->failed |= !pir_move_either(tracked, e, move.side.leaves, move.half);
    if (tracked->touched[e] < moves->stamp)
        tracked->touched[e] = moves->stamp;
}

static inline void take_turn(pir_moves *moves) {
    uint32_t first = moves->turns++ - PIR_MOVES_APART, next = first - PIR_MOVES_APART, last = next - PIR_MOVES_APART;
    if (first < moves->queued)
        pir_fetch_crossing(moves->tracked, moves->at[first % PIR_MOVES_ROOM].side.edge);
    if (next < moves->queued)
        pir_fetch_next_crossing(moves->tracked, moves->at[next % PIR_MOVES_ROOM].side.edge);
    if (last < moves->queued)
        make_move(moves, moves->at[last % PIR_MOVES_ROOM]);
}

void pir_moves_queue(pir_moves *moves, uint32_t f, uint32_t h) {
    const pir_polytope *p = moves->tracked->pairing.p;
    PIR_FETCH(&moves->tracked->pairing.q->twin[h]);
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
        moves->at[moves->queued++ % PIR_MOVES_ROOM] = (pir_move){p->across[i], h};
        pir_fetch_edge(moves->tracked, p->across[i].edge);
        take_turn(moves);
    }
}

bool pir_moves_finish(pir_moves *moves) {
    for (uint32_t i = 0; i < 3 * PIR_MOVES_APART; i++)
        take_turn(moves);
    return !moves->failed;
}

/* --- edges derived anew --- */

/* So many edges are walked at a time: what is fetched for them stays near the processor. */
#define TOGETHER 512

/* Second crossings are fetched by so many edges ahead. */
#define NEXT_AHEAD 12

/*
 * More slots are freed here than taken, and fewer where ends move: so the next update takes them again, one after
 * another, when they are far from the processor. Each has fetched then the one that is taken so many later.
 */
#define TAKEN_AHEAD 16

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

/* The slots that have been freed last, in a ring. */
struct freed {
    uint32_t slot[TAKEN_AHEAD], count;
};

static inline void free_slot(pir_tracked *tracked, uint32_t slot, struct freed *freed) {
    uint32_t *at = &freed->slot[freed->count++ % TAKEN_AHEAD], later = freed->count > TAKEN_AHEAD ? *at : slot;
    *at = slot;
    pir_crossing_free_before(tracked, slot, later);
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
static void free_kept(pir_tracked *tracked, uint32_t *old, uint32_t h, struct freed *freed) {
    pir_crossings *c = &tracked->pairing.crossings;
    uint32_t *at = old;
    while (*at != PIR_NO_CROSSING && c->at[*at].half != h)
        at = &c->at[*at].next;
    uint32_t slot = *at;
    if (slot == PIR_NO_CROSSING || is_left_before(&tracked->pairing, *old, slot, h))
        return;
    *at = c->at[slot].next;
    free_slot(tracked, slot, freed);
}

/* Frees the crossings that edge e had before, from slot `old` on. */
static void free_old(pir_tracked *tracked, uint32_t e, uint32_t old, struct freed *freed) {
    const pir_pairing *pairing = &tracked->pairing;
    for (uint32_t at = pir_crossing_first(pairing, e); at != PIR_NO_CROSSING && old != PIR_NO_CROSSING;
         at = pir_crossing_next(pairing, at))
        free_kept(tracked, &old, pir_crossing_half(pairing, at), freed);
    while (old != PIR_NO_CROSSING) {
        uint32_t next = pir_crossing_next(pairing, old);
        free_slot(tracked, old, freed);
        tracked->statistics.repaired++;
        old = next;
    }
}

bool pir_derive_edges(pir_tracked *tracked, const uint32_t *edge, uint32_t count) {
    struct freed freed = {.count = 0};
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
            free_old(tracked, edge[k + i], old[i], &freed);
        }
    }
    return true;
}
