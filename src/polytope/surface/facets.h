/* SPDX-License-Identifier: MIT */
/*
 * The facets of a model with points at the same place made one, and how they join: by their edges, each an unordered
 * pair of corners.
 */
#ifndef PIR_POLYTOPE_SURFACE_FACETS_H
#define PIR_POLYTOPE_SURFACE_FACETS_H

#include "exact/vectors.h"
#include "polytope/surface/model.h"

/* How facets join along their edges. */
enum pir_joining {
    PIR_JOINED_NOT,     /* some edge is on an odd number of facets: the surface is open */
    PIR_JOINED_ONE_WAY, /* closed, each edge as often walked one way as the other: every facet faces the same side */
    PIR_JOINED_TURNED,  /* closed, each edge on two facets; one way once some facets are reversed */
    PIR_JOINED_NEITHER, /* closed, but the surface is not orientable, or an edge is on more than two facets */
};

struct pir_model_facets {
    uint32_t point_count, place_count; /* different places */
    uint32_t *place;                   /* per point: the first point at the same place */
    uint32_t count;
    uint32_t *start, *corner; /* per facet: three or more corners as places, no two in a row equal; or none */
    uint32_t corner_room;

    enum pir_joining joining;
    /* For each edge, the facets that walk it one way and those that walk it the other differ in
       number by one at most. */
    bool one_way;
    uint8_t *turned; /* per facet: turned round, when PIR_JOINED_TURNED */
    uint32_t *piece; /* likewise, per facet: one facet of the piece that it belongs to, the same for all of the piece */
    /* When PIR_JOINED_NOT: the edge on the earliest facet, that facet, and how many it is on. */
    uint32_t open_edge[2], open_facet, open_count;
};

/* False when out of memory, with nothing left behind. */
bool pir_facets_init(struct pir_model_facets *facets, const struct pir_model *model, const pir_vectors *exact);
void pir_facets_finish(struct pir_model_facets *facets, const pir_allocator *allocator);

#endif
