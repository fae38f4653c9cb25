/* SPDX-License-Identifier: MIT */
/*
 * The part of a sum within a cone of directions. The idea and the invariants stand in region.c.
 */
#ifndef PIR_DYMSUM_REGION_REGION_H
#define PIR_DYMSUM_REGION_REGION_H

#include "dymsum/pairing/tracked.h"
#include "dymsum/region/cover.h"
#include "dymsum/region/sweep.h"

typedef struct pir_region {
    pir_cone cone;
    pir_cover cover;
    bool admits;      /* a sweep has chosen features that are not admitted yet */
    bool jumped;      /* the last step may have carried inactive facets through active arcs */
    pir_sweep *sweep; /* made for the first cone */
} pir_region;

void pir_region_finish(pir_region *region, const pir_allocator *allocator);

/* Makes the memory for regions where it is not there yet, with all features active; false when out of memory. */
bool pir_region_reserve(pir_region *region, pir_tracked *tracked);

/*
 * Limits a whole pairing to a region. *ret_fits: whether it has a cell for every facet that the cover asks for and for
 * no other, crossings for no other edge, and the cover holds. Cells are in range or PIR_NO_PAIR. False when out of
 * memory.
 */
bool pir_region_adopt(pir_region *region, pir_tracked *tracked, const pir_cone *cone, const pir_cover *cover,
                      bool *ret_fits);

/* Whether what is kept includes all that the region needs at `rotation`. */
bool pir_region_holds(const pir_region *region, const pir_rotation *rotation);

/* The part of all features that is active, from 0 to 1. */
double pir_region_share(const pir_region *region, const pir_tracked *tracked);

/* Notes a step from the rotation of unit quaternion `before` to that of the pairing. */
void pir_region_step(pir_region *region, const pir_tracked *tracked, pir_quat before);

/* --- around an update --- */

/* Before an update: chooses anew where the cover has ceased to hold, and drops what is left out. */
void pir_region_follow(pir_region *region, pir_tracked *tracked);

/* After an update: adds what has been chosen and is not there yet. False when out of memory. */
bool pir_region_admit(pir_region *region, pir_tracked *tracked);

/* --- around a rebuild --- */

/* Centres the cover on the rotation of now, by the motion since the cover before. Afresh: that is forgotten. */
void pir_region_centre(pir_region *region, const pir_tracked *tracked);
void pir_region_centre_afresh(pir_region *region, const pir_tracked *tracked);

/* Centres it for a walk, with no more than the cone needs: another walk is likely to follow. */
void pir_region_centre_walk(pir_region *region, const pir_tracked *tracked);

/* Chooses the features that the cover asks for, and drops the others. */
void pir_region_choose(pir_region *region, pir_tracked *tracked);

/* Makes the pairing of what is kept from nothing. There are no crossings before. False when out of memory. */
bool pir_region_walk(pir_region *region, pir_tracked *tracked);

/* Opens: keeps all features, for a rebuild that pairs all. Closes: keeps only what the region needs. */
void pir_region_open(pir_region *region, pir_tracked *tracked);
void pir_region_close(pir_region *region, pir_tracked *tracked);

#endif
