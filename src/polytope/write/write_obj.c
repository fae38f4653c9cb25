/* SPDX-License-Identifier: MIT */
/*
 * Writing OBJ: vertices in decimals that read back as the same doubles, each facet a polygon, its corners counted from
 * 1. Segments and points on their own are the elements `l` and `p`.
 */
#include "polytope/write/write_obj.h"

#include <inttypes.h>

#include "polytope/file/c_locale.h"
#include "polytope/write/write_number.h"

/* An element of `count` vertices, which are counted from 1. */
static void write_element(FILE *file, char kind, const uint32_t *vertices, uint32_t count) {
    fputc(kind, file);
    for (uint32_t i = 0; i < count; i++)
        fprintf(file, " %" PRIu64, (uint64_t)vertices[i] + 1);
    fputc('\n', file);
}

pir_status pir_mesh_write_obj(const pir_mesh *mesh, FILE *file) {
    struct pir_c_locale locale;
    if (!pir_c_locale_enter(&locale))
        return PIR_ERR_MEMORY;
    const pir_vec3 *vertices = pir_mesh_vertices(mesh);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++) {
        fputs("v ", file);
        pir_write_number(file, vertices[v].x, ' ');
        pir_write_number(file, vertices[v].y, ' ');
        pir_write_number(file, vertices[v].z, '\n');
    }
    uint32_t count;
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        const uint32_t *corners = pir_mesh_facet(mesh, f, &count);
        write_element(file, 'f', corners, count);
    }
    const uint32_t *segments = pir_mesh_segments(mesh, &count);
    for (uint32_t i = 0; i < count; i++)
        write_element(file, 'l', segments + 2 * (size_t)i, 2);
    const uint32_t *points = pir_mesh_points(mesh, &count);
    for (uint32_t i = 0; i < count; i++)
        write_element(file, 'p', points + i, 1);
    pir_c_locale_leave(&locale);
    return PIR_OK;
}
