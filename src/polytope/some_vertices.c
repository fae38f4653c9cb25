/* SPDX-License-Identifier: MIT */
/* See some_vertices.h. Exact vertices are copied on the polytope's own scale, so no number grows. */
#include "polytope/some_vertices.h"

pir_status pir_polytope_of_some(const pir_polytope *polytope, const uint32_t *vertices, uint32_t count,
                                pir_polytope **ret_polytope) {
    const pir_allocator *a = &polytope->allocator;
    pir_vec3 *doubles = PIR_NEW(a, pir_vec3, count);
    pir_vectors exact = {0};
    pir_status status = PIR_ERR_MEMORY;
    bool rounded = false;
    if (doubles && pir_vectors_init(&exact, a, count, polytope->exact_vertex.stride)) {
        for (uint32_t i = 0; i < count; i++) {
            pir_int3 x = pir_vertex_exact(polytope, vertices[i]);
            pir_vectors_set(&exact, i, &x);
            doubles[i] = polytope->vertex[vertices[i]];
            for (int k = 0; k < 3; k++)
                rounded |= !pir_vertex_is_double(polytope, vertices[i], k);
        }
        // a hull takes doubles for the points themselves: far from the origin rounded ones would be other points
        const pir_polytope_parts parts = {
            .points = &exact, .scale = &polytope->scale, .doubles = rounded ? NULL : doubles};
        status = pir_polytope_build_hull(&parts, a, ret_polytope);
        for (uint32_t v = 0; status == PIR_OK && v < (*ret_polytope)->vertex_count; v++)
            (*ret_polytope)->source[v] = polytope->source[vertices[(*ret_polytope)->source[v]]];
    }
    pir_vectors_finish(&exact, a);
    PIR_FREE(a, doubles, count);
    return status;
}
