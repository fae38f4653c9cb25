/* SPDX-License-Identifier: MIT */
/* Poses in arrays of the caller's: see pir_pose_array. */
#ifndef PIR_BASE_POSE_ARRAY_H
#define PIR_BASE_POSE_ARRAY_H

#include <string.h>

#include <pirouette/pair_batch.h>

static inline bool pir_is_stride(size_t stride, size_t numbers) {
    return stride == 0 || (stride % sizeof(double) == 0 && stride >= numbers * sizeof(double));
}

/* Whether the strides of an array are those of poses. */
static inline bool pir_pose_array_is_good(const pir_pose_array *array) {
    return pir_is_stride(array->rotation_stride, 4) && pir_is_stride(array->translation_stride, 3);
}

/* Pose `index`; what the array lacks stays as it was. */
static inline void pir_pose_array_get(const pir_pose_array *array, size_t index, pir_pose *ret_pose) {
    const size_t i = array->is_one ? 0 : index;
    const size_t rotation_stride = array->rotation_stride ? array->rotation_stride : 4 * sizeof(double);
    const size_t translation_stride = array->translation_stride ? array->translation_stride : 3 * sizeof(double);
    if (array->rotations)
        memcpy(&ret_pose->rotation, (const char *)array->rotations + i * rotation_stride, sizeof ret_pose->rotation);
    if (array->translations)
        memcpy(&ret_pose->translation, (const char *)array->translations + i * translation_stride,
               sizeof ret_pose->translation);
}

#endif
