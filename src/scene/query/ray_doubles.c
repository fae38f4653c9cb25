/* SPDX-License-Identifier: MIT */
/*
 * A segment against a polytope in doubles: by the half-spaces of its facets, or of a flat piece's sides; and against a
 * triangle, by the signs of the edges around it.
 */
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

/* --- triangles --- */

/*
 * Where the line of a segment crosses a triangle, through whose inside it goes: at h / f with n the product of two
 * edges of the sizes L and L', h = n · p and f = n · d. n is off by less than 8u·L·L', so h by that times M and
 * |n|·(E + 4uM), f by that times D and |n|·(E + 4uD); there is twice as much here.
 */
static bool cross_plane(const pir_vec3 corner[3], pir_vec3 p, const pir_ray_segment *segment, pir_entry *ret_entry) {
    const pir_vec3 d = segment->way, a = pir_vec_sub(corner[1], corner[0]), b = pir_vec_sub(corner[2], corner[0]),
                   n = pir_vec_cross(a, b);
    const double turned = 0x1p-49 * pir_vec_size(a) * pir_vec_size(b), size = 2 * pir_vec_size(n);
    const double h = pir_vec_dot(n, p), far = pir_vec_size(p),
                 error_h = turned * far + size * (segment->error + 0x1p-51 * far);
    const double f = pir_vec_dot(n, d), way = pir_vec_size(d),
                 error_f = turned * way + size * (segment->error + 0x1p-51 * way), square = pir_vec_dot(n, n);
    if (!(fabs(f) > error_f && square > 0x1p-900))
        return false;
    const double time = h / f, error = (error_h + fabs(time) * error_f) / (fabs(f) - error_f) + 0x1p-51 * fabs(time);
    *ret_entry = (pir_entry){.hits = false, .time = 1};
    if (time < -error || time > 1 + error)
        return true;
    *ret_entry = (pir_entry){true, false, time, pir_vec_scale(n, (f < 0 ? 1 : -1) / sqrt(square)), f < 0 ? 1 : -1};
    return time > error && time < 1 - error && 2 * error <= PIR_RAY_GOOD_ENOUGH;
}

/*
 * The segment's line passes edge k of a triangle on the side of the sign of e_k = d · (p_k × p_k+1), with p_k the
 * corners seen from where it begins and d its way. With M the greatest size of p_k, D that of d, and E the error of
 * both, e_k is off by at most (E·M + D·(2E + 8uM))·M, of which there is twice as much here; what underflows is less
 * than 2^-900. Two strict signs that differ: the line misses. Three that are one: it goes through.
 */
bool pir_ray_by_corners(const pir_vec3 corner[3], const pir_ray_segment *segment, pir_entry *ret_entry) {
    const pir_vec3 d = segment->way,
                   p[3] = {pir_vec_sub(corner[0], segment->from), pir_vec_sub(corner[1], segment->from),
                           pir_vec_sub(corner[2], segment->from)};
    const double error = segment->error,
                 most = pir_greater(pir_vec_size(p[0]), pir_greater(pir_vec_size(p[1]), pir_vec_size(p[2]))),
                 long_way = pir_vec_size(d),
                 bound = 2 * (error * most + long_way * (2 * error + 0x1p-50 * most)) * most + 0x1p-900;
    const double e[3] = {pir_vec_dot(d, pir_vec_cross(p[0], p[1])), pir_vec_dot(d, pir_vec_cross(p[1], p[2])),
                         pir_vec_dot(d, pir_vec_cross(p[2], p[0]))};
    const double low = pir_lesser(e[0], pir_lesser(e[1], e[2])), high = pir_greater(e[0], pir_greater(e[1], e[2]));
    if (low < -bound && high > bound) {
        *ret_entry = (pir_entry){.hits = false, .time = 1};
        return true;
    }
    if (!(low > bound || high < -bound))
        return false;
    return cross_plane(corner, p[0], segment, ret_entry);
}
