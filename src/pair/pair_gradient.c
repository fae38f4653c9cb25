/* SPDX-License-Identifier: MIT */
/* Derivatives of a pair's signed distance, in the world, and its active sets. */
#include "pair/pair.h"
#include "query/answer/active.h"
#include "query/gradient/derivative.h"

/* Q's rotation, or NULL where the world is Q's frame. */
static const pir_mat3 *turn_of(const pir_workspace *workspace) {
    return workspace->posed ? &workspace->rotation_q.r : NULL;
}

pir_status pir_pair_gradient(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                             pir_query_result *ret_result, pir_gradient *ret_gradient, pir_curvature *ret_curvature) {
    if (!ret_result || !ret_gradient)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_pair_signed_distance(pair, workspace, input, ret_result);
    if (status != PIR_OK)
        return status;
    const pir_deriving deriving = {input->radius_p, input->radius_q, input->pose_p.translation,
                                   input->pose_q.translation};
    pir_derive(&workspace->frame, turn_of(workspace), workspace->decided, ret_result, &deriving, ret_gradient,
               ret_curvature);
    return PIR_OK;
}

/* --- active sets --- */

static void arrive_in_world(const void *context, pir_query_result *result) {
    pir_pair_to_world(context, result);
}

/* The facets, from the whole difference. */
static pir_status add_facets(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, double slack,
                             pir_active_list *list) {
    pir_placement placement;
    const pir_piece decided = workspace->decided;
    if (!pir_pair_allows(pair, PIR_LEVEL_WHOLE))
        return PIR_ERR_LIMIT;
    pir_status status = pir_pair_place_whole(pair, workspace, input, &placement);
    if (status != PIR_OK)
        return status;
    list->frame = &workspace->query->frame;
    pir_active_facets(list, workspace->query, &placement, decided, slack);
    pair->statistics.by_whole++;
    pair->level = PIR_LEVEL_WHOLE;
    return PIR_OK;
}

/* The answer without radii. */
static pir_status ask_bare(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, double cutoff,
                           pir_query_result *ret_result) {
    pir_pair_input asked = *input;
    asked.radius_p = asked.radius_q = 0;
    asked.cutoff = cutoff;
    return pir_pair_signed_distance(pair, workspace, &asked, ret_result);
}

pir_status pir_pair_active(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, double slack,
                           size_t capacity, pir_active *ret_active, size_t *ret_count) {
    pir_status status = pir_active_check(slack, capacity, ret_active, ret_count);
    if (status != PIR_OK || !pair || !workspace || !input)
        return PIR_ERR_ARGUMENT;
    status = pir_pair_check(input);
    if (status != PIR_OK)
        return status;
    const pir_query_input radii = {.radius_p = input->radius_p, .radius_q = input->radius_q, .cutoff = input->cutoff};
    pir_query_result result;
    status = ask_bare(pair, workspace, input, pir_active_bare(&radii).cutoff, &result);
    if (status != PIR_OK)
        return status;
    pir_active_list list = {.frame = &workspace->frame, .turn = turn_of(workspace), .radii = radii};
    list.deriving = (pir_deriving){0, 0, input->pose_p.translation, input->pose_q.translation};
    list.arrive = workspace->posed ? arrive_in_world : NULL;
    list.context = workspace;
    list.capacity = capacity;
    list.at = ret_active;
    if (workspace->decided.kind != PIR_NO_PIECE)
        status = add_facets(pair, workspace, input, slack, &list);
    else if (pir_active_has_points(&result))
        pir_active_apart(&list, &workspace->exact, &workspace->placement, &result);
    if (status == PIR_OK)
        *ret_count = list.count;
    return status;
}
