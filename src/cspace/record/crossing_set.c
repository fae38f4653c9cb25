/* SPDX-License-Identifier: MIT */
/* The set of toggled crossings. Its three arrays follow the size of the table. */
#include "cspace/record/crossing_set.h"

#include <stdlib.h>
#include <string.h>

#include "base/layout.h"

#define FIRST_ROOM 1024u

static pir_layout layout_of(pir_crossing_set *set) {
    return (pir_layout){
        {PIR_ROW(set->entry, set->room), PIR_ROW(set->used, set->room / 2), PIR_ROW(set->odd, set->room / 2)}};
}

void pir_crossing_set_init(pir_crossing_set *set, const pir_allocator *allocator) {
    *set = (pir_crossing_set){.allocator = *allocator, .stamp = 1};
}

void pir_crossing_set_finish(pir_crossing_set *set) {
    pir_layout layout = layout_of(set);
    pir_layout_free(&set->allocator, &layout);
}

void pir_crossing_set_clear(pir_crossing_set *set) {
    set->count = 0;
    if (++set->stamp == 0) {
        for (uint32_t i = 0; i < set->room; i++)
            set->entry[i].stamp = 0;
        set->stamp = 1;
    }
}

/* The entry of the key, or the one that it would take. */
static uint32_t place_of(const pir_crossing_set *set, pir_crossing_key key) {
    uint32_t mask = set->room - 1, at = (uint32_t)((key * UINT64_C(0x9e3779b97f4a7c15)) >> 32) & mask;
    while (set->entry[at].stamp == set->stamp && set->entry[at].key != key)
        at = (at + 1) & mask;
    return at;
}

static bool grow(pir_crossing_set *set) {
    if (set->room > UINT32_MAX / 4)
        return false;
    pir_crossing_set grown = *set;
    grown.room = set->room ? 2 * set->room : FIRST_ROOM;
    grown.entry = NULL;
    grown.used = NULL;
    grown.odd = NULL;
    pir_layout fresh = layout_of(&grown), old = layout_of(set);
    if (!pir_layout_new(&set->allocator, &fresh)) {
        pir_layout_free(&set->allocator, &fresh);
        return false;
    }
    for (uint32_t i = 0; i < set->count; i++) {
        const pir_crossing_entry *entry = &set->entry[set->used[i]];
        uint32_t at = place_of(&grown, entry->key);
        grown.entry[at] = *entry;
        grown.used[i] = at;
    }
    pir_layout_free(&set->allocator, &old);
    *set = grown;
    return true;
}

bool pir_crossing_set_toggle(pir_crossing_set *set, pir_crossing_key key) {
    if (set->count >= set->room / 2 && !grow(set))
        return false;
    uint32_t at = place_of(set, key);
    pir_crossing_entry *entry = &set->entry[at];
    if (entry->stamp != set->stamp) {
        *entry = (pir_crossing_entry){key, set->stamp, 0};
        set->used[set->count++] = at;
    }
    entry->odd ^= 1;
    return true;
}

static int compare_keys(const void *left, const void *right) {
    pir_crossing_key a, b;
    memcpy(&a, left, sizeof a);
    memcpy(&b, right, sizeof b);
    return (a > b) - (a < b);
}

const pir_crossing_key *pir_crossing_set_remains(pir_crossing_set *set, uint32_t *ret_count) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < set->count; i++)
        if (set->entry[set->used[i]].odd)
            set->odd[count++] = set->entry[set->used[i]].key;
    if (count > 1)
        qsort(set->odd, count, sizeof *set->odd, compare_keys);
    *ret_count = count;
    return set->odd;
}
