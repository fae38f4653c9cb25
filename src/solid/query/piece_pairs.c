/* SPDX-License-Identifier: MIT */
/* See piece_pairs.h. A pair of pieces has one slot that it may be in, and takes it over. No answer depends on it. */
#include "solid/query/piece_pairs.h"

pir_status pir_piece_pairs_get(pir_piece_pairs *pairs, const pir_compound *p, const pir_compound *q,
                               const uint32_t piece[2], const pir_allocator *allocator, pir_pair **ret_pair) {
    const uint32_t hash = (piece[0] * 0x9E3779B1u) ^ (piece[1] * 0x85EBCA6Bu);
    struct pir_piece_slot *slot = &pairs->slot[(hash >> 16) % PIR_PIECE_PAIRS];
    pir_status status = PIR_OK;
    if (!slot->pair) {
        pir_pair_options options = pir_pair_options_default();
        options.allocator = allocator;
        status = pir_pair_create(p->piece[piece[0]], q->piece[piece[1]], &options, &slot->pair);
    } else if (slot->i != piece[0] || slot->j != piece[1]) {
        status = pir_pair_reset(slot->pair, p->piece[piece[0]], q->piece[piece[1]]);
    }
    if (status != PIR_OK)
        return status;
    slot->i = piece[0];
    slot->j = piece[1];
    *ret_pair = slot->pair;
    return PIR_OK;
}

void pir_piece_pairs_finish(pir_piece_pairs *pairs) {
    for (uint32_t k = 0; k < PIR_PIECE_PAIRS; k++)
        pir_pair_destroy(pairs->slot[k].pair);
}
