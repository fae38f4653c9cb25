/* SPDX-License-Identifier: MIT */
/*
 * Whether a facet of a model lies in the boundary of its hull, exactly.
 *
 * It does when all its corners are on one facet of the hull, or when lines between its corners cut it into parts that
 * are each on one facet. So a polygon that rounding has bent a little outward is still a facet of a convex body.
 */
#ifndef PIR_POLYTOPE_SURFACE_CUT_POLYGON_H
#define PIR_POLYTOPE_SURFACE_CUT_POLYGON_H

#include "polytope/surface/on_hull.h"
#include "polytope/surface/six_volumes.h"

enum pir_on_hull_answer { PIR_IS_ON_HULL, PIR_IS_OFF_HULL, PIR_ON_HULL_NO_MEMORY };

/* Whether a polygon lies in the boundary; one without corners does. If so, its parts are added to `volumes`. */
enum pir_on_hull_answer pir_cut_polygon(struct pir_on_hull *on, const uint32_t *corner, uint32_t count, bool turned,
                                        struct pir_six_volumes *volumes);

#endif
