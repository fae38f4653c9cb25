/* SPDX-License-Identifier: MIT */
/* See rotation_box.h. */
#include "plan/rotations/rotation_box.h"

#include <math.h>
#include <stdlib.h>

#define UNIT      20
#define ONE       (1 << UNIT)
#define TOLERANCE 0x1p-40

static pir_quat quat_of(const double q[4]) {
    return (pir_quat){q[0], q[1], q[2], q[3]};
}

pir_rotation_box pir_rotation_box_root(uint32_t number) {
    const uint32_t c = number / 4;
    return (pir_rotation_box){(uint8_t)(number % 4), 1, {c & 1, c >> 1 & 1, c >> 2 & 1}};
}

pir_rotation_box pir_rotation_box_child(pir_rotation_box box, uint32_t number) {
    pir_rotation_box child = {box.chart, (uint8_t)(box.level + 1), {0, 0, 0}};
    for (int k = 0; k < 3; k++)
        child.at[k] = 2 * box.at[k] + (number >> k & 1);
    return child;
}

void pir_rotation_box_bounds(pir_rotation_box box, int32_t ret_low[4], int32_t ret_high[4]) {
    const int32_t width = 2 * ONE >> box.level;
    for (int c = 0, k = 0; c < 4; c++) {
        const bool is_one = c == box.chart;
        ret_low[c] = is_one ? ONE : (int32_t)box.at[k] * width - ONE;
        ret_high[c] = is_one ? ONE : ret_low[c] + width;
        k += !is_one;
    }
}

bool pir_rotation_boxes_touch(pir_rotation_box a, pir_rotation_box b) {
    int32_t low[2][4], high[2][4];
    pir_rotation_box_bounds(a, low[0], high[0]);
    pir_rotation_box_bounds(b, low[1], high[1]);
    bool same = true, mirrored = true;
    for (int c = 0; c < 4; c++) {
        same = same && low[0][c] <= high[1][c] && low[1][c] <= high[0][c];
        mirrored = mirrored && low[0][c] <= -low[1][c] && -high[1][c] <= high[0][c];
    }
    return same || mirrored;
}

bool pir_rotation_box_has(pir_rotation_box box, pir_quat q) {
    const double of[4] = {q.x, q.y, q.z, q.w}, one = of[box.chart];
    int32_t low[4], high[4];
    pir_rotation_box_bounds(box, low, high);
    bool has = one != 0;
    for (int c = 0; c < 4 && has; c++) {
        const double at = of[c] / one * ONE, room = (1 + fabs(at)) * TOLERANCE;
        has = at >= low[c] - room && at <= high[c] + room;
    }
    return has;
}

pir_plan_turns pir_rotation_box_corners(pir_rotation_box box) {
    pir_plan_turns turns = {.count = PIR_PLAN_TURNS};
    int32_t low[4], high[4];
    pir_rotation_box_bounds(box, low, high);
    for (int i = 0; i < PIR_PLAN_TURNS; i++) {
        double q[4];
        for (int c = 0, k = 0; c < 4; c++) {
            q[c] = (double)(c != box.chart && i >> k & 1 ? high[c] : low[c]) / ONE;
            k += c != box.chart;
        }
        turns.q[i] = quat_of(q);
    }
    return turns;
}

pir_quat pir_rotation_box_middle(pir_rotation_box box) {
    int32_t low[4], high[4];
    double q[4];
    pir_rotation_box_bounds(box, low, high);
    for (int c = 0; c < 4; c++)
        q[c] = ((double)low[c] + high[c]) / (2.0 * ONE);
    return quat_of(q);
}
