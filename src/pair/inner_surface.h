/* SPDX-License-Identifier: MIT */
/*
 * A closed surface of triangles whose corners are vertices of D, about a point of D, its centre.
 *
 * Invariants
 *   - Every directed side (i, j) of a triangle is the side (j, i) of one other.
 *   - After pir_surface_place has returned true at a placement, det(a, b, c) > 0 for certain for each triangle with the
 *     corners a, b, c relative to the centre.
 *
 * With both, each ray from the centre leaves the surface through a triangle: the surface is a cycle whose
 * projection on a sphere about the centre covers it at least once. Triangles are parts of D. So a facet of D with
 * normal n has at least the distance from the centre that the triangle on the ray along n has; and where that
 * triangle lies in the plane of another facet of D, it has more than that facet.
 *
 * A surface need not be convex. It keeps its corners as vertex pairs, which pir_surface_place places again at another
 * rotation and centre.
 */
#ifndef PIR_PAIR_SURFACE_H
#define PIR_PAIR_SURFACE_H

#include "query/frame/frame.h"

/* With v corners a surface like a sphere has 2 v − 4 triangles. */
#define PIR_SURFACE_CORNERS   32
#define PIR_SURFACE_TRIANGLES 64

typedef struct pir_surface {
    uint32_t used; /* a bit for each corner that a triangle has */
    uint32_t count;
    uint32_t a[PIR_SURFACE_CORNERS], b[PIR_SURFACE_CORNERS];
    uint8_t corner[3][PIR_SURFACE_TRIANGLES];
} pir_surface;

/* The surface at a placement: in the workspace. Arrays of triangles are padded to whole lanes. */
typedef struct pir_surface_room {
    pir_vec3 centre;
    double reach, error;            /* of lengths: the farthest corner, and what one is off by */
    double det_error, normal_error; /* of a det, and of a normal's length */
    double x[PIR_SURFACE_CORNERS], y[PIR_SURFACE_CORNERS], z[PIR_SURFACE_CORNERS]; /* corners less the centre */
    double nx[PIR_SURFACE_TRIANGLES], ny[PIR_SURFACE_TRIANGLES], nz[PIR_SURFACE_TRIANGLES]; /* (b − a) × (c − a) */
    double det[PIR_SURFACE_TRIANGLES];                                                      /* n · a */
    double low[PIR_SURFACE_TRIANGLES];                        /* the plane is at least this far from the centre */
    uint8_t beside[PIR_SURFACE_CORNERS][PIR_SURFACE_CORNERS]; /* the triangle that has the directed side (i, j) */
} pir_surface_room;

/* Empties the surface and gives it the tetrahedron of four vertices of D. */
void pir_surface_begin(pir_surface *surface, const uint32_t a[4], const uint32_t b[4]);

/*
 * Places the corners about `centre`, a point of the frame exactly as given that is off by at most `error`. False
 * where a det is not certain to be positive; then *ret_worst is the triangle with the least det over area.
 */
bool pir_surface_place(const pir_surface *surface, const pir_frame *frame, pir_vec3 centre, double error, double reach,
                       pir_surface_room *room, uint32_t *ret_worst);

/*
 * Adds vertex (a, b) of D, in place of triangle t, which it lies beyond, and of others beside that. False where no
 * surface about the centre with certain dets comes of that, or it has no room; then the surface is as it was.
 */
bool pir_surface_add(pir_surface *surface, const pir_frame *frame, uint32_t t, uint32_t a, uint32_t b,
                     pir_surface_room *room);

/* Corner i, and the normal of triangle t. */
static inline pir_vec3 pir_surface_corner(const pir_surface_room *room, uint32_t i) {
    return (pir_vec3){room->x[i], room->y[i], room->z[i]};
}

static inline pir_vec3 pir_surface_normal(const pir_surface_room *room, uint32_t t) {
    return (pir_vec3){room->nx[t], room->ny[t], room->nz[t]};
}

/* Whether every directed side has its counterpart: for tests. */
bool pir_surface_is_valid(const pir_surface *surface);

#endif
