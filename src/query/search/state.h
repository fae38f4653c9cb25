/* SPDX-License-Identifier: MIT */
/* Inside, boundary or outside, exactly: see state.c. */
#ifndef PIR_QUERY_SEARCH_STATE_H
#define PIR_QUERY_SEARCH_STATE_H

#include "query/search/search.h"

#define PIR_NO_PLANE UINT32_MAX

/*
 * The exact state. When outside, *ret_slot is the slot of a plane that separates, PIR_NO_PLANE where none is known.
 * On the boundary, *ret_touching is the first true facet in order that t lies on; there may be none where D has no
 * area.
 */
pir_state pir_state_find(pir_search *search, const pir_placement *placement, const pir_query_cache *cache,
                         uint32_t *ret_slot, pir_least *ret_touching, uint32_t *steps);

#endif
