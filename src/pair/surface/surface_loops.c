/* SPDX-License-Identifier: MIT */
/* A surface's loops for any processor, and which version this one runs: see inner_surface.h. */
#include "pair/surface/inner_surface.h"

static void place_corners(const pir_surface *surface, const pir_frame *frame, pir_surface_room *room) {
    for (uint32_t rest = surface->used; rest; rest &= rest - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rest);
        pir_vec3 w = pir_vec_sub(pir_frame_vertex(frame, surface->a[i], surface->b[i]), room->centre);
        room->at[i][0] = w.x;
        room->at[i][1] = w.y;
        room->at[i][2] = w.z;
    }
}

/* The plane of triangle t, and a lower bound on its distance from the centre. */
static inline void make_plane(const pir_surface_room *room, const uint8_t *corner, uint32_t t,
                              pir_surface_planes *ret_planes) {
    const double *a = room->at[corner[t]], *b = room->at[corner[PIR_SURFACE_TRIANGLES + t]];
    const double *c = room->at[corner[2 * PIR_SURFACE_TRIANGLES + t]];
    double ex = b[0] - a[0], ey = b[1] - a[1], ez = b[2] - a[2];
    double fx = c[0] - a[0], fy = c[1] - a[1], fz = c[2] - a[2];
    double nx = ey * fz - ez * fy, ny = ez * fx - ex * fz, nz = ex * fy - ey * fx;
    double det = nx * a[0] + ny * a[1] + nz * a[2];
    ret_planes->nx[t] = nx;
    ret_planes->ny[t] = ny;
    ret_planes->nz[t] = nz;
    ret_planes->det[t] = det;
    ret_planes->low[t] = (det - room->det_error) / (sqrt(nx * nx + ny * ny + nz * nz) + room->normal_error);
}

static uint64_t make_planes(const pir_surface_room *room, const uint8_t *corner, uint32_t count,
                            pir_surface_planes *ret_planes) {
    uint64_t uncertain = 0;
    for (uint32_t t = 0; t < count; t++) {
        make_plane(room, corner, t, ret_planes);
        uncertain |= (uint64_t) !(ret_planes->low[t] > 0) << t;
    }
    return uncertain;
}

static uint64_t find_below(const pir_surface *surface, const pir_surface_room *room, double limit) {
    uint64_t found = 0;
    for (uint32_t t = 0; t < surface->count; t++)
        found |= (uint64_t)(room->plane.low[t] <= limit) << t;
    return found;
}

static double find_least(const pir_surface *surface, const pir_surface_room *room, uint64_t triangles) {
    double least = HUGE_VAL;
    for (uint64_t rest = triangles & pir_surface_first(surface->count); rest; rest &= rest - 1) {
        uint32_t t = (uint32_t)__builtin_ctzll(rest);
        least = room->plane.low[t] < least ? room->plane.low[t] : least;
    }
    return least;
}

static uint64_t find_seen(const pir_surface *surface, const pir_surface_room *room, pir_vec3 w) {
    uint64_t found = 0;
    for (uint32_t t = 0; t < surface->count; t++)
        found |= (uint64_t)(pir_vec_dot(pir_surface_normal(room, t), w) > room->plane.det[t]) << t;
    return found;
}

static uint64_t find_about(const pir_surface *surface, uint32_t corner) {
    const uint8_t *a = surface->corner[0], *b = surface->corner[1], *c = surface->corner[2];
    uint64_t found = 0;
    for (uint32_t t = 0; t < surface->count; t++)
        found |= (uint64_t)(a[t] == corner || b[t] == corner || c[t] == corner) << t;
    return found;
}

static uint64_t find_within(const pir_surface *surface, uint32_t corners) {
    const uint8_t *a = surface->corner[0], *b = surface->corner[1], *c = surface->corner[2];
    uint64_t found = 0;
    for (uint32_t t = 0; t < surface->count; t++)
        found |= (uint64_t)(corners >> a[t] & corners >> b[t] & corners >> c[t] & 1) << t;
    return found;
}

static uint32_t find_either(const uint32_t vertex[PIR_SURFACE_CORNERS], uint32_t u, uint32_t v) {
    uint32_t found = 0;
    for (uint32_t i = 0; i < PIR_SURFACE_CORNERS; i++)
        found |= (uint32_t)(vertex[i] == u || vertex[i] == v) << i;
    return found;
}

static const pir_surface_loops plain = {"plain",   place_corners, make_planes, find_below, find_least,
                                        find_seen, find_about,    find_within, find_either};

const pir_surface_loops *pir_surface_loops_version(unsigned index) {
    if (index == 0)
        return &plain;
#if PIR_HAVE_X86_SURFACE
    if (index == 1 && __builtin_cpu_supports("avx2"))
        return &pir_surface_avx2;
#endif
    return NULL;
}

const pir_surface_loops *pir_surface_loops_best(void) {
    unsigned index = 0;
    while (pir_surface_loops_version(index + 1))
        index++;
    return pir_surface_loops_version(index);
}
