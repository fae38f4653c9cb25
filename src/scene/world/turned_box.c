/* SPDX-License-Identifier: MIT */
/* The box of turned points: see turned_box.h. */
#include "scene/world/turned_box.h"

#include <math.h>
#include <stddef.h>

static void plain(const pir_mat3 *r, const pir_vec3 *point, uint32_t count, pir_vec3 *ret_low, pir_vec3 *ret_high) {
    const pir_mat3 m = *r;
    pir_vec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (uint32_t i = 0; i < count; i++) {
        pir_vec3 y = pir_mat_apply(&m, point[i]);
        low.x = y.x < low.x ? y.x : low.x;
        low.y = y.y < low.y ? y.y : low.y;
        low.z = y.z < low.z ? y.z : low.z;
        high.x = y.x > high.x ? y.x : high.x;
        high.y = y.y > high.y ? y.y : high.y;
        high.z = y.z > high.z ? y.z : high.z;
    }
    *ret_low = low;
    *ret_high = high;
}

pir_turned_box_loop *pir_turned_box_version(unsigned index) {
    if (index == 0)
        return plain;
#if PIR_HAVE_X86_TURNED_BOX
    if (index == 1 && __builtin_cpu_supports("avx2"))
        return pir_turned_box_avx2;
#endif
    return NULL;
}

pir_turned_box_loop *pir_turned_box_best(void) {
    pir_turned_box_loop *best = pir_turned_box_version(1);
    return best ? best : plain;
}
