/* SPDX-License-Identifier: MIT */
/* The pairs of pieces of two bodies whose boxes are within a distance of each other, the nearer ones first. */
#ifndef PIR_SOLID_QUERY_VISIT_H
#define PIR_SOLID_QUERY_VISIT_H

#include "solid/query/piece_look.h"

/* Asks about piece i of P and piece j of Q, and says within which distance pairs are still of interest: at most what it
 * said before, or below 0 when none is. */
typedef double pir_pair_asker(void *context, uint32_t i, uint32_t j);

/* Nothing is asked where no pairs of boxes are within the distance. `number` is another, not 0, for each visit. */
void pir_visit_pairs(const pir_compound *p, const pir_compound *q, const pir_relative *relative, uint64_t number,
                     double within, pir_pair_asker *ask, void *context);

#endif
