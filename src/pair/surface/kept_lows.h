/* SPDX-License-Identifier: MIT */
/*
 * How far the triangles of a surface are from x, from placement to placement.
 *
 * A corner less x goes no farther between two placements than the angle of the turn times P's size and the way of x:
 * a triangle comes nearer by that at most. So a distance that was known once holds less all that was taken since. Few
 * triangles can have come nearer than the least facet of D, and these alone are placed anew.
 *
 * The surface of the last placement had x within: it goes around x a number of times that is not 0. Let its corners
 * move straight to where they are now. Of a triangle that was farther from x than they move, no point meets x on the
 * way. Nor does any of a triangle that is so far now: all its corners are beyond a plane that far from x, and come from
 * less far behind it. So where each triangle is the one or the other, the surface goes around x as it did, and each ray
 * from x leaves it through a triangle, which is what inner_surface.h needs. The signs of dets are not asked for.
 */
#ifndef PIR_PAIR_SURFACE_KEPT_LOWS_H
#define PIR_PAIR_SURFACE_KEPT_LOWS_H

#include "pair/surface/inner_surface.h"

/* Keeps the distances of a surface that is placed about x, all of them certain. Not where that has told little. */
void pir_surface_keep(pir_surface *surface, const pir_frame *frame, const pir_placement *placement,
                      const pir_surface_room *room);

/* A placement, and a facet of D there, as a surface with distances that are kept comes to it. */
typedef struct pir_surface_step {
    const pir_frame *frame;
    const pir_placement *placement;
    double least, most; /* between them the slack of the facet lies, that is above 0 */
    double way, taken;  /* what triangles may have come nearer since the last placement, and since they were placed */
} pir_surface_step;

/* Sets both ways, and the triangles that may be no farther from x than the facet. False where distances cannot tell. */
bool pir_surface_approach(pir_surface *surface, const pir_surface_room *room, pir_surface_step *step,
                          uint64_t *ret_near);

/*
 * Whether these triangles, all but those that lie in the facet, are farther from x than that; false too where they are
 * many. Then distances are kept from this placement on, else they are as they were. `room` is used.
 */
bool pir_surface_stays(pir_surface *surface, const pir_surface_step *step, uint64_t near, pir_surface_room *room);

#endif
