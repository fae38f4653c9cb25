/* SPDX-License-Identifier: MIT */
/*
 * The store of crossings.
 *
 * Invariant: a slot below `used` is either linked from exactly one edge's list or on the free chain.
 */
#include "dymsum/sum.h"

#include <string.h>

static void free_slots(const pir_crossings *c, const pir_allocator *a) {
    PIR_FREE(a, c->half, c->capacity);
    PIR_FREE(a, c->edge, c->capacity);
    PIR_FREE(a, c->next, c->capacity);
}

bool pir_crossings_reserve(pir_sum *sum, uint32_t capacity) {
    pir_crossings *c = &sum->pairing.crossings;
    const pir_allocator *a = &sum->pairing.allocator;
    if (capacity <= c->capacity)
        return true;
    // every new block before an old one goes: a failure changes nothing
    pir_crossings grown = {.first = c->first,
                           .half = PIR_NEW(a, uint32_t, capacity),
                           .edge = PIR_NEW(a, uint32_t, capacity),
                           .next = PIR_NEW(a, uint32_t, capacity),
                           .capacity = capacity,
                           .used = c->used,
                           .free = c->free,
                           .count = c->count};
    if (!grown.half || !grown.edge || !grown.next) {
        free_slots(&grown, a);
        return false;
    }
    if (c->used > 0) {
        memcpy(grown.half, c->half, c->used * sizeof *c->half);
        memcpy(grown.edge, c->edge, c->used * sizeof *c->edge);
        memcpy(grown.next, c->next, c->used * sizeof *c->next);
    }
    free_slots(c, a);
    *c = grown;
    sum->statistics.allocations++;
    return true;
}

void pir_crossings_finish(pir_sum *sum) {
    free_slots(&sum->pairing.crossings, &sum->pairing.allocator);
}

void pir_crossings_clear(pir_sum *sum) {
    for (uint32_t e = 0; e < sum->pairing.p->edge_count; e++)
        sum->pairing.crossings.first[e] = PIR_NO_CROSSING;
    sum->pairing.crossings.used = 0;
    sum->pairing.crossings.free = PIR_NO_CROSSING;
    sum->pairing.crossings.count = 0;
    pir_journal_note_all(&sum->journal);
}

uint32_t pir_crossing_new(pir_sum *sum, uint32_t e, uint32_t h) {
    pir_crossings *c = &sum->pairing.crossings;
    uint32_t slot = c->free;
    if (slot != PIR_NO_CROSSING) {
        c->free = c->next[slot];
    } else {
        if (c->used == c->capacity && (c->capacity > UINT32_MAX / 4 || !pir_crossings_reserve(sum, 2 * c->capacity)))
            return PIR_NO_CROSSING;
        slot = c->used++;
    }
    c->half[slot] = h;
    c->edge[slot] = e;
    c->next[slot] = PIR_NO_CROSSING;
    pir_journal_note(&sum->journal, pir_certificate_count(sum) + slot);
    sum->pairing.crossings.count++;
    return slot;
}

void pir_crossing_free(pir_sum *sum, uint32_t slot) {
    pir_crossings *c = &sum->pairing.crossings;
    c->edge[slot] = PIR_NO_CROSSING;
    c->next[slot] = c->free;
    c->free = slot;
    pir_journal_note(&sum->journal, pir_certificate_count(sum) + slot);
    sum->pairing.crossings.count--;
}
