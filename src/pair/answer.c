/* SPDX-License-Identifier: MIT */
/*
 * Queries on a pair. The first way that proves an answer ends the question:
 *
 *   - proof: the bodies were apart, and have moved too little since (query/proof/proof.h). Where that has been used up,
 *     they may be apart still along the direction of the last time (apart.c). No frame is made for either;
 *   - walk, depth, nearest, depth anew (query/answer/ladder.h), with facets from surfaces and axes (pair_depth.c);
 *   - whole: a query on the difference of the bodies, kept in the workspace.
 *
 * The manifold of an answer is made afterwards (pair_manifold.c).
 *
 * An answer leaves the same hints whichever way gave it.
 */
#include "pair/pair_task.h"

#include "dymsum/relative.h"
#include "dymsum/view.h"
#include "query/answer/follow.h"

/* --- whole --- */

static void forget_whole(pir_workspace *workspace) {
    pir_query_destroy(workspace->query);
    pir_sum_destroy(workspace->sum);
    workspace->query = NULL;
    workspace->sum = NULL;
}

/* The difference of these bodies, at any rotation. */
static pir_status make_whole(pir_pair *pair, pir_workspace *workspace) {
    if (workspace->sum && pir_sum_made_of(workspace->sum, PIR_OPERAND_P) == pair->body_p->body.polytope &&
        pir_sum_made_of(workspace->sum, PIR_OPERAND_Q) == pair->q)
        return PIR_OK;
    forget_whole(workspace);
    pir_sum_options options = {.size = sizeof options, .allocator = &workspace->allocator, .difference = true};
    pir_status status = pir_sum_create(pair->p, pair->q, (pir_quat){0, 0, 0, 1}, &options, &workspace->sum);
    if (status == PIR_OK)
        status = pir_query_create(workspace->sum, &workspace->query);
    return status;
}

/* Keeps the facet of the answer as a hint, as all ways do. */
static void keep_facet(pir_pair *pair, const pir_query_cache *cache) {
    if (cache->pieces != 1 || pair->p->artificial || pair->q->artificial)
        return;
    pair->hint.facet = (pir_piece){cache->kind, cache->first, cache->second};
    pair->hint.has_facet = true;
}

pir_status pir_pair_place_whole(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                pir_placement *ret_placement) {
    pir_status status = make_whole(pair, workspace);
    if (status == PIR_OK)
        status = pir_sum_turn_relative(workspace->sum, input->pose_q.rotation, input->pose_p.rotation);
    workspace->world.translation_p = input->pose_p.translation;
    if (status == PIR_OK)
        status = pir_query_place_relative(workspace->query, &workspace->world, ret_placement);
    if (status != PIR_OK)
        forget_whole(workspace);
    return status;
}

/* The answer of the whole difference, in Q's frame, with the radii. PIR_ERR_MEMORY. */
static pir_status ask_whole(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, int want) {
    pir_placement placement;
    pir_status status = pir_pair_place_whole(pair, workspace, input, &placement);
    if (status != PIR_OK)
        return status;
    pir_query_input asked = {.radius_p = input->radius_p, .radius_q = input->radius_q, .cutoff = input->cutoff};
    pir_query_cache cache = {0};
    pir_query_answer(workspace->query, &placement, &asked, want, &cache, &workspace->answer);
    workspace->decided = workspace->query->room->decided;
    keep_facet(pair, &cache);
    pair->statistics.by_whole++;
    pair->level = PIR_LEVEL_WHOLE;
    return PIR_OK;
}

/* --- the ways --- */

/* The answer where it takes no frame. */
static bool by_proof(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, int want) {
    const double radii = input->radius_p + input->radius_q, cutoff = input->cutoff > 0 ? input->cutoff : 0;
    const bool has_cutoff = (want & PIR_WANT_SEPARATION) || radii > 0;
    const double least = has_cutoff ? cutoff + radii : 0;
    if (!pir_pair_allows(pair, PIR_LEVEL_APART) ||
        !(pir_pair_stays_apart(pair, input, least) ||
          (pair->has_axis && least < HUGE_VAL && pir_pair_apart(pair, workspace->walker, input, least))))
        return false;
    pir_result_clear(&workspace->answer);
    workspace->decided.kind = PIR_NO_PIECE;
    if (has_cutoff) {
        workspace->answer.outcome = PIR_BEYOND_CUTOFF;
        workspace->answer.distance = cutoff;
    }
    pair->statistics.queries++;
    pair->statistics.by_proof++;
    pair->level = PIR_LEVEL_APART;
    return true;
}

static const pir_facet_source source = {pir_pair_is_outside, pir_pair_depth, pir_pair_keep_apart};

static inline void set_task(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, int want,
                            pir_pair_task *ret_task) {
    const double radii = input->radius_p + input->radius_q;
    pir_task *task = &ret_task->task;
    ret_task->pair = pair;
    ret_task->workspace = workspace;
    task->source = &source;
    task->frame = &workspace->frame;
    task->placement = &workspace->placement;
    task->exact = &workspace->exact;
    task->hint = &pair->hint;
    task->walker = workspace->walker;
    task->result = &workspace->answer;
    // rounded bodies overlap where the polytopes are apart
    task->want = want | (radii > 0 ? PIR_WANT_SEPARATION | PIR_WANT_DEPTH : 0);
    task->limit = 0;
    if (task->want & PIR_WANT_SEPARATION)
        task->limit = pir_frame_from(&workspace->frame, (input->cutoff > 0 ? input->cutoff : 0) + radii);
    task->may_near = pir_pair_allows(pair, PIR_LEVEL_NEAR);
    task->may_deep = pir_pair_allows(pair, PIR_LEVEL_OVERLAPPING);
    pir_task_begin(task);
}

/* The answer by less than the whole difference. */
static bool by_need(pir_pair_task *asked) {
    pir_pair *pair = asked->pair;
    switch (pir_task_answer(&asked->task)) {
    case PIR_WAY_WALK:
        pair->statistics.by_walk++;
        pair->level = PIR_LEVEL_NEAR;
        return true;
    case PIR_WAY_NEAREST:
        pair->statistics.by_nearest++;
        pair->level = PIR_LEVEL_NEAR;
        return true;
    case PIR_WAY_DEPTH:
        pair->statistics.by_depth++;
        return true;
    default:
        return false;
    }
}

static void add_radii(const pir_pair_input *input, pir_query_result *result) {
    pir_query_input radii = {.radius_p = input->radius_p, .radius_q = input->radius_q, .cutoff = input->cutoff};
    pir_result_add_radii(&radii, result);
}

/* The answer in the workspace, the frame being set. */
static pir_status find_answer(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, int want) {
    pir_query_result *result = &workspace->answer;
    pir_pair_task asked;
    pir_result_clear(result);
    set_task(pair, workspace, input, want, &asked);
    pair->statistics.queries++;
    if (!by_need(&asked)) {
        if (!pir_pair_allows(pair, PIR_LEVEL_WHOLE))
            return PIR_ERR_LIMIT;
        pir_status status = ask_whole(pair, workspace, input, want);
        if (status != PIR_OK)
            return status;
    } else {
        workspace->decided = asked.task.decided;
        if (input->radius_p + input->radius_q > 0)
            add_radii(input, result);
        else if (result->outcome == PIR_BEYOND_CUTOFF)
            result->distance = input->cutoff > 0 ? input->cutoff : 0;
    }
    if (workspace->posed)
        pir_pair_to_world(workspace, result);
    return PIR_OK;
}

/* --- the calls --- */

/* Copies an answer that has just been stored: see pir_vec_just_stored. */
static inline void give(const volatile pir_query_result *from, pir_query_result *to) {
    to->state = from->state;
    to->outcome = from->outcome;
    to->distance = from->distance;
    to->normal = pir_vec_just_stored(&from->normal);
    to->point_p = pir_vec_just_stored(&from->point_p);
    to->point_q = pir_vec_just_stored(&from->point_q);
    to->witness.p.kind = from->witness.p.kind;
    to->witness.p.index = from->witness.p.index;
    to->witness.q.kind = from->witness.q.kind;
    to->witness.q.index = from->witness.q.index;
    to->steps = from->steps;
}

static pir_status answer(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, int want,
                         pir_query_result *ret_result) {
    if (!pair || !workspace || !input || !ret_result)
        return PIR_ERR_ARGUMENT;
    if (!by_proof(pair, workspace, input, want)) {
        // a proof that is used up is not asked again: an answer that is apart leaves another
        pair->proof.leeway = 0;
        pir_status status = pir_pair_begin(pair, workspace, input);
        if (status == PIR_OK)
            status = find_answer(pair, workspace, input, want);
        if (status != PIR_OK)
            return status;
    }
    give(&workspace->answer, ret_result);
    return PIR_OK;
}

pir_status pir_pair_overlap(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                            pir_query_result *ret_result) {
    if (!pair || !workspace || !input || !ret_result)
        return PIR_ERR_ARGUMENT;
    // the caller's cutoff tells nothing here, but is refused where it is no number
    pir_status status = pir_pair_check(input);
    if (status != PIR_OK)
        return status;
    pir_pair_input near = *input;
    bool rounded = input->radius_p + input->radius_q > 0;
    if (rounded)
        near.cutoff = 0;
    status = answer(pair, workspace, &near, rounded ? PIR_WANT_SEPARATION : 0, ret_result);
    if (status == PIR_OK)
        pir_result_keep_state(ret_result);
    return status;
}

pir_status pir_pair_distance(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                             pir_query_result *ret_result) {
    pir_status status = answer(pair, workspace, input, PIR_WANT_SEPARATION, ret_result);
    if (status == PIR_OK && ret_result->outcome == PIR_OVERLAPPING)
        ret_result->distance = 0;
    return status;
}

pir_status pir_pair_penetration(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                pir_query_result *ret_result) {
    pir_status status = answer(pair, workspace, input, PIR_WANT_DEPTH, ret_result);
    if (status == PIR_OK && ret_result->state == PIR_OUTSIDE)
        ret_result->distance = 0;
    return status;
}

pir_status pir_pair_signed_distance(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                    pir_query_result *ret_result) {
    return answer(pair, workspace, input, PIR_WANT_SEPARATION | PIR_WANT_DEPTH, ret_result);
}
