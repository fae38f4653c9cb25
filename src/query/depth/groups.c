/* SPDX-License-Identifier: MIT */
/* Groups of pieces: see groups.h. */
#include "query/depth/groups.h"

/* --- work space and planes --- */

static pir_layout work_layout_of(pir_group_work *work) {
    return (pir_layout){{PIR_ROWS_LANES(work->direction, work->edges), PIR_ROWS_LANES(work->origin, work->edges),
                         PIR_ROWS_LANES(work->vector[0], work->capacity),
                         PIR_ROWS_LANES(work->vector[1], work->capacity),
                         PIR_ROWS_LANES(work->vector[2], work->capacity)}};
}

void pir_group_work_finish(pir_group_work *work, const pir_allocator *allocator) {
    pir_layout layout = work_layout_of(work);
    pir_layout_free(allocator, &layout);
}

static bool work_resize(pir_group_work *work, const pir_allocator *allocator, uint32_t edges, uint32_t capacity) {
    pir_group_work fresh = {.edges = edges, .capacity = capacity};
    pir_layout layout = work_layout_of(&fresh);
    if (!pir_layout_new(allocator, &layout))
        return false;
    pir_group_work_finish(work, allocator);
    *work = fresh;
    return true;
}

/* The facets that all groups list. */
static uint32_t list_length(const pir_groups *groups) {
    return groups->lists[0]->facet_count + groups->lists[1]->facet_count;
}

static uint32_t greater(uint32_t a, uint32_t b) {
    return a > b ? a : b;
}

pir_status pir_groups_reserve(pir_groups *groups, const pir_allocator *allocator, bool *ret_grown) {
    uint32_t usual = pir_crossings_expected(groups->frame->p.polytope, groups->frame->q.polytope),
             crossings = groups->pairing->crossings.count, length = list_length(groups);
    crossings = crossings > usual ? crossings + crossings / 4 : usual;
    // a slot for every entry of the facet list, the crossings, and what pads the groups
    uint32_t slots = length + crossings + PIR_SCAN_BLOCK * groups->count;
    // a group has all crossings at most, or lists all facets
    uint32_t capacity = greater(crossings, length), edges = groups->lists[0]->edge_count;
    pir_group_work *work = groups->work;
    *ret_grown = false;
    if (slots > groups->planes->capacity) {
        if (!pir_planes_resize(groups->planes, allocator, slots))
            return PIR_ERR_MEMORY;
        *ret_grown = true;
    }
    if ((capacity > work->capacity || edges > work->edges) &&
        !work_resize(work, allocator, greater(edges, work->edges), greater(capacity, work->capacity)))
        return PIR_ERR_MEMORY;
    groups->room_for = crossings + 1;
    return PIR_OK;
}

/* --- the groups --- */

pir_status pir_groups_find_lists(const pir_frame *frame, pir_polytope *const operand[2],
                                 const pir_group_lists *const like[2], const pir_group_lists *ret_lists[2]) {
    const pir_body *const body[2] = {&frame->p, &frame->q};
    for (int i = 0; i < 2; i++) {
        pir_status status = pir_group_lists_of(operand[i], body[i], frame->exponent, i == 1, like[i], &ret_lists[i]);
        if (status != PIR_OK)
            return status;
    }
    return PIR_OK;
}

void pir_groups_set_lists(pir_groups *groups, const pir_group_lists *const lists[2]) {
    PIR_ASSERT(!groups->lists[0] || groups->count == lists[0]->count + lists[1]->count);
    for (int i = 0; i < 2; i++)
        groups->lists[i] = lists[i];
    groups->first_of_q = lists[0]->count;
    groups->count = lists[0]->count + lists[1]->count;
}

void pir_groups_add_rows(pir_groups *groups, pir_layout *layout) {
    pir_layout_add(layout, (pir_layout_row)PIR_ROW(groups->at, groups->count));
}

void pir_groups_fill(pir_groups *groups) {
    for (uint32_t g = 0; g < groups->count; g++) {
        bool of_q = g >= groups->first_of_q;
        const pir_group_range range = groups->lists[of_q]->at[g - (of_q ? groups->first_of_q : 0)];
        groups->at[g] = (pir_group){.of_q = of_q,
                                    .middle = range.middle,
                                    .facets = range.facets,
                                    .own_end = range.own_end,
                                    .facets_end = range.facets_end,
                                    .edges = range.edges,
                                    .edges_end = range.edges_end};
    }
}
