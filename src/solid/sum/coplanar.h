/* SPDX-License-Identifier: MIT */
/* The boundary of the union of convex polygons in one plane, which may overlap. */
#ifndef PIR_SOLID_SUM_COPLANAR_H
#define PIR_SOLID_SUM_COPLANAR_H

#include "solid/glue/union_outline.h"

/* Adds the boundary of the union of polygons on the same side of one plane, one at the least, as a group. */
void pir_coplanar_outline(pir_union_outline *outline, uint32_t group, const pir_polygons *polygons,
                          const uint32_t *polygon, uint32_t count);

#endif
