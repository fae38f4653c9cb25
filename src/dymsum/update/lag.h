/* SPDX-License-Identifier: MIT */
/* Tolerance: how far a pairing may stay behind the rotation that was asked for. See lag.c for the bound. */
#ifndef PIR_DYMSUM_UPDATE_LAG_H
#define PIR_DYMSUM_UPDATE_LAG_H

#include "exact/rotation.h"
#include "polytope/polytope.h"

#define PIR_LAG_KNOTS 4

/* The state of a tolerance. */
typedef struct pir_lag_knots {
    /*
     * after a turn by angle[k] the support function falls short by at most length[k]; rising, length[PIR_LAG_KNOTS - 1]
     * is the tolerance
     */
    double angle[PIR_LAG_KNOTS], length[PIR_LAG_KNOTS];
    pir_rotation now; /* while lagging: the rotation asked for */
} pir_lag_knots;

/*
 * While `lagging`, the pairing is exact at an earlier rotation, and what is shown is placed by knots->now.
 */
typedef struct pir_lag {
    double tolerance; /* a length; 0: never behind */
    bool lagging;
    double bound;         /* while lagging: an upper bound of what the support function falls short by */
    pir_lag_knots *knots; /* made for the first tolerance above 0 */
} pir_lag;

/* Makes the knots, unless they are there, whose rotation has its integers in those given. False when out of memory. */
bool pir_lag_reserve(pir_lag *lag, const pir_allocator *allocator, pir_rotation_integers *integers);
void pir_lag_finish(pir_lag *lag, const pir_allocator *allocator);

/* Measures the operands, whose scale may have changed. */
void pir_lag_measure(pir_lag *lag, const pir_polytope *p, const pir_polytope *q);

/* How far the rotation may turn before the pairing has to follow; there is a tolerance. */
static inline double pir_lag_reach(const pir_lag *lag) {
    return lag->knots->angle[PIR_LAG_KNOTS - 1];
}

/* Whether a turn by `angle` from the pairing's rotation stays within the tolerance. */
static inline bool pir_lag_allows(const pir_lag *lag, double angle) {
    return lag->tolerance > 0 && angle <= pir_lag_reach(lag);
}

/* From here on `rotation` is shown: it is valid, and `angle` away from the pairing's, which is allowed. */
void pir_lag_show(pir_lag *lag, pir_quat rotation, double angle);

#endif
