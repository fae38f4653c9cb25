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

void pir_groups_fill(pir_groups *groups) {
    for (uint32_t g = 0; g < groups->count; g++) {
        bool of_q = g >= groups->first_of_q;
        groups->at[g] = (pir_group){.of_q = of_q, .of = groups->lists[of_q]->at[g - (of_q ? groups->first_of_q : 0)]};
    }
}

/* --- planes --- */

/* Puts a plane that is infinitely far, with the normal of slot `like`: it pads blocks and changes no least slack. */
static void put_nothing(pir_planes *planes, uint32_t slot, pir_piece piece, uint32_t like) {
    pir_lane_put(planes->n, slot, pir_planes_normal(planes, like));
    planes->h[slot] = HUGE_VAL;
    planes->err[slot] = 0;
    planes->piece[slot] = piece;
}

/* Makes the planes of the group's facets in the slots from `slot` on. */
static void make_facets(pir_groups *groups, const pir_group *group, uint32_t slot) {
    pir_planes *planes = groups->planes;
    uint32_t count = group->of.facets_end - group->of.facets;
    const pir_group_lists *lists = pir_lists_of(groups, group);
    const uint32_t *list = lists->facet + group->of.facets;
    pir_lanes normals = pir_lanes_from(lists->facet_normal, group->of.facets), n = pir_lanes_from(planes->n, slot);
    for (uint32_t i = 0; i < count; i++) {
        planes->err[slot + i] = 1;
        if (group->of_q) {
            planes->piece[slot + i] = pir_piece_vf(groups, list[i]);
            pir_lane_put(groups->work->vector[0], i, groups->frame->p.vertex[planes->piece[slot + i].first]);
            pir_lane_put(n, i, groups->frame->q.polytope->normal[list[i]]);
        } else {
            planes->piece[slot + i] = pir_piece_fv(groups, list[i]);
            pir_lane_put(groups->work->vector[1], i, groups->frame->q.vertex[planes->piece[slot + i].second]);
        }
    }
    if (group->of_q)
        groups->scan->turn(count, &groups->frame->r, groups->work->vector[0], groups->work->vector[1]);
    else
        groups->scan->turn(count, &groups->frame->r, normals, n);
    groups->scan->offset(count, n, lists->facet_offset + group->of.facets, groups->work->vector[1], planes->h + slot);
}

/* Makes the planes of the group's edge pairs in the slots from `slot` on. Returns how many there are. */
static uint32_t make_crossings(pir_groups *groups, const pir_group *group, uint32_t slot) {
    pir_planes *planes = groups->planes;
    const pir_polytope *q = groups->frame->q.polytope;
    const pir_pairing *pairing = groups->pairing;
    const pir_lanes *work = groups->work->vector;
    pir_lanes e = groups->work->direction, o = groups->work->origin;
    const pir_group_lists *lists = groups->lists[0];
    uint32_t edges = group->of.edges_end - group->of.edges, count = 0;
    groups->scan->turn(edges, &groups->frame->r, pir_lanes_from(lists->edge_direction, group->of.edges), e);
    groups->scan->turn(edges, &groups->frame->r, pir_lanes_from(lists->edge_origin, group->of.edges), o);
    for (uint32_t i = 0; i < edges; i++) {
        uint32_t edge = lists->edge[group->of.edges + i];
        for (uint32_t at = pir_crossing_first(pairing, edge); at != PIR_NO_CROSSING;
             at = pir_crossing_next(pairing, at), count++) {
            uint32_t h = pir_crossing_half(pairing, at);
            pir_vec3 v = groups->frame->q.vertex[q->origin[h]];
            planes->piece[slot + count] = (pir_piece){PIR_FACET_EE, edge, h};
            pir_lane_put(work[0], count, q->direction[h]);
            pir_lane_put(work[1], count, (pir_vec3){e.x[i], e.y[i], e.z[i]});
            pir_lane_put(work[2], count, (pir_vec3){o.x[i] + v.x, o.y[i] + v.y, o.z[i] + v.z});
        }
    }
    double err = groups->scan->cross(count, work[0], work[1], work[2], pir_lanes_from(planes->n, slot),
                                     planes->h + slot, planes->err + slot);
    // edges that are nearly parallel, one by one
    for (uint32_t i = 0; err * PIR_SIN_EXACT > 1 && i < count; i++)
        if (planes->err[slot + i] * PIR_SIN_EXACT > 1) {
            pir_plane plane;
            if (pir_plane_of_edges(groups->exact, planes->piece[slot + i], &plane))
                pir_planes_put(planes, slot + i, &plane);
            else
                put_nothing(planes, slot + i, planes->piece[slot + i], slot - 1);
        }
    return count;
}

void pir_group_make(pir_groups *groups, uint32_t g) {
    pir_group *group = &groups->at[g];
    if (group->stamp == groups->stamp)
        return;
    pir_planes *planes = groups->planes;
    group->stamp = groups->stamp;
    group->start = planes->used;
    group->count = group->of.facets_end - group->of.facets;
    make_facets(groups, group, group->start);
    if (!group->of_q)
        group->count += make_crossings(groups, group, group->start + group->count);
    planes->used = group->start + group->count;
    while (planes->used % PIR_SCAN_BLOCK != 0)
        put_nothing(planes, planes->used++, (pir_piece){PIR_FACET_FV, 0, 0}, group->start);
    PIR_ASSERT(planes->used <= planes->capacity);
}

/* --- the cached piece --- */

void pir_piece_keep(pir_query_cache *cache, pir_piece piece) {
    if (!cache || piece.kind == PIR_NO_PIECE)
        return;
    cache->pieces = 1;
    cache->kind = piece.kind;
    cache->first = piece.first;
    cache->second = piece.second;
}

bool pir_piece_cached(const pir_groups *groups, const pir_query_cache *cache, pir_piece *ret_piece) {
    const pir_polytope *p = groups->frame->p.polytope, *q = groups->frame->q.polytope;
    if (!cache || cache->pieces != 1)
        return false;
    pir_piece piece = {cache->kind, cache->first, cache->second};
    switch (piece.kind) {
    case PIR_FACET_FV:
        if (piece.first >= p->facet_count)
            return false;
        piece = pir_piece_fv(groups, piece.first);
        break;
    case PIR_FACET_VF:
        if (piece.second >= q->facet_count)
            return false;
        piece = pir_piece_vf(groups, piece.second);
        break;
    case PIR_FACET_EE:
        if (piece.first >= p->edge_count || piece.second >= q->half_count)
            return false;
        // where the crossing is gone, a facet of its edge is near
        if (pir_crossing_find(groups->pairing, piece.first, piece.second) == PIR_NO_CROSSING)
            piece = pir_piece_fv(groups, p->left[p->edge_half[piece.first]]);
        break;
    default:
        return false;
    }
    *ret_piece = piece;
    return true;
}

bool pir_piece_recall(const pir_groups *groups, const pir_query_cache *cache, pir_plane *ret_plane) {
    pir_piece piece;
    return pir_piece_cached(groups, cache, &piece) && pir_plane_of(groups->exact, piece, ret_plane);
}
