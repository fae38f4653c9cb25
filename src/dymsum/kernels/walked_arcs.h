/* SPDX-License-Identifier: MIT */
/*
 * Arcs of P, walked through cells of Q side by side.
 */
#ifndef PIR_DYMSUM_KERNELS_WALKED_ARCS_H
#define PIR_DYMSUM_KERNELS_WALKED_ARCS_H

#include "dymsum/kernels/facet_checks.h"

/* How many arcs of P are walked at a time. */
#define PIR_ARCS 32

/* Arcs of P whose ends are in different cells of Q. */
typedef struct pir_arcs {
    uint32_t count;
    uint32_t edge[PIR_ARCS];                  /* of P */
    uint32_t from[PIR_ARCS], to[PIR_ARCS];    /* the cells of its ends */
    uint32_t side[PIR_ARCS];                  /* the side of the first cell that leads to the last, or PIR_NO_SIDE */
    uint32_t right[PIR_ARCS], left[PIR_ARCS]; /* the facets of Q at that side's ends; or of any other side */
    float value[PIR_ARCS][2];                 /* s of the edge and those two */
} pir_arcs;

/* The side of arc k's first cell, of the halfedges from `start` up to `end`, has been found. */
static inline void pir_arcs_take_side(const pir_polytope *q, pir_arcs *arcs, uint32_t k, uint32_t start, uint32_t end,
                                      uint32_t found) {
    uint32_t side = found != PIR_NO_SIDE ? found : start;
    arcs->side[k] = found;
    arcs->right[k] = q->left[(side > start ? side : end) - 1];
    arcs->left[k] = q->left[side];
}

#endif
