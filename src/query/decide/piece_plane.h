/* SPDX-License-Identifier: MIT */
/* Planes of pieces in parallel arrays. */
#ifndef PIR_QUERY_DECIDE_PIECE_PLANE_H
#define PIR_QUERY_DECIDE_PIECE_PLANE_H

#include "query/decide/placed.h"
#include "query/frame/lanes.h"

/*
 * Edge pairs with a smaller |sin| get their normal from exact integers before they decide an answer, and at once
 * below the second.
 */
#define PIR_SIN_REFINED 0x1p-5
#define PIR_SIN_EXACT   0x1p-40

/* The slack of plane i at x is known within err[i] · the placement's error. */
typedef struct pir_planes {
    pir_lanes n; /* unit normals */
    double *h, *err;
    pir_piece *piece;
    uint32_t capacity, used;
} pir_planes;

/* Room for `capacity` planes, in place of what was there. False when out of memory: then all is as it was. */
bool pir_planes_resize(pir_planes *planes, const pir_allocator *allocator, uint32_t capacity);
void pir_planes_finish(pir_planes *planes, const pir_allocator *allocator);

/* The plane of one piece into slot `slot`; false when its edges are parallel and it is none. */
bool pir_plane_make(pir_exact *exact, pir_planes *planes, pir_piece piece, uint32_t slot);

/* The same for a piece of two edges. */
bool pir_plane_make_ee(pir_exact *exact, pir_planes *planes, pir_piece piece, uint32_t slot);

/* The plane of slot `slot` from exact integers where its angle is small; false when its edges are parallel. */
bool pir_plane_refine(pir_exact *exact, pir_planes *planes, uint32_t slot);

static inline void pir_plane_put(pir_planes *planes, uint32_t slot, pir_vec3 n, double h, double err, pir_piece piece) {
    pir_lane_put(planes->n, slot, n);
    planes->h[slot] = h;
    planes->err[slot] = err;
    planes->piece[slot] = piece;
}

static inline double pir_plane_slack(const pir_planes *planes, uint32_t i, pir_vec3 x) {
    return planes->h[i] - (planes->n.x[i] * x.x + planes->n.y[i] * x.y + planes->n.z[i] * x.z);
}

static inline pir_vec3 pir_plane_normal(const pir_planes *planes, uint32_t i) {
    return (pir_vec3){planes->n.x[i], planes->n.y[i], planes->n.z[i]};
}

/* Whether the slack of plane i is negative for certain. */
static inline bool pir_plane_separates(const pir_planes *planes, uint32_t i, const pir_placement *placement) {
    return pir_plane_slack(planes, i, placement->x) < -placement->error * planes->err[i];
}

#endif
