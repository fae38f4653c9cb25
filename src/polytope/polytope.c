/* SPDX-License-Identifier: MIT */
/*
 * Building polytopes. The layout and its invariants stand in polytope.h.
 *
 * Twins are found without searching: the halfedges sorted by (origin, target) and by (target, origin), both by
 * counting, stand opposite each other. Rings are then followed from each vertex's first halfedge: the next one
 * counter-clockwise is the twin of the one before it in its facet.
 */
#include "polytope/attachment.h"

#include <math.h>
#include <string.h>

#include "base/layout.h"
#include "polytope/facet_order.h"
#include "polytope/hull/hull.h"

/* --- memory --- */

/* The arrays, but that of rings, whose size follows from them. */
static pir_layout layout_of(pir_polytope *p) {
    const size_t v = p->vertex_count, e = p->edge_count, f = p->facet_count, h = p->half_count;
    const size_t more = h + PIR_LANES;
    // a few elements more: vector loads of four doubles, or eight integers, may reach past the last
    return (pir_layout){{PIR_ROW(p->ring_start, v + 1), PIR_ROW(p->origin, h),         PIR_ROW(p->target, more),
                         PIR_ROW(p->twin, h),           PIR_ROW(p->left, more),        PIR_ROW(p->edge, h),
                         PIR_ROW(p->edge_half, e),      PIR_ROW(p->loop_start, f + 1), PIR_ROW(p->loop, h),
                         PIR_ROW(p->across, h),         PIR_ROW(p->arc_ends, e),       PIR_ROW(p->edge_arc, e),
                         PIR_ROW(p->visit, f),          PIR_ROW(p->beside, f),         PIR_ROW(p->source, v),
                         PIR_ROW(p->vertex, v),         PIR_ROW(p->direction, more),   PIR_ROW(p->normal, f + 1),
                         PIR_ROW(p->ring_block, v + 1), PIR_ROW(p->normal4, 4 * f)}};
}

/* With room to begin at a multiple of a block. A point has room for one that is read without need. */
static size_t ring_bytes(const pir_polytope *p) {
    return ((size_t)p->ring_block[p->vertex_count] + 2) * sizeof *p->ring;
}

static void destroy(pir_polytope *p) {
    const pir_allocator allocator = p->allocator, *a = &allocator;
    pir_polytope_free_attachments(p);
    if (p->ring_memory)
        pir_memory_free(a, p->ring_memory, ring_bytes(p), 1);
    pir_layout layout = layout_of(p);
    pir_layout_free(a, &layout);
    pir_vectors_finish(&p->exact_vertex, a);
    pir_vectors_finish(&p->exact_edge, a);
    pir_vectors_finish(&p->exact_normal, a);
    pir_scale_finish(&p->scale, a);
    PIR_FREE(a, p, 1);
}

/* --- combinatorics --- */

/* A halfedge before it has its number. */
struct raw_half {
    uint32_t origin, target, facet, before; /* before: the one before it in its facet */
};

/* Stable counting sort of `order` by the origin or target of what it names. */
static void sort_by(const struct raw_half *raw, bool by_target, const uint32_t *order, uint32_t count, uint32_t *bucket,
                    uint32_t buckets, uint32_t *ret_order) {
    memset(bucket, 0, ((size_t)buckets + 1) * sizeof *bucket);
    for (uint32_t i = 0; i < count; i++)
        bucket[(by_target ? raw[i].target : raw[i].origin) + 1]++;
    for (uint32_t i = 0; i < buckets; i++)
        bucket[i + 1] += bucket[i];
    for (uint32_t i = 0; i < count; i++) {
        const struct raw_half *h = &raw[order[i]];
        ret_order[bucket[by_target ? h->target : h->origin]++] = order[i];
    }
}

/* The facet loops as raw halfedges over vertex numbers; `number` turns a point into a vertex. */
static void list_raw(const pir_polytope_parts *parts, const uint32_t *number, struct raw_half *raw) {
    const pir_loops *loops = parts->facets;
    for (uint32_t f = 0; f < loops->count; f++) {
        uint32_t start = loops->start[f], n = loops->start[f + 1] - start;
        for (uint32_t i = 0; i < n; i++)
            raw[start + i] = (struct raw_half){number[loops->corner[start + i]],
                                               number[loops->corner[start + (i + 1) % n]], f, start + (i + n - 1) % n};
    }
}

/* Numbers the halfedges by rings and fills every per-halfedge array but edge. */
static void number_rings(pir_polytope *p, const struct raw_half *raw, const uint32_t *twin, uint32_t *number) {
    // any halfedge that leaves each vertex: the one with the smallest target, for a start that depends on nothing else
    for (uint32_t i = 0; i < p->half_count; i++) {
        number[i] = UINT32_MAX;
        p->ring_start[raw[i].origin + 1]++;
    }
    for (uint32_t v = 0; v < p->vertex_count; v++)
        p->ring_start[v + 1] += p->ring_start[v];
    uint32_t *first = p->loop; // borrowed until the loops are written: one entry a vertex
    for (uint32_t v = 0; v < p->vertex_count; v++)
        first[v] = UINT32_MAX;
    for (uint32_t i = 0; i < p->half_count; i++) {
        uint32_t v = raw[i].origin;
        if (first[v] == UINT32_MAX || raw[i].target < raw[first[v]].target)
            first[v] = i;
    }
    for (uint32_t v = 0; v < p->vertex_count; v++)
        for (uint32_t h = p->ring_start[v], i = first[v]; h < p->ring_start[v + 1]; h++, i = twin[raw[i].before])
            number[i] = h;
    for (uint32_t i = 0; i < p->half_count; i++) {
        uint32_t h = number[i];
        p->origin[h] = raw[i].origin;
        p->target[h] = raw[i].target;
        p->left[h] = raw[i].facet;
        p->twin[h] = number[twin[i]];
    }
}

/* Edges in the order of `sorted`, raw halfedges by (origin, target). */
static void number_edges(pir_polytope *p, const uint32_t *sorted, const uint32_t *number) {
    uint32_t edges = 0;
    for (uint32_t i = 0; i < p->half_count; i++) {
        uint32_t h = number[sorted[i]];
        if (p->origin[h] > p->target[h])
            continue;
        p->edge[h] = p->edge[p->twin[h]] = edges;
        p->edge_half[edges++] = h;
    }
}

static bool connect(pir_polytope *p, const pir_polytope_parts *parts) {
    const pir_allocator *a = &p->allocator;
    uint32_t h = p->half_count, points = parts->points->count;
    struct raw_half *raw = PIR_NEW(a, struct raw_half, h);
    uint32_t *work = PIR_NEW(a, uint32_t, (size_t)h * 5 + p->vertex_count + 1);
    uint32_t *vertex_number = PIR_NEW(a, uint32_t, points);
    bool done = raw && work && vertex_number;
    if (done) {
        for (uint32_t v = 0; v < p->vertex_count; v++)
            vertex_number[parts->vertices[v]] = v;
        list_raw(parts, vertex_number, raw);
        // sort both ways; position by position, the two lists are twins
        uint32_t *plain = work, *forth = work + h, *back = work + 2 * (size_t)h, *twin = work + 3 * (size_t)h;
        uint32_t *number = work + 4 * (size_t)h, *bucket = work + 5 * (size_t)h;
        for (uint32_t i = 0; i < h; i++)
            plain[i] = i;
        sort_by(raw, true, plain, h, bucket, p->vertex_count, number);
        sort_by(raw, false, number, h, bucket, p->vertex_count, forth);
        sort_by(raw, false, plain, h, bucket, p->vertex_count, number);
        sort_by(raw, true, number, h, bucket, p->vertex_count, back);
        for (uint32_t i = 0; i < h; i++)
            twin[forth[i]] = back[i];
        number_rings(p, raw, twin, number);
        number_edges(p, forth, number);
        for (uint32_t f = 0; f <= p->facet_count; f++)
            p->loop_start[f] = parts->facets->start[f];
        for (uint32_t i = 0; i < h; i++)
            p->loop[i] = number[i];
    }
    PIR_FREE(a, raw, h);
    PIR_FREE(a, work, (size_t)h * 5 + p->vertex_count + 1);
    PIR_FREE(a, vertex_number, points);
    return done;
}

/* A segment: two vertices, two facets across it, the ring of each vertex two halfedges. See polytope.h. */
static void connect_segment(pir_polytope *p) {
    static const uint32_t origin[4] = {0, 0, 1, 1}, twin[4] = {3, 2, 1, 0}, left[4] = {0, 1, 0, 1},
                          edge[4] = {0, 1, 1, 0};
    static const uint32_t loop[4] = {0, 2, 1, 3};
    p->artificial = true;
    for (uint32_t h = 0; h < 4; h++) {
        p->origin[h] = origin[h];
        p->target[h] = 1 - origin[h];
        p->twin[h] = twin[h];
        p->left[h] = left[h];
        p->edge[h] = edge[h];
        p->loop[h] = loop[h];
    }
    p->edge_half[0] = 0;
    p->edge_half[1] = 1;
    for (uint32_t i = 0; i < 3; i++)
        p->ring_start[i] = p->loop_start[i] = 2 * i;
}

/* Writes what follows from the halfedges, where traversals read it in order. */
static void list_neighbours(pir_polytope *p) {
    for (uint32_t i = 0; i < p->half_count; i++) {
        uint32_t half = p->loop[i], edge = p->edge[half];
        p->across[i] = (pir_across){pir_right(p, half), edge & INT32_MAX, p->edge_half[edge] == half};
    }
    for (uint32_t e = 0; e < p->edge_count; e++)
        p->arc_ends[e] = (pir_arc_ends){p->left[p->edge_half[e]], pir_right(p, p->edge_half[e])};
}

/* --- geometry --- */

/* A vector across a segment's edge e: (e_y, −e_x, 0), or (1, 0, 0) when that is zero. */
static void set_across(pir_vectors *normals, const pir_int3 *e, int sign) {
    mp_limb_t one_limb = 1;
    pir_int one = {&one_limb, sign, 0}, zero = {&one_limb, 0, 0};
    pir_int3 across = {{e->c[1], e->c[0], zero}};
    across.c[1].size = -across.c[1].size;
    if (pir_int3_is_zero(&across))
        across = (pir_int3){{one, zero, zero}};
    else if (sign < 0)
        for (int k = 0; k < 2; k++)
            pir_int_negate(&across.c[k]);
    pir_vectors_set(normals, sign > 0 ? 0 : 1, &across);
}

static bool set_vertices(pir_polytope *p, const pir_polytope_parts *parts) {
    const pir_allocator *a = &p->allocator;
    uint32_t longest = 1;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        pir_int3 x = pir_vectors_at(parts->points, parts->vertices[v]);
        uint32_t n = pir_int3_length(&x);
        longest = n > longest ? n : longest;
    }
    if (!pir_scale_copy(&p->scale, a, parts->scale) || !pir_vectors_init(&p->exact_vertex, a, p->vertex_count, longest))
        return false;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        pir_int3 x = pir_vectors_at(parts->points, parts->vertices[v]);
        pir_vectors_set(&p->exact_vertex, v, &x);
        p->source[v] = parts->vertices[v];
        if (parts->doubles) {
            // + 0.0 turns −0 into 0
            pir_vec3 d = parts->doubles[parts->vertices[v]];
            p->vertex[v] = (pir_vec3){d.x + 0.0, d.y + 0.0, d.z + 0.0};
        } else {
            p->vertex[v] = (pir_vec3){pir_scaled_nearest_double(&x.c[0], &p->scale.num, &p->scale.den),
                                      pir_scaled_nearest_double(&x.c[1], &p->scale.num, &p->scale.den),
                                      pir_scaled_nearest_double(&x.c[2], &p->scale.num, &p->scale.den)};
        }
    }
    return true;
}

/*
 * Whether edges and normals are to be divided by their common factors. Where the scale is the common denominator of
 * many rationals the vertices are long, but what an edge's components have in common is nearly all of their length:
 * divided, signs of s(n, e) stay cheap. Edges of doubles seldom take more limbs than this, and have little in common.
 */
static bool is_long(const pir_polytope *p) {
    return p->exact_vertex.stride >= 4;
}

/* Limbs that hold so many bits. */
static uint32_t limbs_of(uint32_t bits) {
    return (bits + GMP_NUMB_BITS - 1) / GMP_NUMB_BITS;
}

/*
 * The differences of vertices, which take one bit more than those: worked out in scratch, where a subtraction wants a
 * limb more, and kept in as many limbs as they can fill.
 */
static bool set_directions(pir_polytope *p, pir_limbs *scratch) {
    const pir_allocator *a = &p->allocator;
    if (!pir_vectors_init(&p->exact_edge, a, p->edge_count, limbs_of(pir_vectors_bits(&p->exact_vertex) + 1)))
        return false;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t h = p->edge_half[e], mark = scratch->used;
        pir_int3 from = pir_vertex_exact(p, p->origin[h]), to = pir_vertex_exact(p, p->target[h]);
        pir_int3 d = pir_int3_take(scratch, p->exact_vertex.stride + 1);
        for (int k = 0; k < 3; k++)
            pir_int_sub(&d.c[k], &to.c[k], &from.c[k]);
        pir_int3_strip(&d);
        pir_vectors_set(&p->exact_edge, e, &d);
        p->direction[h] = pir_int3_unit(&d);
        p->direction[p->twin[h]] = pir_vec_scale(p->direction[h], -1);
        scratch->used = mark;
    }
    return !is_long(p) || pir_vectors_reduce(&p->exact_edge, a);
}

/* Cross products of edges: a component is the difference of two products. */
static bool set_normals(pir_polytope *p, pir_limbs *scratch) {
    const pir_allocator *a = &p->allocator;
    if (!pir_vectors_init(&p->exact_normal, a, p->facet_count, limbs_of(2 * pir_vectors_bits(&p->exact_edge) + 1)))
        return false;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        // the first two sides of a facet turn left at an extreme corner: their cross product points outwards
        pir_int3 d = pir_half_exact(p, p->loop[p->loop_start[f]]), e = pir_half_exact(p, p->loop[p->loop_start[f] + 1]);
        uint32_t mark = scratch->used;
        if (p->artificial) {
            set_across(&p->exact_normal, &d, f == 0 ? 1 : -1);
        } else {
            pir_int3 n = pir_int3_take(scratch, 2 * p->exact_edge.stride + 1);
            pir_int3_cross(&n, &d, &e, scratch);
            pir_int3_strip(&n);
            pir_vectors_set(&p->exact_normal, f, &n);
        }
        pir_int3 n = pir_normal_exact(p, f);
        p->normal[f] = pir_int3_unit(&n);
        scratch->used = mark;
    }
    return !is_long(p) || pir_vectors_reduce(&p->exact_normal, a);
}

/* Edges and normals, in scratch that holds a cross product of edges and a product of two components. */
static bool set_vectors(pir_polytope *p) {
    uint32_t edge = p->exact_vertex.stride + 1, limbs = 3 * (2 * edge + 1) + 2 * edge;
    pir_limbs scratch = {PIR_NEW(&p->allocator, mp_limb_t, limbs), 0, limbs};
    bool done = scratch.base && set_directions(p, &scratch) && set_normals(p, &scratch);
    PIR_FREE(&p->allocator, scratch.base, limbs);
    return done;
}

/* Lays the directions of each ring and edge and the normals out for vector loops and walks, as floats. */
static bool set_floats(pir_polytope *p) {
    const pir_allocator *a = &p->allocator;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        const uint32_t h = p->edge_half[e];
        const pir_vec3 d = p->direction[h];
        p->edge_arc[e] =
            (pir_edge_arc){(float)d.x, (float)d.y, (float)d.z, h, p->arc_ends[e], p->origin[h], p->target[h]};
    }
    for (uint32_t f = 0; f < p->facet_count; f++) {
        const pir_vec3 n = p->normal[f];
        const float lanes[4] = {(float)n.x, (float)n.y, (float)n.z, 0};
        memcpy(p->normal4 + 4 * (size_t)f, lanes, sizeof lanes);
    }
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        uint32_t degree = p->ring_start[v + 1] - p->ring_start[v];
        p->ring_block[v + 1] = p->ring_block[v] + (degree + PIR_LANES - 1) / PIR_LANES;
    }
    p->ring_memory = pir_memory_lasting(a, ring_bytes(p));
    if (!p->ring_memory)
        return false;
    // a block is two lines of a cache, not parts of three
    p->ring = (pir_ring *)(void *)(p->ring_memory + -(uintptr_t)p->ring_memory % sizeof *p->ring);
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        uint32_t lanes = (p->ring_block[v + 1] - p->ring_block[v]) * PIR_LANES;
        for (uint32_t i = 0; i < lanes; i++) {
            uint32_t h = p->ring_start[v] + i < p->ring_start[v + 1] ? p->ring_start[v] + i : p->ring_start[v];
            pir_ring *block = &p->ring[p->ring_block[v] + i / PIR_LANES];
            block->x[i % PIR_LANES] = (float)p->direction[h].x;
            block->y[i % PIR_LANES] = (float)p->direction[h].y;
            block->z[i % PIR_LANES] = (float)p->direction[h].z;
            block->target[i % PIR_LANES] = p->target[h];
        }
    }
    return true;
}

/* --- making and releasing --- */

pir_status pir_polytope_build(const pir_polytope_parts *parts, const pir_allocator *allocator,
                              pir_polytope **ret_polytope) {
    pir_polytope *p = PIR_ZEROED(allocator, pir_polytope, 1);
    if (!p)
        return PIR_ERR_MEMORY;
    bool segment = parts->dimension == 1, point = parts->dimension == 0;
    atomic_init(&p->references, 1);
    p->allocator = *allocator;
    p->dimension = parts->dimension;
    p->vertex_count = parts->vertex_count;
    p->half_count = segment ? 4 : point ? 0 : pir_loops_corners(parts->facets);
    p->edge_count = p->half_count / 2;
    p->facet_count = segment ? 2 : point ? 0 : parts->facets->count;
    pir_layout layout = layout_of(p);
    bool done = pir_layout_new(allocator, &layout);
    if (done && segment)
        connect_segment(p);
    else if (done && !point)
        done = connect(p, parts);
    if (done)
        list_neighbours(p);
    if (!done || !pir_order_facets(p) || !set_vertices(p, parts) || !set_vectors(p) || !set_floats(p)) {
        destroy(p);
        return PIR_ERR_MEMORY;
    }
    *ret_polytope = p;
    return PIR_OK;
}

pir_status pir_polytope_build_hull(const pir_polytope_parts *parts, const pir_allocator *allocator,
                                   pir_polytope **ret_polytope) {
    pir_hull hull;
    pir_status status = pir_hull_make(parts->points, parts->doubles, allocator, &hull);
    if (status != PIR_OK)
        return status;
    pir_polytope_parts whole = *parts;
    whole.dimension = hull.dimension;
    whole.vertices = hull.vertices;
    whole.vertex_count = hull.vertex_count;
    whole.facets = &hull.facets;
    status = pir_polytope_build(&whole, allocator, ret_polytope);
    pir_hull_finish(&hull, allocator);
    return status;
}

pir_polytope *pir_polytope_retain(pir_polytope *polytope) {
    atomic_fetch_add_explicit(&polytope->references, 1, memory_order_relaxed);
    return polytope;
}

void pir_polytope_release(pir_polytope *polytope) {
    if (polytope && atomic_fetch_sub_explicit(&polytope->references, 1, memory_order_acq_rel) == 1)
        destroy(polytope);
}

/* --- reading --- */

static bool is_power_of_two(const pir_int *a) {
    return pir_int_sign(a) > 0 && pir_int_trailing_zeros(a) + 1 == pir_int_bits(a);
}

bool pir_vertex_is_double(const pir_polytope *p, uint32_t vertex, int k) {
    const pir_int3 exact = pir_vertex_exact(p, vertex);
    const double rounded[3] = {p->vertex[vertex].x, p->vertex[vertex].y, p->vertex[vertex].z};
    return exact.c[k].size == 0 ||
           (is_power_of_two(&p->scale.num) && is_power_of_two(&p->scale.den) && fabs(rounded[k]) > 0x1p-900 &&
            pir_int_bits(&exact.c[k]) - pir_int_trailing_zeros(&exact.c[k]) <= 53);
}
