/* SPDX-License-Identifier: MIT */
/* The cells of facets, from nothing. In every call the kernels know of the rotation. */
#ifndef PIR_DYMSUM_REBUILD_FACET_CELLS_H
#define PIR_DYMSUM_REBUILD_FACET_CELLS_H

#include "dymsum/pairing/tracked.h"

/* The cell of a facet, from that of vertex `from`. */
uint32_t pir_locate_facet_of_p(pir_tracked *tracked, uint32_t f, uint32_t from);
uint32_t pir_locate_facet_of_q(pir_tracked *tracked, uint32_t g, uint32_t from);

/* Fills fv. */
void pir_locate_facets_of_p(pir_tracked *tracked);

/* Fills vf from the crossings, which are all there, in slots without a gap. */
void pir_locate_facets_of_q(pir_tracked *tracked);

/*
 * Gives facets of Q cells as far as crossings tell, which are in slots without a gap. In work.mark an edge of Q has 0
 * where all of its crossings are known, otherwise 3 or more. The facets, which had no cells, are in work.queue; returns
 * how many they are.
 */
uint32_t pir_spread_cells_of_q(pir_tracked *tracked);

#endif
