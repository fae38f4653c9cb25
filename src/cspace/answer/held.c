/* SPDX-License-Identifier: MIT */
/*
 * The table of slices that are held: chains of slots by hash, and all slots in one list by the last time they were
 * asked, `newest` to `oldest`.
 */
#include "cspace/answer/held.h"

#include "base/layout.h"
#include "base/report.h"

#define NONE UINT32_MAX

static pir_layout layout_of(pir_held *held) {
    return (pir_layout){{PIR_ROW(held->slice, held->room), PIR_ROW(held->table, held->room)}};
}

bool pir_held_init(pir_held *held, uint32_t room, const pir_allocator *allocator) {
    *held = (pir_held){.room = room, .newest = NONE, .oldest = NONE};
    pir_layout layout = layout_of(held);
    if (!pir_layout_new(allocator, &layout)) {
        pir_layout_free(allocator, &layout);
        *held = (pir_held){0};
        return false;
    }
    for (uint32_t i = 0; i < room; i++)
        held->table[i] = NONE;
    return true;
}

void pir_held_finish(pir_held *held, const pir_allocator *allocator) {
    for (uint32_t i = 0; i < held->used; i++)
        pir_query_destroy(held->slice[i].query);
    pir_layout layout = layout_of(held);
    pir_layout_free(allocator, &layout);
}

static uint32_t hash_of(const pir_held *held, pir_cspace_place place) {
    uint64_t hash = place.slice * 0x9e3779b97f4a7c15u ^ ((uint64_t)place.robot << 32 | place.obstacle);
    hash = (hash ^ hash >> 29) * 0xbf58476d1ce4e5b9u;
    return (uint32_t)((hash >> 32) % held->room);
}

static bool same_place(pir_cspace_place a, pir_cspace_place b) {
    return a.robot == b.robot && a.obstacle == b.obstacle && a.slice == b.slice;
}

static void leave_list(pir_held *held, uint32_t at) {
    pir_held_slice *slice = &held->slice[at];
    *(slice->newer == NONE ? &held->newest : &held->slice[slice->newer].older) = slice->older;
    *(slice->older == NONE ? &held->oldest : &held->slice[slice->older].newer) = slice->newer;
}

static void become_newest(pir_held *held, uint32_t at) {
    held->slice[at].newer = NONE;
    held->slice[at].older = held->newest;
    *(held->newest == NONE ? &held->oldest : &held->slice[held->newest].newer) = at;
    held->newest = at;
}

static void leave_chain(pir_held *held, uint32_t at) {
    uint32_t *link = &held->table[hash_of(held, held->slice[at].place)];
    while (*link != at)
        link = &held->slice[*link].next;
    *link = held->slice[at].next;
}

/* A slot for a new slice, in no chain and no list. */
static uint32_t free_slot(pir_held *held) {
    if (held->used < held->room)
        return held->used++;
    uint32_t at = held->oldest;
    leave_list(held, at);
    leave_chain(held, at);
    pir_query_destroy(held->slice[at].query);
    return at;
}

/* How far `inner_at` is inside of the difference. */
static pir_status find_inner(pir_held_slice *slice) {
    pir_query_input input = pir_query_input_default();
    input.translation = slice->inner_at;
    pir_query_result result;
    pir_status status = pir_query_penetration(slice->query, &input, NULL, &result);
    if (status == PIR_OK)
        slice->inner = result.state == PIR_INSIDE ? -result.distance : 0;
    return status;
}

static pir_status make_slice(const pir_slice_source *source, pir_cspace_place place, pir_vec3 inner_at,
                             pir_report *report, pir_held_slice *slice) {
    *slice = (pir_held_slice){.place = place, .inner_at = inner_at};
    pir_sum *sum = NULL;
    pir_status status = source->sum(source->context, place, report, &sum);
    if (status != PIR_OK)
        return status;
    status = pir_query_create(sum, &slice->query);
    pir_sum_destroy(sum);
    if (status == PIR_OK)
        status = find_inner(slice);
    if (status == PIR_OK)
        return PIR_OK;
    pir_query_destroy(slice->query);
    return pir_fail(report, status, "slice %llu of robot piece %u and obstacle piece %u: %s",
                    (unsigned long long)place.slice, place.robot, place.obstacle, pir_status_text(status));
}

pir_status pir_held_get(pir_held *held, const pir_slice_source *source, pir_cspace_place place, pir_vec3 inner_at,
                        pir_report *report, pir_held_slice **ret_slice) {
    uint32_t *chain = &held->table[hash_of(held, place)];
    uint32_t at = *chain;
    while (at != NONE && !same_place(held->slice[at].place, place))
        at = held->slice[at].next;
    if (at == NONE) {
        pir_held_slice made;
        pir_status status = make_slice(source, place, inner_at, report, &made);
        if (status != PIR_OK)
            return status;
        at = free_slot(held);
        held->slice[at] = made;
        held->slice[at].next = *chain;
        *chain = at;
    } else {
        leave_list(held, at);
    }
    become_newest(held, at);
    *ret_slice = &held->slice[at];
    return PIR_OK;
}
