/* SPDX-License-Identifier: MIT */
/*
 * When a box that moves along a straight way meets the boxes of a node. A point is a box too.
 *
 * Invariants
 *   - A time is no later than the exact one, as long as the box is wider than it has to be by what differences of
 *     coordinates are off by.
 *   - 1/way is finite. Where the way along an axis is shorter than 2^-1000 it stands for nothing: the box is wider by
 *     the way and by enough that it leaves what it touches at no time before 1.
 */
#ifndef PIR_MESH_QUERY_SWEPT_BOXES_H
#define PIR_MESH_QUERY_SWEPT_BOXES_H

#include <math.h>

#include "mesh/query/mesh_walk.h"

#define PIR_SWEPT_SHORT 0x1p-1000

/* The box at time 0, wider on each side than differences of coordinates are off by, and its way until time 1. */
typedef struct pir_swept_box {
    double low[3], high[3];
    double way[3], inverse[3];   /* 1/way */
    double foremost[3], last[3]; /* its sides, along the way: `high` and `low`, or the reverse */
    bool down[3];                /* whether it comes to the upper side of a box first */
} pir_swept_box;

/* Writes in place: where it is copied, its booleans are read together before they have been written. */
static inline void pir_swept_box_set(pir_swept_box *swept, const double low[3], const double high[3], pir_vec3 way) {
    const double ways[3] = {way.x, way.y, way.z};
    for (int k = 0; k < 3; k++) {
        const double along = fabs(ways[k]), by = along < PIR_SWEPT_SHORT ? 0x1p-990 : 0, part = by > 0 ? 0x1p-50 : 0;
        const bool reverse = ways[k] <= -PIR_SWEPT_SHORT;
        const double lower = low[k] - (by + part * fabs(low[k])), upper = high[k] + (by + part * fabs(high[k]));
        swept->low[k] = lower;
        swept->high[k] = upper;
        swept->way[k] = ways[k];
        swept->inverse[k] = by > 0 ? 1 / PIR_SWEPT_SHORT : 1 / ways[k];
        swept->foremost[k] = reverse ? lower : upper;
        swept->last[k] = reverse ? upper : lower;
        swept->down[k] = reverse;
    }
}

/* The times at which it meets each, no later than they are; HUGE_VAL where it meets it at none. */
static inline void pir_swept_times(const pir_swept_box *swept, const pir_mesh_boxes *boxes,
                                   double ret_near[PIR_MESH_WIDTH]) {
    double enter[PIR_MESH_WIDTH] = {0, 0, 0, 0}, leave[PIR_MESH_WIDTH] = {1, 1, 1, 1};
    for (int k = 0; k < 3; k++) {
        const double by = swept->inverse[k], foremost = swept->foremost[k], last = swept->last[k];
        const float *near = swept->down[k] ? boxes->high[k] : boxes->low[k],
                    *far = swept->down[k] ? boxes->low[k] : boxes->high[k];
        for (int i = 0; i < PIR_MESH_WIDTH; i++) {
            const double early = ((double)near[i] - foremost) * by, late = ((double)far[i] - last) * by;
            enter[i] = early > enter[i] ? early : enter[i];
            leave[i] = late < leave[i] ? late : leave[i];
        }
    }
    for (int i = 0; i < PIR_MESH_WIDTH; i++) {
        const double near = enter[i] * (1 - 0x1p-48);
        ret_near[i] = near <= leave[i] * (1 + 0x1p-48) ? near : HUGE_VAL;
    }
}

/* A time no later than that at which it meets a box; HUGE_VAL where it meets it at none. */
static inline double pir_swept_enters(const pir_swept_box *swept, const float low[3], const float high[3]) {
    double enter = 0, leave = 1;
    for (int k = 0; k < 3; k++) {
        const double near = swept->down[k] ? high[k] : low[k], far = swept->down[k] ? low[k] : high[k],
                     early = (near - swept->foremost[k]) * swept->inverse[k],
                     late = (far - swept->last[k]) * swept->inverse[k];
        enter = early > enter ? early : enter;
        leave = late < leave ? late : leave;
    }
    enter *= 1 - 0x1p-48;
    return enter <= leave * (1 + 0x1p-48) ? enter : HUGE_VAL;
}

/*
 * The part of the way, until a time, on which it may meet a box: a box around that part, and false where there is none.
 */
static inline bool pir_swept_part(const pir_swept_box *swept, const pir_walk_box *box, double until,
                                  pir_walk_box *ret_part) {
    double enter = 0, leave = until;
    for (int k = 0; k < 3; k++) {
        const double near = swept->down[k] ? box->high[k] : box->low[k],
                     far = swept->down[k] ? box->low[k] : box->high[k],
                     early = (near - swept->foremost[k]) * swept->inverse[k],
                     late = (far - swept->last[k]) * swept->inverse[k];
        enter = early > enter ? early : enter;
        leave = late < leave ? late : leave;
    }
    enter *= 1 - 0x1p-40;
    leave *= 1 + 0x1p-40;
    for (int k = 0; k < 3; k++) {
        const double first = swept->way[k] * enter, last = swept->way[k] * leave,
                     room = 0x1p-48 * (fabs(swept->low[k]) + fabs(swept->high[k]) + fabs(first) + fabs(last));
        ret_part->low[k] = swept->low[k] + (first < last ? first : last) - room;
        ret_part->high[k] = swept->high[k] + (first < last ? last : first) + room;
    }
    return enter <= leave;
}

#endif
