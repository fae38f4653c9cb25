/* SPDX-License-Identifier: MIT */
#ifndef EXAMPLES_PIANO_DRAW_H
#define EXAMPLES_PIANO_DRAW_H

#include "place.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Draws the path from above, as SVG: obstacles, and the robot at `poses` spots of it. 0 on failure. */
int draw_path(const world *place, const spot *path, int count, int poses, const char *file);

#ifdef __cplusplus
}
#endif

#endif
