/* SPDX-License-Identifier: MIT */
/*
 * The slots of a sum that have changed lately, for live meshes that follow it.
 *
 * Slots are noted in the order in which they change, round and round in room of a fixed size: facets by the numbers of
 * their certificates, behind them crossings by slot. A follower remembers how many entries there were when it read the
 * journal last. When more have been noted since than there is room for, anything may have changed. So a sum does not
 * know who follows it, and a change costs one store. The room is made when somebody first follows.
 *
 * Beside them stand the edges of P whose crossings have changed otherwise than by single facets: a facet of P that goes
 * through one side of its cell toggles the crossing of each of its edges with that side, and a facet of Q those of the
 * side with each of its own edges. `steps` counts updates, and a rebuild for two: whoever has seen all but one of them
 * knows that each facet has moved in one update, at most.
 *
 * Invariant: let a follower have read the journal at `count` entries. Each facet whose cell has changed since, and each
 * crossing whose pair has, is among the later entries, or there are more of these than room. The same holds for edges.
 */
#ifndef PIR_DYMSUM_PAIRING_JOURNAL_H
#define PIR_DYMSUM_PAIRING_JOURNAL_H

#include "base/memory.h"

#define PIR_JOURNAL_ROOM 4096u /* a power of two */

/* While nobody follows there is room for one entry, so that a change costs no question. */
typedef struct pir_journal {
    uint64_t count;
    uint64_t edge_count, steps;
    uint32_t *slot; /* room for mask + 1 entries, and behind them for as many edges */
    uint32_t mask, none;
} pir_journal;

static inline void pir_journal_init(pir_journal *journal) {
    *journal = (pir_journal){.slot = &journal->none};
}

static inline void pir_journal_finish(pir_journal *journal, const pir_allocator *allocator) {
    if (journal->mask > 0)
        PIR_FREE(allocator, journal->slot, 2 * PIR_JOURNAL_ROOM);
}

/* Makes the room for those who follow. What has been noted before is lost. False when out of memory. */
static inline bool pir_journal_keep(pir_journal *journal, const pir_allocator *allocator) {
    uint32_t *room = journal->mask > 0 ? journal->slot : PIR_NEW(allocator, uint32_t, 2 * PIR_JOURNAL_ROOM);
    if (!room)
        return false;
    journal->slot = room;
    journal->mask = PIR_JOURNAL_ROOM - 1;
    return true;
}

static inline void pir_journal_note(pir_journal *journal, uint32_t slot) {
    journal->slot[journal->count++ & journal->mask] = slot;
}

/* Where entry n of the edges stands; while nobody follows that is where every entry does. */
static inline uint32_t *pir_journal_edge_at(const pir_journal *journal, uint64_t n) {
    return &journal->slot[journal->mask + (journal->mask & 1) + (n & journal->mask)];
}

static inline void pir_journal_note_edge(pir_journal *journal, uint32_t edge) {
    *pir_journal_edge_at(journal, journal->edge_count++) = edge;
}

static inline void pir_journal_note_step(pir_journal *journal) {
    journal->steps++;
}

/* Anything may have changed. */
static inline void pir_journal_note_all(pir_journal *journal) {
    journal->count += PIR_JOURNAL_ROOM + 1;
    journal->edge_count += PIR_JOURNAL_ROOM + 1;
    journal->steps += 2;
}

#endif
