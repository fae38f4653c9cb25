/* SPDX-License-Identifier: MIT */
/*
 * The boundary of unions of convex polygons that do not overlap, plane by plane: directed edges with the union on their
 * left, cut wherever an edge, of this plane or another, begins or ends on them.
 */
#ifndef PIR_SOLID_SUM_OUTLINE_H
#define PIR_SOLID_SUM_OUTLINE_H

#include "solid/space/intern.h"
#include "solid/space/polygons.h"

/* A run of a line. */
typedef struct pir_run {
    uint32_t half, line;
    uint32_t a, b; /* points, a before b along the line */
    int sign;      /* 1 when the edge leads from a to b, −1 when from b to a */
} pir_run;

/* A vertex within a run of a line, where runs of other lines end. */
typedef struct pir_touch {
    uint32_t line, point;
} pir_touch;

typedef struct pir_outline {
    pir_space *space;
    pir_intern points, lines;
    uint32_t *line_direction, line_room;
    uint32_t *line_of, line_of_room; /* per plane of the group at hand: the line where it cuts the group's plane */
    pir_run *run;                    /* in order of the half-spaces that were added */
    uint32_t run_count, run_room;
    pir_run *side; /* scratch: the sides of the group at hand, the parts of a run */
    uint32_t side_count, side_room;
    pir_touch *touch; /* by line */
    uint32_t touch_count, touch_room;
    uint32_t *order, order_room, *work, work_room, *place, place_room, place_count;
} pir_outline;

void pir_outline_init(pir_outline *outline, pir_space *space);
void pir_outline_finish(pir_outline *outline);

/* Adds the boundary of the union of polygons in one plane, all on the same side of it. */
void pir_outline_add(pir_outline *outline, const pir_polygons *polygons, const uint32_t *polygon, uint32_t count);

/* Cuts the runs at each other's ends, once all are there. */
void pir_outline_cut(pir_outline *outline);

#endif
