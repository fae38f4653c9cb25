/* SPDX-License-Identifier: MIT */
/*
 * The place: a robot of three convex pieces, a wall with a gap narrower than the robot is wide, and a pillar. The robot
 * moves and turns about the vertical axis. What it may do is asked of slices alone.
 */
#ifndef EXAMPLES_PIANO_PLACE_H
#define EXAMPLES_PIANO_PLACE_H

#include <pirouette/cspace.h>
#include <pirouette/pirouette.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ROBOT_PIECES = 3, OBSTACLES = 3, STEPS = 120 };

/* Where the robot is: its origin, and how far it is turned, in radians. */
typedef struct spot {
    double x, y, z, turn;
} spot;

/* The box of spots that a planner looks in. */
extern const spot spot_least, spot_most, spot_start, spot_goal;

typedef struct world {
    pir_polytope *robot[ROBOT_PIECES], *obstacle[OBSTACLES];
    pir_cspace *slices;
    const char *error; /* what went wrong, or NULL */
    pir_report report; /* and where */
} world;

/* Makes the bodies, slices them into `file`, and opens it; 0 on failure. */
int place_make(world *place, const char *file);
void place_clear(world *place);

pir_pose place_pose(const spot *at);

/* Whether the slices prove a spot, or all of a straight motion, free. */
int place_is_free(world *place, const spot *at);
int place_may_go(world *place, const spot *from, const spot *to);

/* A length of motions: turning by a radian counts as moving by 1. */
double spot_distance(const spot *a, const spot *b);
spot spot_between(const spot *a, const spot *b, double share);

/*
 * Asks `points` points of a path of `count` spots for overlap, pair by pair, by queries that know no slices. The number
 * of points at which the robot touches or overlaps something; −1 on failure.
 */
int place_check(world *place, const spot *path, int count, int points);

#ifdef __cplusplus
}
#endif

#endif
