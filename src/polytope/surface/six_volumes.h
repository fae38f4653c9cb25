/* SPDX-License-Identifier: MIT */
/* Six times the volume that triangles enclose, exactly. */
#ifndef PIR_POLYTOPE_SURFACE_SIX_VOLUMES_H
#define PIR_POLYTOPE_SURFACE_SIX_VOLUMES_H

#include "exact/vectors.h"

/* Six times a volume, as a sum of pyramids with one apex, in the units of the points cubed. */
struct pir_six_volumes {
    const pir_vectors *points;
    pir_limbs scratch;
    pir_int3 apex; /* the origin, unless set otherwise */
    pir_int sum;
};

bool pir_six_volumes_init(struct pir_six_volumes *volumes, const pir_allocator *allocator, const pir_vectors *points);
void pir_six_volumes_finish(struct pir_six_volumes *volumes, const pir_allocator *allocator);

/* Puts the apex one unit above a point along `axis`: pyramids over polygons in one plane are then as their areas. */
void pir_six_volumes_lift(struct pir_six_volumes *volumes, uint32_t point, int axis);

/* Adds the pyramid over a polygon, a fan from its first corner; subtracts it when `turned`. */
void pir_six_volumes_add(struct pir_six_volumes *volumes, const uint32_t *corner, uint32_t count, bool turned);

#endif
