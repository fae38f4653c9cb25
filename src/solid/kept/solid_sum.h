/* SPDX-License-Identifier: MIT */
/* The inside of a sum of solids. */
#ifndef PIR_SOLID_SUM_SOLID_SUM_H
#define PIR_SOLID_SUM_SOLID_SUM_H

#include "solid/kept/kept_sum.h"
#include "solid/space/rest.h"
#include "solid/sum/boundary.h"
#include "solid/sum/operands.h"

struct pir_solid_sum {
    pir_allocator allocator;
    pir_solid_sum_options options;
    pir_solid *solid[2];   /* references */
    pir_operands operands; /* at rest, but for the space, which turns */
    pir_convexes convexes[2];
    pir_space_rest rest;
    pir_rotation_integers integers;
    pir_rotation turned; /* what the space has been brought to */
    pir_quat rotation;
    double scale[2];
    bool made;         /* whether the boundary is there */
    pir_kept_sum kept; /* valid only at `rotation` and `scale` */
    uint32_t rests,
        pause; /* of updates that did not pay: rotations to rebuild before the next, and how many next time */
    pir_sum_boundary boundary;
    uint64_t clipped; /* planes of candidates, by the last rotation */
    uint64_t generation;
};

#endif
