/* SPDX-License-Identifier: MIT */
/* See farthest.h. Ties are settled by the index, so that a result does not depend on how points are sorted. */
#include "simplify/farthest.h"

#include <stdlib.h>

static int by_distance(const void *a, const void *b) {
    const pir_far_point *x = a, *y = b;
    if (x->distance != y->distance)
        return x->distance > y->distance ? -1 : 1;
    return x->index < y->index ? -1 : 1;
}

uint32_t pir_farthest_first(pir_far_point *points, uint32_t count, uint32_t most) {
    uint32_t taken = 0;
    qsort(points, count, sizeof *points, by_distance);
    double enough = count > 0 ? points[0].distance / 2 : 0;
    for (uint32_t i = 0; i < count && taken < most && points[i].distance >= enough; i++) {
        bool alone = true;
        for (uint32_t k = 0; k < taken && alone; k++) {
            pir_vec3 d = pir_vec_sub(points[i].at, points[k].at);
            alone = fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z))) >= enough;
        }
        if (!alone)
            continue;
        pir_far_point kept = points[taken];
        points[taken++] = points[i];
        points[i] = kept;
    }
    return taken;
}
