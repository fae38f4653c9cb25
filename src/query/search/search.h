/* SPDX-License-Identifier: MIT */
/* What searches for the state and for the least slack work on: groups, their bounds, and their findings. */
#ifndef PIR_QUERY_SEARCH_SEARCH_H
#define PIR_QUERY_SEARCH_SEARCH_H

#include "query/decide/facet.h"
#include "query/planes/bounds.h"

typedef struct pir_search {
    pir_groups groups;
    pir_bounds bounds;
    /* per group: its least slack minus its error, HUGE_VAL where a search for the state has not looked */
    double *slack;
    /* what a search for the least slack found: groups, and planes from slot `candidates` to the last */
    uint32_t *looked, looked_count, candidates;
} pir_search;

/*
 * Makes the memory for the frame of `exact`, whose operands are known, and a pairing; all of them are borrowed. False
 * when out of memory; pir_search_finish then frees what is there.
 */
bool pir_search_init(pir_search *search, const pir_allocator *allocator, pir_exact *exact, const pir_pairing *pairing);
void pir_search_finish(pir_search *search, const pir_allocator *allocator);

/* Fills in what depends on the frame's coordinates. */
void pir_search_fill(pir_search *search);

#endif
