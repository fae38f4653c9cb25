/* SPDX-License-Identifier: MIT */
/*
 * The facets of a true sum, and the mesh that they make.
 *
 * A facet made of one piece is that piece's polygon. A facet made of several is the sum of two faces, merged side by
 * side without its pieces. An extreme point of the sum is the sum of just one pair of vertices, so pairs name vertices.
 * Vertices are numbered by rising pair and facets are in canonical order: the mesh depends on the true sum alone.
 */
#include "dymsum/mesh/facet_list.h"

#include <string.h>

#include "base/layout.h"
#include "dymsum/mesh/placing.h"
#include "dymsum/mesh/sum_mesh.h"

static pir_layout layout_of(pir_facet_list *facets) {
    return (pir_layout){
        {PIR_ROW(facets->start, (size_t)facets->facet_room + 1), PIR_ROW(facets->corner, facets->corner_room)}};
}

/* An upper bound of the corners of a facet of one operand plus the face of the other in its direction. */
static uint32_t corner_bound(const pir_polytope *of, uint32_t facet, const pir_polytope *other, pir_sum_face face) {
    uint32_t own = pir_facet_edges(of, facet).count;
    if (face.facet != PIR_NO_FACE)
        return own + pir_facet_edges(other, face.facet).count;
    return face.half != PIR_NO_FACE ? own + 2 : own;
}

/* Room for all facets; of two facets that make one the second is not counted. */
static pir_status reserve_facets(pir_facet_list *facets, const pir_allocator *a, const pir_sum_faces *faces,
                                 uint32_t crossings) {
    const pir_polytope *p = faces->posed->p, *q = faces->posed->q;
    uint64_t count = crossings, corners = 4 * (uint64_t)crossings;
    for (uint32_t f = 0; f < p->facet_count && !p->artificial; f++, count++)
        corners += corner_bound(p, f, q, faces->of_p[f]);
    for (uint32_t g = 0; g < q->facet_count && !q->artificial; g++)
        if (faces->of_q[g].facet == PIR_NO_FACE) {
            count++;
            corners += corner_bound(q, g, p, faces->of_q[g]);
        }
    if (corners > UINT32_MAX)
        return PIR_ERR_LIMIT;
    facets->facet_room = (uint32_t)count;
    facets->corner_room = (uint32_t)corners;
    pir_layout layout = layout_of(facets);
    return pir_layout_new(a, &layout) ? PIR_OK : PIR_ERR_MEMORY;
}

void pir_facet_list_finish(pir_facet_list *facets, const pir_allocator *a) {
    pir_layout layout = layout_of(facets);
    pir_layout_free(a, &layout);
    *facets = (pir_facet_list){0};
}

/* Where the corners of the next facet go, and the end of that facet. */
static pir_sum_corner *next_facet(const pir_facet_list *facets) {
    return facets->corner + facets->corner_count;
}

static void end_facet(pir_facet_list *facets, uint32_t corners) {
    facets->corner_count += corners;
    facets->start[++facets->count] = facets->corner_count;
}

/* Appends the facet that facet f of P is or is part of. */
static void append_facet_of_p(pir_facet_list *facets, const pir_sum_faces *faces, uint32_t f) {
    const pir_polytope *p = faces->posed->p, *q = faces->posed->q;
    pir_face_edges own = pir_facet_edges(p, f);
    pir_sum_corner *corner = next_facet(facets);
    pir_sum_face face = faces->of_p[f];
    uint32_t count = own.count;
    if (face.facet != PIR_NO_FACE) {
        count = pir_face_sum(faces->posed, own, pir_facet_edges(q, face.facet), (pir_facet_of){true, f}, corner);
    } else if (face.half != PIR_NO_FACE) {
        const uint32_t sides[2] = {face.half, q->twin[face.half]};
        count = pir_face_sum(faces->posed, own, (pir_face_edges){sides, 2}, (pir_facet_of){true, f}, corner);
    } else {
        for (uint32_t i = 0; i < count; i++)
            corner[i] = (pir_sum_corner){p->origin[own.half[i]], faces->fv[f]};
    }
    end_facet(facets, count);
}

/* Appends the facet that facet g of Q is or is part of, where that is no facet of P as well. */
static void append_facet_of_q(pir_facet_list *facets, const pir_sum_faces *faces, uint32_t g) {
    const pir_polytope *p = faces->posed->p, *q = faces->posed->q;
    pir_face_edges own = pir_facet_edges(q, g);
    pir_sum_corner *corner = next_facet(facets);
    pir_sum_face face = faces->of_q[g];
    uint32_t count = own.count;
    if (face.half != PIR_NO_FACE) {
        const uint32_t sides[2] = {face.half, p->twin[face.half]};
        count = pir_face_sum(faces->posed, (pir_face_edges){sides, 2}, own, (pir_facet_of){false, g}, corner);
    } else {
        for (uint32_t i = 0; i < count; i++)
            corner[i] = (pir_sum_corner){faces->vf[g], q->origin[own.half[i]]};
    }
    end_facet(facets, count);
}

void pir_facet_list_add_crossing(pir_facet_list *facets, const pir_posed *posed, uint32_t half, uint32_t h) {
    const pir_polytope *p = posed->p, *q = posed->q;
    uint32_t p0 = p->origin[half], p1 = p->target[half], q0 = q->origin[h], q1 = q->target[h];
    pir_sum_corner *corner = next_facet(facets);
    // the outward normal is d × e
    corner[0] = (pir_sum_corner){p0, q0};
    corner[1] = (pir_sum_corner){p0, q1};
    corner[2] = (pir_sum_corner){p1, q1};
    corner[3] = (pir_sum_corner){p1, q0};
    end_facet(facets, 4);
}

pir_status pir_facet_list_begin(pir_facet_list *facets, const pir_allocator *a, const pir_sum_faces *faces,
                                uint32_t crossings) {
    const pir_polytope *p = faces->posed->p, *q = faces->posed->q;
    pir_status status = reserve_facets(facets, a, faces, crossings);
    bool done = status == PIR_OK;
    for (uint32_t f = 0; done && f < p->facet_count && !p->artificial; f++)
        append_facet_of_p(facets, faces, f);
    for (uint32_t g = 0; done && g < q->facet_count && !q->artificial; g++)
        if (faces->of_q[g].facet == PIR_NO_FACE)
            append_facet_of_q(facets, faces, g);
    return status;
}

/* Sorts the corners' places by pair, by counting: first by q, then by p. `order` and `work` hold one entry a corner. */
static void sort_by_pair(const pir_facet_list *facets, uint32_t *bucket, uint32_t p_count, uint32_t q_count,
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

static bool same_corner(pir_sum_corner a, pir_sum_corner b) {
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
static pir_mesh *number_vertices(const pir_facet_list *facets, const pir_allocator *a, const pir_polytope *p,
                                 const pir_polytope *q, const pir_mat3 *r) {
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
            pir_sum_corner corner = facets->corner[i];
            uint32_t v = work[i];
            mesh->facets.corner[i] = v;
            mesh->pair[v][0] = corner.p;
            mesh->pair[v][1] = corner.q;
        }
        memcpy(mesh->facets.start, facets->start, ((size_t)facets->count + 1) * sizeof *facets->start);
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            mesh->vertex[v] = pir_place(r, p, q, mesh->pair[v][0], mesh->pair[v][1]);
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

pir_status pir_facet_list_mesh(const pir_facet_list *facets, const pir_allocator *a, const pir_posed *posed,
                               pir_rotation *shown, pir_precision precision, pir_mesh **ret_mesh) {
    pir_mesh *mesh = number_vertices(facets, a, posed->p, posed->q, &shown->r);
    pir_status status = mesh ? PIR_OK : PIR_ERR_MEMORY;
    if (mesh && precision == PIR_EXACT) {
        pir_placing placing;
        status = pir_placing_init(&placing, a, posed->p, posed->q, shown);
        if (status == PIR_OK) {
            status = pir_placing_fill(&placing, mesh) ? PIR_OK : PIR_ERR_MEMORY;
            pir_placing_finish(&placing, a);
        }
    }
    if (status == PIR_OK)
        *ret_mesh = mesh;
    else
        pir_mesh_destroy(mesh);
    return status;
}
