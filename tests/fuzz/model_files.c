/* SPDX-License-Identifier: MIT */
/* See model_files.h. */
#include "fuzz/model_files.h"

#include <string.h>

const char *model_ending(enum model_form form) {
    static const char *const endings[MODEL_FORM_COUNT] = {"off", "off", "obj", "obj", "stl",
                                                          "stl", "ply", "ply", "ply"};
    return endings[form];
}

static pir_vec3 vertex_of(const pir_mesh *mesh, uint32_t v) {
    return pir_mesh_vertices(mesh)[v];
}

/* One line for each facet: `head`, the number of corners when `counted`, the corners, each plus `first`, and `after`
 * behind each. */
static void print_facets(struct file_bytes *file, const pir_mesh *mesh, const char *head, int counted, uint32_t first,
                         const char *after) {
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        file_print(file, "%s", head);
        if (counted)
            file_print(file, "%u ", (unsigned)count);
        for (uint32_t i = 0; i < count; i++)
            file_print(file, "%u%s%s", (unsigned)(corner[i] + first), after, i + 1 < count ? " " : "\n");
    }
}

static void print_off(struct file_bytes *file, const pir_mesh *mesh, int rational) {
    uint32_t count = pir_mesh_vertex_count(mesh);
    file_print(file, "OFF # a model\n%u %u 0\n", (unsigned)count, (unsigned)pir_mesh_facet_count(mesh));
    for (uint32_t v = 0; v < count; v++) {
        pir_vec3 p = vertex_of(mesh, v);
        if (rational)
            file_print(file, "%.0f/3 %.0f/7 %.0f/30\n", 1000 * p.x, 1000 * p.y, 1000 * p.z);
        else
            file_print(file, "%.17g %.17g %.17g\n", p.x, p.y, p.z);
    }
    print_facets(file, mesh, "", 1, 0, "");
}

static void print_obj(struct file_bytes *file, const pir_mesh *mesh, int full) {
    if (full)
        file_print(file,
                   "# a model\nmtllib model.mtl\no body\ng part\nusemtl grey\nvt 0 0\nvt 1 0.5\nvn 0 0 1\ns off\n");
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++) {
        pir_vec3 p = vertex_of(mesh, v);
        file_print(file, full ? "v  %.9g\t%.9g \\\n%.9g\n" : "v %.9g %.9g %.9g\n", p.x, p.y, p.z);
    }
    print_facets(file, mesh, "f ", 0, 1, full ? "/2/1" : "");
}

/* Bytes of a number, the least significant first unless `big`. */
static void append_number(struct file_bytes *file, const void *number, size_t size, int big) {
    uint8_t bytes[8];
    const uint16_t one = 1;
    memcpy(bytes, number, size);
    if ((*(const uint8_t *)&one == 1) == (big != 0))
        for (size_t k = 0; k < size / 2; k++) {
            uint8_t byte = bytes[k];
            bytes[k] = bytes[size - 1 - k];
            bytes[size - 1 - k] = byte;
        }
    file_append(file, bytes, size);
}

static void append_floats(struct file_bytes *file, pir_vec3 p, int big) {
    const float c[3] = {(float)p.x, (float)p.y, (float)p.z};
    for (int k = 0; k < 3; k++)
        append_number(file, &c[k], sizeof c[k], big);
}

static void print_triangle(struct file_bytes *file, const pir_vec3 corner[3]) {
    file_print(file, "facet normal 0 0 0\n outer loop\n");
    for (int k = 0; k < 3; k++)
        file_print(file, "  vertex %.9g %.9g %.9g\n", corner[k].x, corner[k].y, corner[k].z);
    file_print(file, " endloop\nendfacet\n");
}

static void append_triangle(struct file_bytes *file, const pir_vec3 corner[3]) {
    append_floats(file, (pir_vec3){0, 0, 0}, 0);
    for (int k = 0; k < 3; k++)
        append_floats(file, corner[k], 0);
    file_append(file, "\0", 2);
}

static void print_stl(struct file_bytes *file, const pir_mesh *mesh, int binary) {
    uint32_t triangles = 0, count;
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        pir_mesh_facet(mesh, f, &count);
        triangles += count - 2;
    }
    if (binary) {
        file_print(file, "%-80s", "a model");
        append_number(file, &triangles, sizeof triangles, 0);
    } else {
        file_print(file, "solid model\n");
    }
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        for (uint32_t i = 1; i + 1 < count; i++) {
            const pir_vec3 triangle[3] = {vertex_of(mesh, corner[0]), vertex_of(mesh, corner[i]),
                                          vertex_of(mesh, corner[i + 1])};
            (binary ? append_triangle : print_triangle)(file, triangle);
        }
    }
    if (!binary)
        file_print(file, "endsolid model\n");
}

static void print_ply_header(struct file_bytes *file, const pir_mesh *mesh, const char *format, int big) {
    const char *number = big ? "double" : "float";
    file_print(file, "ply\nformat %s 1.0\ncomment a model\nelement vertex %u\n", format,
               (unsigned)pir_mesh_vertex_count(mesh));
    file_print(file, "property %s x\nproperty %s y\nproperty %s z\n", number, number, number);
    if (big)
        file_print(file, "property uchar red\n");
    file_print(file, "element face %u\nproperty list %s int vertex_indices\nend_header\n",
               (unsigned)pir_mesh_facet_count(mesh), big ? "int" : "uchar");
}

static void print_ply_ascii(struct file_bytes *file, const pir_mesh *mesh) {
    print_ply_header(file, mesh, "ascii", 0);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++) {
        pir_vec3 p = vertex_of(mesh, v);
        file_print(file, "%.9g %.9g %.9g\n", p.x, p.y, p.z);
    }
    print_facets(file, mesh, "", 1, 0, "");
}

static void append_ply_vertex(struct file_bytes *file, pir_vec3 p, int big) {
    if (!big) {
        append_floats(file, p, 0);
        return;
    }
    const double c[3] = {p.x, p.y, p.z};
    for (int k = 0; k < 3; k++)
        append_number(file, &c[k], sizeof c[k], 1);
    file_append(file, "\x80", 1);
}

static void print_ply_binary(struct file_bytes *file, const pir_mesh *mesh, int big) {
    print_ply_header(file, mesh, big ? "binary_big_endian" : "binary_little_endian", big);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++)
        append_ply_vertex(file, vertex_of(mesh, v), big);
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        const uint8_t byte = (uint8_t)count;
        append_number(file, big ? (const void *)&count : &byte, big ? sizeof count : sizeof byte, big);
        for (uint32_t i = 0; i < count; i++)
            append_number(file, &corner[i], sizeof corner[i], big);
    }
}

struct file_bytes model_file(const pir_mesh *mesh, enum model_form form) {
    struct file_bytes file = {0};
    switch (form) {
    case MODEL_OFF:
    case MODEL_OFF_RATIONAL:
        print_off(&file, mesh, form == MODEL_OFF_RATIONAL);
        break;
    case MODEL_OBJ:
    case MODEL_OBJ_FULL:
        print_obj(&file, mesh, form == MODEL_OBJ_FULL);
        break;
    case MODEL_STL_ASCII:
    case MODEL_STL_BINARY:
        print_stl(&file, mesh, form == MODEL_STL_BINARY);
        break;
    case MODEL_PLY_ASCII:
        print_ply_ascii(&file, mesh);
        break;
    case MODEL_PLY_LITTLE:
    case MODEL_PLY_BIG:
        print_ply_binary(&file, mesh, form == MODEL_PLY_BIG);
        break;
    case MODEL_FORM_COUNT:
        break;
    }
    return file;
}
