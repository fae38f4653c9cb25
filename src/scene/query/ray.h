/* SPDX-License-Identifier: MIT */
/*
 * A segment against one piece, in the frame of the piece's body. Three ways: in doubles with proven bounds, which
 * settle most; in integers, which settle the rest; and for a body with a rounding radius, which is no polytope, in
 * doubles alone.
 */
#ifndef PIR_SCENE_QUERY_RAY_H
#define PIR_SCENE_QUERY_RAY_H

#include <pirouette/pose.h>

#include "base/vec.h"
#include "exact/rotation.h"
#include "polytope/polytope.h"
#include "scene/world/scene.h"

/* The segment from `from` to from + way as a body sees it. */
typedef struct pir_ray_segment {
    pir_vec3 from, way;
    double error; /* heights over planes are off by at most this */
} pir_ray_segment;

/* Where a segment enters a piece. */
typedef struct pir_entry {
    bool hits;
    bool inside; /* it begins in the interior */
    double time;
    pir_vec3 normal; /* in the body's frame, of length 1 or 0 */
    int side;        /* of a polygon: 1 from the front, the side of facet 0, −1 from behind, 0 in its plane */
} pir_entry;

/* --- without a radius: pir_ray_rounded is ray_rounded.h's --- */

/* Whether doubles settle it; *ret_entry is set only then. */
bool pir_ray_by_doubles(const pir_polytope *p, const pir_ray_segment *segment, pir_entry *ret_entry);

/* Whether doubles settle a triangle, its corners in order from the front; *ret_entry is set only then. */
bool pir_ray_by_corners(const pir_vec3 corner[3], const pir_ray_segment *segment, pir_entry *ret_entry);

/* The segment in the world, and the body's pose. */
typedef struct pir_world_ray {
    pir_vec3 origin, way;
} pir_world_ray;

/* The limbs that a ray against a polytope needs. */
uint32_t pir_ray_limbs(const pir_polytope *p);

/* Exact but for the last rounding of the time; `segment` for the normal. The room has pir_ray_limbs. */
pir_entry pir_ray_exact(const pir_polytope *p, const pir_world_ray *ray, pir_pose pose, const pir_ray_segment *segment,
                        pir_exact_room *room);

/* --- what all three share --- */

/* A half-space with a side of a flat piece on its boundary: its unit normal, in the plane of the piece, outwards. */
static inline pir_vec3 pir_wall_normal(const pir_polytope *p, uint32_t facet, uint32_t half) {
    return pir_vec_cross(p->direction[half], p->normal[facet]);
}

static inline pir_vec3 pir_facet_corner(const pir_polytope *p, uint32_t facet) {
    return p->vertex[p->origin[p->loop[p->loop_start[facet]]]];
}

/* How far a point is below the plane of a facet. */
static inline double pir_facet_slack(const pir_polytope *p, uint32_t facet, pir_vec3 x) {
    return pir_vec_dot(p->normal[facet], pir_vec_sub(pir_facet_corner(p, facet), x));
}

/* The facet that a point is least below: that of its depth. */
static inline uint32_t pir_least_facet(const pir_polytope *p, pir_vec3 x) {
    uint32_t least = 0;
    for (uint32_t f = 1; f < p->facet_count; f++)
        if (pir_facet_slack(p, f, x) < pir_facet_slack(p, least, x))
            least = f;
    return least;
}

/* −v / |v|; 0 for 0. */
static inline pir_vec3 pir_against(pir_vec3 v) {
    double most = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
    if (!(most > 0))
        return (pir_vec3){0, 0, 0};
    pir_vec3 scaled = {v.x / most, v.y / most, v.z / most};
    return pir_vec_scale(scaled, -1 / sqrt(pir_vec_dot(scaled, scaled)));
}

#endif
