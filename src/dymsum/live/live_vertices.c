/* SPDX-License-Identifier: MIT */
/*
 * The vertices of a live mesh: slots counted by use, and a hash table with linear probing whose gaps are closed when
 * entries are removed.
 */
#include "dymsum/live/live_vertices.h"

#include "base/assert.h"
#include "base/layout.h"

static uint32_t home_of(const pir_live_vertices *v, uint32_t p, uint32_t q) {
    uint64_t key = (uint64_t)p << 32 | q;
    return (uint32_t)((key * UINT64_C(0x9e3779b97f4a7c15)) >> 32) & (2 * v->capacity - 1);
}

/* Where the table has the pair, or the gap where it would go. */
static uint32_t place_of(const pir_live_vertices *v, uint32_t p, uint32_t q) {
    uint32_t i = home_of(v, p, q), mask = 2 * v->capacity - 1;
    while (v->table[i] != PIR_NO_SLOT && (v->pair[v->table[i]][0] != p || v->pair[v->table[i]][1] != q))
        i = (i + 1) & mask;
    return i;
}

static pir_layout layout_of(pir_live_vertices *v) {
    uint32_t capacity = v->capacity;
    return (pir_layout){{PIR_ROW(v->pair, capacity), PIR_ROW(v->uses, capacity), PIR_ROW(v->next_free, capacity),
                         PIR_ROW(v->idle, capacity), PIR_ROW(v->is_idle, capacity),
                         PIR_ROW(v->table, (size_t)capacity * 2)}};
}

bool pir_live_vertices_reserve(pir_live_vertices *v, const pir_allocator *a, uint32_t least) {
    if (least <= v->capacity)
        return true;
    PIR_ASSERT(v->idle_count == 0);
    uint32_t capacity = 64;
    while (capacity < least)
        capacity *= 2;
    pir_live_vertices grown = {.capacity = capacity, .used = v->used, .free = v->capacity ? v->free : PIR_NO_SLOT};
    pir_layout fresh = layout_of(&grown);
    if (!pir_layout_new(a, &fresh)) {
        pir_layout_free(a, &fresh);
        return false;
    }
    for (uint32_t i = 0; i < 2 * capacity; i++)
        grown.table[i] = PIR_NO_SLOT;
    for (uint32_t i = 0; i < v->used; i++) {
        grown.pair[i][0] = v->pair[i][0];
        grown.pair[i][1] = v->pair[i][1];
        grown.uses[i] = v->uses[i];
        grown.next_free[i] = v->next_free[i];
        if (grown.uses[i] > 0)
            grown.table[place_of(&grown, grown.pair[i][0], grown.pair[i][1])] = i;
    }
    pir_live_vertices_finish(v, a);
    *v = grown;
    return true;
}

void pir_live_vertices_finish(pir_live_vertices *v, const pir_allocator *a) {
    pir_layout layout = layout_of(v);
    pir_layout_free(a, &layout);
}

uint32_t pir_live_vertex_take(pir_live_vertices *v, uint32_t p, uint32_t q) {
    uint32_t at = place_of(v, p, q), slot = v->table[at];
    if (slot == PIR_NO_SLOT) {
        slot = v->free;
        if (slot != PIR_NO_SLOT) {
            v->free = v->next_free[slot];
        } else {
            PIR_ASSERT(v->used < v->capacity);
            slot = v->used++;
        }
        v->table[at] = slot;
        v->pair[slot][0] = p;
        v->pair[slot][1] = q;
        v->uses[slot] = 0;
    }
    v->uses[slot]++;
    return slot;
}

void pir_live_vertex_drop(pir_live_vertices *v, uint32_t slot) {
    if (--v->uses[slot] > 0 || v->is_idle[slot])
        return;
    v->is_idle[slot] = 1;
    v->idle[v->idle_count++] = slot;
}

static void empty_slot(pir_live_vertices *v, uint32_t slot) {
    uint32_t mask = 2 * v->capacity - 1, gap = place_of(v, v->pair[slot][0], v->pair[slot][1]);
    // close the gap: an entry behind it moves up if its own place is the gap or before it
    for (uint32_t i = (gap + 1) & mask; v->table[i] != PIR_NO_SLOT; i = (i + 1) & mask) {
        uint32_t home = home_of(v, v->pair[v->table[i]][0], v->pair[v->table[i]][1]);
        if (((i - home) & mask) >= ((i - gap) & mask)) {
            v->table[gap] = v->table[i];
            gap = i;
        }
    }
    v->table[gap] = PIR_NO_SLOT;
    v->next_free[slot] = v->free;
    v->free = slot;
}

void pir_live_vertices_sweep(pir_live_vertices *v) {
    for (uint32_t i = 0; i < v->idle_count; i++) {
        uint32_t slot = v->idle[i];
        v->is_idle[slot] = 0;
        if (v->uses[slot] == 0)
            empty_slot(v, slot);
    }
    v->idle_count = 0;
}
