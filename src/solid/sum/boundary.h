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
    uint32_t *number, number_count;              /* per point of the space its vertex, or none */
    uint32_t *vertex, vertex_count, vertex_room; /* points, as facets, then segments, then points name them */
} pir_sum_boundary;

/* The status is the space's. What is there after a failure is to be finished. */
void pir_sum_boundary_make(pir_sum_boundary *boundary, const pir_shell_body body[2], pir_convexes convexes[2],
                           bool open);
void pir_sum_boundary_finish(pir_sum_boundary *boundary);

#endif
