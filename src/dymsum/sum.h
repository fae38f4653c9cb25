/* SPDX-License-Identifier: MIT */
/*
 * The inside of a sum: a tracked pairing, its region, its tolerance, and what the choice of a method is made from.
 *
 * Only the sum's own files include this. Those who read a sum include dymsum/view.h.
 */
#ifndef PIR_DYMSUM_SUM_H
#define PIR_DYMSUM_SUM_H

#include <stdatomic.h>

#include <pirouette/cgm.h>

#include "dymsum/pairing/tracked.h"
#include "dymsum/region/region.h"
#include "dymsum/update/choose.h"
#include "dymsum/update/lag.h"

struct pir_sum {
    pir_tracked tracked;      /* first, see pir_sum_pairing */
    atomic_uint references;   /* the caller's, and those of its queries and live meshes */
    pir_polytope *made_of[2]; /* at scale 1, by pir_operand: the same objects until the scale is set */
    pir_cost_model cost;
    pir_lag lag;
    pir_region region;
    pir_cgm *cgm_q; /* Q's cubical Gaussian map, from the first rebuild by CGM on */
};

/* A sum at a rotation with all its memory and no pairing yet; it takes references of its own. */
pir_status pir_sum_new(const pir_sum_parts *parts, pir_sum **ret_sum);

/* Makes what a tolerance needs. False when out of memory. */
bool pir_sum_reserve_lag(pir_sum *sum);

/* Called before a change, whether or not that succeeds: a failed call may store the same pairing in other slots. */
static inline void pir_sum_changes(pir_sum *sum) {
    sum->tracked.pairing.generation++;
}

#endif
