/* SPDX-License-Identifier: MIT */
/* Depths of two bodies in pieces, once their state is known: searched by solid/depth. */
#include "solid/depth/depth_answer.h"
#include "solid/query/solid_query.h"

/* The state, and what a depth is searched with where it is PIR_INSIDE. */
static pir_status begin(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *input,
                        pir_state *ret_state) {
    const pir_status status = pir_solid_query_overlap(query, workspace, input, ret_state);
    if (status != PIR_OK || *ret_state != PIR_INSIDE || query->depth)
        return status;
    pir_depth_search *made = PIR_ZEROED(&query->allocator, pir_depth_search, 1);
    if (!made)
        return PIR_ERR_MEMORY;
    if (!pir_depth_search_init(made, &query->p, &query->q, &query->allocator)) {
        pir_depth_search_finish(made);
        PIR_FREE(&query->allocator, made, 1);
        return PIR_ERR_MEMORY;
    }
    query->depth = made;
    return PIR_OK;
}

pir_status pir_solid_query_depth(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *input,
                                 pir_solid_depth *ret_depth) {
    if (!query || !workspace || !input || !ret_depth)
        return PIR_ERR_ARGUMENT;
    pir_solid_depth depth = {0};
    pir_depth_found found;
    pir_status status = begin(query, workspace, input, &depth.state);
    if (status == PIR_OK && depth.state == PIR_INSIDE) {
        status = pir_depth_search_nearest(query->depth, input, &found);
        if (status == PIR_OK)
            status = pir_depth_answer(query->depth, found, &depth);
    }
    if (status == PIR_OK)
        *ret_depth = depth;
    return status;
}

pir_status pir_solid_query_directional_depth(pir_solid_query *query, pir_workspace *workspace,
                                             const pir_pair_input *input, pir_vec3 direction,
                                             pir_solid_depth *ret_depth) {
    if (!query || !workspace || !input || !ret_depth)
        return PIR_ERR_ARGUMENT;
    if (!isfinite(direction.x) || !isfinite(direction.y) || !isfinite(direction.z))
        return PIR_ERR_NOT_FINITE;
    if (direction.x == 0 && direction.y == 0 && direction.z == 0)
        return PIR_ERR_ARGUMENT;
    pir_solid_depth depth = {0};
    pir_depth_found found;
    pir_status status = begin(query, workspace, input, &depth.state);
    if (status == PIR_OK && depth.state == PIR_INSIDE) {
        status = pir_depth_search_along(query->depth, input, direction, &found);
        if (status == PIR_OK)
            status = pir_depth_answer(query->depth, found, &depth);
    }
    if (status == PIR_OK)
        *ret_depth = depth;
    return status;
}
