/* SPDX-License-Identifier: MIT */
/* Polygons of files cut into triangles, without new points and with the signs of their own numbers. */
#ifndef PIR_MESH_POLYGON_CUT_H
#define PIR_MESH_POLYGON_CUT_H

#include "base/memory.h"
#include "base/vec.h"

/* Concave polygons of more corners are refused. */
#define PIR_CUT_MOST 4096

/* Scratch of cutting ears: arrays of PIR_CUT_MOST. */
typedef struct pir_cut_room {
    double (*flat)[2];
    uint32_t *before, *after;
    uint8_t *is_ear;
} pir_cut_room;

/*
 * Cuts the polygon of `count` ≥ 3 corners into count − 2 triangles. Convex ones become a fan from their first
 * corner, others lose one ear after the other. It is looked at along the axis that its normal is nearest to, so it
 * need not be planar. PIR_ERR_FORMAT where it crosses itself, PIR_ERR_LIMIT.
 */
pir_status pir_polygon_cut(const pir_vec3 *point, const uint32_t *corner, uint32_t count, const pir_cut_room *room,
                           uint32_t (*ret_triangles)[3]);

#endif
