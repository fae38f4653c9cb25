/* SPDX-License-Identifier: MIT */
/*
 * The facets of D about the foot of x, found by exact steps: where facets differ by less than doubles tell, as at the
 * ends of two prisms of many sides that are nearly parallel.
 *
 * A step goes from a facet across one of its sides to the facet on the other side of it. Both are proven by exact
 * slopes. From a first facet the steps go across the side that the foot is farthest beyond: facets about one direction
 * are the cells of a convex subdivision, in which such steps end. Then all facets are taken that reach a disc about the
 * foot.
 *
 * Let C be these facets, and G any other whose normal, as a ray from x, leaves D through a facet F of C, at the
 * distance t. D is within the plane of G, so t is at most the slack of G. The slack of F is t times the cosine of the
 * angle of both normals, and so less than t. So the least slack of all is that of a facet of C, or of one whose normal
 * leaves D beside C.
 */
#ifndef PIR_QUERY_WALK_FOOT_WALK_H
#define PIR_QUERY_WALK_FOOT_WALK_H

#include "query/decide/facet.h"

#define PIR_ABOUT_FOOT 16

typedef struct pir_about_foot {
    uint32_t count;
    pir_facet facet[PIR_ABOUT_FOOT];
    double
        radius; /* of a disc about the foot of x on the first facet, in its plane: the facets are all that reach it */
} pir_about_foot;

/*
 * Finds those, from the facet of either body at a vertex of D that faces the direction n of the frame most. False where
 * there are too many, where they are not nearly parallel, where vertices have many edges, or where the way is long.
 */
bool pir_foot_walk(pir_exact *exact, const pir_placement *placement, const uint32_t vertex[2], pir_vec3 n,
                   pir_about_foot *ret_about);

#endif
