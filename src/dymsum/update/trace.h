/* SPDX-License-Identifier: MIT */
/* The cells that facets have crossed in the last step. */
#ifndef PIR_DYMSUM_UPDATE_TRACE_H
#define PIR_DYMSUM_UPDATE_TRACE_H

#include "dymsum/pairing/tracked.h"

/*
 * Follows the facets of P, or of Q, among `count` suspects that have no known side, from the cells where they were
 * before the last step: in order, and no more than there is `room` for traces. Where their ways are certain they are
 * certified in the cells where they are now. Returns how many it has followed.
 */
uint32_t pir_trace_open(pir_tracked *tracked, bool of_p, const pir_suspect *suspects, uint32_t count, uint32_t room,
                        pir_trace *ret_traces);

/* Traces one facet. */
void pir_trace_one(pir_tracked *tracked, bool of_p, uint32_t facet, pir_trace *ret_trace);

#endif
