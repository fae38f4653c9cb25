/* SPDX-License-Identifier: MIT */
/*
 * From a map back to the polytope or sum: every cell is a vertex, every real vertex a facet, whose corners are the
 * cells around it.
 *
 * A cell may be cut by cube edges; its faces carry the same vertices of the sources, and no other cell does, since an
 * extreme point of a sum is the sum of just one choice of vertices. So faces sorted by what they carry number the
 * mesh's vertices, in rising order.
 */
#include "cgm/place.h"
#include "polytope/mesh.h"

#include <string.h>

/* Faces of the six maps but for the outer ones, sorted by the vertices they carry: by counting, from the
   last source to the first. */
static bool sort_faces(const pir_cgm *cgm, uint32_t *face, uint32_t *ret_count) {
    const pir_allocator *a = &cgm->allocator;
    uint32_t count = 0, buckets = 0;
    for (uint32_t map = 0; map < 6; map++)
        for (uint32_t f = cgm->face_start[map] + 1; f < cgm->face_start[map + 1]; f++)
            face[count++] = f;
    for (uint32_t s = 0; s < cgm->source_count; s++)
        if (cgm->source[s].polytope->vertex_count > buckets)
            buckets = cgm->source[s].polytope->vertex_count;
    uint32_t *bucket = PIR_NEW(a, uint32_t, (size_t)buckets + 1), *sorted = PIR_NEW(a, uint32_t, count);
    bool done = bucket && sorted;
    for (uint32_t s = cgm->source_count; s-- > 0 && done;) {
        memset(bucket, 0, ((size_t)buckets + 1) * sizeof *bucket);
        for (uint32_t i = 0; i < count; i++)
            bucket[pir_cgm_source_vertex(cgm, face[i], s) + 1]++;
        for (uint32_t i = 0; i < buckets; i++)
            bucket[i + 1] += bucket[i];
        for (uint32_t i = 0; i < count; i++)
            sorted[bucket[pir_cgm_source_vertex(cgm, face[i], s)]++] = face[i];
        memcpy(face, sorted, count * sizeof *face);
    }
    PIR_FREE(a, bucket, (size_t)buckets + 1);
    PIR_FREE(a, sorted, count);
    *ret_count = count;
    return done;
}

/* Whether v stands for a facet, and is the one of its copies that speaks for it. */
static bool is_facet(const pir_cgm *cgm, uint32_t v) {
    if (!cgm->vertex[v].real)
        return false;
    for (uint32_t copy = cgm->vertex[v].copy; copy != v; copy = cgm->vertex[copy].copy)
        if (copy < v)
            return false;
    return true;
}

/* The cells around v, counter-clockwise, as mesh vertices, into `corner`; their number. `number` holds each face's. */
static uint32_t list_corners(const pir_cgm *cgm, uint32_t v, const uint32_t *number, uint32_t *corner) {
    struct pir_cgm_around around = pir_cgm_around_new(cgm, v);
    uint32_t count = 0;
    do {
        uint32_t cell = number[cgm->half[around.half].face];
        if (count == 0 || corner[count - 1] != cell)
            corner[count++] = cell;
    } while (pir_cgm_around_next(cgm, &around));
    if (count > 1 && corner[0] == corner[count - 1])
        count--;
    for (uint32_t i = 0; i < count / 2; i++) {
        uint32_t other = corner[i];
        corner[i] = corner[count - 1 - i];
        corner[count - 1 - i] = other;
    }
    return count;
}

/* Which of the first two sources a facet comes from: whose vertex changes from corner to corner. */
static pir_facet_kind kind_of(const pir_mesh *mesh, const uint32_t *corner, uint32_t count) {
    uint32_t steps[2] = {0, 0}, both = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *from = mesh->pair[corner[i]], *to = mesh->pair[corner[(i + 1) % count]];
        steps[0] += from[0] != to[0];
        steps[1] += from[1] != to[1];
        both += from[0] != to[0] && from[1] != to[1];
    }
    if (steps[1] == 0)
        return PIR_FACET_FV;
    if (steps[0] == 0)
        return PIR_FACET_VF;
    return count == 4 && steps[0] == 2 && steps[1] == 2 && both == 0 ? PIR_FACET_EE : PIR_FACET_MERGED;
}

static void fill_facets(const pir_cgm *cgm, pir_mesh *mesh, const uint32_t *number) {
    uint32_t at = 0, facet = 0;
    for (uint32_t v = 0; v < pir_cgm_vertices(cgm); v++) {
        if (!is_facet(cgm, v))
            continue;
        uint32_t count = list_corners(cgm, v, number, mesh->facets.corner + at);
        mesh->kind[facet] = (uint8_t)kind_of(mesh, mesh->facets.corner + at, count);
        at += count;
        mesh->facets.start[++facet] = at;
    }
    mesh->edge_count = facet > 0 ? at / 2 : mesh->vertex_count - 1;
}

/* The mesh's facets, and room for their corners: around a vertex there are at most as many cells as halfedges. */
static void count_facets(const pir_cgm *cgm, uint32_t *ret_facets, uint32_t *ret_corners) {
    uint32_t facets = 0, corners = 0;
    for (uint32_t v = 0; v < pir_cgm_vertices(cgm); v++) {
        if (!is_facet(cgm, v))
            continue;
        facets++;
        struct pir_cgm_around around = pir_cgm_around_new(cgm, v);
        do
            corners++;
        while (pir_cgm_around_next(cgm, &around));
    }
    *ret_facets = facets;
    *ret_corners = corners;
}

/* The mesh without coordinates; `face` lists sorted faces, `number` is filled. NULL when out of memory. */
static pir_mesh *make_mesh(const pir_cgm *cgm, const uint32_t *face, uint32_t faces, uint32_t *number) {
    uint32_t vertices = 0, facets, corners;
    for (uint32_t i = 0; i < faces; i++) {
        vertices += i == 0 || !pir_cgm_same_cell(cgm, face[i], face[i - 1]);
        number[face[i]] = vertices - 1;
    }
    count_facets(cgm, &facets, &corners);
    pir_mesh *mesh = pir_mesh_new(&cgm->allocator, vertices, facets, corners);
    if (!mesh)
        return NULL;
    for (uint32_t i = 0; i < faces; i++) {
        uint32_t v = number[face[i]];
        mesh->pair[v][0] = pir_cgm_source_vertex(cgm, face[i], 0);
        mesh->pair[v][1] = cgm->source_count > 1 ? pir_cgm_source_vertex(cgm, face[i], 1) : 0;
        mesh->vertex[v] = pir_cgm_place_near(cgm, face[i]);
    }
    fill_facets(cgm, mesh, number);
    if (pir_loops_canonicalise(&mesh->facets, mesh->kind, &cgm->allocator))
        return mesh;
    pir_mesh_destroy(mesh);
    return NULL;
}

/* Exact coordinates beside the doubles. */
static bool fill_exact(const pir_cgm *cgm, pir_mesh *mesh, const uint32_t *face, uint32_t faces,
                       const uint32_t *number) {
    struct pir_cgm_places places;
    if (!pir_cgm_places_init(&places, cgm))
        return false;
    bool done = pir_vectors_init(&mesh->where, &mesh->allocator, mesh->vertex_count, places.stride) &&
                pir_scale_copy(&mesh->scale, &mesh->allocator, &places.scale);
    for (uint32_t i = 0; i < faces && done; i++) {
        if (i > 0 && number[face[i]] == number[face[i - 1]])
            continue;
        pir_int3 to = pir_vectors_at(&mesh->where, number[face[i]]);
        pir_cgm_place_exact(&places, face[i], &to);
        pir_vectors_put(&mesh->where, number[face[i]], &to);
    }
    mesh->exact = done;
    pir_cgm_places_finish(&places);
    return done;
}

pir_status pir_cgm_mesh(const pir_cgm *cgm, pir_precision precision, pir_mesh **ret_mesh) {
    if (!cgm || !ret_mesh || (precision != PIR_DOUBLE && precision != PIR_EXACT))
        return PIR_ERR_ARGUMENT;
    const pir_allocator *a = &cgm->allocator;
    uint32_t faces = pir_cgm_faces(cgm), count = 0;
    uint32_t *face = PIR_NEW(a, uint32_t, faces), *number = PIR_NEW(a, uint32_t, faces);
    pir_mesh *mesh = NULL;
    if (face && number && sort_faces(cgm, face, &count))
        mesh = make_mesh(cgm, face, count, number);
    if (mesh && precision == PIR_EXACT && !fill_exact(cgm, mesh, face, count, number)) {
        pir_mesh_destroy(mesh);
        mesh = NULL;
    }
    PIR_FREE(a, face, faces);
    PIR_FREE(a, number, faces);
    if (!mesh)
        return PIR_ERR_MEMORY;
    *ret_mesh = mesh;
    return PIR_OK;
}
