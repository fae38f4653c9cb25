/* SPDX-License-Identifier: MIT */
/* The nearest point by the pieces of the pairing: see closest.h. */
#include "query/search/closest.h"

#include "query/decide/witness.h"

bool pir_closest_piece(const pir_groups *groups, pir_witness faces, pir_piece *ret_piece) {
    const pir_polytope *q = groups->frame->q.polytope;
    const pir_pairing *pairing = groups->pairing;
    if (faces.p.kind == PIR_FEATURE_FACET)
        *ret_piece = pir_piece_fv(groups, faces.p.index);
    else if (faces.q.kind == PIR_FEATURE_FACET)
        *ret_piece = pir_piece_vf(groups, faces.q.index);
    else if (faces.p.kind == PIR_FEATURE_EDGE && faces.q.kind == PIR_FEATURE_EDGE) {
        uint32_t at = pir_crossing_first(pairing, faces.p.index);
        while (at != PIR_NO_CROSSING && q->edge[pir_crossing_half(pairing, at)] != faces.q.index)
            at = pir_crossing_next(pairing, at);
        if (at == PIR_NO_CROSSING)
            return false;
        *ret_piece = (pir_piece){PIR_FACET_EE, faces.p.index, pir_crossing_half(pairing, at)};
    } else {
        return false;
    }
    return true;
}

bool pir_closest_prove(const pir_groups *groups, const pir_placement *placement, const pir_simplex *simplex,
                       pir_nearest *ret_nearest) {
    const pir_frame *frame = groups->frame;
    pir_witness faces = {pir_feature_of(frame->p.polytope, simplex->a, simplex->count),
                         pir_feature_of(frame->q.polytope, simplex->b, simplex->count)};
    pir_piece piece;
    bool some = pir_closest_piece(groups, faces, &piece);
    return pir_nearest_prove(groups->exact, placement, faces, some ? &piece : NULL, ret_nearest);
}

bool pir_closest_find(const pir_groups *groups, const pir_placement *placement, const pir_simplex *simplex,
                      pir_nearest *ret_nearest, uint32_t *steps) {
    return pir_closest_prove(groups, placement, simplex, ret_nearest) ||
           pir_nearest_find(groups->exact, placement, simplex, ret_nearest, steps);
}
