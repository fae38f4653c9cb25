/* SPDX-License-Identifier: MIT */
/* The part of a convex polygon that a convex set leaves uncovered. */
#ifndef PIR_SOLID_SUM_SUBTRACT_H
#define PIR_SOLID_SUM_SUBTRACT_H

#include "solid/space/polygons.h"

/* Polygons of a list, a set being cut. */
typedef struct pir_fragments {
    uint32_t *polygon;
    uint32_t count, room, spare_room;
    uint32_t *spare; /* scratch */
} pir_fragments;

void pir_fragments_finish(pir_fragments *fragments, pir_space *space);

/* Adds a polygon to the set. */
void pir_fragments_add(pir_fragments *fragments, pir_space *space, uint32_t polygon);

/*
 * Takes from the fragments what lies in a convex set, of the half-spaces half[0 .. count), all of whose planes are
 * different. A plane of the set may be that of a fragment: where the set is on its upper side, the fragment counts as
 * just above the plane and so within it; where the set is on the lower side, the fragment is left alone. What is taken
 * away is added to `covered`, unless that is NULL. `apart` is as below.
 */
void pir_fragments_subtract(pir_fragments *fragments, pir_polygons *polygons, const uint32_t *half, uint32_t count,
                            pir_fragments *covered, uint32_t *apart);

/* Whether doubles prove that all corners of a polygon are above some half-space. *apart is the one that is looked at
 * first, and becomes the one that was found: half[*apart]. */
bool pir_polygon_is_apart(const pir_polygons *polygons, uint32_t polygon, const uint32_t *half, uint32_t count,
                          uint32_t *apart);

#endif
