/* SPDX-License-Identifier: MIT */
/* The crossings of many edges, derived anew. */
#ifndef PIR_DYMSUM_UPDATE_DERIVE_H
#define PIR_DYMSUM_UPDATE_DERIVE_H

#include "dymsum/pairing/tracked.h"

/*
 * Derives the crossings of `count` different edges of a large sum anew, as pir_derive_edge does of each. False when out
 * of memory.
 */
bool pir_derive_edges(pir_tracked *tracked, const uint32_t *edge, uint32_t count);

#endif
