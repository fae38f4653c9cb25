/* SPDX-License-Identifier: MIT */
/* The boundary of a sum from its pieces at one rotation: what pair sums leave of candidates, glued to facets. */
#ifndef PIR_SOLID_SUM_BOUNDARY_H
#define PIR_SOLID_SUM_BOUNDARY_H

#include "solid/glue/facet_loops.h"
#include "solid/glue/imprint.h"
#include "solid/sum/remains.h"

typedef struct pir_sum_boundary {
    pir_space *space;
    pir_remains remains;
    pir_union_outline outline;
    pir_loop_list loops;
    pir_fragments fragments; /* of all groups */
    pir_facet_group *group;
    uint32_t *order, *work;
    uint32_t order_count, group_count, group_room;
    uint32_t first_loose; /* fragments of boundary facets */
    pir_touching points;
    uint32_t edges, segments;
    bool is_glued; /* of what was kept */
    uint64_t candidates, survivors;
    uint32_t *number, number_room;               /* per point of the space its vertex, or none */
    uint32_t *vertex, vertex_count, vertex_room; /* points, as facets, then segments, then points name them */
} pir_sum_boundary;

/* The status is the space's. What is there after a failure is to be finished. */
void pir_sum_boundary_make(pir_sum_boundary *boundary, const pir_shell_body body[2], pir_convexes convexes[2],
                           bool open);

/* Begins and ends a boundary whose facets are glued by whoever keeps them: its loops and counts, but for the vertices,
 * are to be added between the two. What memory such a boundary has it keeps. */
void pir_sum_boundary_begin(pir_sum_boundary *boundary, pir_space *space);
void pir_sum_boundary_end(pir_sum_boundary *boundary);
void pir_sum_boundary_finish(pir_sum_boundary *boundary);

#endif
