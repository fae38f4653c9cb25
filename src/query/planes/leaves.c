/* SPDX-License-Identifier: MIT */
/*
 * All planes of D at one rotation, in leaves, for many translations.
 *
 * The planes are sorted by the cell of a grid on the cube that their normals fall in, cells along a Z-order curve, and every LEAF of
 * them, one after the other, have a box: of their normals, their least offset and their greatest err. n·x − h is at most what the box allows, so most leaves
 * are ruled out by four numbers. The first to be looked at is the one that holds the direction of x, which in a round D is the nearest.
 *
 * As long as no decision is open, all is told by the values of planes and their errors (query.h); what is open is left to the caller.
 */
#include <string.h>

#include "query/decide/facet.h"

#define LEAF 32

/* Cells along a side of the cube are 2^CELL_BITS. */
#define CELL_BITS  4
#define CELL_COUNT (6u << 2 * CELL_BITS)

static uint32_t leaves_for(uint32_t capacity) {
    // whole lanes
    uint32_t leaves = (capacity + LEAF - 1) / LEAF;
    return (leaves + PIR_SCAN_LANES - 1) / PIR_SCAN_LANES * PIR_SCAN_LANES;
}

void pir_leaves_finish(pir_query *query) {
    const pir_allocator *a = &query->allocator;
    pir_leaves *leaves = &query->leaves;
    uint32_t capacity = leaves->capacity, count = leaves_for(capacity);
    pir_lanes_free(a, &leaves->n, capacity);
    pir_lane_free(a, leaves->h, capacity);
    pir_lane_free(a, leaves->err, capacity);
    PIR_FREE(a, leaves->slot, capacity);
    PIR_FREE(a, leaves->cell, capacity);
    PIR_FREE(a, leaves->cell_start, CELL_COUNT + 1);
    pir_lanes_free(a, &leaves->box_least, count);
    pir_lanes_free(a, &leaves->box_most, count);
    pir_lane_free(a, leaves->box_h, count);
    pir_lane_free(a, leaves->box_err, count);
    pir_lane_free(a, leaves->low, count);
    PIR_FREE(a, leaves->looked, count);
    *leaves = (pir_leaves){0};
}

static pir_status reserve(pir_query *query, uint32_t capacity) {
    const pir_allocator *a = &query->allocator;
    pir_leaves *leaves = &query->leaves;
    if (capacity <= leaves->capacity)
        return PIR_OK;
    pir_leaves_finish(query);
    capacity = (capacity + LEAF - 1) / LEAF * LEAF;
    uint32_t count = leaves_for(capacity);
    leaves->capacity = capacity;
    leaves->h = pir_lane_new(a, capacity);
    leaves->err = pir_lane_new(a, capacity);
    leaves->slot = PIR_NEW(a, uint32_t, capacity);
    leaves->cell = PIR_NEW(a, uint32_t, capacity);
    leaves->cell_start = PIR_NEW(a, uint32_t, CELL_COUNT + 1);
    leaves->box_h = pir_lane_new(a, count);
    leaves->box_err = pir_lane_new(a, count);
    leaves->low = pir_lane_new(a, count);
    leaves->looked = PIR_NEW(a, uint32_t, count);
    bool lanes = pir_lanes_new(a, &leaves->n, capacity);
    lanes = pir_lanes_new(a, &leaves->box_least, count) && lanes;
    lanes = pir_lanes_new(a, &leaves->box_most, count) && lanes;
    if (leaves->h && leaves->err && leaves->slot && leaves->cell && leaves->cell_start && leaves->box_h &&
        leaves->box_err && leaves->low && leaves->looked && lanes)
        return PIR_OK;
    pir_leaves_finish(query);
    return PIR_ERR_MEMORY;
}

/* Where c, from −1 to 1, falls among the cells of a side; their bits two apart. */
static uint32_t spread_cell(double c) {
    double at = (c + 1) * (1 << (CELL_BITS - 1));
    uint32_t i = at > 0 ? (uint32_t)at : 0, most = (1u << CELL_BITS) - 1;
    i = i < most ? i : most;
    return (i & 1) | (i & 2) << 1 | (i & 4) << 2 | (i & 8) << 3;
}

static uint32_t cell_of(pir_vec3 n) {
    double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    if (x >= y && x >= z && x > 0)
        return ((n.x < 0) << 2 * CELL_BITS) + spread_cell(n.y / x) + 2 * spread_cell(n.z / x);
    if (y >= z && y > 0)
        return ((2 + (n.y < 0)) << 2 * CELL_BITS) + spread_cell(n.z / y) + 2 * spread_cell(n.x / y);
    return z > 0 ? ((4 + (n.z < 0)) << 2 * CELL_BITS) + spread_cell(n.x / z) + 2 * spread_cell(n.y / z) : 0;
}

/* Goes over the groups' planes but those of neighbouring facets, which stand in other groups as their own. */
static uint32_t next_own(const pir_group *group, uint32_t k) {
    return k + 1 == group->own_end - group->facets ? group->facets_end - group->facets : k + 1;
}

/* Counts the planes of each cell, which are to begin at cell_start, and lays them out by cells. */
static void sort_planes(pir_query *query) {
    pir_leaves *leaves = &query->leaves;
    const pir_planes *planes = &query->planes;
    uint32_t *start = leaves->cell_start, count = 0;
    memset(start, 0, (CELL_COUNT + 1) * sizeof *start);
    for (uint32_t g = 0; g < query->group_count; g++) {
        const pir_group *group = &query->groups[g];
        for (uint32_t k = 0; k < group->count; k = next_own(group, k), count++) {
            leaves->cell[count] = cell_of(pir_plane_normal(planes, group->start + k));
            start[leaves->cell[count] + 1]++;
        }
    }
    for (uint32_t c = 0; c < CELL_COUNT; c++)
        start[c + 1] += start[c];
    uint32_t from = 0;
    for (uint32_t g = 0; g < query->group_count; g++) {
        const pir_group *group = &query->groups[g];
        for (uint32_t k = 0; k < group->count; k = next_own(group, k), from++) {
            uint32_t to = start[leaves->cell[from]]++, slot = group->start + k;
            pir_lane_put(leaves->n, to, pir_plane_normal(planes, slot));
            leaves->h[to] = planes->h[slot];
            leaves->err[to] = planes->err[slot];
            leaves->slot[to] = slot;
        }
    }
    leaves->plane_count = count;
    leaves->leaf_count = (count + LEAF - 1) / LEAF;
    // fill the last leaf up with its first plane
    for (uint32_t i = count; i < LEAF * leaves->leaf_count; i++) {
        uint32_t like = LEAF * (leaves->leaf_count - 1);
        pir_lane_put(leaves->n, i, pir_lane_get(leaves->n, like));
        leaves->h[i] = leaves->h[like];
        leaves->err[i] = leaves->err[like];
        leaves->slot[i] = leaves->slot[like];
    }
}

static void make_box(pir_leaves *leaves, uint32_t leaf) {
    pir_vec3 least = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, most = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    double h = HUGE_VAL, err = 0;
    for (uint32_t i = LEAF * leaf; i < LEAF * (leaf + 1); i++) {
        pir_vec3 n = pir_lane_get(leaves->n, i);
        least = (pir_vec3){n.x < least.x ? n.x : least.x, n.y < least.y ? n.y : least.y, n.z < least.z ? n.z : least.z};
        most = (pir_vec3){n.x > most.x ? n.x : most.x, n.y > most.y ? n.y : most.y, n.z > most.z ? n.z : most.z};
        h = leaves->h[i] < h ? leaves->h[i] : h;
        err = leaves->err[i] > err ? leaves->err[i] : err;
    }
    pir_lane_put(leaves->box_least, leaf, least);
    pir_lane_put(leaves->box_most, leaf, most);
    leaves->box_h[leaf] = h;
    leaves->box_err[leaf] = err;
}

pir_status pir_leaves_make(pir_query *query) {
    pir_leaves *leaves = &query->leaves;
    if (leaves->stamp == query->stamp)
        return PIR_OK;
    for (uint32_t g = 0; g < query->group_count; g++)
        pir_group_make(query, g);
    pir_status status = reserve(query, query->planes.capacity);
    if (status != PIR_OK)
        return status;
    sort_planes(query);
    for (uint32_t leaf = 0; leaf < leaves->leaf_count; leaf++)
        make_box(leaves, leaf);
    leaves->stamp = query->stamp;
    return PIR_OK;
}

/* The least slack in a leaf; its error is box_err times the placement's at most. */
static double least_of(const pir_query *query, uint32_t leaf, pir_vec3 x) {
    const pir_leaves *leaves = &query->leaves;
    return query->scan->least(LEAF, pir_lanes_from(leaves->n, LEAF * leaf), leaves->h + LEAF * leaf, x);
}

static void bound_leaves(pir_query *query, const pir_placement *placement) {
    const pir_leaves *leaves = &query->leaves;
    query->scan->boxes(leaves->leaf_count, leaves->box_least, leaves->box_most, leaves->box_h, leaves->box_err,
                       placement->x, placement->error, leaves->low);
}

/* The leaf of the direction of x, or near it. */
static uint32_t leaf_along(const pir_leaves *leaves, pir_vec3 x) {
    // cell_start has become where cells end
    uint32_t leaf = leaves->cell_start[cell_of(x)] / LEAF;
    return leaf < leaves->leaf_count ? leaf : leaves->leaf_count - 1;
}

bool pir_leaves_state(pir_query *query, const pir_placement *placement, pir_state *ret_state) {
    const pir_leaves *leaves = &query->leaves;
    if (leaves->leaf_count == 0)
        return false;
    uint32_t first = leaf_along(leaves, placement->x);
    if (least_of(query, first, placement->x) < -placement->error * leaves->box_err[first]) {
        *ret_state = PIR_OUTSIDE;
        return true;
    }
    bound_leaves(query, placement);
    bool open = false;
    for (uint32_t leaf = 0; leaf < leaves->leaf_count; leaf++) {
        if (leaves->low[leaf] > 0)
            continue;
        double s = least_of(query, leaf, placement->x), error = placement->error * leaves->box_err[leaf];
        if (s < -error) {
            *ret_state = PIR_OUTSIDE;
            return true;
        }
        open |= s <= error;
    }
    *ret_state = PIR_INSIDE;
    return !open;
}

/*
 * Of the planes in the leaves that were looked at, those that may have a slack of `limit` at most: their slots, in work space, edge pairs at small
 * angles made exact. Returns how many.
 */
static uint32_t collect(pir_query *query, const pir_placement *placement, uint32_t looked, double limit) {
    pir_leaves *leaves = &query->leaves;
    uint32_t count = 0;
    for (uint32_t k = 0; k < looked; k++) {
        uint32_t leaf = leaves->looked[k], from = LEAF * leaf;
        double low[LEAF];
        if (leaves->low[leaf] > limit)
            continue;
        // planes are boxes of no width
        pir_lanes n = pir_lanes_from(leaves->n, from);
        query->scan->boxes(LEAF, n, n, leaves->h + from, leaves->err + from, placement->x, placement->error, low);
        for (uint32_t i = 0; i < LEAF; i++)
            if (low[i] <= limit) {
                pir_plane_refine(query, leaves->slot[from + i]);
                leaves->cell[count++] = leaves->slot[from + i];
            }
    }
    return count;
}

/*
 * Looks at the leaves that may hold the least slack: their numbers in `looked`, what it is not above in *ret_limit. Returns how many there are.
 */
static uint32_t look_at_leaves(pir_query *query, const pir_placement *placement, double *ret_limit) {
    pir_leaves *leaves = &query->leaves;
    uint32_t first = leaf_along(leaves, placement->x), looked = 0;
    double limit = least_of(query, first, placement->x) + placement->error * leaves->box_err[first];
    bound_leaves(query, placement);
    for (uint32_t leaf = 0; leaf < leaves->leaf_count; leaf++) {
        if (leaves->low[leaf] > limit)
            continue;
        double s = least_of(query, leaf, placement->x), error = placement->error * leaves->box_err[leaf];
        leaves->low[leaf] = s - error;
        leaves->looked[looked++] = leaf;
        limit = s + error < limit ? s + error : limit;
    }
    *ret_limit = limit;
    return looked;
}

double pir_leaves_least(pir_query *query, const pir_placement *placement) {
    const pir_leaves *leaves = &query->leaves;
    double limit, least = HUGE_VAL;
    if (leaves->leaf_count == 0)
        return -HUGE_VAL;
    uint32_t looked = look_at_leaves(query, placement, &limit);
    for (uint32_t k = 0; k < looked; k++)
        least = leaves->low[leaves->looked[k]] < least ? leaves->low[leaves->looked[k]] : least;
    return least;
}

bool pir_leaves_depth(pir_query *query, const pir_placement *placement, pir_facet *ret_facet) {
    if (query->leaves.leaf_count == 0)
        return false;
    double limit;
    uint32_t looked = look_at_leaves(query, placement, &limit), count = collect(query, placement, looked, limit);
    const uint32_t *slot = query->leaves.cell;
    const pir_planes *planes = &query->planes;
    for (uint32_t i = 0; i < count; i++)
        limit = fmin(limit, pir_plane_slack(planes, slot[i], placement->x) + placement->error * planes->err[slot[i]]);
    pir_least least = {.some = false};
    for (uint32_t i = 0; i < count; i++)
        if (pir_plane_slack(planes, slot[i], placement->x) - placement->error * planes->err[slot[i]] <= limit)
            pir_least_offer(query, placement, &least, planes->piece[slot[i]]);
    if (least.some)
        *ret_facet = least.facet;
    return least.some;
}
