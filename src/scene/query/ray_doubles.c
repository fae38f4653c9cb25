/* SPDX-License-Identifier: MIT */
/* A segment against a polytope in doubles: by the half-spaces of its facets, or of a flat piece's sides. */
#include "scene/query/ray_clip.h"

/* A polygon is met where its plane is crossed, if that is within its sides. */
static bool cross_polygon(const pir_polytope *p, const pir_ray_segment *segment, pir_entry *entry) {
    pir_ray_clip plane = pir_ray_unclipped, sides = pir_ray_unclipped;
    const pir_vec3 corner = pir_facet_corner(p, 0);
    uint32_t side = pir_vec_dot(p->normal[0], segment->way) < 0 ? 0 : 1;
    pir_ray_clip_by(&plane, segment, p->normal[side], corner, side);
    for (uint32_t i = p->loop_start[0]; i < p->loop_start[1] && !plane.misses && !sides.misses; i++)
        pir_ray_clip_by(&sides, segment, pir_wall_normal(p, 0, p->loop[i]), p->vertex[p->origin[p->loop[i]]], 0);
    return pir_ray_crosses(&plane, &sides, p->normal[side], entry);
}

static bool enter_body(const pir_polytope *p, const pir_ray_segment *segment, pir_entry *entry) {
    pir_ray_clip clip = pir_ray_unclipped;
    for (uint32_t f = 0; f < p->facet_count && !clip.misses; f++)
        pir_ray_clip_by(&clip, segment, p->normal[f], pir_facet_corner(p, f), f);
    if (pir_ray_clip_misses(&clip)) {
        *entry = (pir_entry){.hits = false, .time = 1};
        return true;
    }
    if (clip.open || !(clip.enter_high < clip.leave_low && clip.leave_low > 0))
        return false;
    if (clip.enter_high < 0 || clip.facet == UINT32_MAX) {
        *entry = (pir_entry){true, true, 0, p->normal[pir_least_facet(p, segment->from)], 0};
        return true;
    }
    *entry = (pir_entry){true, false, clip.time, p->normal[clip.facet], 0};
    return clip.enter_low > 0 && clip.enter_high < 1 && clip.enter_high - clip.enter_low <= PIR_RAY_GOOD_ENOUGH;
}

bool pir_ray_by_doubles(const pir_polytope *p, const pir_ray_segment *segment, pir_entry *ret_entry) {
    return p->dimension == 3   ? enter_body(p, segment, ret_entry)
           : p->dimension == 2 ? cross_polygon(p, segment, ret_entry)
                               : false;
}

/*
 * A normal made of edges in doubles is turned by at most 16u times their lengths over its own; planes and walls along
 * it are off by that times how far the segment is, beside the segment's own error. u = 2^-53.
 */
bool pir_ray_by_corners(const pir_vec3 corner[3], const pir_ray_segment *segment, pir_entry *ret_entry) {
    pir_ray_clip plane = pir_ray_unclipped, walls = pir_ray_unclipped;
    const pir_vec3 from = pir_vec_sub(corner[1], corner[0]), to = pir_vec_sub(corner[2], corner[0]),
                   across = pir_vec_cross(from, to);
    const double area = sqrt(pir_vec_dot(across, across)),
                 turned = 0x1p-49 * (1 + sqrt(pir_vec_dot(from, from) * pir_vec_dot(to, to)) / area);
    if (!(turned < 0x1p-38))
        return false;
    double far = 0;
    for (int k = 0; k < 3; k++) {
        const pir_vec3 off = pir_vec_sub(corner[k], segment->from);
        far = fmax(far, fabs(off.x) + fabs(off.y) + fabs(off.z));
    }
    const pir_vec3 way = segment->way, n = pir_vec_scale(across, 1 / area);
    const bool front = pir_vec_dot(n, way) < 0;
    pir_ray_segment less = *segment;
    less.error += turned * (far + fabs(way.x) + fabs(way.y) + fabs(way.z));
    pir_ray_clip_by(&plane, &less, front ? n : pir_vec_scale(n, -1), corner[0], front ? 0 : 1);
    for (int k = 0; k < 3 && !plane.misses && !walls.misses; k++) {
        const pir_vec3 edge = pir_vec_sub(corner[(k + 1) % 3], corner[k]);
        pir_ray_clip_by(&walls, &less, pir_vec_scale(pir_vec_cross(edge, n), 1 / sqrt(pir_vec_dot(edge, edge))),
                        corner[k], 0);
    }
    return pir_ray_crosses(&plane, &walls, front ? n : pir_vec_scale(n, -1), ret_entry);
}
