/* SPDX-License-Identifier: MIT */
/* Which facets of a hull the points of a model are on, exactly. */
#ifndef PIR_POLYTOPE_SURFACE_ON_HULL_H
#define PIR_POLYTOPE_SURFACE_ON_HULL_H

#include "polytope/hull/orient.h"
#include "polytope/polytope.h"
#include "polytope/surface/facets.h"

/* Where points are on the hull, filled as they are asked for. */
struct pir_on_hull {
    const pir_allocator *allocator;
    const pir_polytope *hull; /* of dimension 3 */
    pir_points points;
    uint32_t *vertex; /* per point: the vertex of the hull at its place, or PIR_NONE */
    /* Per point that is no vertex: its facet of the hull, and another where it is on an edge. PIR_NONE for none, or
       while none is known. */
    struct pir_two_facets {
        uint32_t one, other;
    } * on;
};

bool pir_on_hull_init(struct pir_on_hull *on, const pir_polytope *hull, const struct pir_model_facets *facets,
                      const pir_vectors *exact, const pir_allocator *allocator);
void pir_on_hull_finish(struct pir_on_hull *on);

/* How many facets a point is on, as far as is known, and the one of them numbered `index`. */
uint32_t pir_on_hull_degree(const struct pir_on_hull *on, uint32_t point);
uint32_t pir_on_hull_facet(const struct pir_on_hull *on, uint32_t point, uint32_t index);

/* Finds where the corners of a polygon are; false when one of them is inside the hull. */
bool pir_on_hull_find(struct pir_on_hull *on, const uint32_t *corner, uint32_t count);

/* Whether one facet of the hull holds all corners, which are found. */
bool pir_on_hull_is_on_one(struct pir_on_hull *on, const uint32_t *corner, uint32_t count);

#endif
