/* SPDX-License-Identifier: MIT */
/* A body as the union of convex cells with disjoint insides. */
#ifndef PIR_SOLID_PIECES_DECOMPOSE_H
#define PIR_SOLID_PIECES_DECOMPOSE_H

#include <pirouette/solid.h>

#include "solid/body/solid_body.h"
#include "solid/pieces/cells.h"

typedef struct pir_piece_list {
    uint32_t count, room;
    uint32_t *cell;
} pir_piece_list;

/*
 * Adds the cells to `cells` and their numbers to `pieces`. `method` is not PIR_DECOMPOSE_BEST. The status is the
 * space's.
 */
pir_status pir_decompose(const pir_shell_body *body, pir_decompose_method method, pir_cells *cells,
                         pir_piece_list *pieces);

void pir_piece_list_finish(pir_piece_list *pieces, pir_space *space);
void pir_piece_list_add(pir_piece_list *pieces, pir_space *space, uint32_t cell);

#endif
