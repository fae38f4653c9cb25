/* SPDX-License-Identifier: MIT */
/* The pairs that appeared in a refresh of a live mesh, or disappeared. */
#ifndef PIR_DYMSUM_LIVE_LIVE_PAIRS_H
#define PIR_DYMSUM_LIVE_LIVE_PAIRS_H

#include <pirouette/live_mesh.h>

#include "base/memory.h"

/* Pairs, as keys that order them by kind, p, q, and for callers. */
typedef struct pir_live_pairs {
    pir_sum_pair *at;
    uint64_t *key, *spare; /* spare: room to sort in */
    uint32_t count, capacity;
} pir_live_pairs;

/*
 * The bits of a feature's number in a key. Polytopes have fewer than 2^32 halfedges, and fewer features than half of
 * that.
 */
#define PIR_LIVE_NUMBER_BITS 31

/* Room for `capacity` pairs at least; false when out of memory, and nothing changes. */
bool pir_live_pairs_reserve(pir_live_pairs *pairs, const pir_allocator *allocator, uint32_t capacity);
void pir_live_pairs_finish(pir_live_pairs *pairs, const pir_allocator *allocator);

/* One more; there must be room. */
static inline void pir_live_pairs_note(pir_live_pairs *pairs, pir_facet_kind kind, uint32_t p, uint32_t q) {
    pairs->key[pairs->count++] = ((uint64_t)kind << PIR_LIVE_NUMBER_BITS | p) << PIR_LIVE_NUMBER_BITS | q;
}

/* When all are noted: sorts both lists, removes from both what is in both, and writes them out. */
void pir_live_pairs_settle(pir_live_pairs *appeared, pir_live_pairs *disappeared);

#endif
