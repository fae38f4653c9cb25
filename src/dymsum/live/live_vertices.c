/* SPDX-License-Identifier: MIT */
/*
 * The vertices of a live mesh: slots counted by use, and a hash table with linear probing whose gaps are closed as
 * entries go.
 */
#include "dymsum/live/live_mesh.h"

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

static void free_arrays(const pir_live_vertices *v, const pir_allocator *a) {
    PIR_FREE(a, v->pair, v->capacity);
    PIR_FREE(a, v->uses, v->capacity);
    PIR_FREE(a, v->next_free, v->capacity);
    PIR_FREE(a, v->idle, v->capacity);
    PIR_FREE(a, v->is_idle, v->capacity);
    PIR_FREE(a, v->table, (size_t)v->capacity * 2);
}

bool pir_live_vertices_reserve(pir_live_vertices *v, const pir_allocator *a, uint32_t least) {
    if (least <= v->capacity)
        return true;
    PIR_ASSERT(v->idle_count == 0);
    uint32_t capacity = 64;
    while (capacity < least)
        capacity *= 2;
    pir_live_vertices grown = {.pair = pir_memory_new(a, capacity, sizeof *v->pair),
                               .uses = PIR_NEW(a, uint32_t, capacity),
                               .next_free = PIR_NEW(a, uint32_t, capacity),
                               .idle = PIR_NEW(a, uint32_t, capacity),
                               .is_idle = PIR_ZEROED(a, uint8_t, capacity),
                               .table = PIR_NEW(a, uint32_t, (size_t)capacity * 2),
                               .capacity = capacity,
                               .used = v->used,
                               .free = v->capacity ? v->free : PIR_NO_SLOT};
    if (!grown.pair || !grown.uses || !grown.next_free || !grown.idle || !grown.is_idle || !grown.table) {
        free_arrays(&grown, a);
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
    free_arrays(v, a);
    *v = grown;
    return true;
}

void pir_live_vertices_finish(pir_live_vertices *v, const pir_allocator *a) {
    free_arrays(v, a);
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
    // close the gap: whoever stands behind it, but would rather stand in it or before, moves up
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
