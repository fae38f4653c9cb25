/* SPDX-License-Identifier: MIT */
/* Meshes: what a caller sees of a polytope or a sum. The canonical order is the business of whoever fills one. */
#include "polytope/mesh.h"

#include <string.h>

#include <pirouette/exact.h>

#include "polytope/polytope.h"

pir_mesh *pir_mesh_new(const pir_allocator *allocator, uint32_t vertices, uint32_t facets, uint32_t corners) {
    pir_mesh *mesh = PIR_ZEROED(allocator, pir_mesh, 1);
    if (!mesh)
        return NULL;
    mesh->allocator = *allocator;
    mesh->vertex_count = vertices;
    mesh->corners = corners;
    mesh->vertex = PIR_NEW(allocator, pir_vec3, vertices);
    mesh->pair = pir_memory_new(allocator, vertices, sizeof *mesh->pair);
    bool loops = pir_loops_init(&mesh->facets, allocator, facets, corners);
    if (loops)
        mesh->kind = PIR_ZEROED(allocator, uint8_t, facets);
    if (mesh->vertex && mesh->pair && mesh->kind)
        return mesh;
    pir_mesh_destroy(mesh);
    return NULL;
}

void pir_mesh_destroy(pir_mesh *mesh) {
    if (!mesh)
        return;
    const pir_allocator allocator = mesh->allocator, *a = &allocator;
    PIR_FREE(a, mesh->vertex, mesh->vertex_count);
    PIR_FREE(a, mesh->pair, mesh->vertex_count);
    PIR_FREE(a, mesh->kind, mesh->facets.count);
    PIR_FREE(a, mesh->segment, 2 * (size_t)mesh->segment_count);
    PIR_FREE(a, mesh->point, mesh->point_count);
    pir_loops_finish(&mesh->facets, a, mesh->corners);
    pir_vectors_finish(&mesh->where, a);
    pir_vectors_finish(&mesh->weight, a);
    pir_scale_finish(&mesh->scale, a);
    PIR_FREE(a, mesh, 1);
}

pir_status pir_mesh_from_polytope(const pir_polytope *p, pir_mesh **ret_mesh) {
    if (!p || !ret_mesh)
        return PIR_ERR_ARGUMENT;
    const pir_allocator *a = &p->allocator;
    uint32_t facets = pir_polytope_facet_count(p), corners = p->artificial ? 0 : p->half_count;
    pir_mesh *mesh = pir_mesh_new(a, p->vertex_count, facets, corners);
    if (!mesh)
        return PIR_ERR_MEMORY;
    mesh->edge_count = pir_polytope_edge_count(p);
    if (!pir_vectors_init(&mesh->where, a, p->vertex_count, p->exact_vertex.stride) ||
        !pir_scale_copy(&mesh->scale, a, &p->scale))
        goto fail;
    mesh->exact = true;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        pir_int3 x = pir_vertex_exact(p, v);
        pir_vectors_set(&mesh->where, v, &x);
        mesh->vertex[v] = p->vertex[v];
        mesh->pair[v][0] = v;
        mesh->pair[v][1] = 0;
    }
    for (uint32_t f = 0; f < facets; f++) {
        pir_polytope_facet(p, f, mesh->facets.corner + p->loop_start[f]);
        mesh->facets.start[f + 1] = p->loop_start[f + 1];
    }
    if (!pir_loops_canonicalise(&mesh->facets, mesh->kind, a))
        goto fail;
    *ret_mesh = mesh;
    return PIR_OK;
fail:
    pir_mesh_destroy(mesh);
    return PIR_ERR_MEMORY;
}

uint32_t pir_mesh_vertex_count(const pir_mesh *mesh) {
    return mesh->vertex_count;
}

uint32_t pir_mesh_edge_count(const pir_mesh *mesh) {
    return mesh->edge_count;
}

uint32_t pir_mesh_facet_count(const pir_mesh *mesh) {
    return mesh->facets.count;
}

const pir_vec3 *pir_mesh_vertices(const pir_mesh *mesh) {
    return mesh->vertex;
}

void pir_mesh_pair(const pir_mesh *mesh, uint32_t vertex, uint32_t ret_pair[2]) {
    ret_pair[0] = mesh->pair[vertex][0];
    ret_pair[1] = mesh->pair[vertex][1];
}

const uint32_t *pir_mesh_facet(const pir_mesh *mesh, uint32_t facet, uint32_t *ret_count) {
    *ret_count = mesh->facets.start[facet + 1] - mesh->facets.start[facet];
    return mesh->facets.corner + mesh->facets.start[facet];
}

pir_facet_kind pir_mesh_facet_kind(const pir_mesh *mesh, uint32_t facet) {
    return (pir_facet_kind)mesh->kind[facet];
}

const uint32_t *pir_mesh_segments(const pir_mesh *mesh, uint32_t *ret_count) {
    *ret_count = mesh->segment_count;
    return mesh->segment;
}

const uint32_t *pir_mesh_points(const pir_mesh *mesh, uint32_t *ret_count) {
    *ret_count = mesh->point_count;
    return mesh->point;
}

bool pir_mesh_is_exact(const pir_mesh *mesh) {
    return mesh->exact;
}

pir_status pir_mesh_vertex_exact(const pir_mesh *mesh, uint32_t vertex, mpq_t ret_coordinates[3]) {
    if (!mesh || !mesh->exact || vertex >= mesh->vertex_count)
        return PIR_ERR_ARGUMENT;
    pir_int3 v = pir_vectors_at(&mesh->where, vertex);
    for (int k = 0; k < 3; k++)
        pir_scale_to_rational(ret_coordinates[k], &v.c[k], &mesh->scale);
    if (mesh->weight.count > 0) {
        const pir_int weight = pir_vectors_at(&mesh->weight, vertex).c[0];
        mpz_t view;
        mpz_roinit_n(view, weight.limb, weight.size);
        for (int k = 0; k < 3; k++) {
            mpz_mul(mpq_denref(ret_coordinates[k]), mpq_denref(ret_coordinates[k]), view);
            mpq_canonicalize(ret_coordinates[k]);
        }
    }
    return PIR_OK;
}

bool pir_mesh_equal(const pir_mesh *a, const pir_mesh *b) {
    if (a->vertex_count != b->vertex_count || a->facets.count != b->facets.count ||
        a->segment_count != b->segment_count || a->point_count != b->point_count)
        return false;
    uint32_t corners = pir_loops_corners(&a->facets);
    if (corners != pir_loops_corners(&b->facets))
        return false;
    return memcmp(a->vertex, b->vertex, a->vertex_count * sizeof *a->vertex) == 0 &&
           (a->segment_count == 0 || memcmp(a->segment, b->segment, 2 * a->segment_count * sizeof *a->segment) == 0) &&
           (a->point_count == 0 || memcmp(a->point, b->point, a->point_count * sizeof *a->point) == 0) &&
           memcmp(a->pair, b->pair, a->vertex_count * sizeof *a->pair) == 0 &&
           memcmp(a->facets.start, b->facets.start, (a->facets.count + 1) * sizeof(uint32_t)) == 0 &&
           memcmp(a->facets.corner, b->facets.corner, corners * sizeof(uint32_t)) == 0;
}
