/* SPDX-License-Identifier: MIT */
/*
 * The store of crossings: slots taken, given back and linked.
 *
 * Invariant: a slot below `used` is either linked from exactly one edge's list or on the free chain.
 */
#ifndef PIR_DYMSUM_PAIRING_CROSSINGS_H
#define PIR_DYMSUM_PAIRING_CROSSINGS_H

#include "base/fetching.h"
#include "dymsum/pairing/tracked.h"

/*
 * Room for at least `capacity` slots; false when out of memory, and nothing changes. Counts as an allocation when it
 * grows.
 */
bool pir_crossings_reserve(pir_tracked *tracked, uint32_t capacity);
void pir_crossings_finish(pir_tracked *tracked);

/* Empties every list. */
void pir_crossings_clear(pir_tracked *tracked);

/* Makes every slot unused. The caller empties the lists. */
void pir_crossings_forget(pir_tracked *tracked);

/* A slot that has never been in use; PIR_NO_CROSSING when out of memory. */
uint32_t pir_crossing_new_slot(pir_tracked *tracked);

/* The journal has it that a slot has changed. */
static inline void pir_note_slot(pir_tracked *tracked, uint32_t slot) {
    const pir_facets *q_facets = &tracked->q_facets;
    pir_journal_note(&tracked->journal, q_facets->first_certificate + q_facets->count + slot);
}

/* A slot for the crossing of edge e with halfedge h, not linked; PIR_NO_CROSSING when out of memory. */
static inline uint32_t pir_crossing_new(pir_tracked *tracked, uint32_t e, uint32_t h) {
    pir_crossings *c = &tracked->pairing.crossings;
    uint32_t slot = c->free;
    if (slot != PIR_NO_CROSSING) {
        c->free = c->at[slot].next;
        // nothing is read there: it may be none
        PIR_FETCH((const void *)((uintptr_t)c->at + (uintptr_t)c->at[slot].half * sizeof *c->at));
    } else if ((slot = pir_crossing_new_slot(tracked)) == PIR_NO_CROSSING)
        return PIR_NO_CROSSING;
    c->at[slot] = (pir_crossing){h, e, PIR_NO_CROSSING};
    pir_note_slot(tracked, slot);
    c->count++;
    return slot;
}

/*
 * Frees a slot. A slot that will be taken after it, or none, stands in place of its halfedge, and is fetched when it is
 * taken.
 */
static inline void pir_crossing_free_before(pir_tracked *tracked, uint32_t slot, uint32_t later) {
    pir_crossings *c = &tracked->pairing.crossings;
    c->at[slot] = (pir_crossing){later, PIR_NO_CROSSING, c->free};
    c->free = slot;
    pir_note_slot(tracked, slot);
    c->count--;
}

static inline void pir_crossing_free(pir_tracked *tracked, uint32_t slot) {
    pir_crossing_free_before(tracked, slot, tracked->pairing.crossings.free);
}

/*
 * Links one more crossing, of edge e with halfedge h, behind *last, the end of the edge's list or PIR_NO_CROSSING, and
 * makes it the last. False when out of memory.
 */
bool pir_crossing_append(pir_tracked *tracked, uint32_t e, uint32_t h, uint32_t *last);

/*
 * Adds a crossing to a store that was emptied, and from which no slot was freed since. The journal already
 * holds that everything changes.
 */
bool pir_crossing_push(pir_tracked *tracked, uint32_t e, uint32_t h, uint32_t *last);

#endif
