/* SPDX-License-Identifier: MIT */
/* Vertices at one place by a hash table, edges by sorting, parts by joining sets. */
#include "mesh/weld.h"

#include <string.h>

#include "base/byte_block.h"

#define NONE UINT32_MAX

static bool is_same(pir_vec3 a, pir_vec3 b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* A hash that 0 and −0 share, since they are equal. */
static uint64_t hash_of(pir_vec3 v) {
    const double c[3] = {v.x + 0.0, v.y + 0.0, v.z + 0.0};
    uint64_t hash = pir_hash_words(PIR_HASH_START, c, sizeof c);
    hash = (hash ^ hash >> 32) * UINT64_C(0x9e3779b97f4a7c15);
    return hash ^ hash >> 32;
}

bool pir_weld_vertices(const pir_allocator *allocator, const pir_vec3 *vertex, uint32_t count, uint32_t *same) {
    size_t slots = 16;
    while (slots < 2 * (size_t)count)
        slots *= 2;
    uint32_t *slot = PIR_NEW(allocator, uint32_t, slots);
    if (!slot)
        return false;
    memset(slot, 0xff, slots * sizeof *slot);
    for (uint32_t v = 0; v < count; v++) {
        size_t at = hash_of(vertex[v]) & (slots - 1);
        while (slot[at] != NONE && !is_same(vertex[slot[at]], vertex[v]))
            at = (at + 1) & (slots - 1);
        if (slot[at] == NONE)
            slot[at] = v;
        same[v] = slot[at];
    }
    PIR_FREE(allocator, slot, slots);
    return true;
}

#define DIGIT 11

/* Sorts keys by 11 bits at a time, the lowest first, passing over digits that all have in common. */
static uint64_t *sort_keys(uint64_t *key, uint64_t *work, size_t count) {
    for (int shift = 0; shift < 64; shift += DIGIT) {
        size_t start[1 << DIGIT] = {0}, sum = 0;
        for (size_t i = 0; i < count; i++)
            start[key[i] >> shift & ((1 << DIGIT) - 1)]++;
        if (start[key[0] >> shift & ((1 << DIGIT) - 1)] == count)
            continue;
        for (size_t d = 0; d < 1 << DIGIT; d++) {
            size_t size = start[d];
            start[d] = sum;
            sum += size;
        }
        for (size_t i = 0; i < count; i++)
            work[start[key[i] >> shift & ((1 << DIGIT) - 1)]++] = key[i];
        uint64_t *swap = key;
        key = work;
        work = swap;
    }
    return key;
}

static uint64_t edge_key(uint32_t a, uint32_t b) {
    return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

bool pir_weld_is_closed(const pir_allocator *allocator, const uint32_t (*corner)[3], uint32_t count, bool *ret_closed) {
    size_t edges = 3 * (size_t)count;
    uint64_t *key = PIR_NEW(allocator, uint64_t, 2 * edges);
    if (!key)
        return false;
    for (uint32_t t = 0; t < count; t++)
        for (int k = 0; k < 3; k++)
            key[3 * (size_t)t + (size_t)k] = edge_key(corner[t][k], corner[t][(k + 1) % 3]);
    const uint64_t *sorted = sort_keys(key, key + edges, edges);
    bool closed = true;
    for (size_t i = 0, end; i < edges && closed; i = end) {
        for (end = i + 1; end < edges && sorted[end] == sorted[i];)
            end++;
        // a side from a vertex to itself is none
        closed = (end - i) % 2 == 0 || sorted[i] >> 32 == (sorted[i] & UINT32_MAX);
    }
    PIR_FREE(allocator, key, 2 * edges);
    *ret_closed = closed;
    return true;
}

static uint32_t root_of(uint32_t *part, uint32_t v) {
    while (part[v] != v) {
        part[v] = part[part[v]];
        v = part[v];
    }
    return v;
}

void pir_weld_parts(uint32_t *part, uint32_t vertex_count, const uint32_t (*corner)[3], const uint32_t *item,
                    uint32_t count) {
    for (uint32_t v = 0; v < vertex_count; v++)
        part[v] = v;
    for (uint32_t i = 0; i < count; i++)
        for (int k = 1; k < 3; k++) {
            uint32_t a = root_of(part, corner[item[i]][0]), b = root_of(part, corner[item[i]][k]);
            // the lower number stays, so that paths lead downward
            part[a > b ? a : b] = a < b ? a : b;
        }
    for (uint32_t v = 0; v < vertex_count; v++)
        part[v] = root_of(part, v);
}
