/* SPDX-License-Identifier: MIT */
/*
 * The sum by another way: the exact hull of all pairwise sums of vertices.
 *
 * Points are numbered p·(vertices of Q) + q, so rising points are rising pairs and the canonical facets of the hull
 * are those of the mesh.
 */
#include <pirouette/baseline.h>

#include "base/options.h"
#include "dymsum/mesh/placing.h"
#include "dymsum/mesh/sum_mesh.h"
#include "polytope/hull/hull.h"

/* The mesh of the hull's facets. NULL when out of memory. */
static pir_mesh *mesh_of_hull(const pir_hull *hull, const pir_polytope *p, const pir_polytope *q,
                              const pir_rotation *rotation, const pir_allocator *a) {
    uint32_t corners = hull->facets.count > 0 ? pir_loops_corners(&hull->facets) : 0;
    pir_mesh *mesh = pir_mesh_new(a, hull->vertex_count, hull->facets.count, corners);
    uint32_t *number = PIR_NEW(a, uint32_t, (size_t)p->vertex_count * q->vertex_count);
    if (mesh && number) {
        for (uint32_t v = 0; v < hull->vertex_count; v++) {
            uint32_t point = hull->vertices[v];
            number[point] = v;
            mesh->pair[v][0] = point / q->vertex_count;
            mesh->pair[v][1] = point % q->vertex_count;
            mesh->vertex[v] = pir_place(&rotation->r, p, q, mesh->pair[v][0], mesh->pair[v][1]);
        }
        for (uint32_t i = 0; i < corners; i++)
            mesh->facets.corner[i] = number[hull->facets.corner[i]];
        for (uint32_t f = 0; f < hull->facets.count; f++)
            mesh->facets.start[f + 1] = hull->facets.start[f + 1];
        mesh->edge_count = hull->dimension == 1 ? 1 : corners / 2;
        pir_mesh_set_kinds(mesh);
    } else {
        pir_mesh_destroy(mesh);
        mesh = NULL;
    }
    PIR_FREE(a, number, (size_t)p->vertex_count * q->vertex_count);
    return mesh;
}

pir_status pir_hull_mesh(const pir_polytope *p, const pir_polytope *q, pir_rotation *rotation, const pir_allocator *a,
                         pir_precision precision, pir_mesh **ret_mesh) {
    if ((uint64_t)p->vertex_count * q->vertex_count >= (uint64_t)1 << 30)
        return PIR_ERR_LIMIT;
    pir_placing placing;
    pir_vectors points = {0};
    pir_hull hull = {0};
    pir_mesh *mesh = NULL;
    pir_status status = pir_placing_init(&placing, a, p, q, rotation);
    if (status != PIR_OK)
        return status;
    if (!pir_vectors_init(&points, a, p->vertex_count * q->vertex_count, placing.stride))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        for (uint32_t i = 0; i < p->vertex_count; i++)
            for (uint32_t j = 0; j < q->vertex_count; j++)
                pir_placing_set(&placing, i, j, &points, i * q->vertex_count + j);
        status = pir_hull_make(&points, NULL, a, &hull);
    }
    if (status == PIR_OK) {
        mesh = mesh_of_hull(&hull, p, q, rotation, a);
        if (!mesh || (precision == PIR_EXACT && !pir_placing_fill(&placing, mesh)))
            status = PIR_ERR_MEMORY;
    }
    pir_hull_finish(&hull, a);
    pir_vectors_finish(&points, a);
    pir_placing_finish(&placing, a);
    if (status == PIR_OK)
        *ret_mesh = mesh;
    else
        pir_mesh_destroy(mesh);
    return status;
}

pir_status pir_hull_sum(const pir_polytope *p, const pir_polytope *q, pir_quat quaternion,
                        const pir_sum_options *options, pir_precision precision, pir_mesh **ret_mesh) {
    if (!p || !q || !ret_mesh || (precision != PIR_DOUBLE && precision != PIR_EXACT))
        return PIR_ERR_ARGUMENT;
    pir_sum_options used = pir_sum_options_default();
    pir_status status = pir_options_take("pir_sum_options", options, &used, NULL);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(used.allocator);
    pir_rotation_integers integers;
    pir_rotation rotation = {.integers = &integers};
    status = pir_rotation_set(&rotation, quaternion);
    if (status != PIR_OK)
        return status;
    pir_polytope *reflected = NULL;
    if (used.difference) {
        status = pir_polytope_reflect(p, &reflected);
        if (status != PIR_OK)
            return status;
        p = reflected;
    }
    status = pir_hull_mesh(p, q, &rotation, &allocator, precision, ret_mesh);
    pir_polytope_release(reflected);
    return status;
}
