/* SPDX-License-Identifier: MIT */
/* The text of the box of turned points, one for all processors: several coordinates of a point at a time. */
#include "base/lane_text.h"
#include "scene/world/turned_box.h"

#define PARTS (4 / PIR_WIDTH)

PIR_LANES_TARGET static void find(const pir_mat3 *r, const pir_vec3 *point, uint32_t count, pir_vec3 *ret_low,
                                  pir_vec3 *ret_high) {
    const pir_mat3 m = *r;
    const double columns[3][4] = {{m.m[0][0], m.m[1][0], m.m[2][0], 0},
                                  {m.m[0][1], m.m[1][1], m.m[2][1], 0},
                                  {m.m[0][2], m.m[1][2], m.m[2][2], 0}};
    pir_lane low[PARTS], high[PARTS], x[PARTS], y[PARTS], z[PARTS];
    for (int k = 0; k < PARTS; k++) {
        low[k] = pir_all(HUGE_VAL);
        high[k] = pir_all(-HUGE_VAL);
        x[k] = pir_load(&columns[0][k * PIR_WIDTH]);
        y[k] = pir_load(&columns[1][k * PIR_WIDTH]);
        z[k] = pir_load(&columns[2][k * PIR_WIDTH]);
    }
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < PARTS; k++) {
            pir_lane at = x[k] * point[i].x + y[k] * point[i].y + z[k] * point[i].z;
            low[k] = pir_lesser_lanes(at, low[k]);
            high[k] = pir_greater_lanes(at, high[k]);
        }
    *ret_low = (pir_vec3){low[0][0], low[0][1], low[PARTS - 1][2 % PIR_WIDTH]};
    *ret_high = (pir_vec3){high[0][0], high[0][1], high[PARTS - 1][2 % PIR_WIDTH]};
}

const pir_turned_box_loops PIR_LANES_OF(pir_turned_box) = {find};
