/* SPDX-License-Identifier: MIT */
/* Pieces joined while their unions are convex. */
#ifndef PIR_SOLID_PIECES_MERGE_H
#define PIR_SOLID_PIECES_MERGE_H

#include "solid/pieces/decompose.h"

/* Gives equal points and planes of the pieces one number, then joins pairs of pieces until no union of two is convex.
 * */
void pir_merge_pieces(pir_cells *cells, pir_piece_list *pieces);

#endif
