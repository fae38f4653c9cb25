/* SPDX-License-Identifier: MIT */
/*
 * The crossings of the slice before, copied whole: that costs less than to follow what changes. A slice changes every
 * list of an edge that has an event, and most of these lists are a crossing or two.
 */
#include "cspace/record/held_crossings.h"

#include <string.h>

#include "base/layout.h"

static pir_layout layout_of(pir_held_crossings *held) {
    const pir_polytope *p = held->pairing->p, *q = held->pairing->q;
    return (pir_layout){{PIR_ROW(held->first, p->edge_count), PIR_ROW(held->first_passed, p->edge_count),
                         PIR_ROW(held->passed, (size_t)p->half_count + q->half_count),
                         PIR_ROW(held->odd, q->edge_count)}};
}

static pir_layout layout_of_slots(pir_held_crossings *held) {
    return (pir_layout){{PIR_ROW(held->slot, held->slot_room)}};
}

bool pir_held_crossings_init(pir_held_crossings *held, const pir_pairing *pairing, const pir_allocator *allocator) {
    *held = (pir_held_crossings){.allocator = *allocator, .pairing = pairing};
    pir_layout layout = layout_of(held);
    if (!pir_layout_new(allocator, &layout))
        return false;
    for (uint32_t e = 0; e < pairing->p->edge_count; e++)
        held->first[e] = held->first_passed[e] = PIR_NO_CROSSING;
    return true;
}

void pir_held_crossings_finish(pir_held_crossings *held) {
    if (!held->pairing)
        return;
    pir_layout layout = layout_of(held), slots = layout_of_slots(held);
    pir_layout_free(&held->allocator, &layout);
    pir_layout_free(&held->allocator, &slots);
}

bool pir_held_crossings_reserve(pir_held_crossings *held) {
    const uint32_t room = held->pairing->crossings.capacity;
    if (held->slot && room <= held->slot_room)
        return true;
    pir_held_crossings grown = *held;
    grown.slot = NULL;
    grown.slot_room = room;
    pir_layout fresh = layout_of_slots(&grown), old = layout_of_slots(held);
    if (!pir_layout_new(&held->allocator, &fresh))
        return false;
    if (held->slot_room > 0)
        memcpy(grown.slot, held->slot, held->slot_room * sizeof *held->slot);
    pir_layout_free(&held->allocator, &old);
    *held = grown;
    return true;
}

void pir_held_crossings_take(pir_held_crossings *held) {
    const pir_crossings *c = &held->pairing->crossings;
    const uint32_t edges = held->pairing->p->edge_count;
    held->passed_count = 0;
    if (edges == 0)
        return;
    memcpy(held->first, c->first, edges * sizeof *c->first);
    memcpy(held->slot, c->at, c->used * sizeof *c->at);
}

/* Toggles the parity of an edge of Q. Returns the change in the number of edges with odd parity, 1 or −1. */
static inline uint32_t count_edge(pir_held_crossings *held, uint32_t g) {
    uint8_t odd = held->odd[g] ^= 1;
    return odd ? 1 : UINT32_MAX;
}

/* Counts all edges of Q that edge e of −P is beside of, before, between and now. Counting twice undoes it. */
static uint32_t count_edges(pir_held_crossings *held, uint32_t e) {
    const pir_crossings *c = &held->pairing->crossings;
    const uint32_t *edge = held->pairing->q->edge;
    uint32_t odd = 0;
    for (uint32_t at = held->first[e]; at != PIR_NO_CROSSING; at = held->slot[at].next)
        odd += count_edge(held, edge[held->slot[at].half]);
    for (uint32_t at = c->first[e]; at != PIR_NO_CROSSING; at = c->at[at].next)
        odd += count_edge(held, edge[c->at[at].half]);
    for (uint32_t at = held->first_passed[e]; at != PIR_NO_CROSSING; at = held->passed[at].next)
        odd += count_edge(held, held->passed[at].other);
    return odd;
}

bool pir_is_foreseen(pir_held_crossings *held, uint32_t e) {
    const uint32_t odd = count_edges(held, e);
    if (odd > 0)
        count_edges(held, e);
    held->first_passed[e] = PIR_NO_CROSSING;
    return odd == 0;
}
