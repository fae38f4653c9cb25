/* SPDX-License-Identifier: MIT */
/* Meshes to test with: see mesh_models.h. */
#include "mesh/mesh_models.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static mesh_arrays arrays_of(uint32_t vertices, uint32_t triangles) {
    mesh_arrays a = {malloc(vertices * sizeof *a.vertex), malloc(triangles * sizeof *a.triangle), 0, 0};
    if (!a.vertex || !a.triangle)
        abort();
    return a;
}

void mesh_arrays_clear(mesh_arrays *arrays) {
    free(arrays->vertex);
    free(arrays->triangle);
}

/* A point of the face x + y + z = 1 of the octahedron, in one of its eight places, out on the bumpy sphere. */
static pir_vec3 bumpy_point(uint32_t face, double x, double y, double z, double bumps) {
    double length = sqrt(x * x + y * y + z * z);
    double radius = (1 + bumps * sin(5 * x / length) * sin(7 * y / length + 1) * sin(6 * z / length + 2)) / length;
    return (pir_vec3){(face & 1 ? -x : x) * radius, (face & 2 ? -y : y) * radius, (face & 4 ? -z : z) * radius};
}

static void add_triangle(mesh_arrays *a, pir_vec3 p, pir_vec3 q, pir_vec3 r) {
    uint32_t *t = a->triangle[a->triangles++];
    for (uint32_t k = 0; k < 3; k++)
        t[k] = a->vertices + k;
    a->vertex[a->vertices++] = p;
    a->vertex[a->vertices++] = q;
    a->vertex[a->vertices++] = r;
}

mesh_arrays mesh_bumpy_sphere(uint32_t level, double bumps) {
    uint32_t side = 1u << level, triangles = 8 * side * side;
    mesh_arrays a = arrays_of(3 * triangles, triangles);
    for (uint32_t face = 0; face < 8; face++)
        for (uint32_t i = 0; i < side; i++)
            for (uint32_t j = 0; i + j < side; j++)
                for (uint32_t half = 0; half < (i + j + 1 < side ? 2u : 1u); half++) {
                    uint32_t at[3][2] = {{i + half, j + half}, {i + 1, j}, {i, j + 1}};
                    pir_vec3 p[3];
                    for (int k = 0; k < 3; k++) {
                        double x = (double)at[k][0] / side, y = (double)at[k][1] / side;
                        p[k] = bumpy_point(face, x, y, (double)(side - at[k][0] - at[k][1]) / side, bumps);
                    }
                    // a mirrored face, and an upper half, turn the other way
                    bool mirrored = ((face & 1) + (face >> 1 & 1) + (face >> 2)) % 2 != half;
                    add_triangle(&a, p[0], p[mirrored ? 2 : 1], p[mirrored ? 1 : 2]);
                }
    return a;
}

mesh_arrays mesh_soup(test_random *random, uint32_t count, int size, bool whole) {
    mesh_arrays a = arrays_of(3 * count, count);
    while (a.triangles < count) {
        pir_vec3 p[3];
        for (int k = 0; k < 3; k++) {
            double c[3];
            for (int axis = 0; axis < 3; axis++)
                c[axis] = whole ? test_random_between(random, -size, size) : size * test_random_unit(random);
            p[k] = (pir_vec3){c[0], c[1], c[2]};
        }
        add_triangle(&a, p[0], p[1], p[2]);
    }
    return a;
}

mesh_arrays mesh_fan(uint32_t count) {
    mesh_arrays a = arrays_of(3 * count, count);
    for (uint32_t i = 0; i < count; i++) {
        double from = 6.25 * i / count, to = 6.25 * (i + 1) / count;
        add_triangle(&a, (pir_vec3){0, 0, 0}, (pir_vec3){cos(from), sin(from), 1}, (pir_vec3){cos(to), sin(to), 1});
    }
    return a;
}

mesh_arrays mesh_plane(uint32_t side) {
    mesh_arrays a = arrays_of(6 * side * side, 2 * side * side);
    for (uint32_t i = 0; i < side; i++)
        for (uint32_t j = 0; j < side; j++) {
            pir_vec3 p = {i, j, 0}, q = {i + 1.0, j, 0}, r = {i + 1.0, j + 1.0, 0}, s = {i, j + 1.0, 0};
            add_triangle(&a, p, q, r);
            add_triangle(&a, p, r, s);
        }
    return a;
}

pir_trimesh_arrays mesh_arrays_of(const mesh_arrays *arrays) {
    return (pir_trimesh_arrays){
        .vertices = arrays->vertex,
        .vertex_count = arrays->vertices,
        .triangles = arrays->triangle[0],
        .triangle_count = arrays->triangles,
    };
}

pir_trimesh *mesh_of(const mesh_arrays *arrays, const pir_trimesh_options *options) {
    pir_trimesh *mesh = NULL;
    pir_report report = {0};
    pir_trimesh_arrays given = mesh_arrays_of(arrays);
    if (pir_trimesh_create(&given, options, &report, &mesh) != PIR_OK) {
        fprintf(stderr, "a mesh of tests: %s\n", report.text);
        abort();
    }
    return mesh;
}
