/* SPDX-License-Identifier: MIT */
/* The pairs of pieces of two bodies whose boxes are within a distance of each other, the nearer ones first. */
#ifndef PIR_SOLID_QUERY_VISIT_H
#define PIR_SOLID_QUERY_VISIT_H

#include <pirouette/pair.h>

#include "solid/query/compound.h"

/* Asks about piece i of P and piece j of Q, and says within which distance pairs are still of interest: at most what it
 * said before, or below 0 when none is. */
typedef double pir_pair_asker(void *context, uint32_t i, uint32_t j);

/* The bodies where `input` has them, grown by its radii. */
void pir_visit_pairs(const pir_compound *p, const pir_compound *q, const pir_pair_input *input, double within,
                     pir_pair_asker *ask, void *context);

#endif
