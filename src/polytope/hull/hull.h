/* SPDX-License-Identifier: MIT */
/*
 * The exact convex hull of integer points, of any dimension from 0 to 3, with maximal facets and extreme vertices only.
 */
#ifndef PIR_POLYTOPE_HULL_HULL_H
#define PIR_POLYTOPE_HULL_HULL_H

#include "exact/vectors.h"
#include "polytope/hull/loops.h"
#include "polytope/hull/orient.h"

typedef struct pir_hull {
    int dimension;
    uint32_t vertex_count;
    uint32_t *vertices; /* the extreme points by rising index; of equal points the first */
    pir_loops facets;   /* of point indices, canonical; a polygon's two sides; none below dimension 2 */
    uint32_t corners;   /* room in facets.corner */
} pir_hull;

/*
 * `points` is not empty; doubles: the same points, where they are doubles up to a common factor, or NULL, which is
 * slower. PIR_ERR_MEMORY, PIR_ERR_LIMIT (2^30 points or more).
 */
pir_status pir_hull_make(const pir_vectors *points, const pir_vec3 *doubles, const pir_allocator *allocator,
                         pir_hull *ret_hull);
void pir_hull_finish(pir_hull *hull, const pir_allocator *allocator);

#endif
