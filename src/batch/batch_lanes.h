/* SPDX-License-Identifier: MIT */
/* Lanes: what each thread of a batch asks with, and how poses are dealt to them. */
#ifndef PIR_BATCH_LANES_H
#define PIR_BATCH_LANES_H

#include <string.h>

#include <pirouette/pair_batch.h>

#include "scene/tasks/tasks.h"

/* Padded to lines of the cache, which no two lanes share. */
typedef struct pir_batch_lane {
    void *object; /* of the batch's kind */
    pir_workspace *workspace;
    size_t bad, first_bad;
    pir_status first_status;
    char padding[128 - 4 * sizeof(void *) - sizeof(pir_status)];
} pir_batch_lane;

typedef struct pir_batch_lanes {
    pir_allocator allocator;
    pir_tasks tasks;
    pir_task_pool *pool; /* NULL where the caller brings threads, or there is one */
    uint32_t threads, run;
    pir_batch_lane *lane; /* `threads` of them */
} pir_batch_lanes;

/* Of what options say; NULL for the defaults. What is made on an error is freed with pir_batch_lanes_finish. */
pir_status pir_batch_lanes_init(const pir_pair_batch_options *options, pir_batch_lanes *lanes);
/* Ends the threads and frees all but the objects. */
void pir_batch_lanes_finish(pir_batch_lanes *lanes);

/* Answers poses `begin` up to `end`, with what is a lane's. */
typedef void pir_batch_answerer(const void *job, pir_batch_lane *lane, size_t begin, size_t end);

/* All poses, by all lanes. `ret_summary` may be NULL. */
void pir_batch_lanes_ask(pir_batch_lanes *lanes, pir_batch_answerer *answer, const void *job, size_t count,
                         pir_pair_batch_summary *ret_summary);

/* Counts a pose that is bad. */
static inline void pir_batch_count_bad(pir_batch_lane *lane, size_t index, pir_status status) {
    lane->bad++;
    if (index < lane->first_bad) {
        lane->first_bad = index;
        lane->first_status = status;
    }
}

/* Whether the strides of an array are those of poses. */
bool pir_pose_array_is_good(const pir_pose_array *array);

/* The check of what a batch is given, but for its poses: PIR_OK, or why it is refused. */
pir_status pir_batch_check_input(const pir_pair_batch_input *input);

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

static inline void pir_batch_set(double (*to)[3], size_t i, pir_vec3 v) {
    if (!to)
        return;
    to[i][0] = v.x;
    to[i][1] = v.y;
    to[i][2] = v.z;
}

#endif
