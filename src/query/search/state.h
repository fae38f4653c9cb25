/* SPDX-License-Identifier: MIT */
/* The exact state: see state.c. */
#ifndef PIR_QUERY_SEARCH_STATE_H
#define PIR_QUERY_SEARCH_STATE_H

#include "query/search/search.h"

/*
 * The exact state. Outside, *ret_separating is a piece whose plane separates; its kind is PIR_NO_PIECE where none is
 * known. On the boundary, *ret_touching is the first true facet in order that t lies on; there may be none where D
 * has no area.
 */
pir_state pir_state_find(pir_search *search, const pir_placement *placement, const pir_query_cache *cache,
                         pir_piece *ret_separating, pir_least *ret_touching, uint32_t *steps);

#endif
