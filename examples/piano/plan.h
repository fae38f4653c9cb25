/* SPDX-License-Identifier: MIT */
/* A planner: RRT-Connect (Kuffner and LaValle, ICRA 2000, 10.1109/ROBOT.2000.844730). */
#ifndef EXAMPLES_PIANO_PLAN_H
#define EXAMPLES_PIANO_PLAN_H

#include "place.h"

enum { PATH_ROOM = 512 };

/* A path from start to goal of at most PATH_ROOM spots: their number, or 0 where none was found. */
int plan(world *place, const spot *start, const spot *goal, spot path[PATH_ROOM]);

/* Leaves out spots where a straight motion may go instead, `tries` times at random; the number that is left. */
int shorten(world *place, spot path[PATH_ROOM], int count, int tries);

#endif
