/* SPDX-License-Identifier: MIT */
/*
 * A query and its sum: making a query, releasing it, and following the sum's changes.
 *
 * A query holds references to the sum and to both operands. So what it was made from stays in memory as long as the
 * query does, in whatever order callers destroy things. Each call compares the sum's generation (dymsum/view.h) with
 * the one that the query was last brought to. Where they differ, these may have changed:
 *
 * - Operands. A sum's operand is only ever replaced by the same polytope on another scale. Its features keep their
 *   numbers, and their normals to the bit, so all sizes stay. What depends on coordinates is kept by the new polytope
 *   (frame/body.h, depth/group_lists.h), with the same groups. Bounds begin as in a new query.
 * - Rotation. The planes of the last rotation are forgotten. At one rotation the pairing of given operands is unique,
 *   so nothing is forgotten where the rotation stays. A search in a region makes its planes anew each time
 *   (regional.c).
 * - The number of crossings. There is memory for their planes before anything is asked.
 *
 * A call that fails on the way leaves the query's generation at 0, so that the next call tries again.
 */
#include "query/answer/follow.h"

#include "base/processor.h"

/* --- the queries' room in a scratch --- */

static void destroy_room(void *at, const pir_allocator *allocator) {
    pir_query_room *room = at;
    pir_planes_finish(&room->planes, allocator);
    pir_group_work_finish(&room->work, allocator);
    PIR_FREE(allocator, room->limbs.base, room->limbs.capacity);
    pir_patch_room_finish(&room->patches, allocator);
    PIR_FREE(allocator, room, 1);
}

pir_query_room *pir_query_room_of(pir_scratch *scratch) {
    return pir_scratch_room(scratch, PIR_ROOM_QUERY, sizeof(pir_query_room), destroy_room);
}

pir_status pir_query_room_reserve_limbs(pir_query_room *room, const pir_scratch *scratch, const pir_polytope *p,
                                        const pir_polytope *q) {
    uint32_t need = pir_exact_limbs(p, q);
    if (need <= room->limbs.capacity)
        return PIR_OK;
    mp_limb_t *limbs = PIR_NEW(&scratch->allocator, mp_limb_t, need);
    if (!limbs)
        return PIR_ERR_MEMORY;
    PIR_FREE(&scratch->allocator, room->limbs.base, room->limbs.capacity);
    room->limbs = (pir_limbs){limbs, 0, need};
    room->owner = NULL;
    return PIR_OK;
}

/* --- the life of a query --- */

static pir_layout layout_of(pir_query *query) {
    pir_layout layout = {{{0}}};
    pir_search_add_rows(&query->search, &layout);
    return layout;
}

void pir_query_destroy(pir_query *query) {
    if (!query)
        return;
    const pir_allocator allocator = query->allocator, *a = &allocator;
    if (query->regional.known_p)
        pir_regional_finish(&query->regional, a, &query->frame);
    if (query->leaves)
        pir_leaves_finish(query->leaves, a);
    PIR_FREE(a, query->leaves, 1);
    pir_layout layout = layout_of(query);
    pir_layout_free(a, &layout);
    if (query->room && query->room->owner == query)
        query->room->owner = NULL;
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

/* Finds what the operands that the sum has now keep. When it fails the query is as it was. */
static pir_status fit(pir_query *query) {
    pir_groups *groups = &query->search.groups;
    pir_polytope *const operand[2] = {pir_sum_pairing(query->sum)->p, pir_sum_pairing(query->sum)->q};
    const pir_group_lists *lists[2];
    pir_frame frame;
    pir_status status = pir_query_room_reserve_limbs(query->room, pir_sum_scratch(query->sum), operand[0], operand[1]);
    if (status == PIR_OK)
        status = pir_frame_set_bodies(&frame, operand[0], operand[1]);
    if (status == PIR_OK)
        status = pir_groups_find_lists(&frame, operand, groups->lists, lists);
    if (status != PIR_OK)
        return status;
    query->frame = frame;
    pir_groups_set_lists(groups, lists);
    hold(&query->p, operand[0]);
    hold(&query->q, operand[1]);
    return PIR_OK;
}

/* Begins anew with the bodies and groups that have been found. */
static void fill(pir_query *query) {
    pir_search_fill(&query->search);
    if (query->regional.known_p)
        pir_regional_forget(&query->regional, &query->frame);
    if (query->room->owner == query)
        query->room->owner = NULL;
}

/* Makes what is the query's own. When it fails pir_query_destroy frees what is there. */
static pir_status make(pir_query *query) {
    query->room = pir_query_room_of(pir_sum_scratch(query->sum));
    if (!query->room)
        return PIR_ERR_MEMORY;
    query->exact.frame = &query->frame;
    query->exact.rotation = pir_sum_exact_rotation(query->sum);
    query->room->walker = pir_processor_best()->walker;
    pir_search_init(&query->search, &query->exact, pir_sum_pairing(query->sum));
    query->search.groups.planes = &query->room->planes;
    query->search.groups.work = &query->room->work;
    query->regional.sum = query->sum;
    pir_status status = fit(query);
    if (status != PIR_OK)
        return status;
    pir_layout layout = layout_of(query);
    if (!pir_layout_new(&query->allocator, &layout))
        return PIR_ERR_MEMORY;
    fill(query);
    return PIR_OK;
}

pir_status pir_query_create(pir_sum *difference, pir_query **ret_query) {
    if (!difference || !ret_query || !pir_sum_pairing(difference)->difference)
        return PIR_ERR_ARGUMENT;
    const pir_allocator *a = &pir_sum_pairing(difference)->allocator;
    pir_query *query = PIR_ZEROED(a, pir_query, 1);
    if (!query)
        return PIR_ERR_MEMORY;
    query->allocator = *a;
    query->sum = pir_sum_retain(difference);
    pir_status status = make(query);
    if (status != PIR_OK) {
        pir_query_destroy(query);
        return status;
    }
    *ret_query = query;
    return PIR_OK;
}

/* Makes room for what the present pairing needs. */
static pir_status reserve(pir_query *query) {
    bool grown;
    pir_status status = pir_groups_reserve(&query->search.groups, &pir_sum_scratch(query->sum)->allocator, &grown);
    if (grown)
        query->room->owner = NULL;
    return status;
}

/* Brings the query to the present state of the sum. */
static pir_status follow(pir_query *query) {
    pir_sum *sum = query->sum;
    const pir_pairing *pairing = pir_sum_pairing(sum);
    if (query->generation == pir_sum_generation(sum))
        return PIR_OK;
    pir_status status = PIR_OK;
    // no other polytope can have these addresses while the query holds its references
    if (query->p != pairing->p || query->q != pairing->q) {
        status = fit(query);
        if (status == PIR_OK)
            fill(query);
    }
    if (status == PIR_OK) {
        if (pir_frame_turn(&query->frame, pir_sum_exact_rotation(sum))) {
            query->exact.made = false;
            pir_groups_forget(&query->search.groups);
        }
        if (pairing->crossings.count >= query->search.groups.room_for)
            status = reserve(query);
    }
    query->generation = status == PIR_OK ? pir_sum_generation(sum) : 0;
    return status;
}

pir_status pir_query_need_regional(pir_query *query) {
    if (query->regional.known_p || pir_regional_init(&query->regional, &query->allocator, &query->frame))
        return PIR_OK;
    return PIR_ERR_MEMORY;
}

/* Takes over the room, unless the last call on it was on this query. */
static inline void take_room(pir_query *query) {
    pir_query_room *room = query->room;
    if (room->owner == query)
        return;
    room->owner = query;
    query->exact.scratch = room->limbs;
    query->exact.made = false;
    pir_groups_forget(&query->search.groups);
}

pir_status pir_query_place(pir_query *query, const pir_query_input *input, pir_placement *ret_placement) {
    if (!query || !input)
        return PIR_ERR_ARGUMENT;
    double p = input->radius_p, q = input->radius_q;
    if (!(p >= 0 && p < HUGE_VAL && q >= 0 && q < HUGE_VAL) || isnan(input->cutoff))
        return isnan(p) || isnan(q) || isnan(input->cutoff) ? PIR_ERR_NOT_FINITE : PIR_ERR_ARGUMENT;
    pir_status status = follow(query);
    take_room(query);
    if (query->exact.world) {
        query->exact.world = NULL;
        query->exact.made = false;
    }
    return status == PIR_OK ? pir_frame_place(&query->frame, input->translation, ret_placement) : status;
}

pir_status pir_query_place_relative(pir_query *query, const pir_world *world, pir_placement *ret_placement) {
    pir_status status = follow(query);
    take_room(query);
    query->exact.world = pir_world_is_plain(world) ? NULL : world;
    query->exact.made = false;
    return status == PIR_OK ? pir_frame_place_relative(&query->frame, world, ret_placement) : status;
}

pir_status pir_query_begin(pir_query *query, const pir_query_input *input, pir_placement *ret_placement) {
    if (query && pir_sum_cone(query->sum)->set)
        return PIR_ERR_REGION;
    return pir_query_place(query, input, ret_placement);
}
