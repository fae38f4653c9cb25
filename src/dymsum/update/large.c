/* SPDX-License-Identifier: MIT */
/*
 * Repairs of large sums, where the memory that a repair reads takes longer than the repair.
 *
 * Ends of arcs are moved some turns after they have been queued: first the edge is fetched, then its first crossing,
 * then the next. Edges to be derived anew are walked from nothing, side by side, as in a rebuild: that is faster than
 * trying first what was crossed before. Then the result is compared with that: slots and counts become the same.
 */
#include "dymsum/update/large.h"

#include "base/fetching.h"
#include "dymsum/pairing/crossings.h"
#include "dymsum/rebuild/walk.h"
#include "dymsum/update/repair.h"

/* --- memory that repairs will read --- */

/* Nothing depends on these calls but time. */
PIR_FETCHING void fetch_edge(const pir_tracked *tracked, uint32_t e) {
    PIR_FETCH(&tracked->pairing.crossings.first[e]);
    PIR_FETCH(&tracked->touched[e]);
}

/* The slot, or any where there is none: by a mask, since which it is is not foreseen. */
static inline uint32_t some_slot(uint32_t slot) {
    return slot & -(uint32_t)(slot != PIR_NO_CROSSING);
}

/* Fetches a slot, if it is one. */
PIR_FETCHING void fetch_slot(const pir_tracked *tracked, uint32_t slot) {
    PIR_FETCH(&tracked->pairing.crossings.at[some_slot(slot)]);
}

PIR_FETCHING void fetch_crossing(const pir_tracked *tracked, uint32_t e) {
    fetch_slot(tracked, tracked->pairing.crossings.first[e]);
}

/* Fetches the second crossing of edge e. */
PIR_FETCHING void fetch_next_crossing(const pir_tracked *tracked, uint32_t e) {
    const pir_crossings *c = &tracked->pairing.crossings;
    fetch_slot(tracked, c->at[some_slot(c->first[e])].next);
}

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
        fetch_crossing(moves->tracked, moves->at[first % PIR_MOVES_ROOM].side.edge);
    if (next < moves->queued)
        fetch_next_crossing(moves->tracked, moves->at[next % PIR_MOVES_ROOM].side.edge);
    if (last < moves->queued)
        make_move(moves, moves->at[last % PIR_MOVES_ROOM]);
}

void pir_moves_queue(pir_moves *moves, uint32_t f, uint32_t h) {
    const pir_polytope *p = moves->tracked->pairing.p;
    PIR_FETCH(&moves->tracked->pairing.q->twin[h]);
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
        moves->at[moves->queued++ % PIR_MOVES_ROOM] = (pir_move){p->across[i], h};
        fetch_edge(moves->tracked, p->across[i].edge);
        take_turn(moves);
    }
}

bool pir_moves_finish(pir_moves *moves) {
    for (uint32_t i = 0; i < 3 * PIR_MOVES_APART; i++)
        take_turn(moves);
    return !moves->failed;
}

/* --- edges derived anew --- */

/* So many edges are walked at a time, at most: what is fetched for them stays near the processor. */
#define TOGETHER 512

/* Second crossings are fetched by so many edges ahead. */
#define NEXT_AHEAD 12

/*
 * More slots are freed here than taken, and fewer where ends move: so the next update takes them again, one after
 * another, when they are far from the processor. Each has fetched then the one that is taken so many later.
 */
#define TAKEN_AHEAD 16

/* The slots that have been freed last, in a ring. */
struct freed {
    uint32_t slot[TAKEN_AHEAD], count;
};

static inline void free_slot(pir_tracked *tracked, uint32_t slot, struct freed *freed) {
    uint32_t *at = &freed->slot[freed->count++ % TAKEN_AHEAD], later = freed->count > TAKEN_AHEAD ? *at : slot;
    *at = slot;
    pir_crossing_free_before(tracked, slot, later);
}

/* Fetches what a walk of `count` edges begins with, and their first crossings. */
PIR_FETCHING void fetch_edges(const pir_tracked *tracked, const uint32_t *edge, uint32_t count) {
    const pir_edge_arc *arc = tracked->pairing.p->edge_arc;
    for (uint32_t i = 0; i < count; i++) {
        PIR_FETCH(&arc[edge[i]]);
        PIR_FETCH(&tracked->pairing.crossings.first[edge[i]]);
    }
    for (uint32_t i = 0; i < count; i++) {
        fetch_crossing(tracked, edge[i]);
        PIR_FETCH(&tracked->pairing.fv[arc[edge[i]].ends.from]);
        PIR_FETCH(&tracked->pairing.fv[arc[edge[i]].ends.to]);
    }
}

/* Takes the crossing of halfedge h of Q out of the list at *list: PIR_NO_CROSSING where there is none. */
static uint32_t take_kept(pir_crossings *c, uint32_t *list, uint32_t h) {
    uint32_t *at = list;
    while (*at != PIR_NO_CROSSING && c->at[*at].half != h)
        at = &c->at[*at].next;
    uint32_t slot = *at;
    if (slot != PIR_NO_CROSSING)
        *at = c->at[slot].next;
    return slot;
}

/* Lists the crossings of edge e that a walk has found. What stays keeps its slot. False when out of memory. */
static bool list_found(pir_tracked *tracked, uint32_t e, const pir_walked_crossing *found, uint32_t count,
                       struct freed *freed) {
    pir_crossings *c = &tracked->pairing.crossings;
    uint32_t old = c->first[e], last = PIR_NO_CROSSING;
    c->first[e] = PIR_NO_CROSSING;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t slot = take_kept(c, &old, found[i].half);
        if (slot == PIR_NO_CROSSING)
            slot = pir_crossing_new(tracked, e, found[i].half);
        if (slot == PIR_NO_CROSSING)
            return false;
        c->at[slot].next = PIR_NO_CROSSING;
        *(last == PIR_NO_CROSSING ? &c->first[e] : &c->at[last].next) = slot;
        last = slot;
    }
    while (old != PIR_NO_CROSSING) {
        uint32_t next = c->at[old].next;
        free_slot(tracked, old, freed);
        tracked->statistics.repaired++;
        old = next;
    }
    return true;
}

/* Lists what a walk of `count` edges has found. */
static bool list_walked(pir_tracked *tracked, const uint32_t *edge, uint32_t count, const pir_walked *walked,
                        struct freed *freed) {
    uint32_t from = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t to = from;
        if (i + NEXT_AHEAD < count)
            fetch_next_crossing(tracked, edge[i + NEXT_AHEAD]);
        while (to < walked->count && walked->at[to].edge == edge[i])
            to++;
        if (!list_found(tracked, edge[i], walked->at + from, to - from, freed))
            return false;
        from = to;
    }
    return true;
}

static bool derive_one_by_one(pir_tracked *tracked, const uint32_t *edge, uint32_t count) {
    bool done = true;
    for (uint32_t i = 0; i < count && done; i++)
        done = pir_derive_edge(tracked, edge[i]);
    return done;
}

/* So many edges as are likely to have no more crossings than there is room for. */
static uint32_t edges_together(const pir_pairing *pairing) {
    uint32_t each = 2 * (pairing->crossings.count / pairing->p->edge_count + 1), most = PIR_WALKED_MOST / each;
    return most > TOGETHER ? TOGETHER : most > 0 ? most : 1;
}

bool pir_derive_edges(pir_tracked *tracked, const uint32_t *edge, uint32_t count) {
    pir_walked walked;
    struct freed freed = {.count = 0};
    bool done = true;
    pir_tracked_turn_facets(tracked);
    for (uint32_t k = 0, batch; k < count && done; k += batch) {
        const uint32_t most = edges_together(&tracked->pairing);
        batch = count - k < most ? count - k : most;
        fetch_edges(tracked, edge + k, batch);
        done = pir_walk_aside(tracked, edge + k, batch, &walked)
                   ? list_walked(tracked, edge + k, batch, &walked, &freed)
                   : derive_one_by_one(tracked, edge + k, batch);
    }
    return done;
}
