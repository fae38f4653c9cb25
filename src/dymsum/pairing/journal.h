/* SPDX-License-Identifier: MIT */
/*
 * What has changed in a sum of late, for those who follow it: live meshes.
 *
 * Slots are written down in the order in which they change, round and round in room of a fixed size: facets by the
 * numbers of their certificates, behind them crossings by slot. Whoever follows remembers how many entries there were
 * when it looked last. When more have been written since than there is room for, anything may have changed. So a sum
 * need not know who follows it, and a change costs one store.
 *
 * Invariant: a facet whose cell, or a crossing whose pair, is another than it was when entry `count` was to be the next
 * is among the entries since then, or these are more than there is room for.
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
