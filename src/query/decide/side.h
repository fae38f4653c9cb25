/* SPDX-License-Identifier: MIT */
/*
 * A piece's exact normal, and on which side of its plane a translation lies: the sign of n·W (placed.h) for a corner
 * of it.
 */
#ifndef PIR_QUERY_DECIDE_SIDE_H
#define PIR_QUERY_DECIDE_SIDE_H

#include "query/decide/placed.h"

/* The exact sign of the slack of a piece at a translation. The piece's edges must not be parallel. */
int pir_side_exact(pir_exact *exact, pir_piece piece, pir_vec3 translation);

/* The exact unit normal of an edge pair; false when parallel. */
bool pir_side_normal(pir_exact *exact, pir_piece piece, pir_vec3 *ret_normal);

#endif
