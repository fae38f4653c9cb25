/* SPDX-License-Identifier: MIT */
/* The nearest point of D, from the simplex at which a descent ended and the pieces of the pairing. */
#ifndef PIR_QUERY_SEARCH_CLOSEST_H
#define PIR_QUERY_SEARCH_CLOSEST_H

#include "query/decide/nearest.h"
#include "query/planes/groups.h"

/* The piece that consists of two features. False where the pairing has none. */
bool pir_closest_piece(const pir_groups *groups, pir_witness faces, pir_piece *ret_piece);

/*
 * The nearest point, where doubles and filtered signs prove that the features of the simplex hold it. That proves as
 * well that x is outside of D. False where there is no such proof.
 */
bool pir_closest_prove(const pir_groups *groups, const pir_placement *placement, const pir_simplex *simplex,
                       pir_nearest *ret_nearest);

/*
 * The nearest point from any simplex of at least one vertex, given that x is outside of D. False after a bound on
 * steps.
 */
bool pir_closest_find(const pir_groups *groups, const pir_placement *placement, const pir_simplex *simplex,
                      pir_nearest *ret_nearest, uint32_t *steps);

#endif
