/* SPDX-License-Identifier: MIT */
/*
 * The parts that the sum of open solids leaves out beside facets: segments, points, and the edges where two-sided
 * facets cross others.
 */
#ifndef PIR_SOLID_SUM_TIGHT_H
#define PIR_SOLID_SUM_TIGHT_H

#include "solid/glue/imprint.h"
#include "solid/space/boxes.h"
#include "solid/sum/touching.h"

/* The polygons of all facets; those from `two_sided` on are of two-sided ones. */
typedef struct pir_facet_polygons {
    const pir_polygons *polygons;
    const uint32_t *polygon;
    uint32_t count, two_sided;
} pir_facet_polygons;

/* Adds the edges to the outline, before it is cut, from segments and points that are left. ret_points gets the points
 * on their own, whose numbers are the outline's. */
void pir_tight_add(pir_union_outline *outline, const pir_facet_polygons *facets, const pir_touching *left,
                   pir_touching *ret_points);

#endif
