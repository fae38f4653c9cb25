/* SPDX-License-Identifier: MIT */
/*
 * The rest of closed polygons outside of open convex sets: polygons, segments and points. So a polygon that open sets
 * cover but for a line or a corner leaves that.
 */
#ifndef PIR_SOLID_SUM_TOUCHING_H
#define PIR_SOLID_SUM_TOUCHING_H

#include "solid/glue/union_outline.h"
#include "solid/sum/subtract.h"

typedef struct pir_touching {
    pir_polygons *polygons; /* borrowed: those of the fragments */
    pir_fragments fragments;
    pir_segment *segment;
    uint32_t *point;
    uint32_t segment_count, segment_room, point_count, point_room;
} pir_touching;

void pir_touching_finish(pir_touching *touching, pir_space *space);
void pir_touching_clear(pir_touching *touching);

void pir_touching_add_segment(pir_touching *touching, pir_space *space, pir_segment segment);
void pir_touching_add_point(pir_touching *touching, pir_space *space, uint32_t point);

/* Takes away what lies in the inside of a convex set, of the half-spaces half[0 .. count); `apart` is as of
 * pir_polygon_is_apart. */
void pir_touching_subtract(pir_touching *touching, const uint32_t *half, uint32_t count, uint32_t *apart);

#endif
