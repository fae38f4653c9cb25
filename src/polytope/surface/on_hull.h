/* SPDX-License-Identifier: MIT */
/*
 * Whether the facets of a model lie in the boundary of its hull, and six times the volume that triangles enclose; both
 * exactly.
 *
 * A facet lies in the boundary when all its corners are on one facet of the hull, or when it can be cut along straight
 * lines between its corners into parts of which each is on one. So a polygon that rounding has bent a little outward is
 * still a facet of a convex body.
 */
#ifndef PIR_POLYTOPE_SURFACE_ON_HULL_H
#define PIR_POLYTOPE_SURFACE_ON_HULL_H

#include "polytope/hull/orient.h"
#include "polytope/polytope.h"
#include "polytope/surface/facets.h"

/* Six times a volume, as a sum of pyramids with one apex, in the units of the points cubed. */
struct pir_six_volumes {
    const pir_vectors *points;
    pir_limbs scratch;
    pir_int3 apex; /* the origin, unless set otherwise */
    pir_int sum;
};

bool pir_six_volumes_init(struct pir_six_volumes *volumes, const pir_allocator *allocator, const pir_vectors *points);
void pir_six_volumes_finish(struct pir_six_volumes *volumes, const pir_allocator *allocator);

/* Puts the apex one unit above a point along `axis`: pyramids over polygons in one plane are then as their areas. */
void pir_six_volumes_lift(struct pir_six_volumes *volumes, uint32_t point, int axis);

/* Adds the pyramid over a polygon, a fan from its first corner; subtracts it when `turned`. */
void pir_six_volumes_add(struct pir_six_volumes *volumes, const uint32_t *corner, uint32_t count, bool turned);

/* Where points are on the hull, filled as they are asked for. */
struct pir_on_hull {
    const pir_allocator *allocator;
    const pir_polytope *hull; /* of dimension 3 */
    pir_points points;
    uint32_t *vertex; /* per point: the vertex of the hull at its place, or PIR_NONE */
    /* per point that is no vertex: its facet of the hull, and another where it is on an edge; PIR_NONE for none, or
     * not yet known */
    struct pir_two_facets {
        uint32_t one, other;
    } * on;
};

bool pir_on_hull_init(struct pir_on_hull *on, const pir_polytope *hull, const struct pir_facets *facets,
                      const pir_vectors *exact, const pir_allocator *allocator);
void pir_on_hull_finish(struct pir_on_hull *on);

/* How many facets a point is on, as far as is known, and the one of them numbered `index`. */
uint32_t pir_on_hull_degree(const struct pir_on_hull *on, uint32_t point);
uint32_t pir_on_hull_facet(const struct pir_on_hull *on, uint32_t point, uint32_t index);

enum pir_on_hull_answer { PIR_IS_ON_HULL, PIR_IS_OFF_HULL, PIR_ON_HULL_NO_MEMORY };

/* Whether a polygon lies in the boundary, as one without corners does; then its parts are added to `volumes`. */
enum pir_on_hull_answer pir_on_hull_add(struct pir_on_hull *on, const uint32_t *corner, uint32_t count, bool turned,
                                        struct pir_six_volumes *volumes);

/* The same for a polygon whose corners are all found, and not all on one facet. */
enum pir_on_hull_answer pir_on_hull_cut(struct pir_on_hull *on, const uint32_t *corner, uint32_t count, bool turned,
                                        struct pir_six_volumes *volumes);

#endif
