/* SPDX-License-Identifier: MIT */
/*
 * The true sum as a mesh.
 *
 * A facet made of one piece is that piece's polygon. A facet made of several is the convex polygon that their corners span, found
 * exactly, straight corners dropped: an extreme point of the sum is the sum of just one pair of vertices, so pairs name
 * vertices. Vertices are numbered by rising pair, facets put in canonical order: the mesh depends on the true sum alone.
 */
#include "dymsum/sum_mesh.h"
#include "dymsum/pieces.h"
#include "dymsum/placing.h"
#include "polytope/hull.h"

#include <string.h>

/* The facets of the true sum as polygons of pairs. */
struct facets {
    uint32_t count, corner_count, capacity; /* capacity: of both arrays, in corners */
    uint32_t *start;
    pir_corner *corner;
};

/* A direction in which the group's polygon can be seen exactly: the axis dropped, and the sign of its plane's normal there. */
static int seen_axis(pir_sum *sum, uint32_t piece, int *ret_direction) {
    const pir_polytope *p = sum->p, *q = sum->q;
    pir_signs *signs = &sum->signs;
    uint32_t mark = signs->scratch.used;
    // the piece that stands for a group of several is a facet of P or Q: those come first
    pir_int3 n;
    if (piece < p->facet_count) {
        pir_int3 own = pir_normal_exact(p, piece);
        pir_rotation_make_exact(&signs->rotation);
        n = pir_int3_take(&signs->scratch, p->exact_normal.stride + PIR_MATRIX_LIMBS + 1);
        pir_rotation_apply(&signs->rotation, &n, &own, &signs->scratch);
    } else {
        PIR_ASSERT(piece < p->facet_count + q->facet_count);
        n = pir_normal_exact(q, piece - p->facet_count);
    }
    int axis = n.c[0].size != 0 ? 0 : n.c[1].size != 0 ? 1 : 2;
    *ret_direction = pir_int_sign(&n.c[axis]);
    signs->scratch.used = mark;
    return axis;
}

/* Reduces `count` corners at `corner` to those of the convex polygon they span; returns their number, 0 when out of memory. */
static uint32_t span_polygon(pir_placing *placing, const pir_allocator *a, int axis, int direction, pir_corner *corner,
                             uint32_t count) {
    pir_vectors exact = {0};
    pir_points points = {0};
    uint32_t *index = PIR_NEW(a, uint32_t, count);
    pir_corner *copy = PIR_NEW(a, pir_corner, count);
    uint32_t corners = 0;
    if (index && copy && pir_vectors_init(&exact, a, count, placing->stride)) {
        for (uint32_t i = 0; i < count; i++) {
            pir_placing_set(placing, corner[i].p, corner[i].q, &exact, i);
            index[i] = i;
            copy[i] = corner[i];
        }
        if (pir_points_init(&points, a, &exact))
            corners = pir_polygon_corners(&points, a, axis, direction, index, count);
        for (uint32_t i = 0; i < corners; i++)
            corner[i] = copy[index[i]];
    }
    pir_points_finish(&points, a);
    pir_vectors_finish(&exact, a);
    PIR_FREE(a, index, count);
    PIR_FREE(a, copy, count);
    return corners;
}

/* Appends the facet that the chain of pieces from `first` along `next` makes; a chain ends in PIR_DROPPED. */
static bool append_facet(struct facets *facets, pir_sum *sum, pir_placing *placing, const pir_pieces *pieces,
                         uint32_t first, const uint32_t *next) {
    uint32_t from = facets->corner_count, count = 0;
    for (uint32_t i = first; i != PIR_DROPPED; i = next[i]) {
        uint32_t n = pieces->start[i + 1] - pieces->start[i];
        memcpy(facets->corner + from + count, pieces->corner + pieces->start[i], n * sizeof *facets->corner);
        count += n;
    }
    if (next[first] != PIR_DROPPED) {
        int direction, axis = seen_axis(sum, first, &direction);
        count = span_polygon(placing, &sum->allocator, axis, direction, facets->corner + from, count);
        if (count == 0)
            return false;
    }
    facets->corner_count = from + count;
    facets->start[++facets->count] = facets->corner_count;
    return true;
}

/* All facets, from the pieces and their groups. */
static bool collect_facets(struct facets *facets, pir_sum *sum, pir_placing *placing, const pir_pieces *pieces) {
    const pir_allocator *a = &sum->allocator;
    facets->start = PIR_ZEROED(a, uint32_t, (size_t)pieces->count + 1);
    facets->corner = PIR_NEW(a, pir_corner, pieces->corner_count);
    facets->capacity = pieces->corner_count;
    uint32_t *next = PIR_NEW(a, uint32_t, pieces->count), *last = PIR_NEW(a, uint32_t, pieces->count);
    bool done = facets->start && facets->corner && next && last;
    // chain the pieces of each group in rising order
    for (uint32_t i = 0; done && i < pieces->count; i++) {
        uint32_t group = pieces->group[i];
        next[i] = PIR_DROPPED;
        if (group == PIR_DROPPED)
            continue;
        if (group != i)
            next[last[group]] = i;
        last[group] = i;
    }
    for (uint32_t i = 0; done && i < pieces->count; i++)
        if (pieces->group[i] == i)
            done = append_facet(facets, sum, placing, pieces, i, next);
    PIR_FREE(a, next, pieces->count);
    PIR_FREE(a, last, pieces->count);
    return done;
}

/* Sorts the corners' places by pair, by counting: first by q, then by p. `order` and `work` hold one entry a corner. */
static void sort_by_pair(const struct facets *facets, uint32_t *bucket, uint32_t p_count, uint32_t q_count,
                         uint32_t *work, uint32_t *order) {
    uint32_t n = facets->corner_count;
    memset(bucket, 0, ((size_t)q_count + 1) * sizeof *bucket);
    for (uint32_t i = 0; i < n; i++)
        bucket[facets->corner[i].q + 1]++;
    for (uint32_t v = 0; v < q_count; v++)
        bucket[v + 1] += bucket[v];
    for (uint32_t i = 0; i < n; i++)
        work[bucket[facets->corner[i].q]++] = i;
    memset(bucket, 0, ((size_t)p_count + 1) * sizeof *bucket);
    for (uint32_t i = 0; i < n; i++)
        bucket[facets->corner[i].p + 1]++;
    for (uint32_t v = 0; v < p_count; v++)
        bucket[v + 1] += bucket[v];
    for (uint32_t i = 0; i < n; i++)
        order[bucket[facets->corner[work[i]].p]++] = work[i];
}

static bool same_corner(pir_corner a, pir_corner b) {
    return a.p == b.p && a.q == b.q;
}

void pir_mesh_set_kinds(pir_mesh *mesh) {
    for (uint32_t f = 0; f < mesh->facets.count; f++) {
        const uint32_t *corner = mesh->facets.corner + mesh->facets.start[f];
        uint32_t n = mesh->facets.start[f + 1] - mesh->facets.start[f], p_steps = 0, q_steps = 0, both = 0;
        // how often each operand's vertex changes around the facet
        for (uint32_t i = 0; i < n; i++) {
            const uint32_t *a = mesh->pair[corner[i]], *b = mesh->pair[corner[(i + 1) % n]];
            p_steps += a[0] != b[0];
            q_steps += a[1] != b[1];
            both += a[0] != b[0] && a[1] != b[1];
        }
        bool parallelogram = n == 4 && p_steps == 2 && q_steps == 2 && both == 0;
        mesh->kind[f] = q_steps == 0    ? PIR_FACET_FV
                        : p_steps == 0  ? PIR_FACET_VF
                        : parallelogram ? PIR_FACET_EE
                                        : PIR_FACET_MERGED;
    }
}

/* The mesh of the facets: vertices numbered by rising pair. NULL when out of memory. */
static pir_mesh *number_vertices(const struct facets *facets, pir_sum *sum) {
    const pir_polytope *p = sum->p, *q = sum->q;
    const pir_allocator *a = &sum->allocator;
    uint32_t n = facets->corner_count,
             buckets = (p->vertex_count > q->vertex_count ? p->vertex_count : q->vertex_count) + 1;
    uint32_t *bucket = PIR_NEW(a, uint32_t, buckets), *work = PIR_NEW(a, uint32_t, n), *order = PIR_NEW(a, uint32_t, n);
    pir_mesh *mesh = NULL;
    if (bucket && work && order) {
        sort_by_pair(facets, bucket, p->vertex_count, q->vertex_count, work, order);
        uint32_t vertices = 0;
        for (uint32_t i = 0; i < n; i++) {
            bool is_new = i == 0 || !same_corner(facets->corner[order[i]], facets->corner[order[i - 1]]);
            vertices += is_new;
            work[order[i]] = vertices - 1;
        }
        mesh = pir_mesh_new(a, vertices, facets->count, n);
    }
    if (mesh) {
        for (uint32_t i = 0; i < n; i++) {
            pir_corner corner = facets->corner[i];
            uint32_t v = work[i];
            mesh->facets.corner[i] = v;
            mesh->pair[v][0] = corner.p;
            mesh->pair[v][1] = corner.q;
        }
        memcpy(mesh->facets.start, facets->start, ((size_t)facets->count + 1) * sizeof *facets->start);
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            mesh->vertex[v] = pir_place(&pir_rotation_now(sum)->r, p, q, mesh->pair[v][0], mesh->pair[v][1]);
        mesh->edge_count = n / 2;
        pir_mesh_set_kinds(mesh);
        if (!pir_loops_canonicalise(&mesh->facets, mesh->kind, a)) {
            pir_mesh_destroy(mesh);
            mesh = NULL;
        }
    }
    PIR_FREE(a, bucket, buckets);
    PIR_FREE(a, work, n);
    PIR_FREE(a, order, n);
    return mesh;
}

/* The mesh of the whole sum where a region leaves out a part: by a copy without one. */
static pir_status mesh_of_whole(const pir_sum *sum, pir_precision precision, pir_mesh **ret_mesh) {
    pir_sum *whole = NULL;
    pir_status status = pir_sum_clone(sum, NULL, &whole);
    if (status == PIR_OK)
        status = pir_sum_set_region(whole, sum->region.cone.axis, 4);
    if (status == PIR_OK)
        status = pir_sum_mesh(whole, precision, ret_mesh);
    pir_sum_destroy(whole);
    return status;
}

pir_status pir_sum_mesh(pir_sum *sum, pir_precision precision, pir_mesh **ret_mesh) {
    if (!sum || !ret_mesh || (precision != PIR_DOUBLE && precision != PIR_EXACT))
        return PIR_ERR_ARGUMENT;
    if (sum->region.cone.set)
        return mesh_of_whole(sum, precision, ret_mesh);
    const pir_allocator *a = &sum->allocator;
    struct facets facets = {0};
    pir_pieces pieces = {0};
    pir_placing placing = {0};
    pir_mesh *mesh = NULL;
    pir_status status = pir_pieces_make(&pieces, sum);
    if (status == PIR_OK && (pieces.merged || precision == PIR_EXACT))
        status = pir_placing_init(&placing, a, sum->p, sum->q, &sum->signs.rotation);
    if (status == PIR_OK && !collect_facets(&facets, sum, &placing, &pieces))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK && facets.count == 0) {
        // a point or a segment: nothing has area
        status = pir_hull_mesh(sum->p, sum->q, pir_rotation_now(sum), a, precision, &mesh);
    } else if (status == PIR_OK) {
        mesh = number_vertices(&facets, sum);
        // facets are told apart where the pairing is exact, vertices placed where the sum is seen
        if (mesh && precision == PIR_EXACT && sum->lag.lagging) {
            pir_placing_finish(&placing, a);
            status = pir_placing_init(&placing, a, sum->p, sum->q, &sum->lag.now);
        }
        if (!mesh || status != PIR_OK || (precision == PIR_EXACT && !pir_placing_fill(&placing, mesh)))
            status = PIR_ERR_MEMORY;
    }
    PIR_FREE(a, facets.start, (size_t)pieces.count + 1);
    PIR_FREE(a, facets.corner, facets.capacity);
    pir_placing_finish(&placing, a);
    pir_pieces_finish(&pieces, a);
    if (status == PIR_OK)
        *ret_mesh = mesh;
    else
        pir_mesh_destroy(mesh);
    return status;
}
