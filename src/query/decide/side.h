/* SPDX-License-Identifier: MIT */
/*
 * The exact normal of a piece, and the side of its plane that a translation lies on: the sign of n·W (placed.h) for a
 * corner of the piece.
 */
#ifndef PIR_QUERY_DECIDE_SIDE_H
#define PIR_QUERY_DECIDE_SIDE_H

#include "query/decide/placed.h"

/* The exact sign of the slack of a piece at a translation. The piece's edges must not be parallel. */
int pir_side_exact(pir_exact *exact, pir_piece piece, pir_vec3 translation);

/* The unit normal of an edge pair from exact integers. False where the edges are parallel. */
bool pir_side_normal(pir_exact *exact, pir_piece piece, pir_vec3 *ret_normal);

#endif
