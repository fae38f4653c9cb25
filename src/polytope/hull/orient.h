/* SPDX-License-Identifier: MIT */
/*
 * Exact points and the sides they lie on: the predicates of the convex hull.
 *
 * Each point is held exactly, as integers, and as doubles relative to the first point, each axis scaled by a power of
 * two of its own so that coordinates lie in [−1, 1]. Translation and positive scaling of the axes change no
 * orientation, and they keep the filter sharp for bodies that are flat, thin, tiny, huge or far from the origin.
 */
#ifndef PIR_POLYTOPE_HULL_ORIENT_H
#define PIR_POLYTOPE_HULL_ORIENT_H

#include "base/vec.h"
#include "exact/vectors.h"

typedef struct pir_points {
    const pir_vectors *exact; /* borrowed */
    pir_vec3 *near;           /* exact->count doubles, each coordinate within 1.01·2^-53 */
    uint32_t *source;         /* per point: which of `exact` it is; NULL: they have the same numbers */
    pir_limbs scratch;
} pir_points;

/* doubles: the same points, where they are doubles up to a common factor; or NULL. False when out of memory. */
bool pir_points_init(pir_points *points, const pir_allocator *allocator, const pir_vectors *exact,
                     const pir_vec3 *doubles);
void pir_points_finish(pir_points *points, const pir_allocator *allocator);

/*
 * Renumbers the points so that those near in space are near in number; of equal points the first stays the first.
 * False when out of memory.
 */
bool pir_points_sort(pir_points *points, const pir_allocator *allocator);

/* Which of `exact` point p is. */
static inline uint32_t pir_points_source(const pir_points *points, uint32_t p) {
    return points->source ? points->source[p] : p;
}

/*
 * The plane through a, b, c of `near` points, with the error of pir_plane_height below 2^-43. With u = 2^-53: a
 * difference of coordinates is at most 2 and off by 4.1u; a normal component, two products of those, by
 * 2·(2·2·4.1u + 4u) + 8u < 49u, and at most 8; a height, three products of 8 with 2, by 3·(49u·2 + 8·4.1u + 16u)
 * + 96u < 540u < 2^10·u.
 */
#define PIR_ORIENT_BOUND 0x1p-43

typedef struct pir_hull_plane {
    pir_vec3 origin, normal;
} pir_hull_plane;

pir_hull_plane pir_plane_through(const pir_points *points, uint32_t a, uint32_t b, uint32_t c);

static inline double pir_plane_height(const pir_hull_plane *plane, const pir_points *points, uint32_t p) {
    return pir_vec_dot(plane->normal, pir_vec_sub(points->near[p], plane->origin));
}

/* Exactly: 1 when p is on the side of the plane abc from which a, b, c turn counter-clockwise, −1 beyond, 0 on it. */
int pir_orient_exact(pir_points *points, uint32_t a, uint32_t b, uint32_t c, uint32_t p);

/* The orientation, through the filter. */
int pir_orient(pir_points *points, uint32_t a, uint32_t b, uint32_t c, uint32_t p);

/* Exactly: whether a, b, c lie on a line. */
bool pir_collinear(pir_points *points, uint32_t a, uint32_t b, uint32_t c);

/*
 * Exactly: the turn of a, b, c seen with coordinate `axis` dropped, the other two in cyclic order: 1 counter-clockwise,
 * −1 clockwise, 0 straight on.
 */
int pir_turn(pir_points *points, int axis, uint32_t a, uint32_t b, uint32_t c);

/* The sign of component `axis` of (b − a) × (c − a) is pir_turn; this is an axis where it is not
   zero, or −1 on a line. */
int pir_steepest_axis(pir_points *points, uint32_t a, uint32_t b, uint32_t c);

#endif
