/* SPDX-License-Identifier: MIT */
/* Pieces in a file of slices: the model whole, and numbers beside it for readers that have no Pirouette. */
#ifndef PIR_CSPACE_STORE_PIECE_FILE_H
#define PIR_CSPACE_STORE_PIECE_FILE_H

#include "cspace/parts/plan.h"
#include "cspace/store/h5.h"

/* Writes the pieces of a plan. One that is the same as one shortly before it shares its group. False when it fails. */
bool pir_pieces_put(hid_t file, const pir_plan *plan, pir_packer *packer);

#endif
