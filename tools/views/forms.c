/* SPDX-License-Identifier: MIT */
/* Bodies of a page: see forms.h. */
#include "forms.h"

pir_status forms_add(struct bytes *points, struct bytes *facets, const pir_polytope *piece, uint32_t *first) {
    pir_mesh *mesh = NULL;
    pir_status status = pir_mesh_from_polytope(piece, &mesh);
    if (status != PIR_OK)
        return status;
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++)
        bytes_add_vec(points, pir_mesh_vertices(mesh)[v]);
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        bytes_add_number(facets, count);
        for (uint32_t i = 0; i < count; i++)
            bytes_add_number(facets, *first + corner[i]);
    }
    *first += pir_mesh_vertex_count(mesh);
    pir_mesh_destroy(mesh);
    return PIR_OK;
}

void forms_print(FILE *file, const struct bytes *points, const struct bytes *facets) {
    fputs("\"points\":\"", file);
    bytes_print(file, points->at, points->size);
    fputs("\",\"facets\":\"", file);
    bytes_print(file, facets->at, facets->size);
    fputs("\"", file);
}
