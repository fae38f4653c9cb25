/* SPDX-License-Identifier: MIT */
/*
 * The true sum as a mesh.
 *
 * A facet made of one piece is that piece's polygon. A facet made of several is the sum of two faces, merged side by
 * side without its pieces. An extreme point of the sum is the sum of just one pair of vertices, so pairs name vertices.
 * Vertices are numbered by rising pair and facets are in canonical order: the mesh depends on the true sum alone.
 *
 * Beside the mesh itself, memory holds a bit for each crossing and the facets of the true sum. A sum of many ties has
 * few facets.
 */
#include "dymsum/mesh/sum_mesh.h"

#include "base/layout.h"
#include "dymsum/mesh/face_sum.h"
#include "dymsum/mesh/pieces.h"
#include "dymsum/mesh/placing.h"

#include <string.h>

/* The facets of the true sum as polygons of pairs. */
struct facets {
    uint32_t count, corner_count; /* so far */
    uint32_t facet_room, corner_room;
    uint32_t *start;
    pir_sum_corner *corner;
};

static pir_layout layout_of(struct facets *facets) {
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

/*
 * Room for all facets; of two facets that make one the second is not counted. PIR_ERR_MEMORY, or PIR_ERR_LIMIT beyond
 * 2^32 corners.
 */
static pir_status reserve_facets(struct facets *facets, const pir_posed *posed, const pir_sum_pieces *pieces) {
    const pir_polytope *p = posed->pairing->p, *q = posed->pairing->q;
    uint64_t count = pieces->alone_count, corners = 4 * (uint64_t)pieces->alone_count;
    for (uint32_t f = 0; f < p->facet_count && !p->artificial; f++, count++)
        corners += corner_bound(p, f, q, pieces->of_p[f]);
    for (uint32_t g = 0; g < q->facet_count && !q->artificial; g++)
        if (pieces->of_q[g].facet == PIR_NO_FACE) {
            count++;
            corners += corner_bound(q, g, p, pieces->of_q[g]);
        }
    if (corners > UINT32_MAX)
        return PIR_ERR_LIMIT;
    facets->facet_room = (uint32_t)count;
    facets->corner_room = (uint32_t)corners;
    pir_layout layout = layout_of(facets);
    return pir_layout_new(&posed->pairing->allocator, &layout) ? PIR_OK : PIR_ERR_MEMORY;
}

static void free_facets(struct facets *facets, const pir_allocator *a) {
    pir_layout layout = layout_of(facets);
    pir_layout_free(a, &layout);
    *facets = (struct facets){0};
}

/* Where the corners of the next facet go, and the end of that facet. */
static pir_sum_corner *next_facet(const struct facets *facets) {
    return facets->corner + facets->corner_count;
}

static void end_facet(struct facets *facets, uint32_t corners) {
    facets->corner_count += corners;
    facets->start[++facets->count] = facets->corner_count;
}

/* Appends the facet that facet f of P is or is part of. */
static void append_facet_of_p(struct facets *facets, const pir_posed *posed, const pir_sum_pieces *pieces, uint32_t f) {
    const pir_polytope *p = posed->pairing->p, *q = posed->pairing->q;
    pir_face_edges own = pir_facet_edges(p, f);
    pir_sum_corner *corner = next_facet(facets);
    pir_sum_face face = pieces->of_p[f];
    uint32_t count = own.count;
    if (face.facet != PIR_NO_FACE || face.half != PIR_NO_FACE) {
        const uint32_t sides[2] = {face.half, q->twin[face.half]};
        pir_face_edges other = face.facet != PIR_NO_FACE ? pir_facet_edges(q, face.facet) : (pir_face_edges){sides, 2};
        count = pir_face_sum(posed, own, other, (pir_facet_of){true, f}, corner);
    } else {
        for (uint32_t i = 0; i < count; i++)
            corner[i] = (pir_sum_corner){p->origin[own.half[i]], posed->pairing->fv[f]};
    }
    end_facet(facets, count);
}

/* Appends the facet that facet g of Q is or is part of, where that is no facet of P as well. */
static void append_facet_of_q(struct facets *facets, const pir_posed *posed, const pir_sum_pieces *pieces, uint32_t g) {
    const pir_polytope *p = posed->pairing->p, *q = posed->pairing->q;
    pir_face_edges own = pir_facet_edges(q, g);
    pir_sum_corner *corner = next_facet(facets);
    pir_sum_face face = pieces->of_q[g];
    uint32_t count = own.count;
    if (face.half != PIR_NO_FACE) {
        const uint32_t sides[2] = {face.half, p->twin[face.half]};
        count = pir_face_sum(posed, (pir_face_edges){sides, 2}, own, (pir_facet_of){false, g}, corner);
    } else {
        for (uint32_t i = 0; i < count; i++)
            corner[i] = (pir_sum_corner){posed->pairing->vf[g], q->origin[own.half[i]]};
    }
    end_facet(facets, count);
}

/* Appends the parallelogram of a crossing: its outward normal is d × e. */
static void append_crossing(struct facets *facets, const pir_posed *posed, uint32_t slot) {
    const pir_pairing *pairing = posed->pairing;
    const pir_polytope *p = pairing->p, *q = pairing->q;
    uint32_t half = p->edge_half[pir_crossing_edge(pairing, slot)], h = pir_crossing_half(pairing, slot);
    uint32_t p0 = p->origin[half], p1 = p->target[half], q0 = q->origin[h], q1 = q->target[h];
    pir_sum_corner *corner = next_facet(facets);
    corner[0] = (pir_sum_corner){p0, q0};
    corner[1] = (pir_sum_corner){p0, q1};
    corner[2] = (pir_sum_corner){p1, q1};
    corner[3] = (pir_sum_corner){p1, q0};
    end_facet(facets, 4);
}

/* All facets of the true sum; errors as reserve_facets. */
static pir_status collect_facets(struct facets *facets, const pir_posed *posed) {
    const pir_polytope *p = posed->pairing->p, *q = posed->pairing->q;
    pir_sum_pieces pieces;
    pir_status status = pir_pieces_make(&pieces, posed);
    if (status != PIR_OK)
        return status;
    status = reserve_facets(facets, posed, &pieces);
    bool done = status == PIR_OK;
    for (uint32_t f = 0; done && f < p->facet_count && !p->artificial; f++)
        append_facet_of_p(facets, posed, &pieces, f);
    for (uint32_t g = 0; done && g < q->facet_count && !q->artificial; g++)
        if (pieces.of_q[g].facet == PIR_NO_FACE)
            append_facet_of_q(facets, posed, &pieces, g);
    for (uint32_t slot = 0; done && slot < posed->pairing->crossings.used; slot++)
        if (pir_piece_is_alone(&pieces, slot))
            append_crossing(facets, posed, slot);
    pir_pieces_finish(&pieces, posed);
    return status;
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
static pir_mesh *number_vertices(const struct facets *facets, const pir_sum *sum) {
    const pir_pairing *pairing = pir_sum_pairing(sum);
    const pir_polytope *p = pairing->p, *q = pairing->q;
    const pir_allocator *a = &pairing->allocator;
    const pir_mat3 *r = &pir_sum_shown_rotation(sum)->r;
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

/* The mesh of the whole sum where a region leaves out a part: by a copy without one. */
static pir_status mesh_of_whole(const pir_sum *sum, pir_precision precision, pir_mesh **ret_mesh) {
    pir_sum *whole = NULL;
    pir_status status = pir_sum_clone(sum, NULL, &whole);
    if (status == PIR_OK)
        status = pir_sum_clear_region(whole);
    if (status == PIR_OK)
        status = pir_sum_mesh(whole, precision, ret_mesh);
    pir_sum_destroy(whole);
    return status;
}

/* The facets as a mesh, its vertices placed exactly as well where that is asked for. */
static pir_status mesh_of_facets(const struct facets *facets, const pir_sum *sum, pir_precision precision,
                                 pir_mesh **ret_mesh) {
    const pir_pairing *pairing = pir_sum_pairing(sum);
    const pir_allocator *a = &pairing->allocator;
    pir_mesh *mesh = number_vertices(facets, sum);
    pir_status status = mesh ? PIR_OK : PIR_ERR_MEMORY;
    if (mesh && precision == PIR_EXACT) {
        // facets are told apart where the pairing is exact, vertices placed at the rotation that is shown
        pir_placing placing;
        status = pir_placing_init(&placing, a, pairing->p, pairing->q, pir_sum_shown_rotation(sum));
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

/* The facets of the true sum, from its pairing; errors as reserve_facets. */
static pir_status find_facets(struct facets *facets, pir_sum *sum) {
    const pir_pairing *pairing = pir_sum_pairing(sum);
    const pir_polytope *p = pairing->p;
    pir_posed posed = {pairing, pir_sum_signs(sum), PIR_NEW(&pairing->allocator, pir_vec3, p->facet_count)};
    if (!posed.normal)
        return PIR_ERR_MEMORY;
    for (uint32_t f = 0; f < p->facet_count; f++)
        posed.normal[f] = pir_mat_apply(&posed.signs->rotation.r, p->normal[f]);
    pir_status status = collect_facets(facets, &posed);
    PIR_FREE(&pairing->allocator, posed.normal, p->facet_count);
    return status;
}

pir_status pir_sum_mesh(pir_sum *sum, pir_precision precision, pir_mesh **ret_mesh) {
    if (!sum || !ret_mesh || (precision != PIR_DOUBLE && precision != PIR_EXACT))
        return PIR_ERR_ARGUMENT;
    if (pir_sum_cone(sum)->set)
        return mesh_of_whole(sum, precision, ret_mesh);
    const pir_pairing *pairing = pir_sum_pairing(sum);
    const pir_allocator *a = &pairing->allocator;
    struct facets facets = {0};
    pir_status status = find_facets(&facets, sum);
    // where nothing has area the sum is a point or a segment
    if (status == PIR_OK && facets.count == 0)
        status = pir_hull_mesh(pairing->p, pairing->q, pir_sum_shown_rotation(sum), a, precision, ret_mesh);
    else if (status == PIR_OK)
        status = mesh_of_facets(&facets, sum, precision, ret_mesh);
    free_facets(&facets, a);
    return status;
}
