/* SPDX-License-Identifier: MIT */
/*
 * A mesh of triangles.
 *
 * Invariants
 *   - Corners are numbers of vertices; of vertices at one place the lowest number stands for all.
 *   - Every triangle that has an area is in one leaf of the tree, the others in none.
 *   - Where the mesh is closed, part_vertex has a corner of every part; else it has none.
 */
#ifndef PIR_MESH_TRIMESH_H
#define PIR_MESH_TRIMESH_H

#include <stdatomic.h>

#include <pirouette/trimesh.h>

#include "base/memory.h"
#include "mesh/mesh_tree.h"
#include "mesh/signs/mesh_signs.h"

struct pir_trimesh {
    pir_allocator allocator;
    atomic_uint references;
    uint32_t vertex_count, triangle_count, degenerate_count;
    pir_vec3 *vertex;
    uint32_t (*corner)[3];
    uint32_t *material; /* NULL where all are 0 */
    bool closed, two_sided;
    uint32_t part_count, part_listed;
    uint32_t *part_vertex; /* part_listed of them */
    int low_bit;           /* the lowest bit set in any coordinate; INT32_MAX where all are 0 */
    pir_mesh_tree tree;
};

static inline pir_tri pir_trimesh_tri(const pir_trimesh *mesh, uint32_t triangle) {
    const uint32_t *c = mesh->corner[triangle];
    return (pir_tri){{mesh->vertex[c[0]], mesh->vertex[c[1]], mesh->vertex[c[2]]}};
}

#endif
