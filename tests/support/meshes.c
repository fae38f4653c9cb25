/* SPDX-License-Identifier: MIT */
/* See meshes.h. */
#include "support/meshes.h"

#include <stdlib.h>
#include <string.h>

#include "oracle/check_sum.h"

static uint64_t hash_bits(uint64_t hash, uint64_t bits) {
    for (int k = 0; k < 8; k++) {
        hash ^= bits >> (8 * k) & 0xff;
        hash *= 0x100000001b3u;
    }
    return hash;
}

static uint64_t hash_double(uint64_t hash, double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return hash_bits(hash, bits);
}

uint64_t test_hash_mesh(uint64_t hash, const pir_mesh *mesh) {
    hash = hash_bits(hash, pir_mesh_vertex_count(mesh));
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++) {
        uint32_t pair[2];
        pir_vec3 x = pir_mesh_vertices(mesh)[v];
        pir_mesh_pair(mesh, v, pair);
        hash = hash_double(hash_double(hash_double(hash, x.x), x.y), x.z);
        hash = hash_bits(hash_bits(hash, pair[0]), pair[1]);
    }
    hash = hash_bits(hash, pir_mesh_facet_count(mesh));
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        hash = hash_bits(hash_bits(hash, count), (uint64_t)pir_mesh_facet_kind(mesh, f));
        for (uint32_t i = 0; i < count; i++)
            hash = hash_bits(hash, corner[i]);
    }
    return hash;
}

uint64_t test_hash_pairing(uint64_t hash, const pir_sum *sum) {
    for (uint32_t f = 0; f < pir_polytope_facet_count(pir_sum_p(sum)); f++)
        hash = hash_bits(hash, pir_sum_fv(sum)[f]);
    for (uint32_t g = 0; g < pir_polytope_facet_count(pir_sum_q(sum)); g++)
        hash = hash_bits(hash, pir_sum_vf(sum)[g]);
    uint32_t count = pir_sum_ee_count(sum);
    uint32_t(*pairs)[2] = malloc((count + 1) * sizeof *pairs);
    if (!pairs)
        abort();
    pir_sum_ee(sum, pairs);
    for (uint32_t i = 0; i < count; i++)
        hash = hash_bits(hash_bits(hash, pairs[i][0]), pairs[i][1]);
    free(pairs);
    return hash;
}

const char *test_prove_mesh(const pir_sum *sum, const pir_mesh *mesh) {
    oracle_points p, q;
    oracle_quat rotation;
    oracle_points_from_polytope(&p, pir_sum_p(sum));
    oracle_points_from_polytope(&q, pir_sum_q(sum));
    oracle_quat_init(rotation, pir_sum_rotation(sum));
    oracle_points_rotate(&p, rotation);
    const char *wrong = oracle_check_sum(mesh, &p, &q);
    oracle_quat_clear(rotation);
    oracle_points_clear(&q);
    oracle_points_clear(&p);
    return wrong;
}

const char *test_prove_hull(const pir_polytope *polytope, const pir_vec3 *points, size_t count) {
    // the hull's vertices, so that a mesh's pairs name them, and then all points, which must not reach beyond it
    uint32_t vertices = pir_polytope_vertex_count(polytope);
    pir_vec3 *all = malloc((vertices + count) * sizeof *all);
    pir_mesh *mesh;
    if (!all || pir_mesh_from_polytope(polytope, &mesh) != PIR_OK)
        abort();
    for (uint32_t v = 0; v < vertices; v++)
        all[v] = points[pir_polytope_source(polytope, v)];
    memcpy(all + vertices, points, count * sizeof *points);
    oracle_points p, q;
    oracle_points_from_doubles(&p, all, vertices + count);
    oracle_points_from_doubles(&q, &(pir_vec3){0, 0, 0}, 1);
    const char *wrong = pir_polytope_is_valid(polytope) ? oracle_check_sum(mesh, &p, &q) : "the polytope is not valid";
    oracle_points_clear(&q);
    oracle_points_clear(&p);
    pir_mesh_destroy(mesh);
    free(all);
    return wrong;
}
