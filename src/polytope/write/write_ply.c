/* SPDX-License-Identifier: MIT */
/*
 * Writing PLY in binary, the least significant byte first: vertices of three doubles, each facet a list of its corners.
 * Segments are the element `edge`.
 *
 * Most readers expect a list's size in a byte and indices in an int. Wider types stand only where those do not reach.
 */
#include "polytope/write/write_ply.h"

#include <inttypes.h>
#include <stdbool.h>

#include "polytope/write/write_bytes.h"

static uint32_t most_corners(const pir_mesh *mesh) {
    uint32_t most = 0, count;
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        pir_mesh_facet(mesh, f, &count);
        most = count > most ? count : most;
    }
    return most;
}

static void write_header(const pir_mesh *mesh, FILE *file, uint32_t segments, bool wide) {
    const char *index = pir_mesh_vertex_count(mesh) > INT32_MAX ? "uint" : "int";
    fprintf(file,
            "ply\nformat binary_little_endian 1.0\nelement vertex %" PRIu32
            "\nproperty double x\nproperty double y\nproperty double z\nelement face %" PRIu32
            "\nproperty list %s %s vertex_indices\n",
            pir_mesh_vertex_count(mesh), pir_mesh_facet_count(mesh), wide ? "uint" : "uchar", index);
    if (segments > 0)
        fprintf(file, "element edge %" PRIu32 "\nproperty %s vertex1\nproperty %s vertex2\n", segments, index, index);
    fputs("end_header\n", file);
}

static void write_indices(FILE *file, const uint32_t *indices, size_t count) {
    for (size_t i = 0; i < count; i++)
        pir_write_bytes(file, indices[i], 4);
}

void pir_mesh_write_ply(const pir_mesh *mesh, FILE *file) {
    const bool wide = most_corners(mesh) > UINT8_MAX;
    uint32_t segment_count, count;
    const uint32_t *segments = pir_mesh_segments(mesh, &segment_count);
    write_header(mesh, file, segment_count, wide);
    const pir_vec3 *vertices = pir_mesh_vertices(mesh);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++) {
        pir_write_double(file, vertices[v].x);
        pir_write_double(file, vertices[v].y);
        pir_write_double(file, vertices[v].z);
    }
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        const uint32_t *corners = pir_mesh_facet(mesh, f, &count);
        pir_write_bytes(file, count, wide ? 4 : 1);
        write_indices(file, corners, count);
    }
    write_indices(file, segments, 2 * (size_t)segment_count);
}
