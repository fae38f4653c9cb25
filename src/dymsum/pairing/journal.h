/* SPDX-License-Identifier: MIT */
/*
 * The slots of a sum that have changed lately, for live meshes that follow it.
 *
 * Slots are noted in the order in which they change, round and round in room of a fixed size: facets by the numbers of
 * their certificates, behind them crossings by slot. A follower remembers how many entries there were when it read the
 * journal last. When more have been noted since than there is room for, anything may have changed. So a sum does not
 * know who follows it, and a change costs one store.
 *
 * Invariant: let a follower have read the journal at `count` entries. Each facet whose cell has changed since, and each
 * crossing whose pair has, is among the later entries, or there are more of these than room.
 */
#ifndef PIR_DYMSUM_PAIRING_JOURNAL_H
#define PIR_DYMSUM_PAIRING_JOURNAL_H

#include <stdint.h>

#define PIR_JOURNAL_ROOM 1024u /* a power of two */

typedef struct pir_journal {
    uint64_t count;
    uint32_t slot[PIR_JOURNAL_ROOM];
} pir_journal;

static inline void pir_journal_note(pir_journal *journal, uint32_t slot) {
    journal->slot[journal->count++ % PIR_JOURNAL_ROOM] = slot;
}

/* Anything may have changed. */
static inline void pir_journal_note_all(pir_journal *journal) {
    journal->count += PIR_JOURNAL_ROOM + 1;
}

#endif
