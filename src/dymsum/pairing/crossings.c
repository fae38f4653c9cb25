/* SPDX-License-Identifier: MIT */
/* The store of crossings. See crossings.h. */
#include "dymsum/pairing/crossings.h"

#include <string.h>

static pir_layout layout_of(pir_crossings *c) {
    return (pir_layout){{PIR_ROW(c->at, c->capacity)}};
}

bool pir_crossings_reserve(pir_tracked *tracked, uint32_t capacity) {
    pir_crossings *c = &tracked->pairing.crossings;
    const pir_allocator *a = &tracked->pairing.allocator;
    if (capacity <= c->capacity)
        return true;
    // every new block is made before an old one is freed: a failure changes nothing
    pir_crossings grown = *c;
    grown.capacity = capacity;
    pir_layout fresh = layout_of(&grown), old = layout_of(c);
    if (!pir_layout_new(a, &fresh)) {
        pir_layout_free(a, &fresh);
        return false;
    }
    if (c->used > 0)
        memcpy(grown.at, c->at, c->used * sizeof *c->at);
    pir_layout_free(a, &old);
    *c = grown;
    tracked->statistics.allocations++;
    return true;
}

void pir_crossings_finish(pir_tracked *tracked) {
    pir_layout layout = layout_of(&tracked->pairing.crossings);
    pir_layout_free(&tracked->pairing.allocator, &layout);
}

void pir_crossings_clear(pir_tracked *tracked) {
    pir_pairing *pairing = &tracked->pairing;
    for (uint32_t e = 0; e < pairing->p->edge_count; e++)
        pairing->crossings.first[e] = PIR_NO_CROSSING;
    pir_crossings_forget(tracked);
}

void pir_crossings_forget(pir_tracked *tracked) {
    pir_crossings *c = &tracked->pairing.crossings;
    c->used = 0;
    c->free = PIR_NO_CROSSING;
    c->count = 0;
    pir_journal_note_all(&tracked->journal);
}

uint32_t pir_crossing_new_slot(pir_tracked *tracked) {
    pir_crossings *c = &tracked->pairing.crossings;
    if (c->used == c->capacity && (c->capacity > UINT32_MAX / 4 || !pir_crossings_reserve(tracked, 2 * c->capacity)))
        return PIR_NO_CROSSING;
    return c->used++;
}

bool pir_crossing_append(pir_tracked *tracked, uint32_t e, uint32_t h, uint32_t *last) {
    uint32_t slot = pir_crossing_new(tracked, e, h);
    if (slot == PIR_NO_CROSSING)
        return false;
    if (*last == PIR_NO_CROSSING)
        tracked->pairing.crossings.first[e] = slot;
    else
        tracked->pairing.crossings.at[*last].next = slot;
    *last = slot;
    return true;
}

bool pir_crossing_push(pir_tracked *tracked, uint32_t e, uint32_t h, uint32_t *last) {
    pir_crossings *c = &tracked->pairing.crossings;
    if (c->used == c->capacity)
        return pir_crossing_append(tracked, e, h, last);
    uint32_t slot = c->used++;
    c->at[slot] = (pir_crossing){h, e, PIR_NO_CROSSING};
    c->count++;
    *(*last == PIR_NO_CROSSING ? &c->first[e] : &c->at[*last].next) = slot;
    *last = slot;
    return true;
}
