/* SPDX-License-Identifier: MIT */
/* Facets from the edges round them: loops, holes with the facets they are in, and slits that make each one loop. */
#ifndef PIR_SOLID_GLUE_LOOPS_H
#define PIR_SOLID_GLUE_LOOPS_H

#include "solid/glue/union_outline.h"

typedef struct pir_loop {
    uint32_t first, count; /* corners */
    bool hole;
    uint32_t within; /* of a hole: the loop of its facet */
} pir_loop;

typedef struct pir_loop_list {
    pir_space *space;
    uint32_t count, room, corner_count, corner_room;
    pir_loop *loop;
    uint32_t *corner; /* points */
    uint32_t facet_count, facet_room, facet_corner_count, facet_corner_room;
    uint32_t boundary_count; /* facets of groups that are not loose, which come first */
    uint32_t *facet;         /* where the corners of each facet end */
    uint32_t *facet_corner;
    uint32_t *spare, spare_count, spare_room; /* scratch: the corners of the facet at hand */
    uint32_t hole_count;
    bool *used; /* scratch, per run */
    uint32_t used_room, *seat, seat_room;
    uint32_t *order, order_room, *work, work_room; /* likewise, per loop of a group */
    pir_loop *copy;
    uint32_t copy_room;
} pir_loop_list;

/* Takes all out, and keeps the memory. */
void pir_loops_begin(pir_loop_list *loops, pir_space *space);

/* Adds a corner to the facet at hand, a point; and ends that facet. */
void pir_loops_push_corner(pir_loop_list *loops, uint32_t point);
void pir_loops_end_facet(pir_loop_list *loops);

/* Traces the runs of an outline that has been cut, those of one group after the other; adds their facets. */
void pir_loops_trace(pir_loop_list *loops, const pir_union_outline *outline);
void pir_loop_list_finish(pir_loop_list *loops);

#endif
