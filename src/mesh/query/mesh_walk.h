/* SPDX-License-Identifier: MIT */
/*
 * A traversal of a mesh or a height field: boxes first, the nearest of a node's children before the others.
 *
 * Invariants
 *   - A triangle is looked at, at most once, if `measure` is at most `most` for each box that holds it and is given,
 *     and if it meets `within`. Others may be.
 *   - Boxes hold what they are given for, whatever was rounded.
 */
#ifndef PIR_MESH_QUERY_MESH_WALK_H
#define PIR_MESH_QUERY_MESH_WALK_H

#include "mesh/height_field.h"
#include "mesh/trimesh.h"

/* A triangle that a walk comes to. */
typedef struct pir_met_triangle {
    uint32_t number;
    uint32_t id[3]; /* of its corners: equal where they are at one place */
    pir_tri tri;
} pir_met_triangle;

/* A box along the axes of the surface's frame. */
typedef struct pir_walk_box {
    double low[3], high[3];
} pir_walk_box;

typedef struct pir_walk {
    /* Writes how near each box can be, HUGE_VAL for what is not to be entered. */
    void (*measure)(const void *context, const pir_mesh_boxes *boxes, double ret_near[PIR_MESH_WIDTH]);
    /* Looks at a triangle; false ends the walk. */
    bool (*look)(void *context, const pir_met_triangle *triangle);
    void *context;
    const double *most;         /* what is not as near as this is not entered; it may change */
    const pir_walk_box *within; /* triangles that do not meet it may be left out; NULL: none */
} pir_walk;

/* Where a walk looks for what meets a box: 0 for those of `boxes` that meet it, HUGE_VAL for others. */
void pir_walk_box_measure(const pir_walk_box *box, const pir_mesh_boxes *boxes, double ret_near[PIR_MESH_WIDTH]);

/* Whether the box around a triangle meets a box. */
bool pir_walk_box_meets(const pir_walk_box *box, const pir_tri *tri);

/* PIR_ERR_ARGUMENT where there is neither a mesh nor a field. */
pir_status pir_surface_check(pir_surface_ref surface);

void pir_surface_walk(pir_surface_ref surface, const pir_walk *walk);

pir_tri pir_surface_tri(pir_surface_ref surface, uint32_t triangle);
/* A triangle, which is none of a hole, as a walk comes to it. */
pir_met_triangle pir_surface_met(pir_surface_ref surface, uint32_t triangle);
uint32_t pir_surface_material(pir_surface_ref surface, uint32_t triangle);

/* A box around all triangles. */
pir_walk_box pir_surface_bounds(pir_surface_ref surface);

/* The greatest size of a coordinate of a box around all, axis by axis. */
void pir_surface_reach(pir_surface_ref surface, double ret_reach[3]);

#endif
