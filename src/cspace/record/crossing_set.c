/* SPDX-License-Identifier: MIT */
/* The set of toggled crossings. */
#include "cspace/record/crossing_set.h"

#include "base/layout.h"

#define NO_ENTRY   UINT32_MAX
#define FIRST_ROOM 256u

static uint32_t words_of(const pir_crossing_set *set) {
    return set->edges / 64 + 1;
}

static pir_layout layout_of(pir_crossing_set *set) {
    return (pir_layout){{PIR_ROW(set->first, set->edges), PIR_ROW(set->touched, words_of(set))}};
}

bool pir_crossing_set_init(pir_crossing_set *set, uint32_t edges, const pir_allocator *allocator) {
    *set = (pir_crossing_set){.allocator = *allocator, .edges = edges, .free = NO_ENTRY};
    pir_layout layout = layout_of(set);
    if (!pir_layout_new(allocator, &layout))
        return false;
    for (uint32_t e = 0; e < edges; e++)
        set->first[e] = NO_ENTRY;
    return true;
}

void pir_crossing_set_finish(pir_crossing_set *set) {
    pir_layout layout = layout_of(set);
    pir_layout_free(&set->allocator, &layout);
    PIR_FREE(&set->allocator, set->entry, set->room);
}

static bool grow(pir_crossing_set *set) {
    uint32_t room = set->room ? 2 * set->room : FIRST_ROOM;
    if (set->room > UINT32_MAX / 4)
        return false;
    pir_crossing_entry *grown = PIR_RESIZE(&set->allocator, set->entry, set->room, room);
    if (!grown)
        return false;
    set->entry = grown;
    set->room = room;
    return true;
}

bool pir_crossing_set_toggle(pir_crossing_set *set, uint32_t e, uint32_t g) {
    for (uint32_t *link = &set->first[e]; *link != NO_ENTRY; link = &set->entry[*link].next) {
        uint32_t at = *link;
        if (set->entry[at].other != g)
            continue;
        *link = set->entry[at].next;
        set->entry[at].next = set->free;
        set->free = at;
        return true;
    }
    uint32_t at = set->free;
    if (at != NO_ENTRY) {
        set->free = set->entry[at].next;
    } else {
        if (set->used == set->room && !grow(set))
            return false;
        at = set->used++;
    }
    set->entry[at] = (pir_crossing_entry){g, set->first[e]};
    set->first[e] = at;
    set->touched[e / 64] |= (uint64_t)1 << e % 64;
    return true;
}

uint32_t pir_crossing_set_take(pir_crossing_set *set, uint32_t *ret_edges) {
    uint32_t count = 0;
    for (uint32_t w = 0; w < words_of(set); w++) {
        for (uint64_t left = set->touched[w]; left; left &= left - 1) {
            uint32_t e = 64 * w + (uint32_t)__builtin_ctzll(left);
            if (set->first[e] != NO_ENTRY)
                ret_edges[count++] = e;
            set->first[e] = NO_ENTRY;
        }
        set->touched[w] = 0;
    }
    set->used = 0;
    set->free = NO_ENTRY;
    return count;
}
