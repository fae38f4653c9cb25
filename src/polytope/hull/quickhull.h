/* SPDX-License-Identifier: MIT */
/*
 * A triangulated convex hull by quickhull, every visibility decided exactly. Coplanar triangles are left as they are:
 * hull.c merges.
 */
#ifndef PIR_POLYTOPE_HULL_QUICKHULL_H
#define PIR_POLYTOPE_HULL_QUICKHULL_H

#include "polytope/hull/orient.h"

typedef struct pir_triangle {
    uint32_t vertex[3];   /* counter-clockwise from outside */
    uint32_t neighbor[3]; /* neighbor[i] is across the edge from vertex[i] to the next */
    pir_plane plane;
    uint32_t outside; /* first point of the list of those that see it and wait here, or PIR_NONE */
    uint32_t mark;    /* the round in which it was last found visible or not */
    bool alive, visible;
} pir_triangle;

#define PIR_NONE UINT32_MAX

typedef struct pir_quickhull {
    pir_points *points; /* borrowed */
    pir_allocator allocator;
    pir_triangle *triangle;
    uint32_t count, capacity;
    uint32_t *next;    /* per point: the next in its triangle's list */
    uint32_t *horizon; /* per point: the new triangle whose horizon edge starts there */
    uint32_t *stack;   /* triangles to visit */
    uint32_t stack_capacity;
    uint32_t round;
} pir_quickhull;

/* The hull of all points, starting from four that are not coplanar. PIR_ERR_MEMORY leaves nothing to release. */
pir_status pir_quickhull_run(pir_quickhull *hull, pir_points *points, const pir_allocator *allocator,
                             const uint32_t simplex[4]);
void pir_quickhull_finish(pir_quickhull *hull);

#endif
