/* SPDX-License-Identifier: MIT */
/*
 * Vectors and planes in parallel arrays, as the loops of depth/scan.h read and write them.
 *
 * A loop takes whole lanes: it reads and writes up to PIR_SCAN_LANES − 1 elements past the count that it is given.
 * Arrays have room for them, or hold whole lanes.
 */
#ifndef PIR_QUERY_FRAME_LANES_H
#define PIR_QUERY_FRAME_LANES_H

#include "base/layout.h"
#include "base/vec.h"

/* Elements in a lane. */
#define PIR_SCAN_LANES 4

/* Planes in a block. Loops for a least slack take whole blocks, and groups are padded to whole blocks. */
#define PIR_SCAN_BLOCK 8

/* Vectors in parallel arrays. */
typedef struct pir_lanes {
    double *x, *y, *z;
} pir_lanes;

/* Rows of a layout: the three arrays of a pir_lanes that loops do not leave. */
#define PIR_ROWS(lanes, elements)                                                                                      \
    PIR_ROW((lanes).x, elements), PIR_ROW((lanes).y, elements), PIR_ROW((lanes).z, elements)

/* Rows with room for what loops write past the end: of an array, and of the three of a pir_lanes. */
#define PIR_ROW_LANE(member, elements) PIR_ROW(member, (size_t)(elements) + PIR_SCAN_LANES)
#define PIR_ROWS_LANES(lanes, elements)                                                                                \
    PIR_ROW_LANE((lanes).x, elements), PIR_ROW_LANE((lanes).y, elements), PIR_ROW_LANE((lanes).z, elements)

static inline void pir_lane_put(pir_lanes lanes, uint32_t i, pir_vec3 v) {
    lanes.x[i] = v.x;
    lanes.y[i] = v.y;
    lanes.z[i] = v.z;
}

static inline pir_vec3 pir_lane_get(pir_lanes lanes, uint32_t i) {
    return (pir_vec3){lanes.x[i], lanes.y[i], lanes.z[i]};
}

static inline pir_lanes pir_lanes_from(pir_lanes lanes, uint32_t i) {
    return (pir_lanes){lanes.x + i, lanes.y + i, lanes.z + i};
}

#endif
