/* SPDX-License-Identifier: MIT */
/*
 * Ties settled for real: the rotation q + (ε, ε³, ε⁹, ε²⁷) with an ε so small that its powers rank like the
 * symbolic ones do, and of q and −q the one that rotations take. That is the perturbation that the library promises,
 * carried out in (large) integers instead of symbols.
 */
#ifndef PIR_ORACLE_PERTURBED_H
#define PIR_ORACLE_PERTURBED_H

#include <pirouette/sum.h>

#include "oracle/points.h"

/*
 * q, or −q, perturbed, as integers. s is a form of degree 2 in q: for integers a and b of `bits` bits, and q in
 * integers of `span` bits, the coefficients of its expansion in ε are integers below 2^(2·bits + 2·span + 8), so
 * with ε = 2^-(2·bits + 2·span + 16) the first that is not zero outweighs all after it.
 */
void oracle_perturbed_quat_init(oracle_quat to, pir_quat q, uint32_t bits);

/* The sign of (M(q)·a)·b. */
int oracle_sign(oracle_quat q, oracle_vec a, oracle_vec b);

/* Edges that make a facet of the sum, and its normal at the rotation itself; zero where they are parallel there. */
typedef struct oracle_edges {
    uint32_t p, q;
    pir_vec3 normal; /* as long as between 0.5 and 2 */
} oracle_edges;

/* A pairing: the farthest vertex along each facet's normal, and the pairs of edges, by rising numbers. */
typedef struct oracle_pairing {
    uint32_t *fv, *vf;
    uint32_t count;
    oracle_edges *ee;
} oracle_pairing;

/*
 * The pairing at the perturbed rotation, by trying all vertices and all pairs of edges. `p` and `q` as pir_sum_p and
 * pir_sum_q have them. A point or a segment has no facets.
 */
void oracle_pairing_init(oracle_pairing *pairing, const pir_polytope *p, const pir_polytope *q, pir_quat rotation);
void oracle_pairing_clear(oracle_pairing *pairing);

/*
 * That the pairing of a sum without a region, of polytopes of dimension 2 or 3, is that of the perturbed rotation.
 * NULL, or what does not hold.
 */
const char *oracle_check_pairing(const pir_sum *sum);

#endif
