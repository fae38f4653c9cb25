/* SPDX-License-Identifier: MIT */
/*
 * What a sum keeps when its caller needs a cone of directions only. The idea and the invariants stand in region.c.
 */
#ifndef PIR_DYMSUM_REGION_REGION_H
#define PIR_DYMSUM_REGION_REGION_H

#include "dymsum/pairing/tracked.h"
#include "dymsum/region/cover.h"
#include "dymsum/region/sweep.h"

typedef struct pir_region {
    pir_cone cone;
    pir_cover cover;
    bool admits;     /* a sweep has counted in features that are still inactive */
    bool jumped;     /* the last step may have carried what was or is inactive through what is active */
    pir_sweep sweep; /* memory from the first cone on */
} pir_region;

void pir_region_finish(pir_region *region, const pir_allocator *allocator);

/* Makes memory for regions, unless it is there, all features being active; false when out of memory. */
bool pir_region_reserve(pir_region *region, pir_tracked *tracked);

/*
 * Gives a pairing that has no region, but is the pairing of one, that region; *ret_fits: whether the pairing has a cell
 * for every facet that the cover asks for, none for any other, no crossings else, and the cover holds. Cells are in
 * range or PIR_NO_PAIR. False when out of memory.
 */
bool pir_region_adopt(pir_region *region, pir_tracked *tracked, const pir_cone *cone, const pir_cover *cover,
                      bool *ret_fits);

/* Whether what is kept holds all that the region needs at `rotation`. */
bool pir_region_holds(const pir_region *region, const pir_rotation *rotation);

/* The part of all features that is active, from 0 to 1. */
double pir_region_share(const pir_region *region, const pir_tracked *tracked);

/* Notes a step from the rotation of unit quaternion `before` to that of the pairing. */
void pir_region_step(pir_region *region, const pir_tracked *tracked, pir_quat before);

/* --- around an update --- */

/* Before: where the region needs it chooses anew what is kept, and drops the rest. */
void pir_region_follow(pir_region *region, pir_tracked *tracked);

/* After: brings in what has been chosen and is not there yet. False when out of memory. */
bool pir_region_admit(pir_region *region, pir_tracked *tracked);

/* --- around a rebuild --- */

/* Centres the cover on the rotation of now. `afresh`: whatever was before. */
void pir_region_centre(pir_region *region, const pir_tracked *tracked, bool afresh);

/* Chooses what the cover asks for, and drops what it leaves out. */
void pir_region_choose(pir_region *region, pir_tracked *tracked);

/* Makes the pairing of what is kept from nothing; there are no crossings before. False when out of memory. */
bool pir_region_walk(pir_region *region, pir_tracked *tracked);

/* Keeps all features, for a rebuild that knows no regions; and then again only what the region needs. */
void pir_region_open(pir_region *region, pir_tracked *tracked);
void pir_region_close(pir_region *region, pir_tracked *tracked);

#endif
