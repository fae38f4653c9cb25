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
     * where there is a tolerance: after a turn by angle[k] the support function falls short by at most length[k];
     * rising, length[PIR_LAG_KNOTS - 1] is the tolerance
     */
    double angle[PIR_LAG_KNOTS], length[PIR_LAG_KNOTS];
    bool lagging;
    double bound;     /* while lagging: an upper bound of what the support function falls short by */
    pir_rotation now; /* while lagging: the rotation asked for */
} pir_lag;

/* Measures the operands, whose scale may have changed. */
void pir_lag_measure(pir_lag *lag, const pir_polytope *p, const pir_polytope *q);

/* Whether a turn by `angle` from the pairing's rotation stays within the tolerance. */
static inline bool pir_lag_allows(const pir_lag *lag, double angle) {
    return angle <= lag->angle[PIR_LAG_KNOTS - 1];
}

/* From here on `rotation` is shown: it is valid, and `angle` away from the pairing's, which is allowed. */
void pir_lag_show(pir_lag *lag, pir_quat rotation, double angle);

#endif
