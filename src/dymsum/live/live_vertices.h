/* SPDX-License-Identifier: MIT */
/*
 * The vertices of a live mesh: each pair (vertex of P, vertex of Q) that corners name has a slot.
 *
 * Invariants after a sweep:
 *   - `uses` of a slot is the number of corners that name it; the free slots are chained through `next_free`;
 *   - the table finds the slot of every pair in use, by open addressing; it is at most half full.
 */
#ifndef PIR_DYMSUM_LIVE_LIVE_VERTICES_H
#define PIR_DYMSUM_LIVE_LIVE_VERTICES_H

#include "base/memory.h"

#define PIR_NO_SLOT UINT32_MAX

/* Vertices in slots, found by pair. */
typedef struct pir_live_vertices {
    uint32_t (*pair)[2];
    uint32_t *uses, *next_free;
    uint32_t *idle; /* slots whose last use ended in this refresh, each once */
    uint8_t *is_idle;
    uint32_t capacity, used, free, idle_count;
    uint32_t *table; /* slots, or PIR_NO_SLOT; twice as many as capacity, a power of two */
} pir_live_vertices;

/* Room for `capacity` vertices at least; false when out of memory, and nothing changes. */
bool pir_live_vertices_reserve(pir_live_vertices *vertices, const pir_allocator *allocator, uint32_t capacity);
void pir_live_vertices_finish(pir_live_vertices *vertices, const pir_allocator *allocator);

/* The slot of the pair, used once more; there must be room. */
uint32_t pir_live_vertex_take(pir_live_vertices *vertices, uint32_t p, uint32_t q);

/* The slot is used once less. Without uses it is kept for whoever takes its pair again, until the sweep empties it. */
void pir_live_vertex_drop(pir_live_vertices *vertices, uint32_t slot);
void pir_live_vertices_sweep(pir_live_vertices *vertices);

#endif
