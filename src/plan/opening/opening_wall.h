/* SPDX-License-Identifier: MIT */
/*
 * Walls of obstacles that a piece of the robot has to pass, and the holes in them.
 *
 * A plane n·x = d cuts pieces of the obstacles, in a set W. A piece K of the robot is on its side n·x < d at the
 * start, on the other at the goal, wholly. A point p within K can be at places in Q alone: the bounds, as much wider
 * as p is far from the origin. Invariants of a wall, each in rationals: the part of Q in the plane that is not in W is
 * in holes, but for what has no area. A hole is a union of convex polygons, of whose sides every point is in W, or on
 * a side of another one that runs the other way. So the hole's boundary is in W.
 *
 * Obstacles that touch but for roundings leave slits, which are no holes: a corner of K may be in one, however thin.
 * So K is taken a part of 2^-PIR_OPENING_SHRINK smaller about p, which is farther from what K misses, by that part of
 * how far p is inside of K. Sections are widened about their corners' mean by no more than that, `room`, which closes
 * slits.
 *
 * On a free way, from when K last leaves the side of the start, until it is on the other for the first time, the plane
 * cuts the inside of K, in a connected set that misses W. As p passes the plane it is in a hole; what is cut cannot
 * leave this one, neither at once nor as it changes. So it always is in a disc that has all holes' corners about one
 * middle each: `square` is above the squares of their distances.
 */
#ifndef PIR_PLAN_OPENING_OPENING_WALL_H
#define PIR_PLAN_OPENING_OPENING_WALL_H

#include "plan/opening/opening_body.h"
#include "plan/opening/opening_polygon.h"
#include "plan/plan_write.h"

#define PIR_OPENING_SHRINK 30

typedef struct pir_opening_hole {
    pir_opening_polygons parts;
    double centre[3];
} pir_opening_hole;

typedef struct pir_opening_wall {
    mpq_t plane[4], square; /* n and d; of the disc */
    pir_opening_hole *hole;
    uint32_t holes;
    uint32_t *piece, pieces; /* of the robot: those that have to pass */
} pir_opening_wall;

/* Exact pieces, of which walls are made. */
typedef struct pir_opening_parts {
    pir_plan_asked question;
    pir_opening_body *robot, *obstacle;
    pir_opening_body *at[2];  /* pieces of the robot, as they are at both ends */
    pir_opening_half **facet; /* of each obstacle */
    mpq_t (*point)[3];        /* of each piece of the robot, the one within it: the mean of its vertices */
    mpq_t reach;              /* above how far these are from the origin */
    mpq_t room;               /* a double: how much nearer sections may be than obstacles are */
} pir_opening_parts;

/* PIR_ERR_LIMIT where numbers become too long. */
pir_status pir_opening_parts_make(const pir_plan_asked *question, pir_opening_parts *ret_parts);
void pir_opening_parts_finish(pir_opening_parts *parts);

/*
 * Makes the wall in a plane, given by doubles. Without pieces where it is none: where no piece has to pass, where holes
 * are open, or have too many parts.
 */
pir_status pir_opening_wall_make(const pir_opening_parts *parts, const double n[3], double d,
                                 pir_opening_wall *ret_wall);
void pir_opening_wall_finish(pir_opening_wall *wall);

#endif
