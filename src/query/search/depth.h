/* SPDX-License-Identifier: MIT */
/* The least slack, which is the global penetration depth: see depth.c. */
#ifndef PIR_QUERY_SEARCH_DEPTH_H
#define PIR_QUERY_SEARCH_DEPTH_H

#include "query/search/search.h"

/*
 * The true facet of least slack. False where D has none. Where x is outside, only the sign of its slack has a
 * meaning.
 */
bool pir_depth_find(pir_search *search, const pir_placement *placement, const pir_query_cache *cache,
                    pir_facet *ret_facet, uint32_t *steps);

#endif
