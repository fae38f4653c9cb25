/* SPDX-License-Identifier: MIT */
/* The text of a surface's loops (inner_surface.h), one for all processors: several triangles at a time. */
#include <string.h>

#include "base/lane_text.h"
#include "pair/surface/inner_surface.h"

PIR_LANES_TARGET static void corners(const pir_surface *surface, const pir_frame *frame, pir_surface_room *room) {
    const pir_mat3 r = frame->r;
    const double columns[3][4] = {{r.m[0][0], r.m[1][0], r.m[2][0], 0},
                                  {r.m[0][1], r.m[1][1], r.m[2][1], 0},
                                  {r.m[0][2], r.m[1][2], r.m[2][2], 0}},
                 centre[4] = {room->centre.x, room->centre.y, room->centre.z, 0};
    for (uint32_t rest = surface->used; rest; rest &= rest - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rest);
        const pir_vec3 a = frame->p.vertex[surface->a[i]];
        // a body's vertices can be read one number past the last
        const double *b = &frame->q.vertex[surface->b[i]].x;
        for (int k = 0; k < 4; k += PIR_WIDTH) {
            pir_lane w =
                pir_load(&columns[0][k]) * a.x + pir_load(&columns[1][k]) * a.y + pir_load(&columns[2][k]) * a.z;
            pir_store(&room->at[i][k], w + pir_load(&b[k]) - pir_load(&centre[k]));
        }
    }
}

/* One corner of each of several triangles. */
PIR_LANES_INLINE pir_lane3 corner_of(const pir_surface_room *room, const uint8_t *corner) {
    const double *at[PIR_WIDTH];
    for (int k = 0; k < PIR_WIDTH; k++)
        at[k] = room->at[corner[k]];
    return pir_lane3_gather(at);
}

/* How far planes are from the centre at least, given their normals and a corner on each; sets their dets. */
PIR_LANES_INLINE pir_lane low_of(pir_lane3 n, pir_lane3 corner, const pir_surface_room *room, pir_lane *ret_det) {
    *ret_det = pir_lane3_dot(n, corner);
    return (*ret_det - room->det_error) / (pir_roots(pir_lane3_dot(n, n)) + room->normal_error);
}

PIR_LANES_TARGET static uint64_t planes(const pir_surface_room *room, const uint8_t *corner, uint32_t count,
                                        pir_surface_planes *ret_planes) {
    uint64_t above = 0;
    for (uint32_t t = 0; t < count; t += PIR_WIDTH) {
        pir_lane3 a = corner_of(room, &corner[t]);
        pir_lane3 e = pir_lane3_sub(corner_of(room, &corner[PIR_SURFACE_TRIANGLES + t]), a);
        pir_lane3 f = pir_lane3_sub(corner_of(room, &corner[2 * PIR_SURFACE_TRIANGLES + t]), a);
        pir_lane3 n = pir_lane3_cross(e, f);
        pir_lane det, low = low_of(n, a, room, &det);
        pir_store(&ret_planes->nx[t], n.x);
        pir_store(&ret_planes->ny[t], n.y);
        pir_store(&ret_planes->nz[t], n.z);
        pir_store(&ret_planes->det[t], det);
        pir_store(&ret_planes->low[t], low);
        above |= (uint64_t)pir_where(low > (pir_lane){0}) << t;
    }
    // past the count there are corners of triangles that are gone
    return ~above & pir_surface_first(count);
}

/* The corners k of several triangles, less the centre. */
PIR_LANES_INLINE pir_lane3 placed_corner(const pir_surface *surface, const uint8_t *triangle, int k,
                                         const pir_frame *frame, pir_vec3 centre) {
    const double(*r)[3] = frame->r.m, *p[PIR_WIDTH], *q[PIR_WIDTH];
    for (int i = 0; i < PIR_WIDTH; i++) {
        const uint32_t c = surface->corner[k][triangle[i]];
        p[i] = &frame->p.vertex[surface->a[c]].x;
        q[i] = &frame->q.vertex[surface->b[c]].x;
    }
    const pir_lane3 a = pir_lane3_gather(p), b = pir_lane3_gather(q);
    return (pir_lane3){r[0][0] * a.x + r[0][1] * a.y + r[0][2] * a.z + b.x - centre.x,
                       r[1][0] * a.x + r[1][1] * a.y + r[1][2] * a.z + b.y - centre.y,
                       r[2][0] * a.x + r[2][1] * a.y + r[2][2] * a.z + b.z - centre.z};
}

PIR_LANES_TARGET static void lows(const pir_surface *surface, const uint8_t *triangle, uint32_t count,
                                  const pir_frame *frame, const pir_surface_room *room, double *low) {
    const pir_vec3 centre = room->centre;
    for (uint32_t i = 0; i < count; i += PIR_WIDTH) {
        const pir_lane3 a = placed_corner(surface, &triangle[i], 0, frame, centre);
        const pir_lane3 e = pir_lane3_sub(placed_corner(surface, &triangle[i], 1, frame, centre), a);
        const pir_lane3 f = pir_lane3_sub(placed_corner(surface, &triangle[i], 2, frame, centre), a);
        pir_lane unused;
        const pir_lane3 n = pir_lane3_cross(e, f);
        pir_store(&low[i], low_of(n, a, room, &unused));
    }
}

PIR_LANES_TARGET static uint64_t below(const pir_surface *surface, const pir_surface_room *room, double limit) {
    uint64_t found = 0;
    for (uint32_t t = 0; t < surface->count; t += PIR_WIDTH)
        found |= (uint64_t)pir_where(pir_load(&room->plane.low[t]) <= pir_all(limit)) << t;
    return found & pir_surface_first(surface->count);
}

PIR_LANES_TARGET static uint64_t near(const pir_surface *surface, float limit) {
    // floats that are not below 0 are in the order of their bits, as numbers below 2^31
    uint32_t bits;
    memcpy(&bits, &limit, sizeof bits);
    uint64_t found = 0;
    for (uint32_t t = 0; t < surface->count; t += 2 * PIR_WIDTH) {
        const pir_number_lanes less = *(const pir_number_lanes *)&surface->lows.low[t] - (bits + 1);
        found |= (uint64_t)pir_numbers_where(0 - (less >> 31)) << t;
    }
    return found & pir_surface_first(surface->count);
}

PIR_LANES_TARGET static double least(const pir_surface *surface, const pir_surface_room *room, uint64_t triangles) {
    const pir_lane none = pir_all(HUGE_VAL);
    pir_lane_bits bit;
    for (int k = 0; k < PIR_WIDTH; k++)
        bit[k] = 1 << k;
    pir_lane low = none;
    triangles &= pir_surface_first(surface->count);
    for (uint32_t t = 0; t < surface->count; t += PIR_WIDTH) {
        pir_lane_bits is = (((pir_lane_bits){0} + (int64_t)(triangles >> t)) & bit) == bit;
        low = pir_lesser_lanes(pir_choose(is, pir_load(&room->plane.low[t]), none), low);
    }
    return pir_least_of(low);
}

PIR_LANES_TARGET static uint64_t seen(const pir_surface *surface, const pir_surface_room *room, pir_vec3 w) {
    const pir_lane3 to = pir_lane3_all(w);
    const pir_surface_planes *plane = &room->plane;
    uint64_t found = 0;
    for (uint32_t t = 0; t < surface->count; t += PIR_WIDTH) {
        pir_lane3 n = {pir_load(&plane->nx[t]), pir_load(&plane->ny[t]), pir_load(&plane->nz[t])};
        found |= (uint64_t)pir_where(pir_lane3_dot(n, to) > pir_load(&plane->det[t])) << t;
    }
    return found & pir_surface_first(surface->count);
}

/* --- corners as bytes --- */

/* The bytes that are looked at together. */
#define BYTES (8 * PIR_WIDTH)

PIR_LANES_INLINE pir_byte_lanes bytes_at(const uint8_t *corner) {
    return *(const pir_byte_lanes *)corner;
}

PIR_LANES_TARGET static uint64_t about(const pir_surface *surface, uint32_t corner) {
    const uint8_t c = (uint8_t)corner, (*const of)[PIR_SURFACE_TRIANGLES] = surface->corner;
    uint64_t found = 0;
    for (uint32_t t = 0; t < PIR_SURFACE_TRIANGLES; t += BYTES) {
        pir_byte_lanes is = (pir_byte_lanes)(bytes_at(&of[0][t]) == c);
        is |= (pir_byte_lanes)(bytes_at(&of[1][t]) == c) | (pir_byte_lanes)(bytes_at(&of[2][t]) == c);
        found |= (uint64_t)pir_bytes_where(is) << t;
    }
    return found & pir_surface_first(surface->count);
}

PIR_LANES_TARGET static uint64_t within(const pir_surface *surface, uint32_t corners) {
    const uint8_t(*of)[PIR_SURFACE_TRIANGLES] = surface->corner;
    uint64_t found = 0;
    for (uint32_t t = 0; t < PIR_SURFACE_TRIANGLES; t += BYTES) {
        pir_byte_lanes in = pir_bytes_in(corners, bytes_at(&of[0][t])) & pir_bytes_in(corners, bytes_at(&of[1][t]));
        found |= (uint64_t)pir_bytes_where(in & pir_bytes_in(corners, bytes_at(&of[2][t]))) << t;
    }
    return found & pir_surface_first(surface->count);
}

PIR_LANES_TARGET static uint32_t either(const uint32_t vertex[PIR_SURFACE_CORNERS], uint32_t u, uint32_t v) {
    uint32_t found = 0;
    for (uint32_t i = 0; i < PIR_SURFACE_CORNERS; i += 2 * PIR_WIDTH) {
        const pir_number_lanes of = *(const pir_number_lanes *)&vertex[i];
        found |= pir_numbers_where((pir_number_lanes)(of == u) | (pir_number_lanes)(of == v)) << i;
    }
    return found;
}

const pir_surface_loops PIR_LANES_OF(pir_surface) = {PIR_LANES_NAME, corners, lows,  planes, below, near,
                                                     least,          seen,    about, within, either};
