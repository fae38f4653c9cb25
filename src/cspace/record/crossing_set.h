/* SPDX-License-Identifier: MIT */
/*
 * Crossings that are toggled: those toggled an odd number of times are what remains.
 *
 * A table with open addressing, at most half full. An entry counts where it has the table's stamp, so emptying the
 * table takes no time.
 */
#ifndef PIR_CSPACE_RECORD_CROSSING_SET_H
#define PIR_CSPACE_RECORD_CROSSING_SET_H

#include "base/memory.h"

/* An edge of −P and an edge of Q whose arcs cross. Pairs compare as numbers: by edge of −P, then by edge of Q. */
typedef uint64_t pir_crossing_key;

static inline pir_crossing_key pir_crossing_key_of(uint32_t edge_p, uint32_t edge_q) {
    return (uint64_t)edge_p << 32 | edge_q;
}

typedef struct pir_crossing_entry {
    pir_crossing_key key;
    uint32_t stamp, odd;
} pir_crossing_entry;

typedef struct pir_crossing_set {
    pir_allocator allocator;
    pir_crossing_entry *entry;
    uint32_t *used;        /* the entries that count, by when they came */
    pir_crossing_key *odd; /* room for what remains */
    uint32_t count, room;  /* entries that count; the table's size, a power of two, or 0 */
    uint32_t stamp;
} pir_crossing_set;

void pir_crossing_set_init(pir_crossing_set *set, const pir_allocator *allocator);
void pir_crossing_set_finish(pir_crossing_set *set);

/* Empties the set. */
void pir_crossing_set_clear(pir_crossing_set *set);

/* False when out of memory. */
bool pir_crossing_set_toggle(pir_crossing_set *set, pir_crossing_key key);

/* What remains, rising: *ret_count of them, valid until the set changes. */
const pir_crossing_key *pir_crossing_set_remains(pir_crossing_set *set, uint32_t *ret_count);

#endif
