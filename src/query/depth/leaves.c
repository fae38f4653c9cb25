/* SPDX-License-Identifier: MIT */
/*
 * All planes of D at one rotation, in leaves, for many translations.
 *
 * A grid on the cube sorts the planes by their normals, its cells along a Z-order curve. LEAF planes in a row make a
 * leaf. A leaf has a box: of its normals, its least offset and its greatest err. The box bounds its slacks from
 * below, and most leaves are ruled out by their boxes alone. The first leaf to be searched is that of the direction
 * of x; in a round D it holds the least slack.
 *
 * Values of planes and their errors (frame.h) decide as long as they are certain. What they leave open is left to the
 * caller.
 */
#include <string.h>

#include "query/depth/leaves.h"

/* Planes in a leaf: four blocks, so that a box costs little beside the planes that it rules out. */
#define LEAF 32

/*
 * The cells along a side of the cube are 2^CELL_BITS. 6 · 16² cells hold a few planes each on bodies of some thousand
 * facets.
 */
#define CELL_BITS  4
#define CELL_COUNT (6u << 2 * CELL_BITS)

static uint32_t leaves_for(uint32_t capacity) {
    // whole lanes
    uint32_t leaves = (capacity + LEAF - 1) / LEAF;
    return (leaves + PIR_SCAN_LANES - 1) / PIR_SCAN_LANES * PIR_SCAN_LANES;
}

static pir_layout layout_of(pir_leaves *leaves) {
    uint32_t capacity = leaves->capacity, count = leaves_for(capacity);
    return (pir_layout){{PIR_ROWS_LANES(leaves->n, capacity), PIR_ROW_LANE(leaves->h, capacity),
                         PIR_ROW_LANE(leaves->err, capacity), PIR_ROW(leaves->slot, capacity),
                         PIR_ROW(leaves->cell, capacity), PIR_ROW(leaves->cell_start, CELL_COUNT + 1),
                         PIR_ROWS_LANES(leaves->box.least, count), PIR_ROWS_LANES(leaves->box.most, count),
                         PIR_ROW_LANE(leaves->box.h, count), PIR_ROW_LANE(leaves->box.err, count),
                         PIR_ROW_LANE(leaves->low, count), PIR_ROW(leaves->looked, count)}};
}

void pir_leaves_finish(pir_leaves *leaves, const pir_allocator *allocator) {
    pir_layout layout = layout_of(leaves);
    pir_layout_free(allocator, &layout);
    *leaves = (pir_leaves){0};
}

static pir_status reserve(pir_leaves *leaves, const pir_allocator *allocator, uint32_t capacity) {
    if (leaves->h && capacity <= leaves->capacity)
        return PIR_OK;
    pir_leaves_finish(leaves, allocator);
    // a quarter more than is needed, so that a count that rises slowly seldom needs new memory
    leaves->capacity = (capacity + capacity / 4 + LEAF - 1) / LEAF * LEAF;
    pir_layout layout = layout_of(leaves);
    if (pir_layout_new(allocator, &layout))
        return PIR_OK;
    pir_leaves_finish(leaves, allocator);
    return PIR_ERR_MEMORY;
}

/* The cell of coordinate c, from −1 to 1, along a side, its bits spread two apart. */
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

/* The plane of a group after plane `k`, without the neighbouring facets, which are planes of other groups as well. */
static uint32_t next_own(const pir_group *group, uint32_t k) {
    return k + 1 == group->of.own_end - group->of.facets ? group->of.facets_end - group->of.facets : k + 1;
}

/* Sorts the planes by cells: counts those of each cell, then puts them where their cell begins. */
static void sort_planes(pir_leaves *leaves, const pir_groups *groups) {
    const pir_planes *planes = groups->planes;
    uint32_t *start = leaves->cell_start, count = 0;
    memset(start, 0, (CELL_COUNT + 1) * sizeof *start);
    for (uint32_t g = 0; g < groups->count; g++) {
        const pir_group *group = &groups->at[g];
        for (uint32_t k = 0; k < group->count; k = next_own(group, k), count++) {
            leaves->cell[count] = cell_of(pir_planes_normal(planes, group->start + k));
            start[leaves->cell[count] + 1]++;
        }
    }
    for (uint32_t c = 0; c < CELL_COUNT; c++)
        start[c + 1] += start[c];
    uint32_t from = 0;
    for (uint32_t g = 0; g < groups->count; g++) {
        const pir_group *group = &groups->at[g];
        for (uint32_t k = 0; k < group->count; k = next_own(group, k), from++) {
            uint32_t to = start[leaves->cell[from]]++, slot = group->start + k;
            pir_lane_put(leaves->n, to, pir_planes_normal(planes, slot));
            leaves->h[to] = planes->h[slot];
            leaves->err[to] = planes->err[slot];
            leaves->slot[to] = slot;
        }
    }
    leaves->plane_count = count;
    leaves->leaf_count = (count + LEAF - 1) / LEAF;
    // fill up the last leaf with its first plane
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
    pir_lane_put(leaves->box.least, leaf, least);
    pir_lane_put(leaves->box.most, leaf, most);
    leaves->box.h[leaf] = h;
    leaves->box.err[leaf] = err;
}

pir_status pir_leaves_make(pir_leaves *leaves, pir_groups *groups, const pir_allocator *allocator) {
    if (leaves->stamp == groups->stamp)
        return PIR_OK;
    for (uint32_t g = 0; g < groups->count; g++)
        pir_group_make(groups, g);
    pir_status status = reserve(leaves, allocator, groups->planes->used);
    if (status != PIR_OK)
        return status;
    sort_planes(leaves, groups);
    for (uint32_t leaf = 0; leaf < leaves->leaf_count; leaf++)
        make_box(leaves, leaf);
    leaves->stamp = groups->stamp;
    return PIR_OK;
}

/* The least slack in a leaf. Its error is at most box.err times the placement's. */
static double least_of(const pir_leaves *leaves, const pir_scan *scan, uint32_t leaf, pir_vec3 x) {
    return scan->least(LEAF, pir_lanes_from(leaves->n, LEAF * leaf), leaves->h + LEAF * leaf, x);
}

static void bound_leaves(const pir_leaves *leaves, const pir_scan *scan, const pir_placement *placement) {
    scan->boxes(leaves->leaf_count, &leaves->box, placement->x, placement->error, leaves->low);
}

/* The leaf of the direction of x, or one near it. */
static uint32_t leaf_along(const pir_leaves *leaves, pir_vec3 x) {
    // cell_start holds the ends of cells now
    uint32_t leaf = leaves->cell_start[cell_of(x)] / LEAF;
    return leaf < leaves->leaf_count ? leaf : leaves->leaf_count - 1;
}

bool pir_leaves_state(pir_leaves *leaves, const pir_groups *groups, const pir_placement *placement,
                      pir_state *ret_state) {
    if (leaves->leaf_count == 0)
        return false;
    uint32_t first = leaf_along(leaves, placement->x);
    if (least_of(leaves, groups->scan, first, placement->x) < -placement->error * leaves->box.err[first]) {
        *ret_state = PIR_OUTSIDE;
        return true;
    }
    bound_leaves(leaves, groups->scan, placement);
    bool open = false;
    for (uint32_t leaf = 0; leaf < leaves->leaf_count; leaf++) {
        if (leaves->low[leaf] > 0)
            continue;
        double s = least_of(leaves, groups->scan, leaf, placement->x), error = placement->error * leaves->box.err[leaf];
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
 * Collects the planes that may have a slack of at most `limit`, of the leaves that were searched: their slots, in
 * work space. Planes of edge pairs at small angles are refined. Returns how many there are.
 */
static uint32_t collect(pir_leaves *leaves, pir_groups *groups, const pir_placement *placement, uint32_t looked,
                        double limit) {
    uint32_t count = 0;
    for (uint32_t k = 0; k < looked; k++) {
        uint32_t leaf = leaves->looked[k], from = LEAF * leaf;
        double low[LEAF];
        if (leaves->low[leaf] > limit)
            continue;
        // a plane is a box of no width
        pir_lanes n = pir_lanes_from(leaves->n, from);
        pir_box_lanes planes = {n, n, leaves->h + from, leaves->err + from};
        groups->scan->boxes(LEAF, &planes, placement->x, placement->error, low);
        for (uint32_t i = 0; i < LEAF; i++)
            if (low[i] <= limit) {
                pir_planes_refine(groups->exact, groups->planes, leaves->slot[from + i]);
                leaves->cell[count++] = leaves->slot[from + i];
            }
    }
    return count;
}

/*
 * Searches the leaves that may hold the least slack. Their numbers are in `looked`; *ret_limit is an upper bound on
 * the least slack. Returns how many leaves there are.
 */
static uint32_t look_at_leaves(pir_leaves *leaves, const pir_groups *groups, const pir_placement *placement,
                               double *ret_limit) {
    uint32_t first = leaf_along(leaves, placement->x), looked = 0;
    double limit = least_of(leaves, groups->scan, first, placement->x) + placement->error * leaves->box.err[first];
    bound_leaves(leaves, groups->scan, placement);
    for (uint32_t leaf = 0; leaf < leaves->leaf_count; leaf++) {
        if (leaves->low[leaf] > limit)
            continue;
        double s = least_of(leaves, groups->scan, leaf, placement->x), error = placement->error * leaves->box.err[leaf];
        leaves->low[leaf] = s - error;
        leaves->looked[looked++] = leaf;
        limit = s + error < limit ? s + error : limit;
    }
    *ret_limit = limit;
    return looked;
}

double pir_leaves_least(pir_leaves *leaves, const pir_groups *groups, const pir_placement *placement) {
    double limit, least = HUGE_VAL;
    if (leaves->leaf_count == 0)
        return -HUGE_VAL;
    uint32_t looked = look_at_leaves(leaves, groups, placement, &limit);
    for (uint32_t k = 0; k < looked; k++)
        least = leaves->low[leaves->looked[k]] < least ? leaves->low[leaves->looked[k]] : least;
    return least;
}

bool pir_leaves_depth(pir_leaves *leaves, pir_groups *groups, const pir_placement *placement, pir_facet *ret_facet) {
    if (leaves->leaf_count == 0)
        return false;
    double limit;
    uint32_t looked = look_at_leaves(leaves, groups, placement, &limit),
             count = collect(leaves, groups, placement, looked, limit);
    const uint32_t *slot = leaves->cell;
    const pir_planes *planes = groups->planes;
    for (uint32_t i = 0; i < count; i++)
        limit = fmin(limit, pir_planes_slack(planes, slot[i], placement->x) + placement->error * planes->err[slot[i]]);
    pir_least least = {.found = false};
    for (uint32_t i = 0; i < count; i++)
        if (pir_planes_slack(planes, slot[i], placement->x) - placement->error * planes->err[slot[i]] <= limit)
            pir_least_offer(groups->exact, placement, &least, planes->piece[slot[i]]);
    if (least.found)
        *ret_facet = least.facet;
    return least.found;
}
