/* SPDX-License-Identifier: MIT */
/*
 * Points are put in order by their exact coordinates, so that equal ones stand together. Edges are sorted by both ends
 * with two stable counting passes, O(edges + points) for any number of facets at a corner; equal edges then stand
 * together, by rising facets. Which facets must be turned is found by union-find with a parity: two facets that walk an
 * edge the same way face different sides.
 */
#include "polytope/surface/facets.h"

#include <string.h>

#include "base/memory.h"
#include "base/sort.h"

/* --- places --- */

static int compare_ints(const pir_int *a, const pir_int *b) {
    if (a->size != b->size)
        return a->size < b->size ? -1 : 1;
    if (a->size == 0)
        return 0;
    int order = mpn_cmp(a->limb, b->limb, pir_int_length(a));
    return a->size < 0 ? -order : order;
}

static int compare_points(const pir_vectors *points, uint32_t a, uint32_t b) {
    pir_int3 va = pir_vectors_at(points, a), vb = pir_vectors_at(points, b);
    int order = 0;
    for (int k = 0; k < 3 && order == 0; k++)
        order = compare_ints(&va.c[k], &vb.c[k]);
    return order;
}

static bool point_before(void *context, uint32_t a, uint32_t b) {
    return compare_points(context, a, b) < 0;
}

/* `order` and `work` have room for all points. */
static void find_places(struct pir_model_facets *facets, const pir_vectors *exact, uint32_t *order, uint32_t *work) {
    for (uint32_t p = 0; p < exact->count; p++)
        order[p] = p;
    pir_vectors points = *exact;
    pir_sort(order, exact->count, work, point_before, &points);
    // equal points keep their order, so that the first of them has the least number
    for (uint32_t i = 0; i < exact->count; i++) {
        bool same = i > 0 && compare_points(exact, order[i - 1], order[i]) == 0;
        facets->place[order[i]] = same ? facets->place[order[i - 1]] : order[i];
        facets->place_count += !same;
    }
}

/* The corners of each facet as places, without those that equal the one before. Of one or two
   places it has no sides left. */
static void copy_corners(struct pir_model_facets *facets, const struct pir_model *model) {
    uint32_t end = 0;
    for (uint32_t f = 0; f < facets->count; f++) {
        uint32_t first = end;
        facets->start[f] = first;
        for (uint32_t i = model->facet[f].start; i < pir_model_corners_end(model, f); i++) {
            uint32_t place = facets->place[model->corner[i]];
            if (end == first || facets->corner[end - 1] != place)
                facets->corner[end++] = place;
        }
        while (end > first && facets->corner[end - 1] == facets->corner[first])
            end--;
        if (end - first < 3)
            end = first;
    }
    facets->start[facets->count] = end;
}

/* --- edges --- */

struct edge {
    uint32_t low, high;
    uint32_t facet_way; /* twice the facet, plus 1 when it walks from high to low */
};

static void list_edges(const struct pir_model_facets *facets, struct edge *edges) {
    uint32_t count = 0;
    for (uint32_t f = 0; f < facets->count; f++)
        for (uint32_t i = facets->start[f]; i < facets->start[f + 1]; i++) {
            uint32_t a = facets->corner[i], b = facets->corner[i + 1 < facets->start[f + 1] ? i + 1 : facets->start[f]];
            edges[count++] = (struct edge){a < b ? a : b, a < b ? b : a, 2 * f + (a > b)};
        }
}

/* One stable counting pass: `from` to `into`, by one end; `starts` has room for point_count + 1. */
static void counting_pass(const struct edge *from, struct edge *into, size_t count, bool by_high, uint32_t *starts,
                          uint32_t point_count) {
    memset(starts, 0, ((size_t)point_count + 1) * sizeof *starts);
    for (size_t i = 0; i < count; i++)
        starts[(by_high ? from[i].high : from[i].low) + 1]++;
    for (size_t p = 0; p < point_count; p++)
        starts[p + 1] += starts[p];
    for (size_t i = 0; i < count; i++)
        into[starts[by_high ? from[i].high : from[i].low]++] = from[i];
}

/* The end of the edges that equal edges[i]. */
static uint32_t group_end(const struct edge *edges, uint32_t count, uint32_t i) {
    uint32_t end = i + 1;
    while (end < count && edges[end].low == edges[i].low && edges[end].high == edges[i].high)
        end++;
    return end;
}

static uint32_t find_root(struct pir_model_facets *facets, uint32_t f) {
    uint32_t root = f;
    uint8_t turned = 0;
    while (facets->piece[root] != root) {
        turned ^= facets->turned[root];
        root = facets->piece[root];
    }
    // every facet on the way then hangs from the root, turned against it or not
    while (facets->piece[f] != root && f != root) {
        uint32_t next = facets->piece[f];
        uint8_t rest = turned ^ facets->turned[f];
        facets->piece[f] = root;
        facets->turned[f] = turned;
        turned = rest;
        f = next;
    }
    return root;
}

/* Joins two facets, one turned against the other or not; false when they are joined otherwise already. */
static bool join(struct pir_model_facets *facets, uint32_t a, uint32_t b, bool against) {
    uint32_t root_a = find_root(facets, a), root_b = find_root(facets, b);
    uint8_t turned = (uint8_t)(facets->turned[a] ^ facets->turned[b] ^ against);
    if (root_a == root_b)
        return turned == 0;
    facets->piece[root_b] = root_a;
    facets->turned[root_b] = turned;
    return true;
}

/* Turns facets so that those on either side of an edge walk it opposite ways; all edges are on two. */
static bool turn_facets(struct pir_model_facets *facets, const struct edge *edges, uint32_t count) {
    for (uint32_t f = 0; f < facets->count; f++)
        facets->piece[f] = f;
    for (uint32_t i = 0; i < count; i += 2) {
        uint32_t a = edges[i].facet_way, b = edges[i + 1].facet_way;
        if (!join(facets, a / 2, b / 2, a % 2 == b % 2))
            return false;
    }
    for (uint32_t f = 0; f < facets->count; f++)
        find_root(facets, f);
    return true;
}

static void examine_edges(struct pir_model_facets *facets, const struct edge *edges, uint32_t count) {
    bool in_pairs = true;
    uint32_t open = UINT32_MAX;
    facets->one_way = true;
    for (uint32_t i = 0, end; i < count; i = end) {
        end = group_end(edges, count, i);
        uint32_t backward = 0;
        for (uint32_t k = i; k < end; k++)
            backward += edges[k].facet_way % 2;
        facets->one_way = facets->one_way && (backward == (end - i) / 2 || backward == (end - i + 1) / 2);
        in_pairs = in_pairs && end - i == 2;
        if ((end - i) % 2 == 1 && (open == UINT32_MAX || edges[i].facet_way / 2 < facets->open_facet)) {
            open = i;
            facets->open_facet = edges[i].facet_way / 2;
            facets->open_count = end - i;
        }
    }
    if (open != UINT32_MAX) {
        facets->joining = PIR_JOINED_NOT;
        facets->open_edge[0] = edges[open].low;
        facets->open_edge[1] = edges[open].high;
    } else {
        facets->joining = facets->one_way                                 ? PIR_JOINED_ONE_WAY
                          : in_pairs && turn_facets(facets, edges, count) ? PIR_JOINED_TURNED
                                                                          : PIR_JOINED_NEITHER;
    }
}

/* --- the whole --- */

static bool join_facets(struct pir_model_facets *facets, const pir_allocator *allocator) {
    uint32_t count = facets->start[facets->count];
    size_t start_count = (size_t)facets->point_count + 1;
    struct edge *edges = PIR_NEW(allocator, struct edge, count);
    struct edge *other = PIR_NEW(allocator, struct edge, count);
    uint32_t *starts = PIR_NEW(allocator, uint32_t, start_count);
    bool done = edges && other && starts;
    if (done) {
        list_edges(facets, edges);
        counting_pass(edges, other, count, true, starts, facets->point_count);
        counting_pass(other, edges, count, false, starts, facets->point_count);
        examine_edges(facets, edges, count);
    }
    PIR_FREE(allocator, starts, start_count);
    PIR_FREE(allocator, other, count);
    PIR_FREE(allocator, edges, count);
    return done;
}

bool pir_facets_init(struct pir_model_facets *facets, const struct pir_model *model, const pir_vectors *exact) {
    const pir_allocator *a = &model->allocator;
    *facets = (struct pir_model_facets){
        .point_count = exact->count, .count = model->facet_count, .corner_room = model->corner_count};
    facets->place = PIR_NEW(a, uint32_t, facets->point_count);
    facets->start = PIR_NEW(a, uint32_t, (size_t)facets->count + 1);
    facets->corner = PIR_NEW(a, uint32_t, facets->corner_room);
    facets->turned = PIR_ZEROED(a, uint8_t, facets->count);
    facets->piece = PIR_ZEROED(a, uint32_t, facets->count);
    uint32_t *order = PIR_NEW(a, uint32_t, exact->count), *work = PIR_NEW(a, uint32_t, exact->count);
    bool done = facets->place && facets->start && facets->corner && facets->turned && facets->piece && order && work;
    if (done) {
        find_places(facets, exact, order, work);
        copy_corners(facets, model);
    }
    PIR_FREE(a, work, exact->count);
    PIR_FREE(a, order, exact->count);
    done = done && join_facets(facets, a);
    if (!done)
        pir_facets_finish(facets, a);
    return done;
}

void pir_facets_finish(struct pir_model_facets *facets, const pir_allocator *allocator) {
    PIR_FREE(allocator, facets->place, facets->point_count);
    PIR_FREE(allocator, facets->start, (size_t)facets->count + 1);
    PIR_FREE(allocator, facets->corner, facets->corner_room);
    PIR_FREE(allocator, facets->turned, facets->count);
    PIR_FREE(allocator, facets->piece, facets->count);
    *facets = (struct pir_model_facets){0};
}
