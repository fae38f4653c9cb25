/* SPDX-License-Identifier: MIT */
/*
 * A triangulated convex hull by quickhull, every visibility decided exactly. Coplanar triangles are left as they are:
 * hull.c merges.
 */
#ifndef PIR_POLYTOPE_HULL_QUICKHULL_H
#define PIR_POLYTOPE_HULL_QUICKHULL_H

#include "polytope/hull/orient.h"

/* One cache line, so the origin of the plane is not kept: it is the place of vertex[0]. */
typedef struct pir_triangle {
    pir_vec3 normal;      /* of its plane, outwards, not of unit length */
    double farthest;      /* the height of the first point of `outside` */
    uint32_t vertex[3];   /* counter-clockwise from outside */
    uint32_t neighbor[3]; /* neighbor[i] is across the edge from vertex[i] to the next */
    uint32_t outside;     /* first point of the list of those that see it and wait here, or PIR_NONE */
    uint32_t mark; /* twice the round in which it was last looked at, one more if it was visible; or PIR_DELETED */
} pir_triangle;

#define PIR_NONE    UINT32_MAX
#define PIR_DELETED UINT32_MAX

/* Slots of triangles, growing. */
typedef struct pir_slots {
    uint32_t *slot;
    uint32_t count, capacity;
} pir_slots;

typedef struct pir_quickhull {
    pir_points *points; /* borrowed */
    pir_allocator allocator;
    pir_triangle *triangle; /* slots [0, count) have been used; those deleted are in `free` */
    uint32_t count, capacity;
    uint32_t *next;    /* per point: the next in its triangle's list */
    uint32_t *horizon; /* per point: the new triangle whose horizon edge starts there */
    pir_slots visible; /* the triangles that the point in hand sees */
    pir_slots fresh;   /* those made in their place */
    pir_slots open;    /* a stack that holds every triangle with a list, and others */
    pir_slots free;
    uint32_t round;
} pir_quickhull;

/*
 * The hull of all points, starting from four that are not coplanar. Fastest where points near in space are near in
 * number. PIR_ERR_MEMORY leaves nothing to release.
 */
pir_status pir_quickhull_run(pir_quickhull *hull, pir_points *points, const pir_allocator *allocator,
                             const uint32_t simplex[4]);
void pir_quickhull_finish(pir_quickhull *hull);

static inline bool pir_triangle_lives(const pir_triangle *triangle) {
    return triangle->mark != PIR_DELETED;
}

#endif
