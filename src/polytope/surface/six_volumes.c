/* SPDX-License-Identifier: MIT */
/* See six_volumes.h. */
#include "polytope/surface/six_volumes.h"

bool pir_six_volumes_init(struct pir_six_volumes *volumes, const pir_allocator *allocator, const pir_vectors *points) {
    // the apex, three corners from there, a cross product, a determinant, a product on the way, and two sums, which
    // 2^34 determinants lengthen by a limb
    uint32_t corner = points->stride + 2, limbs = 12 * corner + 3 * 2 * corner + 4 * (3 * corner + 4);
    *volumes = (struct pir_six_volumes){.points = points};
    volumes->scratch = (pir_limbs){PIR_NEW(allocator, mp_limb_t, limbs), 0, limbs};
    if (!volumes->scratch.base)
        return false;
    volumes->apex = pir_int3_take(&volumes->scratch, corner);
    volumes->sum = pir_limbs_take(&volumes->scratch, 3 * corner + 4);
    return true;
}

void pir_six_volumes_lift(struct pir_six_volumes *volumes, uint32_t point, int axis) {
    mp_limb_t one_limb = 1;
    const pir_int one = {&one_limb, 1, 0};
    pir_int3 p = pir_vectors_at(volumes->points, point);
    for (int k = 0; k < 3; k++)
        pir_int_copy(&volumes->apex.c[k], &p.c[k]);
    pir_int_add(&volumes->apex.c[axis], &volumes->apex.c[axis], &one);
}

void pir_six_volumes_finish(struct pir_six_volumes *volumes, const pir_allocator *allocator) {
    PIR_FREE(allocator, volumes->scratch.base, volumes->scratch.capacity);
}

/* A point from the apex, in scratch. */
static pir_int3 from_apex(struct pir_six_volumes *volumes, uint32_t point) {
    pir_int3 v = pir_int3_take(&volumes->scratch, volumes->points->stride + 2);
    pir_int3 p = pir_vectors_at(volumes->points, point);
    for (int k = 0; k < 3; k++)
        pir_int_sub(&v.c[k], &p.c[k], &volumes->apex.c[k]);
    return v;
}

void pir_six_volumes_add(struct pir_six_volumes *volumes, const uint32_t *corner, uint32_t count, bool turned) {
    pir_limbs *scratch = &volumes->scratch;
    uint32_t stride = volumes->points->stride + 2;
    for (uint32_t i = 1; i + 1 < count; i++) {
        uint32_t mark = scratch->used;
        pir_int3 a = from_apex(volumes, corner[0]);
        pir_int3 b = from_apex(volumes, corner[turned ? i + 1 : i]);
        pir_int3 c = from_apex(volumes, corner[turned ? i : i + 1]);
        pir_int3 across = pir_int3_take(scratch, 2 * stride);
        pir_int determinant = pir_limbs_take(scratch, 3 * stride + 4);
        pir_int3_cross(&across, &a, &b, scratch);
        pir_int3_dot(&determinant, &across, &c, scratch);
        pir_int_add(&volumes->sum, &volumes->sum, &determinant);
        scratch->used = mark;
    }
}
