/* SPDX-License-Identifier: MIT */
/* Derivatives of the distance of two bodies in pieces: those of the two pieces that have it. */
#include "solid/query/solid_query.h"

/* An answer about no features. */
static void set_none(pir_gradient *gradient, pir_curvature *curvature) {
    *gradient = (pir_gradient){.features = {{PIR_FEATURE_NONE, 0}, {PIR_FEATURE_NONE, 0}}};
    if (curvature)
        *curvature = (pir_curvature){.is_known = false};
}

pir_status pir_solid_query_gradient(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *input,
                                    pir_solid_distance *ret_distance, pir_gradient *ret_gradient,
                                    pir_curvature *ret_curvature) {
    pir_solid_distance distance;
    pir_query_result result;
    pir_pair *pair;
    if (!ret_distance || !ret_gradient)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_solid_query_distance(query, workspace, input, &distance);
    if (status != PIR_OK)
        return status;
    if (distance.result.outcome == PIR_OVERLAPPING || distance.result.outcome == PIR_BEYOND_CUTOFF) {
        set_none(ret_gradient, ret_curvature);
    } else {
        const uint32_t piece[2] = {distance.piece_p, distance.piece_q};
        pir_pair_input asked = *input;
        asked.cutoff = HUGE_VAL;
        status = pir_piece_pairs_get(&query->pairs, &query->p, &query->q, piece, &query->allocator, &pair);
        if (status == PIR_OK)
            status = pir_pair_gradient(pair, workspace, &asked, &result, ret_gradient, ret_curvature);
        if (status != PIR_OK)
            return status;
    }
    *ret_distance = distance;
    return PIR_OK;
}
