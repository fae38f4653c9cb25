/* SPDX-License-Identifier: MIT */
/* Facets of pieces: see piece_facets.h. Each is cut into a fan of one-sided triangles that face outwards. */
#include "scene/world/piece_facets.h"

#include "polytope/polytope.h"

static void cut(const pir_polytope *p, uint32_t *corner) {
    for (uint32_t f = 0; f < p->facet_count; f++)
        for (uint32_t i = p->loop_start[f] + 1; i + 1 < p->loop_start[f + 1]; i++) {
            *corner++ = p->origin[p->loop[p->loop_start[f]]];
            *corner++ = p->origin[p->loop[i]];
            *corner++ = p->origin[p->loop[i + 1]];
        }
}

pir_status pir_piece_facets(pir_scene_piece *piece, const pir_allocator *allocator) {
    const pir_polytope *p = piece->extent.polytope;
    if (piece->facets)
        return PIR_OK;
    const size_t triangles = p->half_count - 2 * (size_t)p->facet_count;
    uint32_t *corner = PIR_NEW(allocator, uint32_t, 3 * triangles);
    if (!corner)
        return PIR_ERR_MEMORY;
    cut(p, corner);
    const pir_trimesh_arrays arrays = {
        .vertices = p->vertex, .vertex_count = p->vertex_count, .triangles = corner, .triangle_count = triangles};
    pir_trimesh_options options = pir_trimesh_options_default();
    options.allocator = allocator;
    pir_status status = pir_trimesh_create(&arrays, &options, NULL, &piece->facets);
    PIR_FREE(allocator, corner, 3 * triangles);
    return status;
}
