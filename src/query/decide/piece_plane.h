/* SPDX-License-Identifier: MIT */
/* Planes of pieces, one by one and in parallel arrays. */
#ifndef PIR_QUERY_DECIDE_PIECE_PLANE_H
#define PIR_QUERY_DECIDE_PIECE_PLANE_H

#include "query/decide/placed.h"
#include "query/frame/lanes.h"

/*
 * The least sines of the angles of edge pairs. Below PIR_SIN_EXACT doubles do not give a normal, and it is made from
 * exact integers at once. Below PIR_SIN_REFINED it is made from exact integers before it decides an answer, so that
 * no error grows beyond 1 / PIR_SIN_REFINED.
 */
#define PIR_SIN_REFINED 0x1p-5
#define PIR_SIN_EXACT   0x1p-40

/*
 * A piece's plane: unit normal and offset. The error of its slack h − n·x is at most err times the placement's
 * error.
 */
typedef struct pir_plane {
    pir_vec3 n;
    double h, err;
    pir_piece piece;
} pir_plane;

/* The plane of a piece. False where its edges are parallel, so that it has none. */
bool pir_plane_of(pir_exact *exact, pir_piece piece, pir_plane *ret_plane);

/* The plane of a piece of two edges. */
bool pir_plane_of_edges(pir_exact *exact, pir_piece piece, pir_plane *ret_plane);

/*
 * Makes a plane from exact integers where the angle of its edges is below PIR_SIN_REFINED. False where they are
 * parallel.
 */
bool pir_plane_refine(pir_exact *exact, pir_plane *plane);

static inline double pir_plane_slack(const pir_plane *plane, pir_vec3 x) {
    return plane->h - pir_vec_dot(plane->n, x);
}

/* Whether the slack of a plane is certainly negative, so that it separates the bodies. */
static inline bool pir_plane_separates(const pir_plane *plane, const pir_placement *placement) {
    return pir_plane_slack(plane, placement->x) < -placement->error * plane->err;
}

/* --- in parallel arrays --- */

/* Planes in parallel arrays, which the loops of depth/scan.h read. */
typedef struct pir_planes {
    pir_lanes n; /* unit normals */
    double *h, *err;
    pir_piece *piece;
    uint32_t capacity, used;
} pir_planes;

/* Makes memory for `capacity` planes in place of the present ones. False when out of memory; then all is as it was. */
bool pir_planes_resize(pir_planes *planes, const pir_allocator *allocator, uint32_t capacity);
void pir_planes_finish(pir_planes *planes, const pir_allocator *allocator);

static inline void pir_planes_put(pir_planes *planes, uint32_t slot, const pir_plane *plane) {
    pir_lane_put(planes->n, slot, plane->n);
    planes->h[slot] = plane->h;
    planes->err[slot] = plane->err;
    planes->piece[slot] = plane->piece;
}

static inline double pir_planes_slack(const pir_planes *planes, uint32_t i, pir_vec3 x) {
    return planes->h[i] - (planes->n.x[i] * x.x + planes->n.y[i] * x.y + planes->n.z[i] * x.z);
}

static inline pir_vec3 pir_planes_normal(const pir_planes *planes, uint32_t i) {
    return (pir_vec3){planes->n.x[i], planes->n.y[i], planes->n.z[i]};
}

/* Refines the plane in slot i. Where its edges are parallel it stays as it is. */
static inline void pir_planes_refine(pir_exact *exact, pir_planes *planes, uint32_t i) {
    if (planes->err[i] * PIR_SIN_REFINED < 1)
        return;
    pir_plane plane = {.err = planes->err[i], .piece = planes->piece[i]};
    if (pir_plane_refine(exact, &plane))
        pir_planes_put(planes, i, &plane);
}

#endif
