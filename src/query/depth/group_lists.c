/* SPDX-License-Identifier: MIT */
/* The groups of one body: see group_lists.h. */
#include "query/depth/group_lists.h"

#include <string.h>

#include "base/sort.h"

/*
 * Facets in a group. With about three edge pairs for each facet of P, either kind of group makes about 32 planes,
 * four blocks.
 */
#define GROUP_OF_P 8
#define GROUP_OF_Q 32

/* --- memory --- */

static pir_layout layout_of(pir_group_lists *lists) {
    size_t facets = lists->facet_capacity, edges = lists->of_q ? 0 : lists->polytope->edge_count, count = lists->count;
    return (pir_layout){{PIR_ROW(lists->at, count), PIR_ROW(lists->facet, facets),
                         PIR_ROWS_LANES(lists->facet_normal, facets), PIR_ROW_LANE(lists->facet_offset, facets),
                         PIR_ROW(lists->edge, edges), PIR_ROW(lists->edge_left, edges),
                         PIR_ROW(lists->edge_right, edges), PIR_ROWS_LANES(lists->edge_direction, edges),
                         PIR_ROWS_LANES(lists->edge_origin, edges), PIR_ROWS_LANES(lists->cap_axis, count),
                         PIR_ROWS_LANES(lists->cap_corner, count), PIR_ROW_LANE(lists->cap_cosine, count),
                         PIR_ROW_LANE(lists->cap_sine, count)}};
}

static void destroy(pir_attachment *attachment, const pir_allocator *allocator) {
    pir_group_lists *lists = (pir_group_lists *)attachment;
    pir_layout layout = layout_of(lists);
    pir_layout_free(allocator, &layout);
    PIR_FREE(allocator, lists, 1);
}

/* --- grouping --- */

/* A key to sort a facet by: one coordinate of its normal, then its number. */
static uint64_t coordinate_key(const pir_polytope *p, uint32_t f, int axis) {
    pir_vec3 n = p->normal[f];
    double c = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
    return (uint64_t)(uint32_t)(0x1p30 * (2 + fmin(1, fmax(-1, c)))) << 32 | f;
}

/* The first facet of group `g` of `groups`, among `count` facets in order. */
static uint32_t group_start(uint32_t count, uint32_t g, uint32_t groups) {
    return (uint32_t)((uint64_t)count * g / groups);
}

/* Moves the `first` lowest of `count` different keys to the front. */
static void part_keys(uint64_t *keys, uint32_t count, uint32_t first) {
    while (count > 1 && first > 0 && first < count) {
        uint64_t pivot = keys[count / 2];
        uint32_t low = 0, high = count - 1;
        for (;;) {
            while (keys[low] < pivot)
                low++;
            while (keys[high] > pivot)
                high--;
            if (low >= high)
                break;
            uint64_t swapped = keys[low];
            keys[low] = keys[high];
            keys[high] = swapped;
        }
        // the pivot is at `low`: what is before it is less, what is behind it is greater
        if (first <= low) {
            count = low;
        } else {
            keys += low + 1;
            count -= low + 1;
            first -= low + 1;
        }
    }
}

/* The axis of the longest side of the box around the normals of the given facets. */
static int longest_side(const pir_polytope *p, const uint64_t *keys, uint32_t count) {
    double longest = -1;
    int axis = 0;
    for (int k = 0; k < 3; k++) {
        double low = 1, high = -1;
        for (uint32_t i = 0; i < count; i++) {
            pir_vec3 n = p->normal[(uint32_t)keys[i]];
            double c = k == 0 ? n.x : k == 1 ? n.y : n.z;
            low = c < low ? c : low;
            high = c > high ? c : high;
        }
        if (high - low > longest) {
            longest = high - low;
            axis = k;
        }
    }
    return axis;
}

/*
 * Sorts the facets of groups [from, to) of `groups` so that the normals of each group are near each other. It halves
 * the groups across the longest side of their normals' box.
 */
static void sort_groups(const pir_polytope *p, uint64_t *keys, uint32_t from, uint32_t to, uint32_t groups) {
    uint32_t start = group_start(p->facet_count, from, groups), end = group_start(p->facet_count, to, groups),
             middle = from + (to - from) / 2;
    int axis = longest_side(p, keys + start, end - start);
    for (uint32_t i = start; i < end; i++)
        keys[i] = coordinate_key(p, (uint32_t)keys[i], axis);
    if (to - from == 1) {
        pir_sort_short(keys + start, end - start);
        return;
    }
    part_keys(keys + start, end - start, group_start(p->facet_count, middle, groups) - start);
    sort_groups(p, keys, from, middle, groups);
    sort_groups(p, keys, middle, to, groups);
}

/*
 * The place of a facet in the list of `group`, which is being made. The facet is added where it is not listed yet:
 * seen[f] is where f was listed last.
 */
static uint32_t list_facet(pir_group_lists *lists, uint32_t f, const pir_group_range *group, uint32_t *seen) {
    if (seen[f] == UINT32_MAX || seen[f] < group->facets) {
        seen[f] = lists->facet_count;
        lists->facet[lists->facet_count++] = f;
    }
    return seen[f] - group->facets;
}

/*
 * Lists the edges whose left facet is one of keys[from..to), which the group has listed, and the facets beyond those
 * edges.
 */
static void list_edges(pir_group_lists *lists, const pir_group_range *group, const uint64_t *keys, uint32_t from,
                       uint32_t to, uint32_t *seen) {
    const pir_polytope *p = lists->polytope;
    for (uint32_t i = from; i < to; i++) {
        uint32_t f = (uint32_t)keys[i];
        for (uint32_t k = p->loop_start[f]; k < p->loop_start[f + 1]; k++) {
            uint32_t half = p->loop[k];
            if (p->edge_half[p->edge[half]] != half)
                continue;
            lists->edge[lists->edge_count] = p->edge[half];
            lists->edge_left[lists->edge_count] = i - from;
            lists->edge_right[lists->edge_count++] = list_facet(lists, pir_right(p, half), group, seen);
        }
    }
}

/* Makes all groups. Their lists are filled up to whole lanes with their first facets. */
static void make_groups(pir_group_lists *lists, uint64_t *keys, uint32_t *seen) {
    const pir_polytope *p = lists->polytope;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        keys[f] = f;
        seen[f] = UINT32_MAX;
    }
    if (lists->used > 0)
        sort_groups(p, keys, 0, lists->used, lists->used);
    for (uint32_t g = 0; g < lists->used; g++) {
        pir_group_range *group = &lists->at[g];
        uint32_t from = group_start(p->facet_count, g, lists->used),
                 to = group_start(p->facet_count, g + 1, lists->used);
        group->facets = lists->facet_count;
        group->edges = lists->edge_count;
        for (uint32_t i = from; i < to; i++)
            list_facet(lists, (uint32_t)keys[i], group, seen);
        group->own_end = lists->facet_count;
        if (!lists->of_q)
            list_edges(lists, group, keys, from, to, seen);
        while ((lists->facet_count - group->facets) % PIR_SCAN_LANES != 0)
            lists->facet[lists->facet_count++] = lists->facet[group->facets];
        group->facets_end = lists->facet_count;
        group->edges_end = lists->edge_count;
    }
}

/* --- caps --- */

/* The least cosine between the normals of facet f and of any facet in the group's list, where that is above `least`. */
static double least_cosine(const pir_group_lists *lists, const pir_group_range *group, uint32_t f, double above) {
    const pir_vec3 *normal = lists->polytope->normal, n = normal[f];
    double least = 1;
    for (uint32_t i = group->facets; i < group->facets_end && least > above; i++) {
        double cosine = pir_vec_dot(n, normal[lists->facet[i]]);
        least = cosine < least ? cosine : least;
    }
    return least;
}

/* Chooses the middle of group `g` and the angle of its cap. */
static void choose_cap(pir_group_lists *lists, uint32_t g) {
    pir_group_range *group = &lists->at[g];
    double cosine = -HUGE_VAL;
    for (uint32_t i = group->facets; i < group->own_end; i++) {
        double least = least_cosine(lists, group, lists->facet[i], cosine);
        if (least > cosine) {
            cosine = least;
            group->middle = lists->facet[i];
        }
    }
    // normals are off by 8u each, so their cosine is off by less than 32u
    cosine -= 0x1p-47;
    // where the cap is no bound, a huge sine makes its bound negative
    lists->cap_cosine[g] = cosine > 0 ? cosine : 0;
    lists->cap_sine[g] = cosine > 0 ? sqrt((1 - cosine) * (1 + cosine)) * (1 + 0x1p-50) : 0x1p1000;
}

/* An empty group takes the cap of the group before it, so that whole lanes are caps. */
static void choose_caps(pir_group_lists *lists) {
    for (uint32_t g = 0; g < lists->used; g++)
        choose_cap(lists, g);
    for (uint32_t g = lists->used; g < lists->count; g++) {
        lists->at[g] = (pir_group_range){.middle = lists->at[g - 1].middle};
        lists->cap_cosine[g] = lists->cap_cosine[g - 1];
        lists->cap_sine[g] = lists->cap_sine[g - 1];
    }
}

/* --- making --- */

/* Copies the groups of the same body at another scale. */
static void copy_groups(pir_group_lists *lists, const pir_group_lists *from) {
    PIR_ASSERT(lists->count == from->count && lists->facet_capacity == from->facet_capacity);
    lists->facet_count = from->facet_count;
    lists->edge_count = from->edge_count;
    memcpy(lists->at, from->at, lists->count * sizeof *lists->at);
    memcpy(lists->facet, from->facet, lists->facet_count * sizeof *lists->facet);
    memcpy(lists->edge, from->edge, lists->edge_count * sizeof *lists->edge);
    memcpy(lists->edge_left, from->edge_left, lists->edge_count * sizeof *lists->edge_left);
    memcpy(lists->edge_right, from->edge_right, lists->edge_count * sizeof *lists->edge_right);
    memcpy(lists->cap_cosine, from->cap_cosine, lists->count * sizeof *lists->cap_cosine);
    memcpy(lists->cap_sine, from->cap_sine, lists->count * sizeof *lists->cap_sine);
}

/* Copies the coordinates of what the lists name, in their order. */
static void fill_lists(pir_group_lists *lists, const pir_body *body) {
    const pir_polytope *p = lists->polytope;
    for (uint32_t i = 0; i < lists->facet_count; i++) {
        pir_lane_put(lists->facet_normal, i, p->normal[lists->facet[i]]);
        lists->facet_offset[i] = body->offset[lists->facet[i]];
    }
    for (uint32_t i = 0; i < lists->edge_count; i++) {
        uint32_t half = p->edge_half[lists->edge[i]];
        pir_lane_put(lists->edge_direction, i, p->direction[half]);
        pir_lane_put(lists->edge_origin, i, body->vertex[p->origin[half]]);
    }
    for (uint32_t g = 0; g < lists->count; g++) {
        uint32_t middle = lists->at[g].middle;
        pir_lane_put(lists->cap_axis, g, p->normal[middle]);
        pir_lane_put(lists->cap_corner, g, body->vertex[p->origin[p->loop[p->loop_start[middle]]]]);
    }
}

/* The groups themselves, without coordinates. False when out of memory. */
static bool group_facets(pir_group_lists *lists) {
    const pir_polytope *p = lists->polytope;
    uint64_t *keys = PIR_NEW(&p->allocator, uint64_t, p->facet_count);
    uint32_t *seen = PIR_NEW(&p->allocator, uint32_t, p->facet_count);
    bool done = keys && seen;
    if (done) {
        make_groups(lists, keys, seen);
        choose_caps(lists);
    }
    PIR_FREE(&p->allocator, keys, p->facet_count);
    PIR_FREE(&p->allocator, seen, p->facet_count);
    return done;
}

/* Names of attachments: of P's groups and of Q's. */
static const char kinds[2];

static pir_group_lists *make(pir_polytope *p, const pir_body *body, int exponent, bool of_q,
                             const pir_group_lists *like) {
    const pir_allocator *a = &p->allocator;
    pir_group_lists *lists = PIR_ZEROED(a, pir_group_lists, 1);
    if (!lists)
        return NULL;
    uint32_t size = of_q ? GROUP_OF_Q : GROUP_OF_P;
    lists->attachment = (pir_attachment){.kind = &kinds[of_q], .key = exponent, .destroy = destroy};
    lists->polytope = p;
    lists->of_q = of_q;
    lists->used = (p->facet_count + size - 1) / size;
    lists->count = pir_whole_lanes(lists->used);
    // every facet once, those beyond the edges, and what pads the groups
    lists->facet_capacity = p->facet_count + (of_q ? 0 : p->half_count) + PIR_SCAN_LANES * lists->count;
    pir_layout layout = layout_of(lists);
    bool done = pir_layout_new(a, &layout);
    if (done && like)
        copy_groups(lists, like);
    else
        done = done && group_facets(lists);
    if (!done) {
        destroy(&lists->attachment, a);
        return NULL;
    }
    fill_lists(lists, body);
    return lists;
}

pir_status pir_group_lists_of(pir_polytope *p, const pir_body *body, int exponent, bool of_q,
                              const pir_group_lists *like, const pir_group_lists **ret_lists) {
    pir_attachment *attachment = pir_polytope_attachment(p, &kinds[of_q], exponent);
    if (!attachment) {
        pir_group_lists *made = make(p, body, exponent, of_q, like);
        if (!made)
            return PIR_ERR_MEMORY;
        attachment = pir_polytope_attach(p, &made->attachment);
    }
    *ret_lists = (const pir_group_lists *)attachment;
    return PIR_OK;
}
