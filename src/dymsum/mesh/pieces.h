/* SPDX-License-Identifier: MIT */
/*
 * Which pieces of a sum, one for each pair of the pairing, make one facet of the true sum.
 *
 * A facet of the true sum is the face of P, rotated, plus the face of Q in its normal's direction. It takes several
 * pieces only where one of the two faces is a facet and the other is more than a vertex. So it is enough to know, for
 * each facet of P and of Q, the face of the other operand in its direction; and which crossings stand alone.
 */
#ifndef PIR_DYMSUM_MESH_PIECES_H
#define PIR_DYMSUM_MESH_PIECES_H

#include "dymsum/mesh/facet_list.h"
#include "dymsum/view.h"

typedef struct pir_sum_pieces {
    pir_sum_face *of_p, *of_q; /* per facet of P, of Q */
    uint64_t *alone;           /* a bit for each slot of a crossing: its parallelogram is a facet */
    uint32_t alone_count;
} pir_sum_pieces;

/*
 * The pieces of a sum whose pairing is exact at the rotation of `posed`, told apart exactly.
 * PIR_ERR_MEMORY leaves nothing to release.
 */
pir_status pir_pieces_make(pir_sum_pieces *pieces, const pir_pairing *pairing, const pir_posed *posed);
void pir_pieces_finish(pir_sum_pieces *pieces, const pir_pairing *pairing);

static inline bool pir_piece_is_alone(const pir_sum_pieces *pieces, uint32_t slot) {
    return pieces->alone[slot / 64] >> slot % 64 & 1;
}

#endif
