/* SPDX-License-Identifier: MIT */
/* The point of the difference that is nearest to the origin, by integers alone. */
#ifndef PIR_CERTIFICATE_NEAREST_PAIRS_H
#define PIR_CERTIFICATE_NEAREST_PAIRS_H

#include "certificate/stance.h"

/*
 * Corners with positive weights: the point Σ weight·vertex / `whole`, where `whole` is the sum of the weights. The
 * corners of a nearest point are affinely independent.
 */
typedef struct pir_mix {
    pir_vertex_pair corner[8];
    mpz_t weight[8], whole;
    pir_triple point; /* Σ weight·vertex: `whole` times the point */
    int count;
} pir_mix;

void pir_mix_init(pir_mix *mix);
void pir_mix_finish(pir_mix *mix);

/* Divides the weights by what they have in common, and sums them up. */
void pir_mix_reduce(pir_mix *mix, const pir_stance *bodies);

/*
 * Sets `mix` to the nearest point. It begins at the corner that lies lowest along `start`, which costs steps alone
 * where it is far off. Each step costs the vertices of both bodies.
 */
void pir_nearest_pairs(const pir_stance *bodies, const pir_triple *start, pir_mix *mix);

#endif
