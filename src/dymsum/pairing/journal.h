/* SPDX-License-Identifier: MIT */
/*
 * The slots of a sum that have changed lately, for live meshes that follow it.
 *
 * Slots are noted in the order in which they change, round and round in room of a fixed size: facets by the numbers of
 * their certificates, behind them crossings by slot. A follower remembers how many entries there were when it read the
 * journal last. When more have been noted since than there is room for, anything may have changed. So a sum does not
 * know who follows it, and a change costs one store. The room is made when somebody first follows.
 *
 * Invariant: let a follower have read the journal at `count` entries. Each facet whose cell has changed since, and each
 * crossing whose pair has, is among the later entries, or there are more of these than room.
 */
#ifndef PIR_DYMSUM_PAIRING_JOURNAL_H
#define PIR_DYMSUM_PAIRING_JOURNAL_H

#include "base/memory.h"

#define PIR_JOURNAL_ROOM 1024u /* a power of two */

/* While nobody follows there is room for one entry, so that a change costs no question. */
typedef struct pir_journal {
    uint64_t count;
    uint32_t *slot, mask; /* room for mask + 1 entries */
    uint32_t none;
} pir_journal;

static inline void pir_journal_init(pir_journal *journal) {
    *journal = (pir_journal){.slot = &journal->none};
}

static inline void pir_journal_finish(pir_journal *journal, const pir_allocator *allocator) {
    if (journal->mask > 0)
        PIR_FREE(allocator, journal->slot, PIR_JOURNAL_ROOM);
}

/* Makes the room for those who follow. What has been noted before is lost. False when out of memory. */
static inline bool pir_journal_keep(pir_journal *journal, const pir_allocator *allocator) {
    uint32_t *room = journal->mask > 0 ? journal->slot : PIR_NEW(allocator, uint32_t, PIR_JOURNAL_ROOM);
    if (!room)
        return false;
    journal->slot = room;
    journal->mask = PIR_JOURNAL_ROOM - 1;
    return true;
}

static inline void pir_journal_note(pir_journal *journal, uint32_t slot) {
    journal->slot[journal->count++ & journal->mask] = slot;
}

/* Anything may have changed. */
static inline void pir_journal_note_all(pir_journal *journal) {
    journal->count += PIR_JOURNAL_ROOM + 1;
}

#endif
