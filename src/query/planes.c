/* SPDX-License-Identifier: MIT */
/*
 * The facets of D as planes, in groups, and what a group's slacks can be without looking.
 *
 * Why bounds last. For a unit normal n, s(n) = h_D(n) − n·x is the slack of D's plane in that direction. As n turns by a small angle, the
 * support h_P(n) of a body changes by that angle times the part of its support vertex p across n, √(|p|² − h_P(n)²), which is at most its
 * swing √(size² − inner²), inner the least offset of its facets. Q's facets stand still: a turn by θ changes the support of R·P in a fixed
 * direction by at most θ·swing_p, a move of x by d changes n·x by at most d. P's facets turn with R: seen from P the same holds with Q's
 * support, and with x, turned back: n·x changes by at most θ·|x across n| + θ²/2·|x|, and over an arc n·x is least at an end while positive. Between the facets of P the crossings come and go, but all of them lie on
 * the arcs between facets, where s runs through pieces of a·cos(φ − φ₀): while positive these are concave, so on an arc shorter than half a turn
 * s is nowhere less than at the crossings and at the two facets. A group of P's hence holds, beside the facets and edges that are its own, the
 * facets at the far ends of its edges. P flat has arcs of half a turn: its groups are always looked at.
 *
 * Boxes. Where a group's planes are made, n·x − h is at most what the box around them allows: for many translations at one rotation.
 */
#include <stdlib.h>
#include <string.h>

#include "query/query.h"

/*
 * Boxes are for placements of at most this reach, which all that are not far outside have: sizes are below 2. What a box takes off an offset
 * for each unit of err is the error of a slack there.
 */
#define BOX_REACH 8.0
#define BOX_ERROR (BOX_REACH * PIR_SLACK_BOUND)

/* Facets of P in a group, each with about three more edge pairs, and of Q. */
#define GROUP_OF_P 8
#define GROUP_OF_Q 32

/* --- memory --- */

/* Arrays have room for whole lanes; what is past the end is zero until something is written there. */
static double *lane_new(const pir_allocator *a, size_t count) {
    return PIR_ZEROED(a, double, count + PIR_SCAN_LANES);
}

static void lane_free(const pir_allocator *a, double *lane, size_t count) {
    PIR_FREE(a, lane, count + PIR_SCAN_LANES);
}

static bool lanes_new(const pir_allocator *a, pir_lanes *lanes, size_t count) {
    lanes->x = lane_new(a, count);
    lanes->y = lane_new(a, count);
    lanes->z = lane_new(a, count);
    return lanes->x && lanes->y && lanes->z;
}

static void lanes_free(const pir_allocator *a, pir_lanes *lanes, size_t count) {
    lane_free(a, lanes->x, count);
    lane_free(a, lanes->y, count);
    lane_free(a, lanes->z, count);
}

static void planes_free(const pir_allocator *a, pir_planes *planes) {
    lanes_free(a, &planes->n, planes->capacity);
    lane_free(a, planes->h, planes->capacity);
    lane_free(a, planes->err, planes->capacity);
    PIR_FREE(a, planes->piece, planes->capacity);
}

/* Room for `capacity` planes; those that are there are lost. The old ones stay where it fails. */
static bool planes_resize(pir_query *query, uint32_t capacity) {
    const pir_allocator *a = &query->allocator;
    pir_planes fresh = {.capacity = capacity};
    bool done = lanes_new(a, &fresh.n, capacity);
    fresh.h = lane_new(a, capacity);
    fresh.err = lane_new(a, capacity);
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
        done = lanes_new(a, &fresh[k], capacity) && done;
    for (int k = 0; k < 3; k++) {
        lanes_free(a, done ? &query->work[k] : &fresh[k], done ? query->work_capacity : capacity);
        if (done)
            query->work[k] = fresh[k];
    }
    if (done)
        query->work_capacity = capacity;
    return done;
}

pir_status pir_planes_reserve(pir_query *query) {
    // every list entry, every crossing, what pads the groups, and one spare for a piece by itself; a group has at most all crossings
    uint32_t crossings = query->sum->ee_count;
    uint32_t need = query->facet_list_count + crossings + PIR_SCAN_BLOCK * query->group_count + 1;
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
    return 2 * (size_t)query->p->half_count + query->p->facet_count + query->q->facet_count;
}

void pir_planes_finish(pir_query *query) {
    const pir_allocator *a = &query->allocator;
    uint32_t groups = query->group_count, edges = query->p->edge_count;
    planes_free(a, &query->planes);
    for (int k = 0; k < 3; k++)
        lanes_free(a, &query->work[k], query->work_capacity);
    lanes_free(a, &query->where, groups);
    lanes_free(a, &query->box_least, groups);
    lanes_free(a, &query->box_most, groups);
    lane_free(a, query->box_offset, groups);
    PIR_FREE(a, query->looked, groups);
    lanes_free(a, &query->facet_normal, list_capacity(query));
    lanes_free(a, &query->edge_direction, edges);
    lanes_free(a, &query->edge_origin, edges);
    lanes_free(a, &query->turned_direction, edges);
    lanes_free(a, &query->turned_origin, edges);
    lane_free(a, query->facet_offset, list_capacity(query));
    lane_free(a, query->bound, groups);
    lane_free(a, query->when, groups);
    lane_free(a, query->lever, groups);
    lane_free(a, query->bend, groups);
    lane_free(a, query->low, groups);
    PIR_FREE(a, query->groups, groups);
    PIR_FREE(a, query->slack, groups);
    PIR_FREE(a, query->facet_list, list_capacity(query));
    PIR_FREE(a, query->edge_list, edges);
}

static bool allocate(pir_query *query) {
    const pir_allocator *a = &query->allocator;
    uint32_t groups = query->group_count, edges = query->p->edge_count;
    query->groups = PIR_ZEROED(a, pir_group, groups);
    query->slack = PIR_NEW(a, double, groups);
    query->bound = lane_new(a, groups);
    query->when = lane_new(a, groups);
    query->lever = lane_new(a, groups);
    query->bend = lane_new(a, groups);
    query->low = lane_new(a, groups);
    query->facet_list = PIR_NEW(a, uint32_t, list_capacity(query));
    query->edge_list = PIR_NEW(a, uint32_t, edges);
    query->facet_offset = lane_new(a, list_capacity(query));
    query->box_offset = lane_new(a, groups);
    query->looked = PIR_NEW(a, uint32_t, groups);
    bool lanes = lanes_new(a, &query->where, groups);
    lanes = lanes_new(a, &query->box_least, groups) && lanes;
    lanes = lanes_new(a, &query->box_most, groups) && lanes;
    lanes = lanes_new(a, &query->facet_normal, list_capacity(query)) && lanes;
    lanes = lanes_new(a, &query->edge_direction, edges) && lanes;
    lanes = lanes_new(a, &query->edge_origin, edges) && lanes;
    lanes = lanes_new(a, &query->turned_direction, edges) && lanes;
    lanes = lanes_new(a, &query->turned_origin, edges) && lanes;
    return query->groups && query->slack && query->bound && query->when && query->lever && query->bend && query->low &&
           query->facet_list && query->edge_list && query->facet_offset && query->box_offset && query->looked && lanes;
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

/* A facet list's entry, once: `seen` says which group listed a facet last. */
static void list_facet(pir_query *query, uint32_t f, uint32_t group, uint32_t *seen) {
    if (seen[f] == group)
        return;
    seen[f] = group;
    query->facet_list[query->facet_list_count++] = f;
}

/* Group `g` of P: facets keys[from..to), the edges whose left facet is one of them, and the facets beyond those edges. */
static void make_group_of_p(pir_query *query, uint32_t g, const uint64_t *keys, uint32_t from, uint32_t to,
                            uint32_t *seen) {
    const pir_polytope *p = query->p;
    pir_group *group = &query->groups[g];
    group->facets = query->facet_list_count;
    group->edges = query->edge_list_count;
    for (uint32_t i = from; i < to; i++)
        list_facet(query, (uint32_t)keys[i], g, seen);
    group->own_end = query->facet_list_count;
    for (uint32_t i = from; i < to; i++) {
        uint32_t f = (uint32_t)keys[i];
        for (uint32_t k = p->loop_start[f]; k < p->loop_start[f + 1]; k++) {
            uint32_t half = p->loop[k];
            if (p->edge_half[p->edge[half]] != half)
                continue;
            query->edge_list[query->edge_list_count++] = p->edge[half];
            list_facet(query, pir_right(p, half), g, seen);
        }
    }
    group->facets_end = query->facet_list_count;
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
    uint32_t groups_of_q = query->group_count - query->groups_of_p;
    sort_facets(q, keys, groups_of_q);
    for (uint32_t i = 0; i < groups_of_q; i++, g++) {
        pir_group *group = &query->groups[g];
        group->of_q = true;
        group->edges = group->edges_end = query->edge_list_count;
        group->facets = query->facet_list_count;
        uint32_t to = group_start(q->facet_count, i + 1, groups_of_q);
        for (uint32_t k = group_start(q->facet_count, i, groups_of_q); k < to; k++)
            query->facet_list[query->facet_list_count++] = (uint32_t)keys[k];
        group->own_end = group->facets_end = query->facet_list_count;
    }
}

static void put_lane(pir_lanes lanes, uint32_t i, pir_vec3 v) {
    lanes.x[i] = v.x;
    lanes.y[i] = v.y;
    lanes.z[i] = v.z;
}

/* Copies what the lists name into their order. */
static void fill_lists(pir_query *query) {
    const pir_polytope *p = query->p;
    for (uint32_t g = 0; g < query->group_count; g++) {
        const pir_group *group = &query->groups[g];
        const pir_polytope *of = group->of_q ? query->q : p;
        const double *offsets = group->of_q ? query->hq : query->hp;
        for (uint32_t i = group->facets; i < group->facets_end; i++) {
            put_lane(query->facet_normal, i, of->normal[query->facet_list[i]]);
            query->facet_offset[i] = offsets[query->facet_list[i]];
        }
        query->bound[g] = -HUGE_VAL;
        put_lane(query->where, g, (pir_vec3){0, 0, 0});
    }
    for (uint32_t i = 0; i < query->edge_list_count; i++) {
        uint32_t half = p->edge_half[query->edge_list[i]];
        put_lane(query->edge_direction, i, p->direction[half]);
        put_lane(query->edge_origin, i, query->vp[p->origin[half]]);
    }
}

pir_status pir_planes_init(pir_query *query) {
    const pir_polytope *p = query->p, *q = query->q;
    const pir_allocator *a = &query->allocator;
    for (unsigned i = 0; pir_scan_version(i); i++)
        query->scan = pir_scan_version(i);
    query->groups_of_p = (p->facet_count + GROUP_OF_P - 1) / GROUP_OF_P;
    query->group_count = query->groups_of_p + (q->facet_count + GROUP_OF_Q - 1) / GROUP_OF_Q;
    uint32_t most = p->facet_count > q->facet_count ? p->facet_count : q->facet_count;
    uint64_t *keys = PIR_NEW(a, uint64_t, most);
    uint32_t *seen = PIR_NEW(a, uint32_t, most);
    bool done = allocate(query) && keys && seen;
    if (done) {
        make_groups(query, keys, seen);
        fill_lists(query);
        // room for what most rotations need
        uint32_t crossings = 3 * (p->edge_count + q->edge_count) + 64, facets = query->facet_list_count;
        done = planes_resize(query, facets + crossings + PIR_SCAN_BLOCK * query->group_count + 1) &&
               work_resize(query, facets > crossings ? facets : crossings);
    }
    PIR_FREE(a, keys, most);
    PIR_FREE(a, seen, most);
    return done ? PIR_OK : PIR_ERR_MEMORY;
}

/* --- planes --- */

static void put_plane(pir_planes *planes, uint32_t slot, pir_vec3 n, double h, double err, pir_piece piece) {
    put_lane(planes->n, slot, n);
    planes->h[slot] = h;
    planes->err[slot] = err;
    planes->piece[slot] = piece;
}

static void make_fv(pir_query *query, uint32_t f, uint32_t slot) {
    pir_vec3 n = pir_mat_apply(&query->r, query->p->normal[f]);
    double h = query->hp[f] + pir_vec_dot(n, query->vq[query->sum->fv[f]]);
    put_plane(&query->planes, slot, n, h, 1, (pir_piece){PIR_FACET_FV, f, 0});
}

static void make_vf(pir_query *query, uint32_t g, uint32_t slot) {
    pir_vec3 n = query->q->normal[g];
    double h = query->hq[g] + pir_vec_dot(n, pir_mat_apply(&query->r, query->vp[query->sum->vf[g]]));
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

static pir_lanes lanes_from(pir_lanes lanes, uint32_t i) {
    return (pir_lanes){lanes.x + i, lanes.y + i, lanes.z + i};
}

/* A plane that never matters: infinitely far, its normal that of slot `like`. */
static void put_nothing(pir_planes *planes, uint32_t slot, pir_piece piece, uint32_t like) {
    put_plane(planes, slot, pir_plane_normal(planes, like), HUGE_VAL, 0, piece);
}

/* The planes of the group's facets, from slot `slot`. */
static void make_facets(pir_query *query, const pir_group *group, uint32_t slot) {
    pir_planes *planes = &query->planes;
    uint32_t count = group->facets_end - group->facets;
    const uint32_t *list = query->facet_list + group->facets;
    pir_lanes normals = lanes_from(query->facet_normal, group->facets), n = lanes_from(planes->n, slot);
    for (uint32_t i = 0; i < count; i++) {
        planes->err[slot + i] = 1;
        if (group->of_q) {
            planes->piece[slot + i] = (pir_piece){PIR_FACET_VF, 0, list[i]};
            put_lane(query->work[0], i, query->vp[query->sum->vf[list[i]]]);
            put_lane(n, i, query->q->normal[list[i]]);
        } else {
            planes->piece[slot + i] = (pir_piece){PIR_FACET_FV, list[i], 0};
            put_lane(query->work[1], i, query->vq[query->sum->fv[list[i]]]);
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
    const pir_crossings *c = &query->sum->crossings;
    const pir_lanes *work = query->work;
    pir_lanes e = query->turned_direction, o = query->turned_origin;
    uint32_t edges = group->edges_end - group->edges, count = 0;
    query->scan->turn(edges, &query->r, lanes_from(query->edge_direction, group->edges), e);
    query->scan->turn(edges, &query->r, lanes_from(query->edge_origin, group->edges), o);
    for (uint32_t i = 0; i < edges; i++) {
        uint32_t edge = query->edge_list[group->edges + i];
        for (uint32_t at = query->sum->first[edge]; at != PIR_NO_CROSSING; at = c->next[at], count++) {
            uint32_t h = c->half[at];
            pir_vec3 v = query->vq[q->origin[h]];
            planes->piece[slot + count] = (pir_piece){PIR_FACET_EE, edge, h};
            put_lane(work[0], count, q->direction[h]);
            put_lane(work[1], count, (pir_vec3){e.x[i], e.y[i], e.z[i]});
            put_lane(work[2], count, (pir_vec3){o.x[i] + v.x, o.y[i] + v.y, o.z[i] + v.z});
        }
    }
    double err = query->scan->cross(count, work[0], work[1], work[2], lanes_from(planes->n, slot), planes->h + slot,
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

/* The box of group g's own planes: its neighbours stand in other boxes. */
static void make_box(const pir_query *query, uint32_t g) {
    const pir_planes *planes = &query->planes;
    const pir_group *group = &query->groups[g];
    pir_vec3 least = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, most = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    double offset = HUGE_VAL;
    uint32_t own = group->own_end - group->facets, all = group->facets_end - group->facets;
    for (uint32_t k = 0; k < group->count; k = k + 1 == own ? all : k + 1) {
        uint32_t i = group->start + k;
        double x = planes->n.x[i], y = planes->n.y[i], z = planes->n.z[i],
               h = planes->h[i] - BOX_ERROR * planes->err[i];
        least = (pir_vec3){fmin(least.x, x), fmin(least.y, y), fmin(least.z, z)};
        most = (pir_vec3){fmax(most.x, x), fmax(most.y, y), fmax(most.z, z)};
        offset = fmin(offset, h);
    }
    put_lane(query->box_least, g, least);
    put_lane(query->box_most, g, most);
    query->box_offset[g] = offset;
}

void pir_groups_make_all(pir_query *query) {
    if (query->boxed == query->stamp)
        return;
    for (uint32_t g = 0; g < query->group_count; g++) {
        pir_group_make(query, g);
        make_box(query, g);
    }
    query->boxed = query->stamp;
}

void pir_groups_bound(pir_query *query, const pir_placement *placement) {
    if (query->boxed == query->stamp && placement->reach <= BOX_REACH) {
        query->scan->boxes(query->group_count, query->box_least, query->box_most, query->box_offset, placement->x,
                           placement->error, query->low);
        return;
    }
    query->scan->bounds(query->group_count, query->bound, query->when, query->lever, query->bend, query->where,
                        query->turn, placement->x, placement->error, query->low);
    // a bound that is not above zero does not last: the arcs between are concave only while s is positive
    for (uint32_t g = 0; g < query->group_count; g++)
        if (!(query->bound[g] > 0) || (g < query->groups_of_p && query->p->dimension < 3))
            query->low[g] = -HUGE_VAL;
}

/* How far x reaches across the normals of a group that reach `along` it at least; all of |x| where some are at right angles or more. */
static double across(double length, double along) {
    return along > 0 && along < length ? sqrt((length - along) * (length + along)) : length;
}

void pir_group_look(pir_query *query, uint32_t g, const pir_placement *placement, double *ret_low, double *ret_high) {
    pir_group_make(query, g);
    const pir_group *group = &query->groups[g];
    const pir_planes *planes = &query->planes;
    uint32_t blocks = (group->count + PIR_SCAN_BLOCK - 1) / PIR_SCAN_BLOCK * PIR_SCAN_BLOCK;
    double least[3], length = placement->reach - query->size_p - query->size_q;
    query->scan->look(blocks, lanes_from(planes->n, group->start), planes->h + group->start, planes->err + group->start,
                      placement->x, placement->error, least);
    *ret_low = least[0];
    *ret_high = least[1];
    query->bound[g] = least[0];
    query->when[g] = query->turn;
    // what rounding may hide of x is below 2^-40 of the reach
    query->lever[g] = group->of_q ? query->swing_p
                                  : query->swing_q + across(length, least[2] - 0x1p-40 * placement->reach) +
                                        0x1p-40 * placement->reach;
    query->bend[g] = group->of_q ? 0 : 0.5 * length;
    put_lane(query->where, g, placement->x);
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

/* Whether edge e and halfedge h still cross. */
static bool crosses(const pir_sum *sum, uint32_t e, uint32_t h) {
    for (uint32_t at = sum->first[e]; at != PIR_NO_CROSSING; at = sum->crossings.next[at])
        if (sum->crossings.half[at] == h)
            return true;
    return false;
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
        if (!crosses(query->sum, piece.first, piece.second))
            piece = (pir_piece){PIR_FACET_FV, p->left[p->edge_half[piece.first]], 0};
        break;
    default:
        return false;
    }
    *ret_slot = query->planes.capacity - 1;
    return pir_plane_make(query, piece, *ret_slot);
}
