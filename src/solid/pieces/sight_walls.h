/* SPDX-License-Identifier: MIT */
/* A body as the union of convex cells, by the sight walls of its reflex edges (Hachenberger 2008). */
#ifndef PIR_SOLID_PIECES_SIGHT_WALLS_H
#define PIR_SOLID_PIECES_SIGHT_WALLS_H

#include "solid/pieces/decompose.h"

/* As pir_decompose, for PIR_DECOMPOSE_WALLS. */
void pir_decompose_by_sight(const pir_shell_body *body, pir_cells *cells, pir_piece_list *pieces);

#endif
