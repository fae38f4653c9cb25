/* SPDX-License-Identifier: MIT */
/* The rebuild by checking all pairs. */
#ifndef PIR_DYMSUM_REBUILD_BRUTE_H
#define PIR_DYMSUM_REBUILD_BRUTE_H

#include "dymsum/pairing/tracked.h"

/* As pir_walk_rebuild. O(features of P · features of Q). */
pir_status pir_brute_rebuild(pir_tracked *tracked);

#endif
