/* SPDX-License-Identifier: MIT */
/* Which pieces of a group may hold the least slack: see sieve.c. */
#ifndef PIR_QUERY_SEARCH_SIEVE_H
#define PIR_QUERY_SEARCH_SIEVE_H

#include "query/search/search.h"

/*
 * Adds to the candidates those pieces of group `g` whose slack may be at most `limit`, without making its other
 * planes; keeps the group's bound. Returns what the least slack of all is not above, `limit` or less.
 */
double pir_group_sieve(pir_search *search, uint32_t g, const pir_placement *placement, double limit);

#endif
