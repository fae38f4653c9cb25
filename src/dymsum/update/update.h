/* SPDX-License-Identifier: MIT */
/* The update: the pairing carried through the last step. */
#ifndef PIR_DYMSUM_UPDATE_UPDATE_H
#define PIR_DYMSUM_UPDATE_UPDATE_H

#include "dymsum/pairing/tracked.h"

/*
 * Checks the certificates that have expired and repairs what has failed, at the rotation in pairing.signs. `jumped`:
 * the step may have carried facets without certificates through arcs, so every edge is derived anew. On PIR_ERR_MEMORY
 * the pairing is not usable.
 */
pir_status pir_update_repair(pir_tracked *tracked, bool jumped);

#endif
