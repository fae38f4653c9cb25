/* SPDX-License-Identifier: MIT */
/* All that a scene has to know of a body's surface: see surfaces.h. */
#include "scene/world/surfaces.h"

#include <string.h>

#include "mesh/query/mesh_walk.h"

uint32_t pir_surface_corners(pir_surface_ref surface, pir_vec3 ret_point[8]) {
    const pir_walk_box box = pir_surface_bounds(surface);
    const double *low = box.low, *high = box.high;
    for (int k = 0; k < 8; k++)
        ret_point[k] = (pir_vec3){k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]};
    return 8;
}

uint32_t pir_surface_triangle(pir_surface_ref surface, uint32_t triangle, pir_vec3 ret_point[3]) {
    const pir_tri tri = pir_surface_tri(surface, triangle);
    memcpy(ret_point, tri.p, sizeof tri.p);
    return 3;
}

double pir_surface_farthest(pir_surface_ref surface) {
    pir_vec3 corner[8];
    double most = 0;
    pir_surface_corners(surface, corner);
    for (int k = 0; k < 8; k++)
        most = fmax(most, sqrt(pir_vec_dot(corner[k], corner[k])));
    return most * (1 + 0x1p-40);
}

double pir_surface_skin(pir_surface_ref surface) {
    const pir_walk_box box = pir_surface_bounds(surface);
    const double triangles = surface.mesh ? surface.mesh->triangle_count : surface.field->triangles;
    return 0.25 * fmax(box.high[0] - box.low[0], fmax(box.high[1] - box.low[1], box.high[2] - box.low[2])) /
           sqrt(triangles);
}

bool pir_surface_is_two_sided(pir_surface_ref surface) {
    return surface.mesh ? surface.mesh->two_sided : surface.field->two_sided;
}

/* --- content --- */

/* FNV-1a over words. */
static uint64_t hash_word(uint64_t hash, uint64_t word) {
    return (hash ^ word) * UINT64_C(0x100000001b3);
}

static uint64_t hash_double(uint64_t hash, double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    hash = hash_word(hash, bits);
    return hash ^ hash >> 29;
}

static uint64_t hash_point(uint64_t hash, pir_vec3 p) {
    return hash_double(hash_double(hash_double(hash, p.x), p.y), p.z);
}

static uint64_t hash_mesh(uint64_t hash, const pir_trimesh *mesh) {
    hash = hash_word(hash, mesh->triangle_count);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const pir_tri tri = pir_trimesh_tri(mesh, t);
        for (int k = 0; k < 3; k++)
            hash = hash_point(hash, tri.p[k]);
    }
    return hash;
}

static uint64_t hash_field(uint64_t hash, const pir_height_field *field) {
    hash = hash_word(hash_word(hash, field->columns), field->rows);
    hash = hash_double(hash_double(hash, field->step_x), field->step_y);
    for (uint32_t cell = 0; cell < pir_height_cells(field); cell++) {
        const uint32_t i = cell % pir_height_cell_columns(field), j = cell / pir_height_cell_columns(field);
        if (pir_height_is_hole(field, cell)) {
            hash = hash_word(hash, cell);
            continue;
        }
        // the corners of a hole alone may be anything
        for (uint32_t k = 0; k < 4; k++)
            hash = hash_double(hash, pir_height_sample(field, i + k % 2, j + k / 2).z);
    }
    return hash;
}

uint64_t pir_surface_hash(pir_surface_ref surface) {
    const uint64_t hash = hash_word(UINT64_C(0xcbf29ce484222325), pir_surface_is_two_sided(surface));
    return surface.mesh ? hash_mesh(hash, surface.mesh) : hash_field(hash, surface.field);
}
