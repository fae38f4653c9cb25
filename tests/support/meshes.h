/* SPDX-License-Identifier: MIT */
/* Meshes and sums in tests: hashes of their bits, and proofs by the oracle from public calls alone. */
#ifndef PIR_TEST_MESHES_H
#define PIR_TEST_MESHES_H

#include <pirouette/sum.h>

#include "support/hash.h"

/* The hash of a mesh: vertices bit by bit, pairs, facets, kinds. `hash` is the one so far, or TEST_HASH_START. */
uint64_t test_hash_mesh(uint64_t hash, const pir_mesh *mesh);

/* The hash of a pairing, likewise. */
uint64_t test_hash_pairing(uint64_t hash, const pir_sum *sum);

/* That the mesh, which holds exact coordinates, is the sum that `sum` stands for. NULL, or what does not hold. */
const char *test_prove_mesh(const pir_sum *sum, const pir_mesh *mesh);

/* That the mesh from_mesh of `polytope` is the hull of the points. */
const char *test_prove_hull(const pir_polytope *polytope, const pir_vec3 *points, size_t count);

#endif
