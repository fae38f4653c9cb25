/* SPDX-License-Identifier: MIT */
/* Meshes to test with, as arrays that are freed by mesh_arrays_clear. */
#ifndef PIR_TEST_MESH_MODELS_H
#define PIR_TEST_MESH_MODELS_H

#include <pirouette/trimesh.h>

#include "support/random.h"

typedef struct mesh_arrays {
    pir_vec3 *vertex;
    uint32_t (*triangle)[3];
    uint32_t vertices, triangles;
} mesh_arrays;

/* An octahedron divided `level` times, 8·4^level triangles, whose radius is 1 with bumps of a height. */
mesh_arrays mesh_bumpy_sphere(uint32_t level, double bumps);

/* `count` triangles that have nothing to do with each other: whole numbers from −size to size, or numbers between. */
mesh_arrays mesh_soup(test_random *random, uint32_t count, int size, bool whole);

/* `count` triangles around one point. */
mesh_arrays mesh_fan(uint32_t count);

/* A flat square of 2·side² triangles in the plane z = 0. */
mesh_arrays mesh_plane(uint32_t side);

void mesh_arrays_clear(mesh_arrays *arrays);

pir_trimesh_arrays mesh_arrays_of(const mesh_arrays *arrays);

/* The mesh of arrays, which must be one. */
pir_trimesh *mesh_of(const mesh_arrays *arrays, const pir_trimesh_options *options);

#endif
