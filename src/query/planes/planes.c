/* SPDX-License-Identifier: MIT */
/*
 * The facets of D as planes, in groups of neighbours: some facets of P with the edges whose left facet is one of them and what crosses
 * those, or some facets of Q. What a group's slacks can be without looking is told in bounds.c.
 *
 * A group of P's holds, beside the facets and edges that are its own, the facets at the far ends of its edges: its bounds need them. Groups of
 * Q begin at a whole block of lanes, behind empty groups, so that a block of groups is of one body.
 */
#include <stdlib.h>
#include <string.h>

#include "query/query.h"

/* Facets of P in a group, each with about three more edge pairs, and of Q. */
#define GROUP_OF_P 8
#define GROUP_OF_Q 32

/* --- memory --- */

static void planes_free(const pir_allocator *a, pir_planes *planes) {
    pir_lanes_free(a, &planes->n, planes->capacity);
    pir_lane_free(a, planes->h, planes->capacity);
    pir_lane_free(a, planes->err, planes->capacity);
    PIR_FREE(a, planes->piece, planes->capacity);
}

/* Room for `capacity` planes; those that are there are lost. The old ones stay where it fails. */
static bool planes_resize(pir_query *query, uint32_t capacity) {
    const pir_allocator *a = &query->allocator;
    pir_planes fresh = {.capacity = capacity};
    bool done = pir_lanes_new(a, &fresh.n, capacity);
    fresh.h = pir_lane_new(a, capacity);
    fresh.err = pir_lane_new(a, capacity);
    fresh.piece = PIR_NEW(a, pir_piece, capacity);
    done = done && fresh.h && fresh.err && fresh.piece;
    planes_free(a, done ? &query->planes : &fresh);
    if (done)
        query->planes = fresh;
    return done;
}

static bool work_resize(pir_query *query, uint32_t capacity) {
    const pir_allocator *a = &query->allocator;
    pir_lanes fresh[3] = {{0}, {0}, {0}};
    bool done = true;
    for (int k = 0; k < 3; k++)
        done = pir_lanes_new(a, &fresh[k], capacity) && done;
    for (int k = 0; k < 3; k++) {
        pir_lanes_free(a, done ? &query->work[k] : &fresh[k], done ? query->work_capacity : capacity);
        if (done)
            query->work[k] = fresh[k];
    }
    if (done)
        query->work_capacity = capacity;
    return done;
}

pir_status pir_planes_reserve(pir_query *query) {
    // every list entry, every crossing, what pads the groups, and the spare slots; a group has at most all crossings
    uint32_t crossings = pir_sum_ee_count(query->sum);
    uint32_t need = query->facet_list_count + crossings + PIR_SCAN_BLOCK * query->group_count + PIR_SPARE_SLOTS;
    if (need > query->planes.capacity) {
        if (!planes_resize(query, need + need / 4))
            return PIR_ERR_MEMORY;
        query->stamp++;
        query->planes.used = 0;
    }
    uint32_t work = crossings > query->facet_list_count ? crossings : query->facet_list_count;
    return work <= query->work_capacity || work_resize(query, work + work / 4) ? PIR_OK : PIR_ERR_MEMORY;
}

static size_t list_capacity(const pir_query *query) {
    return 2 * (size_t)query->p->half_count + query->p->facet_count + query->q->facet_count +
           PIR_SCAN_LANES * (size_t)query->group_count;
}

void pir_planes_finish(pir_query *query) {
    const pir_allocator *a = &query->allocator;
    uint32_t groups = query->group_count, edges = query->p->edge_count;
    planes_free(a, &query->planes);
    for (int k = 0; k < 3; k++)
        pir_lanes_free(a, &query->work[k], query->work_capacity);
    PIR_FREE(a, query->looked, groups);
    pir_lanes_free(a, &query->facet_normal, list_capacity(query));
    pir_lanes_free(a, &query->edge_direction, edges);
    pir_lanes_free(a, &query->edge_origin, edges);
    pir_lanes_free(a, &query->turned_direction, edges);
    pir_lanes_free(a, &query->turned_origin, edges);
    pir_lane_free(a, query->facet_offset, list_capacity(query));
    PIR_FREE(a, query->groups, groups);
    PIR_FREE(a, query->slack, groups);
    PIR_FREE(a, query->facet_list, list_capacity(query));
    PIR_FREE(a, query->edge_list, edges);
    PIR_FREE(a, query->edge_left, edges);
    PIR_FREE(a, query->edge_right, edges);
}

static bool allocate(pir_query *query) {
    const pir_allocator *a = &query->allocator;
    uint32_t groups = query->group_count, edges = query->p->edge_count;
    query->groups = PIR_ZEROED(a, pir_group, groups);
    query->slack = PIR_NEW(a, double, groups);
    query->facet_list = PIR_NEW(a, uint32_t, list_capacity(query));
    query->edge_list = PIR_NEW(a, uint32_t, edges);
    query->edge_left = PIR_NEW(a, uint32_t, edges);
    query->edge_right = PIR_NEW(a, uint32_t, edges);
    query->facet_offset = pir_lane_new(a, list_capacity(query));
    query->looked = PIR_NEW(a, uint32_t, groups);
    bool lanes = pir_lanes_new(a, &query->facet_normal, list_capacity(query));
    lanes = pir_lanes_new(a, &query->edge_direction, edges) && lanes;
    lanes = pir_lanes_new(a, &query->edge_origin, edges) && lanes;
    lanes = pir_lanes_new(a, &query->turned_direction, edges) && lanes;
    lanes = pir_lanes_new(a, &query->turned_origin, edges) && lanes;
    return query->groups && query->slack && query->facet_list && query->edge_list && query->edge_left &&
           query->edge_right && query->facet_offset && query->looked && lanes;
}

/* --- grouping, once --- */

/* A facet's number under one coordinate of its normal, to sort by. */
static uint64_t coordinate_key(const pir_polytope *p, uint32_t f, int axis) {
    pir_vec3 n = p->normal[f];
    double c = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
    return (uint64_t)(uint32_t)(0x1p30 * (2 + fmin(1, fmax(-1, c)))) << 32 | f;
}

static int compare_keys(const void *a, const void *b) {
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Where group `g` of `groups` begins among `count` facets. */
static uint32_t group_start(uint32_t count, uint32_t g, uint32_t groups) {
    return (uint32_t)((uint64_t)count * g / groups);
}

/* Sorts the facets of groups [from, to) of `groups` so that each group's normals are near each other: halves across the longest side. */
static void sort_groups(const pir_polytope *p, uint64_t *keys, uint32_t from, uint32_t to, uint32_t groups) {
    uint32_t start = group_start(p->facet_count, from, groups), end = group_start(p->facet_count, to, groups);
    double longest = -1;
    int axis = 0;
    for (int k = 0; k < 3; k++) {
        double low = 1, high = -1;
        for (uint32_t i = start; i < end; i++) {
            pir_vec3 n = p->normal[(uint32_t)keys[i]];
            double c = k == 0 ? n.x : k == 1 ? n.y : n.z;
            low = fmin(low, c);
            high = fmax(high, c);
        }
        if (high - low > longest)
            longest = high - low, axis = k;
    }
    for (uint32_t i = start; i < end; i++)
        keys[i] = coordinate_key(p, (uint32_t)keys[i], axis);
    qsort(keys + start, end - start, sizeof *keys, compare_keys);
    uint32_t middle = from + (to - from) / 2;
    if (to - from > 1) {
        sort_groups(p, keys, from, middle, groups);
        sort_groups(p, keys, middle, to, groups);
    }
}

static void sort_facets(const pir_polytope *p, uint64_t *keys, uint32_t groups) {
    for (uint32_t f = 0; f < p->facet_count; f++)
        keys[f] = f;
    if (groups > 0)
        sort_groups(p, keys, 0, groups, groups);
}

/* A facet's place in the list of `group`, which is being made, listed there if it is not yet: seen[f] is where f was listed last. */
static uint32_t list_facet(pir_query *query, uint32_t f, const pir_group *group, uint32_t *seen) {
    if (seen[f] == UINT32_MAX || seen[f] < group->facets) {
        seen[f] = query->facet_list_count;
        query->facet_list[query->facet_list_count++] = f;
    }
    return seen[f] - group->facets;
}

static uint32_t whole_lanes(uint32_t count) {
    return (count + PIR_SCAN_LANES - 1) / PIR_SCAN_LANES * PIR_SCAN_LANES;
}

/* Ends the list of `group`, filled up to whole lanes with its first facet. */
static void end_facets(pir_query *query, pir_group *group) {
    while ((query->facet_list_count - group->facets) % PIR_SCAN_LANES != 0)
        query->facet_list[query->facet_list_count++] = query->facet_list[group->facets];
    group->facets_end = query->facet_list_count;
}

/* Group `g` of P: facets keys[from..to), the edges whose left facet is one of them, and the facets beyond those edges. */
static void make_group_of_p(pir_query *query, uint32_t g, const uint64_t *keys, uint32_t from, uint32_t to,
                            uint32_t *seen) {
    const pir_polytope *p = query->p;
    pir_group *group = &query->groups[g];
    group->facets = query->facet_list_count;
    group->edges = query->edge_list_count;
    for (uint32_t i = from; i < to; i++)
        list_facet(query, (uint32_t)keys[i], group, seen);
    group->own_end = query->facet_list_count;
    for (uint32_t i = from; i < to; i++) {
        uint32_t f = (uint32_t)keys[i];
        for (uint32_t k = p->loop_start[f]; k < p->loop_start[f + 1]; k++) {
            uint32_t half = p->loop[k];
            if (p->edge_half[p->edge[half]] != half)
                continue;
            query->edge_list[query->edge_list_count] = p->edge[half];
            query->edge_left[query->edge_list_count] = i - from;
            query->edge_right[query->edge_list_count++] = list_facet(query, pir_right(p, half), group, seen);
        }
    }
    end_facets(query, group);
    group->edges_end = query->edge_list_count;
}

static void make_groups(pir_query *query, uint64_t *keys, uint32_t *seen) {
    const pir_polytope *p = query->p, *q = query->q;
    uint32_t g = 0;
    sort_facets(p, keys, query->groups_of_p);
    memset(seen, 0xff, p->facet_count * sizeof *seen);
    for (uint32_t i = 0; i < query->groups_of_p; i++, g++)
        make_group_of_p(query, g, keys, group_start(p->facet_count, i, query->groups_of_p),
                        group_start(p->facet_count, i + 1, query->groups_of_p), seen);
    sort_facets(q, keys, query->groups_of_q);
    g = query->first_of_q;
    for (uint32_t i = 0; i < query->groups_of_q; i++, g++) {
        pir_group *group = &query->groups[g];
        group->of_q = true;
        group->edges = group->edges_end = query->edge_list_count;
        group->facets = query->facet_list_count;
        uint32_t to = group_start(q->facet_count, i + 1, query->groups_of_q);
        for (uint32_t k = group_start(q->facet_count, i, query->groups_of_q); k < to; k++)
            query->facet_list[query->facet_list_count++] = (uint32_t)keys[k];
        group->own_end = query->facet_list_count;
        end_facets(query, group);
    }
}

/* Copies what the lists name into their order. */
void pir_planes_fill(pir_query *query) {
    const pir_polytope *p = query->p;
    for (uint32_t g = 0; g < query->group_count; g++) {
        const pir_group *group = &query->groups[g];
        const pir_polytope *of = group->of_q ? query->q : p;
        const double *offsets = group->of_q ? query->hq : query->hp;
        for (uint32_t i = group->facets; i < group->facets_end; i++) {
            pir_lane_put(query->facet_normal, i, of->normal[query->facet_list[i]]);
            query->facet_offset[i] = offsets[query->facet_list[i]];
        }
    }
    for (uint32_t i = 0; i < query->edge_list_count; i++) {
        uint32_t half = p->edge_half[query->edge_list[i]];
        pir_lane_put(query->edge_direction, i, p->direction[half]);
        pir_lane_put(query->edge_origin, i, query->vp[p->origin[half]]);
    }
}

bool pir_planes_init(pir_query *query) {
    const pir_polytope *p = query->p, *q = query->q;
    const pir_allocator *a = &query->allocator;
    for (unsigned i = 0; pir_scan_version(i); i++)
        query->scan = pir_scan_version(i);
    query->groups_of_p = (p->facet_count + GROUP_OF_P - 1) / GROUP_OF_P;
    query->groups_of_q = (q->facet_count + GROUP_OF_Q - 1) / GROUP_OF_Q;
    query->first_of_q = whole_lanes(query->groups_of_p);
    query->group_count = query->first_of_q + whole_lanes(query->groups_of_q);
    uint32_t most = p->facet_count > q->facet_count ? p->facet_count : q->facet_count;
    uint64_t *keys = PIR_NEW(a, uint64_t, most);
    uint32_t *seen = PIR_NEW(a, uint32_t, most);
    bool done = allocate(query) && keys && seen;
    if (done) {
        make_groups(query, keys, seen);
        // room for what most rotations need
        uint32_t crossings = 3 * (p->edge_count + q->edge_count) + 64, facets = query->facet_list_count;
        done = planes_resize(query, facets + crossings + PIR_SCAN_BLOCK * query->group_count + PIR_SPARE_SLOTS) &&
               work_resize(query, facets > crossings ? facets : crossings);
    }
    PIR_FREE(a, keys, most);
    PIR_FREE(a, seen, most);
    return done;
}

/* --- planes --- */

static void put_plane(pir_planes *planes, uint32_t slot, pir_vec3 n, double h, double err, pir_piece piece) {
    pir_lane_put(planes->n, slot, n);
    planes->h[slot] = h;
    planes->err[slot] = err;
    planes->piece[slot] = piece;
}

static void make_fv(pir_query *query, uint32_t f, uint32_t slot) {
    pir_vec3 n = pir_mat_apply(&query->r, query->p->normal[f]);
    double h = query->hp[f] + pir_vec_dot(n, query->vq[pir_sum_pairing(query->sum)->fv[f]]);
    put_plane(&query->planes, slot, n, h, 1, (pir_piece){PIR_FACET_FV, f, 0});
}

static void make_vf(pir_query *query, uint32_t g, uint32_t slot) {
    pir_vec3 n = query->q->normal[g];
    double h = query->hq[g] + pir_vec_dot(n, pir_mat_apply(&query->r, query->vp[pir_sum_pairing(query->sum)->vf[g]]));
    put_plane(&query->planes, slot, n, h, 1, (pir_piece){PIR_FACET_VF, 0, g});
}

static bool make_ee(pir_query *query, pir_piece piece, uint32_t slot) {
    const pir_polytope *p = query->p, *q = query->q;
    uint32_t half = p->edge_half[piece.first], h = piece.second;
    pir_vec3 n = pir_vec_cross(q->direction[h], pir_mat_apply(&query->r, p->direction[half]));
    pir_vec3 y = pir_vec_add(pir_mat_apply(&query->r, query->vp[p->origin[half]]), query->vq[q->origin[h]]);
    double square = pir_vec_dot(n, n), err = 1;
    if (square < PIR_SIN_EXACT * PIR_SIN_EXACT) {
        if (!pir_side_normal(query, piece, &n))
            return false;
    } else {
        err = 1 / sqrt(square);
        n = pir_vec_scale(n, err);
    }
    put_plane(&query->planes, slot, n, pir_vec_dot(n, y), err, piece);
    return true;
}

bool pir_plane_make(pir_query *query, pir_piece piece, uint32_t slot) {
    if (piece.kind == PIR_FACET_EE)
        return make_ee(query, piece, slot);
    if (piece.kind == PIR_FACET_FV)
        make_fv(query, piece.first, slot);
    else
        make_vf(query, piece.second, slot);
    return true;
}

bool pir_plane_refine(pir_query *query, uint32_t slot) {
    pir_planes *planes = &query->planes;
    pir_piece piece = planes->piece[slot];
    if (planes->err[slot] * PIR_SIN_REFINED < 1)
        return true;
    pir_vec3 n;
    if (!pir_side_normal(query, piece, &n))
        return false;
    pir_vec3 y =
        pir_frame_vertex(query, query->p->origin[query->p->edge_half[piece.first]], query->q->origin[piece.second]);
    put_plane(planes, slot, n, pir_vec_dot(n, y), 1, piece);
    return true;
}

/* --- groups --- */

/* A plane that never matters: infinitely far, its normal that of slot `like`. */
static void put_nothing(pir_planes *planes, uint32_t slot, pir_piece piece, uint32_t like) {
    put_plane(planes, slot, pir_plane_normal(planes, like), HUGE_VAL, 0, piece);
}

/* The planes of the group's facets, from slot `slot`. */
static void make_facets(pir_query *query, const pir_group *group, uint32_t slot) {
    pir_planes *planes = &query->planes;
    uint32_t count = group->facets_end - group->facets;
    const uint32_t *list = query->facet_list + group->facets;
    pir_lanes normals = pir_lanes_from(query->facet_normal, group->facets), n = pir_lanes_from(planes->n, slot);
    for (uint32_t i = 0; i < count; i++) {
        planes->err[slot + i] = 1;
        if (group->of_q) {
            planes->piece[slot + i] = (pir_piece){PIR_FACET_VF, 0, list[i]};
            pir_lane_put(query->work[0], i, query->vp[pir_sum_pairing(query->sum)->vf[list[i]]]);
            pir_lane_put(n, i, query->q->normal[list[i]]);
        } else {
            planes->piece[slot + i] = (pir_piece){PIR_FACET_FV, list[i], 0};
            pir_lane_put(query->work[1], i, query->vq[pir_sum_pairing(query->sum)->fv[list[i]]]);
        }
    }
    if (group->of_q)
        query->scan->turn(count, &query->r, query->work[0], query->work[1]);
    else
        query->scan->turn(count, &query->r, normals, n);
    query->scan->offset(count, n, query->facet_offset + group->facets, query->work[1], planes->h + slot);
}

/* The planes of what crosses the group's edges, from slot `slot`; returns how many. */
static uint32_t make_crossings(pir_query *query, const pir_group *group, uint32_t slot) {
    pir_planes *planes = &query->planes;
    const pir_polytope *q = query->q;
    const pir_pairing *pairing = pir_sum_pairing(query->sum);
    const pir_lanes *work = query->work;
    pir_lanes e = query->turned_direction, o = query->turned_origin;
    uint32_t edges = group->edges_end - group->edges, count = 0;
    query->scan->turn(edges, &query->r, pir_lanes_from(query->edge_direction, group->edges), e);
    query->scan->turn(edges, &query->r, pir_lanes_from(query->edge_origin, group->edges), o);
    for (uint32_t i = 0; i < edges; i++) {
        uint32_t edge = query->edge_list[group->edges + i];
        for (uint32_t at = pir_crossing_first(pairing, edge); at != PIR_NO_CROSSING;
             at = pir_crossing_next(pairing, at), count++) {
            uint32_t h = pir_crossing_half(pairing, at);
            pir_vec3 v = query->vq[q->origin[h]];
            planes->piece[slot + count] = (pir_piece){PIR_FACET_EE, edge, h};
            pir_lane_put(work[0], count, q->direction[h]);
            pir_lane_put(work[1], count, (pir_vec3){e.x[i], e.y[i], e.z[i]});
            pir_lane_put(work[2], count, (pir_vec3){o.x[i] + v.x, o.y[i] + v.y, o.z[i] + v.z});
        }
    }
    double err = query->scan->cross(count, work[0], work[1], work[2], pir_lanes_from(planes->n, slot), planes->h + slot,
                                    planes->err + slot);
    // edges that are nearly parallel, one by one
    for (uint32_t i = 0; err * PIR_SIN_EXACT > 1 && i < count; i++)
        if (planes->err[slot + i] * PIR_SIN_EXACT > 1 && !make_ee(query, planes->piece[slot + i], slot + i))
            put_nothing(planes, slot + i, planes->piece[slot + i], slot - 1);
    return count;
}

void pir_group_make(pir_query *query, uint32_t g) {
    pir_group *group = &query->groups[g];
    if (group->stamp == query->stamp)
        return;
    pir_planes *planes = &query->planes;
    group->stamp = query->stamp;
    group->start = planes->used;
    group->count = group->facets_end - group->facets;
    make_facets(query, group, group->start);
    if (!group->of_q)
        group->count += make_crossings(query, group, group->start + group->count);
    planes->used = group->start + group->count;
    while (planes->used % PIR_SCAN_BLOCK != 0)
        put_nothing(planes, planes->used++, (pir_piece){PIR_FACET_FV, 0, 0}, group->start);
    PIR_ASSERT(planes->used < planes->capacity);
}

/* --- the cached piece --- */

void pir_piece_keep(pir_query_cache *cache, pir_piece piece) {
    if (!cache)
        return;
    cache->pieces = 1;
    cache->kind = piece.kind;
    cache->first = piece.first;
    cache->second = piece.second;
}

bool pir_piece_recall(pir_query *query, const pir_query_cache *cache, uint32_t *ret_slot) {
    const pir_polytope *p = query->p, *q = query->q;
    if (!cache || cache->pieces != 1)
        return false;
    pir_piece piece = {cache->kind, cache->first, cache->second};
    switch (piece.kind) {
    case PIR_FACET_FV:
        if (piece.first >= p->facet_count)
            return false;
        break;
    case PIR_FACET_VF:
        if (piece.second >= q->facet_count)
            return false;
        break;
    case PIR_FACET_EE:
        if (piece.first >= p->edge_count || piece.second >= q->half_count)
            return false;
        // a crossing that is gone leaves its edge's facet
        if (pir_crossing_find(pir_sum_pairing(query->sum), piece.first, piece.second) == PIR_NO_CROSSING)
            piece = (pir_piece){PIR_FACET_FV, p->left[p->edge_half[piece.first]], 0};
        break;
    default:
        return false;
    }
    *ret_slot = query->planes.capacity - 1;
    return pir_plane_make(query, piece, *ret_slot);
}
