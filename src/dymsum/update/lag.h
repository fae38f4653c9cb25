/* SPDX-License-Identifier: MIT */
/* Tolerance: how far a pairing may stay behind the rotation that was asked for. See lag.c for the bound. */
#ifndef PIR_DYMSUM_UPDATE_LAG_H
#define PIR_DYMSUM_UPDATE_LAG_H

#include "exact/rotation.h"
#include "polytope/polytope.h"

#define PIR_LAG_KNOTS 4

/*
 * While `lagging`, the pairing is exact at an earlier rotation, and what is shown is placed by `now`.
 */
typedef struct pir_lag {
    double tolerance; /* a length; 0: never behind */
    /*
     * where there is a tolerance: up to an angle the support function falls short by a length at most; rising, the last
     * length it
     */
    double angle[PIR_LAG_KNOTS], length[PIR_LAG_KNOTS];
    bool lagging;
    double bound;     /* while lagging: what the support function falls short of at most */
    pir_rotation now; /* while lagging: the rotation asked for */
} pir_lag;

/* Measures the operands, whose scale may have changed. */
void pir_lag_measure(pir_lag *lag, const pir_polytope *p, const pir_polytope *q);

/* Whether a turn by `angle` stays within the tolerance. */
static inline bool pir_lag_allows(const pir_lag *lag, double angle) {
    return angle <= lag->angle[PIR_LAG_KNOTS - 1];
}

/* Shows `rotation`, which is valid and `angle`, allowed, from the pairing's. */
void pir_lag_show(pir_lag *lag, pir_quat rotation, double angle);

#endif
