/* SPDX-License-Identifier: MIT */
/* Edges that lie within facets, of which they are no side: the facets' loops are to walk them both ways. */
#ifndef PIR_SOLID_GLUE_IMPRINT_H
#define PIR_SOLID_GLUE_IMPRINT_H

#include "solid/glue/union_outline.h"

/* The polygons of a group, in one plane. */
typedef struct pir_facet_group {
    const pir_polygons *polygons;
    const uint32_t *polygon;
    uint32_t count;
} pir_facet_group;

/* Shortens *segment to what of it is in a closed convex set, of the half-spaces half[0 .. count): whether that has a
 * length. The segment lies in the planes that it names. */
bool pir_segment_clip(pir_space *space, pir_segment *segment, const uint32_t *half, uint32_t count);

/* Adds to the runs of an outline that has been cut, for each group, those loose runs that lie within its polygons. */
void pir_union_outline_imprint(pir_union_outline *outline, const pir_facet_group *group, uint32_t count);

/* How many edges there are: runs at one place are one. */
uint32_t pir_union_outline_edges(pir_union_outline *outline);

#endif
