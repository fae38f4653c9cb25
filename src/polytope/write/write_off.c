/* SPDX-License-Identifier: MIT */
/*
 * Writing OFF: counts, vertices, facets, one to a line, so that what is read back is the same numbers.
 *
 * A double is written with the fewest digits that read back as itself; an exact coordinate as an integer or a/b in
 * lowest terms.
 */
#include "polytope/write/write_off.h"

#include <inttypes.h>

#include <pirouette/exact.h>

#include "polytope/file/c_locale.h"
#include "polytope/write/write_number.h"

static void write_doubles(const pir_mesh *mesh, FILE *file) {
    const pir_vec3 *vertices = pir_mesh_vertices(mesh);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++) {
        pir_write_number(file, vertices[v].x, ' ');
        pir_write_number(file, vertices[v].y, ' ');
        pir_write_number(file, vertices[v].z, '\n');
    }
}

static pir_status write_rationals(const pir_mesh *mesh, FILE *file) {
    mpq_t point[3];
    for (int axis = 0; axis < 3; axis++)
        mpq_init(point[axis]);
    pir_status status = PIR_OK;
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh) && status == PIR_OK; v++) {
        status = pir_mesh_vertex_exact(mesh, v, point);
        for (int axis = 0; axis < 3 && status == PIR_OK; axis++) {
            mpq_out_str(file, 10, point[axis]);
            fputc(axis < 2 ? ' ' : '\n', file);
        }
    }
    for (int axis = 0; axis < 3; axis++)
        mpq_clear(point[axis]);
    return status;
}

/* Facets; what a facet cannot tell is in comments, which readers pass over. */
static void write_facets(const pir_mesh *mesh, FILE *file) {
    uint32_t count;
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        const uint32_t *corners = pir_mesh_facet(mesh, f, &count);
        fprintf(file, "%" PRIu32, count);
        for (uint32_t i = 0; i < count; i++)
            fprintf(file, " %" PRIu32, corners[i]);
        fputs(pir_mesh_facet_kind(mesh, f) == PIR_FACET_TWO_SIDED ? " # two-sided\n" : "\n", file);
    }
    const uint32_t *segments = pir_mesh_segments(mesh, &count);
    for (uint32_t i = 0; i < count; i++)
        fprintf(file, "# segment %" PRIu32 " %" PRIu32 "\n", segments[2 * i], segments[2 * i + 1]);
    const uint32_t *points = pir_mesh_points(mesh, &count);
    for (uint32_t i = 0; i < count; i++)
        fprintf(file, "# point %" PRIu32 "\n", points[i]);
}

pir_status pir_mesh_write_off(const pir_mesh *mesh, FILE *file, bool exact) {
    struct pir_c_locale locale;
    if (!pir_c_locale_enter(&locale))
        return PIR_ERR_MEMORY;
    fprintf(file, "OFF\n%" PRIu32 " %" PRIu32 " %" PRIu32 "\n", pir_mesh_vertex_count(mesh), pir_mesh_facet_count(mesh),
            pir_mesh_edge_count(mesh));
    pir_status status = PIR_OK;
    if (exact)
        status = write_rationals(mesh, file);
    else
        write_doubles(mesh, file);
    write_facets(mesh, file);
    pir_c_locale_leave(&locale);
    return status;
}
