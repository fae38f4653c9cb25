/* SPDX-License-Identifier: MIT */
/* The exact state and the least slack, searched among the pieces of a pairing: see depth.c and state.c. */
#ifndef PIR_QUERY_DEPTH_DEPTH_H
#define PIR_QUERY_DEPTH_DEPTH_H

#include "query/decide/facet.h"
#include "query/depth/bounds.h"
#include "query/depth/groups.h"
#include "query/nearest/nearest_vertex.h"

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

/*
 * The true facet of least slack. False where D has none. Where x is outside, only the sign of its slack has a
 * meaning.
 */
bool pir_depth_find(pir_search *search, const pir_placement *placement, const pir_query_cache *cache,
                    pir_facet *ret_facet, uint32_t *steps);

/* --- state.c --- */

/*
 * The exact state. Outside, *ret_separating is a piece whose plane separates; its kind is PIR_NO_PIECE where none is
 * known. On the boundary, *ret_touching is the first true facet in order that t lies on; there may be none where D
 * has no area.
 */
pir_state pir_state_find(pir_search *search, const pir_placement *placement, const pir_query_cache *cache,
                         pir_piece *ret_separating, pir_least *ret_touching, uint32_t *steps);

/* Whether a facet of D at the simplex certainly separates. Then the cache keeps it, if there is one. */
bool pir_prove_outside(const pir_groups *groups, const pir_placement *placement, const pir_simplex *simplex,
                       pir_query_cache *cache);

#endif
