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

/* Sets what a search works on, which is borrowed. It begins as zeros, and has no groups yet. */
void pir_search_init(pir_search *search, pir_exact *exact, const pir_pairing *pairing);

/* Adds the rows of a search, whose groups have their lists, to a layout. */
void pir_search_add_rows(pir_search *search, pir_layout *layout);

/* Makes groups and bounds anew. */
void pir_search_fill(pir_search *search);

#endif
