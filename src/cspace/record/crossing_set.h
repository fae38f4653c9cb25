/* SPDX-License-Identifier: MIT */
/*
 * Crossings that are toggled: those toggled an odd number of times are what remains, edge by edge of −P.
 *
 * The crossings of an edge that remain are a chain. Few do: a toggle looks at a few entries.
 */
#ifndef PIR_CSPACE_RECORD_CROSSING_SET_H
#define PIR_CSPACE_RECORD_CROSSING_SET_H

#include "base/memory.h"

/* A crossing that remains: the edge of Q, and the next entry of its chain. Free entries are chained too. */
typedef struct pir_crossing_entry {
    uint32_t other, next;
} pir_crossing_entry;

typedef struct pir_crossing_set {
    pir_allocator allocator;
    uint32_t edges;    /* of −P */
    uint32_t *first;   /* per edge of −P: an entry, or none */
    uint64_t *touched; /* a bit for each edge that may have a chain */
    pir_crossing_entry *entry;
    uint32_t used, room, free;
} pir_crossing_set;

/* An empty set, for so many edges of −P. False when out of memory; pir_crossing_set_finish releases what is there. */
bool pir_crossing_set_init(pir_crossing_set *set, uint32_t edges, const pir_allocator *allocator);
void pir_crossing_set_finish(pir_crossing_set *set);

/* Toggles the crossing of edge e of −P with edge g of Q. False when out of memory. */
bool pir_crossing_set_toggle(pir_crossing_set *set, uint32_t e, uint32_t g);

/* Empties the set. The edges of −P with crossings that remained go to ret_edges, rising; returns their number. */
uint32_t pir_crossing_set_take(pir_crossing_set *set, uint32_t *ret_edges);

#endif
