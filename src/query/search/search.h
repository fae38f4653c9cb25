/* SPDX-License-Identifier: MIT */
/* What a search for the state or the least slack works on: groups, their bounds, and what it has found. */
#ifndef PIR_QUERY_SEARCH_SEARCH_H
#define PIR_QUERY_SEARCH_SEARCH_H

#include "query/decide/facet.h"
#include "query/planes/bounds.h"

typedef struct pir_search {
    pir_groups groups;
    pir_bounds bounds;
    double *slack; /* per group: what a search for the state knows, HUGE_VAL where it did not look */
    /*
     * what a search for the least slack found: groups that were looked at, and planes from slot `candidates` up to
     * the spare ones
     */
    uint32_t *looked, looked_count, candidates;
} pir_search;

/*
 * Memory for a frame, whose operands are known, and a pairing; all of these are borrowed. False when out of
 * memory: pir_search_finish frees what is there.
 */
bool pir_search_init(pir_search *search, const pir_allocator *allocator, pir_exact *exact, const pir_pairing *pairing);
void pir_search_finish(pir_search *search, const pir_allocator *allocator);

/* Fills in what depends on the frame's coordinates. */
void pir_search_fill(pir_search *search);

#endif
