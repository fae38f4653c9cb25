/* SPDX-License-Identifier: MIT */
/* Derivatives of the signed distance on a sum, and its active sets. */
#include "query/answer/active.h"

pir_status pir_query_gradient(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                              pir_query_result *ret_result, pir_gradient *ret_gradient, pir_curvature *ret_curvature) {
    if (!ret_result || !ret_gradient)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_signed_distance(query, input, cache, ret_result);
    if (status != PIR_OK)
        return status;
    const pir_deriving deriving = {input->radius_p, input->radius_q, input->translation, {0, 0, 0}};
    pir_derive(&query->frame, NULL, query->room->decided, ret_result, &deriving, ret_gradient, ret_curvature);
    return PIR_OK;
}

pir_status pir_query_active(pir_query *query, const pir_query_input *input, double slack, size_t capacity,
                            pir_active *ret_active, size_t *ret_count) {
    pir_status status = pir_active_check(slack, capacity, ret_active, ret_count);
    if (status != PIR_OK || !input)
        return PIR_ERR_ARGUMENT;
    pir_query_result result;
    pir_placement placement;
    status = pir_query_begin(query, input, &placement);
    if (status != PIR_OK)
        return status;
    const pir_query_input bare = pir_active_bare(input);
    status = pir_query_signed_distance(query, &bare, NULL, &result);
    if (status != PIR_OK)
        return status;
    pir_active_list list = {.frame = &query->frame, .radii = *input, .capacity = capacity, .at = ret_active};
    list.deriving.origin_p = input->translation;
    if (query->room->decided.kind != PIR_NO_PIECE)
        pir_active_facets(&list, query, &placement, query->room->decided, slack);
    else if (pir_active_has_points(&result))
        pir_active_apart(&list, &query->exact, &placement, &result);
    *ret_count = list.count;
    return PIR_OK;
}
