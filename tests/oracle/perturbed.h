/* SPDX-License-Identifier: MIT */
/*
 * Ties settled for real: the rotation q + (ε, ε³, ε⁹, ε²⁷) with an ε so small that its powers rank like the
 * symbolic ones do. That is the perturbation that the library promises, carried out in (large) integers instead of
 * symbols.
 */
#ifndef PIR_ORACLE_PERTURBED_H
#define PIR_ORACLE_PERTURBED_H

#include <pirouette/sum.h>

#include "oracle/points.h"

/*
 * q perturbed, as integers. s is a form of degree 2 in q: for integers a and b of `bits` bits, and q in integers of
 * `span` bits, the coefficients of its expansion in ε are integers below 2^(2·bits + 2·span + 8), so with ε =
 * 2^-(2·bits + 2·span + 16) the first that is not zero outweighs all after it.
 */
void oracle_perturbed_quat_init(oracle_quat to, pir_quat q, uint32_t bits);

/* The sign of (M(q)·a)·b. */
int oracle_sign(oracle_quat q, oracle_vec a, oracle_vec b);

/*
 * That the pairing of a sum of polytopes of dimension 2 or 3 is that of the perturbed rotation: fv and vf are the
 * farthest vertices along facet normals, ee are the pairs of edges that lie farthest, alone, along their common normal.
 * NULL, or what does not hold.
 */
const char *oracle_check_pairing(const pir_sum *sum);

#endif
