/* SPDX-License-Identifier: MIT */
/* A polytope in exact OFF: through the writer of meshes, to a stream in memory. */
#include "polytope/write/off_text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/io.h>
#include <pirouette/mesh.h>

static pir_status write_off(const pir_mesh *mesh, const pir_allocator *a, pir_bytes *bytes) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream)
        return PIR_ERR_MEMORY;
    pir_status status = pir_mesh_write_stream(mesh, stream, "piece", "off", 1, NULL);
    if (fclose(stream) != 0 || (status != PIR_OK && status != PIR_ERR_MEMORY))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK && !pir_bytes_reserve(bytes, a, size))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        memcpy(bytes->data + bytes->used, text, size);
        bytes->used += size;
    }
    free(text);
    return status;
}

pir_status pir_off_text(const pir_polytope *polytope, const pir_allocator *allocator, pir_bytes *bytes) {
    pir_mesh *mesh = NULL;
    pir_status status = pir_mesh_from_polytope(polytope, &mesh);
    if (status == PIR_OK)
        status = write_off(mesh, allocator, bytes);
    pir_mesh_destroy(mesh);
    return status;
}
