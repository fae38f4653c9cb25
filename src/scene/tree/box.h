/* SPDX-License-Identifier: MIT */
/*
 * Boxes with edges along the axes, in floats that are rounded outward: a box holds what it was made of, and two bodies
 * whose boxes do not meet share no point. Boxes that touch meet.
 */
#ifndef PIR_SCENE_TREE_BOX_H
#define PIR_SCENE_TREE_BOX_H

#include "base/vec.h"

typedef struct pir_box {
    float low[3], high[3];
} pir_box;

/* Coordinates beyond this are refused, so that no area overflows. */
#define PIR_BOX_FARTHEST 0x1p60

/* A float not above x: what is subtracted is more than the rounding of x to a float. |x| is at most 2^61. */
static inline float pir_float_below(double x) {
    return (float)(x - fabs(x) * 0x1p-23 - 0x1p-148);
}

static inline float pir_float_above(double x) {
    return (float)(x + fabs(x) * 0x1p-23 + 0x1p-148);
}

static inline bool pir_box_meets(const pir_box *a, const pir_box *b) {
    return a->low[0] <= b->high[0] && b->low[0] <= a->high[0] && a->low[1] <= b->high[1] && b->low[1] <= a->high[1] &&
           a->low[2] <= b->high[2] && b->low[2] <= a->high[2];
}

static inline bool pir_box_holds(const pir_box *outer, const pir_box *inner) {
    bool holds = true;
    for (int k = 0; k < 3; k++)
        holds = holds && outer->low[k] <= inner->low[k] && inner->high[k] <= outer->high[k];
    return holds;
}

static inline pir_box pir_box_join(const pir_box *a, const pir_box *b) {
    pir_box all;
    for (int k = 0; k < 3; k++) {
        all.low[k] = a->low[k] < b->low[k] ? a->low[k] : b->low[k];
        all.high[k] = a->high[k] > b->high[k] ? a->high[k] : b->high[k];
    }
    return all;
}

/* Wider by a distance on each side, which may be infinite. */
static inline pir_box pir_box_wider(const pir_box *box, double by) {
    pir_box wide;
    by = by < PIR_BOX_FARTHEST ? by : PIR_BOX_FARTHEST;
    for (int k = 0; k < 3; k++) {
        wide.low[k] = pir_float_below(box->low[k] - by);
        wide.high[k] = pir_float_above(box->high[k] + by);
    }
    return wide;
}

/* Half of the surface. */
static inline float pir_box_area(const pir_box *box) {
    float x = box->high[0] - box->low[0], y = box->high[1] - box->low[1], z = box->high[2] - box->low[2];
    return x * y + y * z + z * x;
}

/* The area of the two joined. */
static inline float pir_box_joint_area(const pir_box *a, const pir_box *b) {
    pir_box all = pir_box_join(a, b);
    return pir_box_area(&all);
}

#endif
