/* SPDX-License-Identifier: MIT */
/* A sieve for the pieces of a group that may hold the least slack: see sieve.c. */
#ifndef PIR_QUERY_SEARCH_SIEVE_H
#define PIR_QUERY_SEARCH_SIEVE_H

#include "query/search/search.h"

/*
 * Adds those pieces of group `g` to the candidates whose slack may be at most `limit`, and keeps the group's bound.
 * Returns an upper bound on the least slack of all, `limit` or less.
 */
double pir_group_sieve(pir_search *search, uint32_t g, const pir_placement *placement, double limit);

#endif
