/* SPDX-License-Identifier: MIT */
/*
 * The facets of a kept sum glued together, and kept so: which points are one vertex, the edges of each facet, the
 * vertices of others within these, the loops. From one rotation to the next only what has changed is made anew, and
 * doubles look at the rest again.
 *
 * Points that are one, or in a plane, by what they are of (identity.h), are so at every rotation. All else is looked
 * at: that vertices are apart, that ends stand along their lines as they did, that a vertex near an edge is off it.
 * Where doubles do not tell, exact numbers do.
 *
 * Invariants after a call that succeeds, unless it is `fleeting`:
 * - The outline of each facet that bounds the sum is made. It is of the facet's edges, until the facet is clipped anew.
 * - Two points are at one vertex exactly if they are one at every rotation.
 * - A vertex is in the list of touches of each edge that has it within, and of no other one.
 * - A vertex that is not in the list of those near an edge can get to it only once the vertices have gone farther than
 *   is noted with the list: ways add up from call to call, each the farthest way of any vertex. A vertex that goes much
 *   farther than others is `fresh` instead, as one that is new: it is held against all edges.
 * Where something is so at this rotation by numbers alone, the glue is fleeting, and the next call begins afresh.
 */
#ifndef PIR_SOLID_KEPT_KEPT_GLUE_H
#define PIR_SOLID_KEPT_KEPT_GLUE_H

#include "solid/glue/facet_loops.h"
#include "solid/kept/kept_facet.h"
#include "solid/kept/vertex_grid.h"

typedef struct pir_kept_glue {
    pir_space *space;
    bool fleeting;
    uint32_t vertex_count;
    uint32_t *point, point_room;   /* per vertex: a point of a facet that is there, or none */
    pir_number_list spare;         /* vertices that are not in use */
    uint32_t *vertex, vertex_room; /* per point of the space that is a vertex's, or stands for one */
    uint64_t *mark;                /* per vertex: the round in which it was met last */
    uint64_t *met;                 /* per point of the space likewise */
    uint32_t mark_room, met_room;
    uint64_t round;    /* of facets, in all calls */
    double *place;     /* per vertex: x, y, z in the last call */
    uint64_t *ended;   /* per vertex: the call in which an edge ended there */
    uint64_t *renewed; /* per vertex: the call in which it was fresh */
    uint32_t place_room, ended_room, renewed_room;
    uint64_t calls;
    pir_number_list fresh;
    bool all_fresh, gridded;  /* whether there are too many of them; whether the grid is of this call */
    double way, mean;         /* that all others went in all calls; that they went in this one, in the mean */
    pir_number_list there;    /* scratch: vertices in use */
    pir_union_outline around; /* of the facet at hand; its points are those of all vertices */
    pir_union_outline cut;    /* of the facet at hand, its runs cut */
    pir_places planes;
    pir_vertex_grid grid;
    pir_segment_list edge; /* scratch, as is what follows */
    pir_number_list found, touch, first;
} pir_kept_glue;

/* Glues the facets, in this order, and adds their loops; *ret_edges is how many edges there are. False where planes of
 * facets are one at this rotation, so that they are to be united, or to be in another order; or the space's status says
 * why. */
bool pir_kept_glue_make(pir_kept_glue *glue, pir_plane_facet *const *facet, const uint32_t *order, uint32_t count,
                        pir_loop_list *loops, uint32_t *ret_edges);

void pir_kept_glue_init(pir_kept_glue *glue, pir_space *space);
void pir_kept_glue_finish(pir_kept_glue *glue);

#endif
