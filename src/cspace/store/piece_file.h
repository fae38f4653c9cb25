/* SPDX-License-Identifier: MIT */
/* Pieces in a file of slices: the model whole, and numbers beside it for readers that have no Pirouette. */
#ifndef PIR_CSPACE_STORE_PIECE_FILE_H
#define PIR_CSPACE_STORE_PIECE_FILE_H

#include "cspace/store/h5.h"
#include "cspace/store/plan.h"

/* Writes the pieces into a group of that name. False when that fails. */
bool pir_pieces_put(hid_t file, const char *name, const pir_plan_piece *piece, uint32_t count, pir_packer *packer,
                    const pir_allocator *allocator);

#endif
