/* SPDX-License-Identifier: MIT */
/* The level `whole`: a query on the difference of the pair's bodies, kept in the workspace. */
#include "dymsum/relative.h"
#include "dymsum/view.h"
#include "pair/pair.h"
#include "query/answer/follow.h"
#include "query/answer/result.h"

static void forget(pir_workspace *workspace) {
    pir_query_destroy(workspace->query);
    pir_sum_destroy(workspace->sum);
    workspace->query = NULL;
    workspace->sum = NULL;
}

/* The difference of these bodies, at any rotation. */
static pir_status make(pir_pair *pair, pir_workspace *workspace) {
    if (workspace->sum && pir_sum_made_of(workspace->sum, PIR_OPERAND_P) == pair->body_p->body.polytope &&
        pir_sum_made_of(workspace->sum, PIR_OPERAND_Q) == pair->q)
        return PIR_OK;
    forget(workspace);
    pir_sum_options options = {.allocator = &workspace->allocator, .difference = 1};
    pir_status status = pir_sum_create(pair->p, pair->q, (pir_quat){0, 0, 0, 1}, &options, &workspace->sum);
    if (status == PIR_OK)
        status = pir_query_create(workspace->sum, &workspace->query);
    if (status != PIR_OK)
        forget(workspace);
    return status;
}

/* Keeps the facet of the answer as a hint, as all levels do. */
static void keep_facet(pir_pair *pair, const pir_query_cache *cache) {
    if (cache->pieces != 1 || pair->p->artificial || pair->q->artificial)
        return;
    pair->facet = (pir_piece){cache->kind, cache->first, cache->second};
    pair->has_facet = true;
}

pir_status pir_pair_whole(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, int want,
                          pir_query_result *result) {
    pir_placement placement;
    pir_status status = make(pair, workspace);
    if (status == PIR_OK)
        status = pir_sum_turn_relative(workspace->sum, input->pose_q.rotation, input->pose_p.rotation);
    workspace->world.translation_p = input->pose_p.translation;
    if (status == PIR_OK)
        status = pir_query_place_relative(workspace->query, &workspace->world, &placement);
    if (status != PIR_OK) {
        forget(workspace);
        return status;
    }
    pir_query_input asked = {.radius_p = input->radius_p, .radius_q = input->radius_q, .cutoff = input->cutoff};
    pir_query_cache cache = {0};
    pir_query_answer(workspace->query, &placement, &asked, want, &cache, result);
    keep_facet(pair, &cache);
    return PIR_OK;
}
