/* SPDX-License-Identifier: MIT */
/* When a box that moves along a straight way meets the boxes of a node. A point is a box too. */
#ifndef PIR_MESH_QUERY_SWEPT_BOXES_H
#define PIR_MESH_QUERY_SWEPT_BOXES_H

#include <math.h>

#include "mesh/mesh_tree.h"

/* The box at time 0, wider on each side than differences of coordinates are off by, and its way until time 1. */
typedef struct pir_swept_box {
    double low[3], high[3];
    double way[3], inverse[3]; /* 1/way, 0 where that is no number */
} pir_swept_box;

static inline pir_swept_box pir_swept_box_of(const double low[3], const double high[3], pir_vec3 way) {
    pir_swept_box swept = {.way = {way.x, way.y, way.z}};
    for (int k = 0; k < 3; k++) {
        const double inverse = 1 / swept.way[k];
        swept.low[k] = low[k];
        swept.high[k] = high[k];
        swept.inverse[k] = isfinite(inverse) ? inverse : 0;
    }
    return swept;
}

/* The times at which it meets each, no later than they are; HUGE_VAL where it meets it at none. */
static inline void pir_swept_times(const pir_swept_box *swept, const pir_mesh_boxes *boxes,
                                   double ret_near[PIR_MESH_WIDTH]) {
    double enter[PIR_MESH_WIDTH], leave[PIR_MESH_WIDTH];
    for (int i = 0; i < PIR_MESH_WIDTH; i++) {
        enter[i] = 0;
        leave[i] = 1;
    }
    for (int k = 0; k < 3; k++) {
        const double by = swept->inverse[k], reach = fabs(swept->way[k]);
        for (int i = 0; i < PIR_MESH_WIDTH; i++) {
            double low = (double)boxes->low[k][i] - swept->high[k], high = (double)boxes->high[k][i] - swept->low[k];
            if (by == 0) {
                // next to no way along this axis: what its ends are beyond is not met
                enter[i] = low > reach || high < -reach ? HUGE_VAL : enter[i];
                continue;
            }
            double first = low * by, second = high * by;
            double early = first < second ? first : second, late = first < second ? second : first;
            enter[i] = early > enter[i] ? early : enter[i];
            leave[i] = late < leave[i] ? late : leave[i];
        }
    }
    for (int i = 0; i < PIR_MESH_WIDTH; i++) {
        double near = enter[i] * (1 - 0x1p-48);
        ret_near[i] = near <= leave[i] * (1 + 0x1p-48) ? near : HUGE_VAL;
    }
}

#endif
