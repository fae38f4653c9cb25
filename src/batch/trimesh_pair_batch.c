/* SPDX-License-Identifier: MIT */
/* Many poses of two meshes. A lane is a pair, of one thread at a time. */
#include <pirouette/trimesh_batch.h>

#include <math.h>

#include "batch/batch_lanes.h"

struct pir_trimesh_pair_batch {
    pir_batch_lanes lanes;
};

typedef pir_status trimesh_asker(pir_trimesh_pair *, pir_pose, pir_pose, pir_trimesh_distance *);

/* One call. */
typedef struct trimesh_job {
    trimesh_asker *ask;
    const pir_trimesh_pair_batch_input *input;
    const pir_trimesh_pair_batch_arrays *arrays;
} trimesh_job;

static pir_status make(const void *p, const void *q, const pir_allocator *allocator, void **ret_object) {
    pir_trimesh_pair_options options = pir_trimesh_pair_options_default();
    pir_trimesh_pair *pair = NULL;
    options.allocator = allocator;
    // a pair takes references, which is no change of what the meshes say
    const pir_status status = pir_trimesh_pair_create((pir_trimesh *)p, (pir_trimesh *)q, &options, &pair);
    *ret_object = pair;
    return status;
}

static void destroy(void *object) {
    pir_trimesh_pair_destroy(object);
}

static const pir_batch_kind kind = {make, destroy};

pir_status pir_trimesh_pair_batch_create(pir_trimesh *p, pir_trimesh *q, const pir_pair_batch_options *options,
                                         pir_trimesh_pair_batch **ret_batch) {
    pir_batch_lanes *lanes = NULL;
    const pir_status status = pir_batch_lanes_create(&kind, p, q, options, ret_batch ? &lanes : NULL);
    if (status == PIR_OK)
        *ret_batch = (pir_trimesh_pair_batch *)lanes;
    return status;
}

void pir_trimesh_pair_batch_destroy(pir_trimesh_pair_batch *batch) {
    pir_batch_lanes_destroy((pir_batch_lanes *)batch);
}

static void write_answer(const pir_trimesh_pair_batch_arrays *to, size_t i, pir_status status,
                         const pir_trimesh_distance *answer) {
    if (to->state)
        to->state[i] = status == PIR_OK ? (uint8_t)answer->state : PIR_POSE_BAD;
    if (to->status)
        to->status[i] = (uint8_t)status;
    if (to->distance)
        to->distance[i] = answer->distance;
    if (to->triangle_p)
        to->triangle_p[i] = answer->triangle_p;
    if (to->triangle_q)
        to->triangle_q[i] = answer->triangle_q;
    pir_batch_set(to->point_p, i, answer->point_p);
    pir_batch_set(to->point_q, i, answer->point_q);
}

static void answer_run(const void *data, pir_batch_lane *lane, size_t begin, size_t end) {
    const trimesh_job *job = data;
    const pir_vec3 none = {NAN, NAN, NAN};
    pir_pose p = {{0, 0, 0, 1}, {0, 0, 0}}, q = p;
    for (size_t i = begin; i < end; i++) {
        pir_trimesh_distance answer;
        pir_pose_array_get(&job->input->poses_p, i, &p);
        pir_pose_array_get(&job->input->poses_q, i, &q);
        const pir_status status = job->ask(lane->object, p, q, &answer);
        if (status != PIR_OK) {
            answer = (pir_trimesh_distance){PIR_TRIMESH_APART, NAN, 0, 0, none, none};
            pir_batch_count_bad(lane, i, status);
        }
        write_answer(job->arrays, i, status, &answer);
    }
}

static pir_status ask_many(pir_trimesh_pair_batch *batch, trimesh_asker *ask, const pir_trimesh_pair_batch_input *input,
                           size_t count, const pir_trimesh_pair_batch_arrays *arrays,
                           pir_pair_batch_summary *ret_summary) {
    if (!batch || !input || !arrays || !pir_pose_array_is_good(&input->poses_p) ||
        !pir_pose_array_is_good(&input->poses_q))
        return PIR_ERR_ARGUMENT;
    const trimesh_job job = {ask, input, arrays};
    pir_batch_lanes_ask(&batch->lanes, answer_run, &job, count, ret_summary);
    return PIR_OK;
}

pir_status pir_trimesh_pair_batch_nearest(pir_trimesh_pair_batch *batch, const pir_trimesh_pair_batch_input *input,
                                          size_t count, const pir_trimesh_pair_batch_arrays *arrays,
                                          pir_pair_batch_summary *ret_summary) {
    return ask_many(batch, pir_trimesh_pair_nearest, input, count, arrays, ret_summary);
}

pir_status pir_trimesh_pair_batch_farthest(pir_trimesh_pair_batch *batch, const pir_trimesh_pair_batch_input *input,
                                           size_t count, const pir_trimesh_pair_batch_arrays *arrays,
                                           pir_pair_batch_summary *ret_summary) {
    return ask_many(batch, pir_trimesh_pair_farthest, input, count, arrays, ret_summary);
}
