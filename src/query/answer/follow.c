/* SPDX-License-Identifier: MIT */
/*
 * A query and its sum: making a query, releasing it, and following the sum's changes.
 *
 * A query holds references to the sum and to both operands. So what it was made from stays in memory as long as the
 * query does, in whatever order callers destroy things. Each call compares the sum's generation (dymsum/view.h) with
 * the one that the query was last brought to. Where they differ, these may have changed:
 *
 * - Operands. A sum's operand is only ever replaced by the same polytope on another scale. Its features keep their
 *   numbers, and their normals to the bit, so all sizes and the groups stay. What depends on coordinates is filled in
 *   again, in the same memory; only the scratch of exact signs may have to grow, with the digits of the scale. Bounds
 *   begin as in a new query.
 * - Rotation. The planes of the last rotation are forgotten. At one rotation the pairing of given operands is unique,
 *   so nothing is forgotten where the rotation stays. A search in a region makes its planes anew each time
 *   (regional.c).
 * - The number of crossings. There is memory for their planes before anything is asked.
 *
 * A call that fails on the way leaves the query's generation at 0, so that the next call tries again.
 */
#include "query/answer/follow.h"

void pir_query_destroy(pir_query *query) {
    if (!query)
        return;
    const pir_allocator allocator = query->allocator, *a = &allocator;
    pir_patch_room_finish(&query->patches, a, query->p->vertex_count, query->q->vertex_count);
    pir_regional_finish(&query->regional, a, &query->frame);
    pir_leaves_finish(&query->leaves, a);
    pir_search_finish(&query->search, a);
    pir_exact_finish(&query->exact, a);
    pir_frame_finish(&query->frame, a);
    pir_polytope_release(query->p);
    pir_polytope_release(query->q);
    pir_sum_destroy(query->sum);
    PIR_FREE(a, query, 1);
}

/* Replaces the reference in *held by one to `polytope`. */
static void hold(pir_polytope **held, pir_polytope *polytope) {
    pir_polytope *before = *held;
    *held = pir_polytope_retain(polytope);
    pir_polytope_release(before);
}

/* Fills in what depends on the coordinates of the operands that the sum has now. */
static pir_status fit(pir_query *query) {
    query->fits = false;
    hold(&query->p, pir_sum_pairing(query->sum)->p);
    hold(&query->q, pir_sum_pairing(query->sum)->q);
    if (!pir_exact_reserve(&query->exact, &query->allocator, query->p, query->q))
        return PIR_ERR_MEMORY;
    // the scratch of exact signs is larger than a vertex and a limb
    pir_status status = pir_frame_fill(&query->frame, query->p, query->q, query->exact.scratch.base);
    if (status != PIR_OK)
        return status;
    pir_search_fill(&query->search);
    pir_regional_forget(&query->regional, &query->frame);
    query->patches.p.shape.facet = query->patches.q.shape.facet = 0;
    query->fits = true;
    return PIR_OK;
}

/*
 * Makes all memory whose size the operands tell. False when out of memory; pir_query_destroy then frees what is
 * there.
 */
static bool reserve(pir_query *query) {
    const pir_allocator *a = &query->allocator;
    bool done = pir_frame_init(&query->frame, a, query->p, query->q);
    query->exact.frame = &query->frame;
    query->exact.rotation = pir_sum_exact_rotation(query->sum);
    done = pir_search_init(&query->search, a, &query->exact, pir_sum_pairing(query->sum)) && done;
    done = pir_regional_init(&query->regional, a, &query->frame, query->sum) && done;
    return pir_patch_room_init(&query->patches, a, query->p->vertex_count, query->q->vertex_count) && done;
}

pir_status pir_query_create(pir_sum *difference, pir_query **ret_query) {
    if (!difference || !ret_query || !pir_sum_pairing(difference)->difference)
        return PIR_ERR_ARGUMENT;
    const pir_pairing *pairing = pir_sum_pairing(difference);
    const pir_allocator *a = &pairing->allocator;
    pir_query *query = PIR_ZEROED(a, pir_query, 1);
    if (!query)
        return PIR_ERR_MEMORY;
    query->allocator = *a;
    query->sum = pir_sum_retain(difference);
    hold(&query->p, pairing->p);
    hold(&query->q, pairing->q);
    pir_status status = reserve(query) ? fit(query) : PIR_ERR_MEMORY;
    if (status != PIR_OK) {
        pir_query_destroy(query);
        return status;
    }
    *ret_query = query;
    return PIR_OK;
}

/* Brings the query to the present state of the sum. */
static pir_status follow(pir_query *query) {
    pir_sum *sum = query->sum;
    const pir_pairing *pairing = pir_sum_pairing(sum);
    if (query->generation == pir_sum_generation(sum))
        return PIR_OK;
    pir_status status = PIR_OK;
    // no other polytope can have these addresses while the query holds its references
    if (query->p != pairing->p || query->q != pairing->q || !query->fits)
        status = fit(query);
    if (status == PIR_OK) {
        if (pir_frame_turn(&query->frame, pir_sum_exact_rotation(sum))) {
            query->exact.made = false;
            pir_groups_forget(&query->search.groups);
        }
        status = pir_groups_reserve(&query->search.groups, &query->allocator);
    }
    query->generation = status == PIR_OK ? pir_sum_generation(sum) : 0;
    return status;
}

pir_status pir_query_place(pir_query *query, const pir_query_input *input, pir_placement *ret_placement) {
    if (!query || !input)
        return PIR_ERR_ARGUMENT;
    double p = input->radius_p, q = input->radius_q;
    if (!(p >= 0 && p < HUGE_VAL && q >= 0 && q < HUGE_VAL) || isnan(input->cutoff))
        return isnan(p) || isnan(q) || isnan(input->cutoff) ? PIR_ERR_NOT_FINITE : PIR_ERR_ARGUMENT;
    pir_status status = follow(query);
    if (query->exact.world) {
        query->exact.world = NULL;
        query->exact.made = false;
    }
    return status == PIR_OK ? pir_frame_place(&query->frame, input->translation, ret_placement) : status;
}

pir_status pir_query_place_relative(pir_query *query, const pir_world *world, pir_placement *ret_placement) {
    pir_status status = follow(query);
    query->exact.world = pir_world_is_plain(world) ? NULL : world;
    query->exact.made = false;
    return status == PIR_OK ? pir_frame_place_relative(&query->frame, world, ret_placement) : status;
}

pir_status pir_query_begin(pir_query *query, const pir_query_input *input, pir_placement *ret_placement) {
    if (query && pir_sum_cone(query->sum)->set)
        return PIR_ERR_UNSUPPORTED;
    return pir_query_place(query, input, ret_placement);
}
