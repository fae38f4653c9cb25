/* SPDX-License-Identifier: MIT */
/* The rebuild by the overlay of two cubical Gaussian maps. */
#ifndef PIR_DYMSUM_REBUILD_CGM_REBUILD_H
#define PIR_DYMSUM_REBUILD_CGM_REBUILD_H

#include <pirouette/cgm.h>

#include "dymsum/pairing/tracked.h"

/* As pir_walk_rebuild. *map_q is Q's map, or NULL before the first rebuild, which makes it; the caller destroys it. */
pir_status pir_cgm_rebuild(pir_tracked *tracked, pir_cgm **map_q);

#endif
