/* SPDX-License-Identifier: MIT */
/* Groups of pieces: see groups.h. */
#include "query/planes/groups.h"

#include <stdlib.h>
#include <string.h>

/*
 * Facets in a group. With about three edge pairs for each facet of P, either kind of group makes about 32 planes,
 * four blocks.
 */
#define GROUP_OF_P 8
#define GROUP_OF_Q 32

/* --- memory --- */

/* The entries of the facet list: every facet once, those beyond the edges of groups of P, and what pads the groups. */
static size_t list_capacity(const pir_groups *groups) {
    const pir_polytope *p = groups->frame->p.polytope, *q = groups->frame->q.polytope;
    return 2 * (size_t)p->half_count + p->facet_count + q->facet_count + PIR_SCAN_LANES * (size_t)groups->count;
}

static pir_layout layout_of(pir_groups *groups) {
    pir_group_lists *list = &groups->list;
    size_t facets = list_capacity(groups), edges = groups->frame->p.polytope->edge_count;
    return (pir_layout){{PIR_ROW(groups->at, groups->count), PIR_ROW(list->facet, facets),
                         PIR_ROWS_LANES(list->facet_normal, facets), PIR_ROW_LANE(list->facet_offset, facets),
                         PIR_ROW(list->edge, edges), PIR_ROW(list->edge_left, edges), PIR_ROW(list->edge_right, edges),
                         PIR_ROWS_LANES(list->edge_direction, edges), PIR_ROWS_LANES(list->edge_origin, edges)}};
}

static pir_layout work_layout_of(pir_group_work *work) {
    return (pir_layout){{PIR_ROWS_LANES(work->direction, work->edges), PIR_ROWS_LANES(work->origin, work->edges),
                         PIR_ROWS_LANES(work->vector[0], work->capacity),
                         PIR_ROWS_LANES(work->vector[1], work->capacity),
                         PIR_ROWS_LANES(work->vector[2], work->capacity)}};
}

static void work_finish(pir_group_work *work, const pir_allocator *allocator) {
    pir_layout layout = work_layout_of(work);
    pir_layout_free(allocator, &layout);
}

static bool work_resize(pir_group_work *work, const pir_allocator *allocator, uint32_t edges, uint32_t capacity) {
    pir_group_work fresh = {.edges = edges, .capacity = capacity};
    pir_layout layout = work_layout_of(&fresh);
    bool done = pir_layout_new(allocator, &layout);
    work_finish(done ? work : &fresh, allocator);
    if (done)
        *work = fresh;
    return done;
}

/* Slots for every entry of the facet list, the given crossings, and what pads the groups. */
static uint32_t slots_for(const pir_groups *groups, uint32_t crossings) {
    return groups->list.facet_count + crossings + PIR_SCAN_BLOCK * groups->count;
}

/* Elements of work space. A group has all crossings at most, or lists all facets. */
static uint32_t work_for(const pir_groups *groups, uint32_t crossings) {
    return crossings > groups->list.facet_count ? crossings : groups->list.facet_count;
}

pir_status pir_groups_reserve(pir_groups *groups, const pir_allocator *allocator) {
    uint32_t crossings = groups->pairing->crossings.count, slots = slots_for(groups, crossings),
             work = work_for(groups, crossings);
    if (slots > groups->planes.capacity) {
        // a quarter more than is needed, so that a count that rises slowly seldom needs new memory
        if (!pir_planes_resize(&groups->planes, allocator, slots + slots / 4))
            return PIR_ERR_MEMORY;
        pir_groups_forget(groups);
    }
    if (work <= groups->work.capacity || work_resize(&groups->work, allocator, groups->work.edges, work + work / 4))
        return PIR_OK;
    return PIR_ERR_MEMORY;
}

void pir_groups_finish(pir_groups *groups, const pir_allocator *allocator) {
    pir_layout layout = layout_of(groups);
    pir_layout_free(allocator, &layout);
    work_finish(&groups->work, allocator);
    pir_planes_finish(&groups->planes, allocator);
}

/* --- grouping, once --- */

/* A key to sort a facet by: one coordinate of its normal, then its number. */
static uint64_t coordinate_key(const pir_polytope *p, uint32_t f, int axis) {
    pir_vec3 n = p->normal[f];
    double c = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
    return (uint64_t)(uint32_t)(0x1p30 * (2 + fmin(1, fmax(-1, c)))) << 32 | f;
}

static int compare_keys(const void *a, const void *b) {
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* The first facet of group `g` of `groups`, among `count` facets in order. */
static uint32_t group_start(uint32_t count, uint32_t g, uint32_t groups) {
    return (uint32_t)((uint64_t)count * g / groups);
}

/*
 * Sorts the facets of groups [from, to) of `groups` so that the normals of each group are near each other. It halves
 * the groups across the longest side of their normals' box.
 */
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
        if (high - low > longest) {
            longest = high - low;
            axis = k;
        }
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

/*
 * The place of a facet in the list of `group`, which is being made. The facet is added where it is not listed yet:
 * seen[f] is where f was listed last.
 */
static uint32_t list_facet(pir_groups *groups, uint32_t f, const pir_group *group, uint32_t *seen) {
    if (seen[f] == UINT32_MAX || seen[f] < group->facets) {
        seen[f] = groups->list.facet_count;
        groups->list.facet[groups->list.facet_count++] = f;
    }
    return seen[f] - group->facets;
}

static uint32_t whole_lanes(uint32_t count) {
    return (count + PIR_SCAN_LANES - 1) / PIR_SCAN_LANES * PIR_SCAN_LANES;
}

/* Ends the list of `group` and fills it up to whole lanes with its first facet. */
static void end_facets(pir_groups *groups, pir_group *group) {
    while ((groups->list.facet_count - group->facets) % PIR_SCAN_LANES != 0)
        groups->list.facet[groups->list.facet_count++] = groups->list.facet[group->facets];
    group->facets_end = groups->list.facet_count;
}

/*
 * Makes group `g` of P: facets keys[from..to), the edges whose left facet is one of them, and the facets beyond those
 * edges.
 */
static void make_group_of_p(pir_groups *groups, uint32_t g, const uint64_t *keys, uint32_t from, uint32_t to,
                            uint32_t *seen) {
    const pir_polytope *p = groups->frame->p.polytope;
    pir_group *group = &groups->at[g];
    group->facets = groups->list.facet_count;
    group->edges = groups->list.edge_count;
    for (uint32_t i = from; i < to; i++)
        list_facet(groups, (uint32_t)keys[i], group, seen);
    group->own_end = groups->list.facet_count;
    for (uint32_t i = from; i < to; i++) {
        uint32_t f = (uint32_t)keys[i];
        for (uint32_t k = p->loop_start[f]; k < p->loop_start[f + 1]; k++) {
            uint32_t half = p->loop[k];
            if (p->edge_half[p->edge[half]] != half)
                continue;
            groups->list.edge[groups->list.edge_count] = p->edge[half];
            groups->list.edge_left[groups->list.edge_count] = i - from;
            groups->list.edge_right[groups->list.edge_count++] = list_facet(groups, pir_right(p, half), group, seen);
        }
    }
    end_facets(groups, group);
    group->edges_end = groups->list.edge_count;
}

static void make_groups(pir_groups *groups, uint64_t *keys, uint32_t *seen) {
    const pir_polytope *p = groups->frame->p.polytope, *q = groups->frame->q.polytope;
    uint32_t g = 0;
    sort_facets(p, keys, groups->of_p);
    memset(seen, 0xff, p->facet_count * sizeof *seen);
    for (uint32_t i = 0; i < groups->of_p; i++, g++)
        make_group_of_p(groups, g, keys, group_start(p->facet_count, i, groups->of_p),
                        group_start(p->facet_count, i + 1, groups->of_p), seen);
    sort_facets(q, keys, groups->of_q);
    g = groups->first_of_q;
    for (uint32_t i = 0; i < groups->of_q; i++, g++) {
        pir_group *group = &groups->at[g];
        group->of_q = true;
        group->edges = group->edges_end = groups->list.edge_count;
        group->facets = groups->list.facet_count;
        uint32_t to = group_start(q->facet_count, i + 1, groups->of_q);
        for (uint32_t k = group_start(q->facet_count, i, groups->of_q); k < to; k++)
            groups->list.facet[groups->list.facet_count++] = (uint32_t)keys[k];
        group->own_end = groups->list.facet_count;
        end_facets(groups, group);
    }
}

/* Copies the coordinates of what the lists name, in their order. */
void pir_groups_fill(pir_groups *groups) {
    const pir_frame *frame = groups->frame;
    pir_group_lists *list = &groups->list;
    for (uint32_t g = 0; g < groups->count; g++) {
        const pir_group *group = &groups->at[g];
        const pir_body *of = group->of_q ? &frame->q : &frame->p;
        for (uint32_t i = group->facets; i < group->facets_end; i++) {
            pir_lane_put(list->facet_normal, i, of->polytope->normal[list->facet[i]]);
            list->facet_offset[i] = of->offset[list->facet[i]];
        }
    }
    const pir_polytope *p = frame->p.polytope;
    for (uint32_t i = 0; i < list->edge_count; i++) {
        uint32_t half = p->edge_half[list->edge[i]];
        pir_lane_put(list->edge_direction, i, p->direction[half]);
        pir_lane_put(list->edge_origin, i, frame->p.vertex[p->origin[half]]);
    }
}

/*
 * A count of crossings that most rotations do not exceed: three per edge, and some for bodies of few edges, whose
 * counts vary most. A rotation with more makes the memory grow.
 */
static uint32_t usual_crossings(const pir_polytope *p, const pir_polytope *q) {
    return 3 * (p->edge_count + q->edge_count) + 64;
}

bool pir_groups_init(pir_groups *groups, const pir_allocator *allocator) {
    const pir_polytope *p = groups->frame->p.polytope, *q = groups->frame->q.polytope;
    for (unsigned i = 0; pir_scan_version(i); i++)
        groups->scan = pir_scan_version(i);
    groups->of_p = (p->facet_count + GROUP_OF_P - 1) / GROUP_OF_P;
    groups->of_q = (q->facet_count + GROUP_OF_Q - 1) / GROUP_OF_Q;
    groups->first_of_q = whole_lanes(groups->of_p);
    groups->count = groups->first_of_q + whole_lanes(groups->of_q);
    uint32_t most = p->facet_count > q->facet_count ? p->facet_count : q->facet_count;
    uint64_t *keys = PIR_NEW(allocator, uint64_t, most);
    uint32_t *seen = PIR_NEW(allocator, uint32_t, most);
    pir_layout layout = layout_of(groups);
    bool done = pir_layout_new(allocator, &layout) && keys && seen;
    if (done) {
        make_groups(groups, keys, seen);
        uint32_t crossings = usual_crossings(p, q);
        done = pir_planes_resize(&groups->planes, allocator, slots_for(groups, crossings)) &&
               work_resize(&groups->work, allocator, p->edge_count, work_for(groups, crossings));
    }
    PIR_FREE(allocator, keys, most);
    PIR_FREE(allocator, seen, most);
    return done;
}
