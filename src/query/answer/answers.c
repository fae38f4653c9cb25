/* SPDX-License-Identifier: MIT */
/*
 * Queries on one placement: overlap, separation, penetration. All of them share the exact state. The ways are those of
 * ladder.h, with the pieces of the pairing as the source of facets. The searches among these are in query/depth, the
 * decisions in query/decide.
 */
#include "query/answer/follow.h"
#include "query/answer/ladder.h"
#include "query/contact/manifold.h"
#include "query/depth/depth.h"

pir_query_input pir_query_input_default(void) {
    return (pir_query_input){{0, 0, 0}, 0, 0, HUGE_VAL, 0};
}

/* --- what a cache keeps --- */

static void recall_simplex(const pir_query *query, const pir_query_cache *cache, pir_hint *hint) {
    hint->points = 0;
    if (!cache || cache->points > 3)
        return;
    for (uint32_t i = 0; i < cache->points; i++) {
        if (cache->p[i] >= query->p->vertex_count || cache->q[i] >= query->q->vertex_count)
            return;
        hint->a[i] = cache->p[i];
        hint->b[i] = cache->q[i];
    }
    hint->points = (uint8_t)cache->points;
}

/* The hint in a cache: a facet, where the last answer was by one, inside or from a simplex of three vertices. */
static pir_hint recall(const pir_query *query, const pir_query_cache *cache) {
    pir_hint hint = {.has_facet = false};
    recall_simplex(query, cache, &hint);
    if (cache && cache->pieces == 1 && (cache->points == 0 || cache->points == 3))
        hint.has_facet = pir_piece_cached(&query->search.groups, cache, &hint.facet);
    hint.deep = hint.has_facet && cache->points == 0;
    return hint;
}

/* Keeps a hint in a cache: three vertices, 0 past the count. An answer from inside keeps none. */
static void keep(pir_query_cache *cache, const pir_hint *hint, bool inside) {
    if (!cache)
        return;
    if (hint->has_facet)
        pir_piece_keep(cache, hint->facet);
    cache->points = inside ? 0 : hint->points;
    for (uint32_t i = 0; i < 3; i++) {
        cache->p[i] = i < cache->points ? hint->a[i] : 0;
        cache->q[i] = i < cache->points ? hint->b[i] : 0;
    }
}

/* --- the pieces of the pairing as a source of facets --- */

/* A question to a query. */
struct query_task {
    pir_task task; /* first: what the ladder knows */
    pir_query *query;
    pir_query_cache *cache;
    pir_state state; /* where the descent left it open */
    pir_least least; /* on the boundary the first facet that touches */
};

static struct query_task *query_task_of(pir_task *task) {
    return (struct query_task *)task;
}

/* The exact state, with a piece that separates in the cache. */
static pir_state find_state(struct query_task *asked) {
    pir_piece separating;
    pir_state state = pir_state_find(&asked->query->search, asked->task.placement, asked->cache, &separating,
                                     &asked->least, &asked->task.result->steps);
    if (state == PIR_OUTSIDE)
        pir_piece_keep(asked->cache, separating);
    return state;
}

static bool is_outside(pir_task *task, double *ret_distance) {
    struct query_task *asked = query_task_of(task);
    const pir_simplex *simplex = &task->simplex;
    const pir_placement *placement = task->placement;
    bool far = simplex->lower > PIR_CLEARLY_APART * placement->reach && simplex->lower > 4 * placement->error;
    *ret_distance = simplex->lower;
    if (!task->is_outside &&
        !(far && pir_prove_outside(&asked->query->search.groups, placement, simplex, asked->cache))) {
        asked->state = find_state(asked);
        return asked->state == PIR_OUTSIDE;
    }
    return true;
}

/* Whether the facet of least slack is proven to be the depth; sets the state. */
static bool find_depth(struct query_task *asked) {
    const pir_task *task = &asked->task;
    const pir_placement *placement = task->placement;
    pir_least *least = &asked->least;
    pir_plane last;
    asked->state = PIR_OUTSIDE;
    if (pir_piece_recall(&asked->query->search.groups, asked->cache, &last) && pir_plane_separates(&last, placement))
        return false;
    least->found = pir_depth_find(&asked->query->search, placement, asked->cache, &least->facet, &task->result->steps);
    if (least->found) {
        double slack = least->facet.h - pir_vec_dot(least->facet.n, placement->x);
        double error = placement->error * least->facet.err;
        if (slack < -error)
            pir_piece_keep(asked->cache, least->facet.piece);
        asked->state = slack > error ? PIR_INSIDE : PIR_OUTSIDE;
        if (slack > error || slack < -error)
            return slack > error;
    }
    const pir_least deepest = *least;
    asked->state = find_state(asked);
    if (asked->state == PIR_INSIDE)
        *least = deepest;
    return asked->state != PIR_OUTSIDE;
}

/* The answer from the state, x not being outside, and from the least facet where the depth is wanted. */
static bool finish(struct query_task *asked) {
    pir_task *task = &asked->task;
    if (asked->state == PIR_BOUNDARY) {
        pir_task_touching(task, &asked->least);
    } else if (task->want & PIR_WANT_DEPTH) {
        pir_task_inside(task, &asked->least.facet, pir_facet_slack(task->exact, task->placement, &asked->least.facet));
        task->hint->deep = true;
    } else {
        pir_result_set_state(task->result, PIR_INSIDE);
    }
    return true;
}

/* Depth first where the last answer was deep, or where nothing else is wanted; else once the descent has failed. */
static bool find_from_pieces(pir_task *task, bool anew) {
    struct query_task *asked = query_task_of(task);
    if (!anew) {
        if (!(task->want & PIR_WANT_DEPTH) || (!task->was_deep && (task->want & PIR_WANT_SEPARATION)))
            return false;
        if (find_depth(asked))
            return finish(asked);
        task->is_outside = true;
        return !(task->want & PIR_WANT_SEPARATION);
    }
    if (asked->state == PIR_INSIDE && (task->want & PIR_WANT_DEPTH))
        pir_depth_find(&asked->query->search, task->placement, asked->cache, &asked->least.facet, &task->result->steps);
    return finish(asked);
}

static const pir_facet_source source = {is_outside, find_from_pieces, NULL};

/* --- answers --- */

static void begin(pir_query *query, const pir_placement *placement, int want, pir_query_cache *cache,
                  struct query_task *ret_asked) {
    pir_task *task = &ret_asked->task;
    ret_asked->query = query;
    ret_asked->cache = cache;
    ret_asked->least.found = false;
    task->source = &source;
    task->frame = &query->frame;
    task->placement = placement;
    task->exact = &query->exact;
    task->walker = query->room->walker;
    task->want = want;
    task->limit = 0;
    task->may_near = task->may_deep = true;
    pir_task_begin(task);
}

void pir_query_answer(pir_query *query, const pir_placement *placement, const pir_query_input *input, int want,
                      pir_query_cache *cache, pir_query_result *result) {
    const double radii = input->radius_p + input->radius_q;
    struct query_task asked;
    pir_hint hint = recall(query, cache);
    pir_result_clear(result);
    // rounded bodies overlap where the polytopes are apart
    begin(query, placement, want | (radii > 0 ? PIR_WANT_SEPARATION | PIR_WANT_DEPTH : 0), cache, &asked);
    asked.task.hint = &hint;
    asked.task.result = result;
    if (asked.task.want & PIR_WANT_SEPARATION)
        asked.task.limit = pir_frame_from(&query->frame, fmax(input->cutoff, 0) + radii);
    pir_task_answer(&asked.task);
    query->room->decided = asked.task.decided;
    keep(cache, &hint, result->state == PIR_INSIDE);
    pir_result_add_radii(input, result);
}

/* The state alone. Certain answers that cost little come before the ways. */
static void answer_state(pir_query *query, const pir_placement *placement, pir_query_cache *cache,
                         pir_query_result *result) {
    struct query_task asked;
    pir_hint hint = {.has_facet = false};
    pir_plane last;
    if (pir_piece_recall(&query->search.groups, cache, &last) && pir_plane_separates(&last, placement))
        return;
    bool inside = query->search.groups.count > 0;
    pir_bounds_find(&query->search.bounds, &query->search.groups, placement, 0);
    for (uint32_t g = 0; g < query->search.groups.count && inside; g++)
        inside = query->search.bounds.low[g] > 0;
    if (inside) {
        pir_result_set_state(result, PIR_INSIDE);
        return;
    }
    recall_simplex(query, cache, &hint);
    begin(query, placement, 0, cache, &asked);
    asked.task.hint = &hint;
    asked.task.result = result;
    pir_task_answer(&asked.task);
    // a simplex from outside is a good begin still when x comes back
    if (result->state == PIR_OUTSIDE)
        keep(cache, &hint, false);
    else if (hint.has_facet)
        pir_piece_keep(cache, hint.facet);
}

/* Answers from the facets in the sum's region. */
static void answer_in_region(pir_query *query, const pir_placement *placement, pir_query_cache *cache,
                             pir_query_result *result) {
    pir_least least;
    pir_result_set_state(
        result, pir_regional_find(&query->regional, &query->search.groups, placement, cache, &least, &result->steps));
    if (!least.found) {
        result->outcome = PIR_NO_HIT;
        return;
    }
    if (result->state == PIR_OUTSIDE) {
        pir_piece_keep(cache, least.facet.piece);
    } else {
        pir_result_depth_of(&query->exact, placement, &least.facet,
                            pir_facet_slack(&query->exact, placement, &least.facet), result);
        pir_piece_keep(cache, least.facet.piece);
        if (cache)
            cache->points = 0;
        result->outcome = PIR_NOT_SEPARATED;
    }
}

/* --- the calls --- */

static pir_status answer(pir_query *query, const pir_query_input *input, int want, pir_query_cache *cache,
                         pir_query_result *ret_result) {
    pir_placement placement;
    if (!ret_result)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_place(query, input, &placement);
    if (status != PIR_OK)
        return status;
    // separation and rounded bodies need the whole sum
    bool in_region = pir_sum_cone(query->sum)->set;
    if (in_region && (want != PIR_WANT_DEPTH || input->radius_p + input->radius_q > 0))
        return PIR_ERR_REGION;
    if (in_region && (status = pir_query_need_regional(query)) != PIR_OK)
        return status;
    // nothing fails from here on
    if (in_region) {
        pir_result_clear(ret_result);
        answer_in_region(query, &placement, cache, ret_result);
    } else {
        pir_query_answer(query, &placement, input, want, cache, ret_result);
    }
    return PIR_OK;
}

pir_status pir_query_overlap(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                             pir_query_result *ret_result) {
    pir_placement placement;
    if (!ret_result)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_begin(query, input, &placement);
    if (status != PIR_OK)
        return status;
    if (input->radius_p + input->radius_q > 0) {
        pir_query_input near = *input;
        near.cutoff = 0;
        status = answer(query, &near, PIR_WANT_SEPARATION, cache, ret_result);
        if (status == PIR_OK)
            pir_result_keep_state(ret_result);
        return status;
    }
    pir_result_clear(ret_result);
    answer_state(query, &placement, cache, ret_result);
    return PIR_OK;
}

pir_status pir_query_distance(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                              pir_query_result *ret_result) {
    pir_status status = answer(query, input, PIR_WANT_SEPARATION, cache, ret_result);
    if (status == PIR_OK && ret_result->outcome == PIR_OVERLAPPING)
        ret_result->distance = 0;
    return status;
}

pir_status pir_query_penetration(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                                 pir_query_result *ret_result) {
    pir_status status = answer(query, input, PIR_WANT_DEPTH, cache, ret_result);
    if (status == PIR_OK && ret_result->state == PIR_OUTSIDE)
        ret_result->distance = 0;
    return status;
}

pir_status pir_query_signed_distance(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                                     pir_query_result *ret_result) {
    return answer(query, input, PIR_WANT_SEPARATION | PIR_WANT_DEPTH, cache, ret_result);
}

pir_status pir_query_manifold(pir_query *query, const pir_query_input *input, const pir_query_result *answer,
                              size_t capacity, pir_contact *ret_contacts, size_t *ret_count) {
    pir_placement placement;
    if (!answer || (!ret_contacts && capacity > 0) || !ret_count)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_begin(query, input, &placement);
    if (status != PIR_OK)
        return status;
    pir_manifold_ask ask = {input, answer, capacity};
    pir_patch_room *room = &query->room->patches;
    if (!pir_patch_room_reserve(room, &pir_sum_scratch(query->sum)->allocator, query->p->vertex_count,
                                query->q->vertex_count))
        return PIR_ERR_MEMORY;
    return pir_manifold_find(&query->frame, &placement, room, &ask, ret_contacts, ret_count);
}
