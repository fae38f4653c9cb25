/* SPDX-License-Identifier: MIT */
/* The cells of all facets, from nothing. */
#ifndef PIR_DYMSUM_REBUILD_FACET_CELLS_H
#define PIR_DYMSUM_REBUILD_FACET_CELLS_H

#include "dymsum/pairing/tracked.h"

/* Fills fv. The kernels know of the rotation. */
void pir_locate_facets_of_p(pir_tracked *tracked);

/* Fills vf from the crossings, which are all there, in slots without a gap. The kernels know of the rotation. */
void pir_locate_facets_of_q(pir_tracked *tracked);

#endif
