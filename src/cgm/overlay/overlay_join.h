/* SPDX-License-Identifier: MIT */
/* The third stage of an overlay: edges, rings and faces of the result. */
#ifndef PIR_CGM_OVERLAY_OVERLAY_JOIN_H
#define PIR_CGM_OVERLAY_OVERLAY_JOIN_H

#include "cgm/overlay/overlay_state.h"

/* Makes the edges on b alone and links the rings of one map, a's part being there; false when out of memory. */
bool pir_overlay_join(struct pir_overlay *overlay, uint32_t map);

/* Gives the features of the finished maps what their sources contribute; false when out of memory. */
bool pir_overlay_attribute(struct pir_overlay *overlay);

#endif
