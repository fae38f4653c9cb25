/* SPDX-License-Identifier: MIT */
/* What is left of a proof: see held_proof.h. */
#include "pair/facet/held_proof.h"

pir_leeway pir_held_moved(const pir_held *held, const pir_frame *frame, const pir_placement *placement) {
    pir_vec3 way = pir_vec_sub(placement->x, held->at);
    // both ends of the way are off by the error of a placement
    return (pir_leeway){pir_rotation_angle_bound(held->turned, frame->unit),
                        sqrt(pir_vec_dot(way, way)) * (1 + 0x1p-40) + 4 * placement->error};
}

void pir_held_set(pir_held *held, const pir_frame *frame, const pir_placement *placement, const pir_same_facet *same) {
    const pir_facet *facet = &same->facet;
    uint32_t corner = facet->piece.kind == PIR_FACET_FV ? facet->a : facet->b;
    *held = (pir_held){.some = same->falls > 0,
                       .is_short = held->is_short,
                       .at = placement->x,
                       .turned = frame->unit,
                       .falls = same->falls,
                       .known = {same->margin, corner}};
}

bool pir_held_known(const pir_held *held, pir_leeway moved, const pir_placement *placement, pir_same_known *ret_known) {
    *ret_known = held->known;
    ret_known->margin -= (moved.way + moved.turn * placement->reach) * (1 + 0x1p-40);
    return moved.turn < held->falls && ret_known->margin > 0;
}
