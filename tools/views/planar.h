/* SPDX-License-Identifier: MIT */
/* Planar sections of slices: --planar AXIS=NUMBER, and the section of one slice. Functions that return false, or NULL,
   have complained. */
#ifndef TOOLS_VIEWS_PLANAR_H
#define TOOLS_VIEWS_PLANAR_H

#include "../args.h"
#include "slices.h"

/* The plane on which one coordinate, 0, 1 or 2, is `offset`. */
struct planar {
    bool given;
    int axis;
    double offset;
};

/* Reads --planar; not given where the option is not. */
bool planar_read(const struct args *args, struct planar *planar);

/* The section of the difference of a pair of pieces; to be destroyed. */
pir_section *planar_section(const struct planar *planar, const struct slices *slices, uint64_t shown, uint32_t pair);

/* The coordinates of a corner in the plane: y and z, z and x, or x and y. */
void planar_flat(const struct planar *planar, pir_vec3 corner, double ret_flat[2]);

#endif
