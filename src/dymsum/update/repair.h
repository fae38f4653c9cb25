/* SPDX-License-Identifier: MIT */
/* The crossings of one edge of P, brought up to date with an event. Each call returns false when out of memory. */
#ifndef PIR_DYMSUM_UPDATE_REPAIR_H
#define PIR_DYMSUM_UPDATE_REPAIR_H

#include "dymsum/pairing/tracked.h"

/* The arc's first cell, or its last, changes from the near side of halfedge h of Q to the far one. */
bool pir_move_start(pir_tracked *tracked, uint32_t e, uint32_t h);
bool pir_move_end(pir_tracked *tracked, uint32_t e, uint32_t h);

/* Either of the two. It is the faster one among many edges, where a processor does not foresee what the next one is. */
bool pir_move_either(pir_tracked *tracked, uint32_t e, bool start, uint32_t h);

/* Facet g of Q has crossed the arc and is now left of it, or right. */
bool pir_pass_facet(pir_tracked *tracked, uint32_t e, uint32_t g, bool to_left);

/* Derives the crossings anew, from the arc's left cell, which is known, to its right one. */
bool pir_derive_edge(pir_tracked *tracked, uint32_t e);

#endif
