/* SPDX-License-Identifier: MIT */
/* The cells that one facet has crossed in the last step. */
#ifndef PIR_DYMSUM_UPDATE_TRACE_H
#define PIR_DYMSUM_UPDATE_TRACE_H

#include "dymsum/pairing/tracked.h"

#define PIR_TRACE_LONGEST 8

/* The sides that a facet has crossed, in order, the cell where it is now, and how long it stays there. */
typedef struct pir_trace {
    uint32_t count, crossed[PIR_TRACE_LONGEST], cell;
    pir_expiry expiry;
} pir_trace;

/*
 * Follows facet f of P, or g of Q, from the cell in fv or vf, where it was before the last step. False where doubles
 * are not certain.
 */
bool pir_trace_fv(pir_tracked *tracked, uint32_t f, pir_trace *ret_trace);
bool pir_trace_vf(pir_tracked *tracked, uint32_t g, pir_trace *ret_trace);

#endif
