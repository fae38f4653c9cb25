/* SPDX-License-Identifier: MIT */
/*
 * The sum by the object-space method: see object_search.c. The method's last step is Euler's condition, by which its
 * authors tell that rounding lost vertices or facets. Nothing is lost here, so it only guards against a bug.
 */
#include <pirouette/baseline.h>

#include "base/options.h"
#include "dymsum/mesh/object_search.h"
#include "dymsum/mesh/object_sum.h"
#include "dymsum/mesh/sum_mesh.h"

/* The most products of a normal with a vertex: a few seconds. */
#define MOST_PRODUCTS ((uint64_t)1 << 32)

bool pir_mesh_is_whole(const pir_mesh *mesh) {
    uint32_t corners = pir_loops_corners(&mesh->facets);
    return corners % 2 == 0 && (uint64_t)mesh->vertex_count + mesh->facets.count == (uint64_t)corners / 2 + 2;
}

static bool is_too_large(const pir_polytope *p, const pir_polytope *q) {
    uint64_t normals = (uint64_t)p->edge_count * q->edge_count + p->facet_count + q->facet_count;
    uint64_t vertices = (uint64_t)p->vertex_count + q->vertex_count;
    return normals > MOST_PRODUCTS / vertices;
}

/* The mesh of what a search has found. */
static pir_status mesh_of_search(const pir_object_search *search, pir_precision precision, pir_mesh **ret_mesh) {
    const pir_posed *posed = search->posed;
    const pir_sum_faces faces = {posed, search->of_p, search->of_q, search->fv, search->vf};
    pir_rotation *rotation = &posed->signs->rotation;
    pir_facet_list facets = {0};
    pir_mesh *mesh = NULL;
    pir_status status = pir_facet_list_begin(&facets, search->allocator, &faces, search->swept_count);
    for (uint32_t i = 0; status == PIR_OK && i < search->swept_count; i++)
        pir_facet_list_add_crossing(&facets, posed, search->swept[i].half, search->swept[i].h);
    if (status == PIR_OK && facets.count == 0)
        // a point or a segment: there is no normal to go along
        status = pir_hull_mesh(posed->p, posed->q, rotation, search->allocator, precision, &mesh);
    else if (status == PIR_OK)
        status = pir_facet_list_mesh(&facets, search->allocator, posed, rotation, precision, &mesh);
    if (status == PIR_OK && facets.count > 0 && !pir_mesh_is_whole(mesh))
        status = PIR_ERR_INTERNAL;
    pir_facet_list_finish(&facets, search->allocator);
    if (status == PIR_OK)
        *ret_mesh = mesh;
    else
        pir_mesh_destroy(mesh);
    return status;
}

static pir_status mesh_at(const pir_polytope *p, const pir_polytope *q, pir_signs *signs, const pir_allocator *a,
                          pir_precision precision, pir_mesh **ret_mesh) {
    pir_posed posed;
    pir_status status = pir_posed_init(&posed, a, p, q, signs);
    if (status != PIR_OK)
        return status;
    pir_object_search search;
    status = pir_object_search_run(&search, &posed, a);
    if (status == PIR_OK)
        status = mesh_of_search(&search, precision, ret_mesh);
    pir_object_search_finish(&search);
    pir_posed_finish(&posed, a);
    return status;
}

pir_status pir_object_sum(const pir_polytope *p, const pir_polytope *q, pir_quat quaternion,
                          const pir_sum_options *options, pir_precision precision, pir_mesh **ret_mesh) {
    if (!p || !q || !ret_mesh || (precision != PIR_DOUBLE && precision != PIR_EXACT))
        return PIR_ERR_ARGUMENT;
    pir_sum_options used = pir_sum_options_default();
    pir_status status = pir_options_take("pir_sum_options", options, &used, NULL);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(used.allocator);
    pir_signs_room room = {0};
    pir_signs signs;
    pir_signs_init(&signs, &room);
    status = pir_rotation_set(&signs.rotation, quaternion);
    if (status != PIR_OK)
        return status;
    if (is_too_large(p, q))
        return PIR_ERR_LIMIT;
    pir_polytope *reflected = NULL;
    if (used.difference) {
        status = pir_polytope_reflect(p, &reflected);
        p = reflected;
    }
    if (status == PIR_OK)
        status = pir_signs_reserve(&room, &allocator, pir_object_limbs(p), pir_object_limbs(q));
    if (status == PIR_OK)
        status = mesh_at(p, q, &signs, &allocator, precision, ret_mesh);
    pir_signs_room_finish(&room, &allocator);
    pir_polytope_release(reflected);
    return status;
}
