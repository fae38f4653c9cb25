/* SPDX-License-Identifier: MIT */
/* Arrays for the loops of scan.h. They have room for whole lanes; what is past the end is zero until something is written there. */
#ifndef PIR_QUERY_FRAME_LANES_H
#define PIR_QUERY_FRAME_LANES_H

#include "base/memory.h"
#include "query/planes/scan.h"

static inline double *pir_lane_new(const pir_allocator *a, size_t count) {
    return PIR_ZEROED(a, double, count + PIR_SCAN_LANES);
}

static inline void pir_lane_free(const pir_allocator *a, double *lane, size_t count) {
    PIR_FREE(a, lane, count + PIR_SCAN_LANES);
}

static inline bool pir_lanes_new(const pir_allocator *a, pir_lanes *lanes, size_t count) {
    lanes->x = pir_lane_new(a, count);
    lanes->y = pir_lane_new(a, count);
    lanes->z = pir_lane_new(a, count);
    return lanes->x && lanes->y && lanes->z;
}

static inline void pir_lanes_free(const pir_allocator *a, pir_lanes *lanes, size_t count) {
    pir_lane_free(a, lanes->x, count);
    pir_lane_free(a, lanes->y, count);
    pir_lane_free(a, lanes->z, count);
}

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
