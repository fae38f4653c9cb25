/* SPDX-License-Identifier: MIT */
/*
 * Parts of facets of an obstacle: closed convex polygons, segments and points in the plane of a facet, which the
 * insides of sums leave uncovered.
 *
 * A polygon has a wall through each side, a half-space that holds it; corner i is where the plane and the walls i − 1
 * and i meet. A segment has two corners and three walls: that of its line, then those of its two ends. A point has one
 * corner. So every corner is where three planes of the obstacle meet, and no number rests on a constructed one.
 */
#ifndef PIR_SOLID_DEPTH_FREE_PARTS_H
#define PIR_SOLID_DEPTH_FREE_PARTS_H

#include "solid/depth/obstacle.h"

typedef struct pir_free_part {
    uint32_t plane, first, corners; /* walls are from `first` on as well */
    uint32_t nearest;               /* its point that is nearest to the place of P */
    double least, most;             /* between which its distance is */
} pir_free_part;

typedef struct pir_free_parts {
    pir_obstacle *obstacle;
    pir_free_part *part;
    uint32_t *corner, *wall;
    int8_t *sign; /* scratch, per corner */
    uint32_t count, room, used, corner_room, wall_room, sign_room;
} pir_free_parts;

void pir_free_parts_finish(pir_free_parts *parts);

/* Adds the facet that a plane of a sum has, but for what is inner (shared_features.h): as one part, as its sides and
 * corners, or none. They are those from the returned number on. */
uint32_t pir_free_parts_facet(pir_free_parts *parts, uint32_t plane);

/* The corners of the facet of a plane by doubles, within 2^-47: how many; 0 where it may be more than the copy of one
 * facet or has more than there is room for. */
uint32_t pir_free_parts_corners(const pir_obstacle *obstacle, uint32_t plane, uint32_t room, double (*ret_corner)[3]);

/* Adds the parts of a part that the inside of a sum leaves: those from the returned number on. */
uint32_t pir_free_parts_subtract(pir_free_parts *parts, uint32_t part, const pir_obstacle_sum *sum);

#endif
