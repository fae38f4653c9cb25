/* SPDX-License-Identifier: MIT */
/* The nearest point of D from where a descent ended, by the pieces of the pairing. */
#ifndef PIR_QUERY_SEARCH_CLOSEST_H
#define PIR_QUERY_SEARCH_CLOSEST_H

#include "query/decide/nearest.h"
#include "query/planes/groups.h"

/*
 * The nearest point where the features at which a descent ended, in doubles and filtered signs, prove to hold it: that
 * also proves that x is outside of D. False where they do not.
 */
bool pir_closest_prove(const pir_groups *groups, const pir_placement *placement, const pir_simplex *simplex,
                       pir_nearest *ret_nearest);

/* The same from any simplex of at least one vertex, given that x is outside of D; false after a bound on steps. */
bool pir_closest_find(const pir_groups *groups, const pir_placement *placement, const pir_simplex *simplex,
                      pir_nearest *ret_nearest, uint32_t *steps);

#endif
