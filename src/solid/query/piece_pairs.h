/* SPDX-License-Identifier: MIT */
/* Pairs by need for pairs of pieces: as many as have a slot keep what their last answer needed. */
#ifndef PIR_SOLID_QUERY_PIECE_PAIRS_H
#define PIR_SOLID_QUERY_PIECE_PAIRS_H

#include <pirouette/pair.h>

#include "solid/pieces/compound.h"

#define PIR_PIECE_PAIRS 256

typedef struct pir_piece_pairs {
    struct pir_piece_slot {
        pir_pair *pair;
        uint32_t i, j;
    } slot[PIR_PIECE_PAIRS];
} pir_piece_pairs;

/* The pair of piece i of P and piece j of Q. Errors as of pir_pair_create. */
pir_status pir_piece_pairs_get(pir_piece_pairs *pairs, const pir_compound *p, const pir_compound *q,
                               const uint32_t piece[2], const pir_allocator *allocator, pir_pair **ret_pair);
void pir_piece_pairs_finish(pir_piece_pairs *pairs);

#endif
