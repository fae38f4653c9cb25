/* SPDX-License-Identifier: MIT */
/* The second stage of an overlay: the edges of a, cut by b. */
#ifndef PIR_CGM_OVERLAY_OVERLAY_WALK_H
#define PIR_CGM_OVERLAY_OVERLAY_WALK_H

#include "cgm/overlay/overlay_state.h"

/* Walks all edges of a off the rim in one map, its rim vertices being located; false when out of memory. */
bool pir_overlay_walk(struct pir_overlay *overlay, uint32_t map);

#endif
