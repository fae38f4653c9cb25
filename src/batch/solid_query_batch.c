/* SPDX-License-Identifier: MIT */
/* Many poses of two bodies in convex pieces. A lane is a query and a workspace, of one thread at a time. */
#include <pirouette/solid_batch.h>

#include <math.h>

#include "batch/batch_lanes.h"

struct pir_solid_query_batch {
    pir_batch_lanes lanes;
};

/* An answer of whichever call. */
typedef struct solid_answer {
    pir_state state;
    double distance;
    pir_vec3 normal, point_p, point_q;
    uint32_t piece_p, piece_q;
} solid_answer;

typedef pir_status solid_asker(pir_solid_query *, pir_workspace *, const pir_pair_input *, solid_answer *);

/* One call. */
typedef struct solid_job {
    solid_asker *ask;
    const pir_pair_batch_input *input;
    const pir_solid_query_batch_arrays *arrays;
} solid_job;

static pir_status make(const void *p, const void *q, const pir_allocator *allocator, void **ret_object) {
    pir_solid_query *query = NULL;
    const pir_status status = pir_solid_query_create(p, q, allocator, &query);
    *ret_object = query;
    return status;
}

static void destroy(void *object) {
    pir_solid_query_destroy(object);
}

static const pir_batch_kind kind = {make, destroy};

pir_status pir_solid_query_batch_create(const pir_pieces *p, const pir_pieces *q, const pir_pair_batch_options *options,
                                        pir_solid_query_batch **ret_batch) {
    pir_batch_lanes *lanes = NULL;
    const pir_status status = pir_batch_lanes_create(&kind, p, q, options, ret_batch ? &lanes : NULL);
    if (status == PIR_OK)
        *ret_batch = (pir_solid_query_batch *)lanes;
    return status;
}

void pir_solid_query_batch_destroy(pir_solid_query_batch *batch) {
    pir_batch_lanes_destroy((pir_batch_lanes *)batch);
}

static pir_status ask_overlap(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *input,
                              solid_answer *answer) {
    return pir_solid_query_overlap(query, workspace, input, &answer->state);
}

static pir_status ask_distance(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *input,
                               solid_answer *answer) {
    pir_solid_distance is;
    const pir_status status = pir_solid_query_distance(query, workspace, input, &is);
    if (status == PIR_OK)
        *answer = (solid_answer){is.result.state,   is.result.distance, is.result.normal, is.result.point_p,
                                 is.result.point_q, is.piece_p,         is.piece_q};
    return status;
}

static pir_status ask_depth(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *input,
                            solid_answer *answer) {
    pir_solid_depth is;
    const pir_status status = pir_solid_query_depth(query, workspace, input, &is);
    if (status == PIR_OK)
        *answer = (solid_answer){is.state,           is.depth, is.normal, is.point_p, is.point_q, is.facet[0].piece_p,
                                 is.facet[0].piece_q};
    return status;
}

static void write_answer(const pir_solid_query_batch_arrays *to, size_t i, pir_status status,
                         const solid_answer *answer) {
    if (to->state)
        to->state[i] = status == PIR_OK ? (uint8_t)answer->state : PIR_POSE_BAD;
    if (to->status)
        to->status[i] = (uint8_t)status;
    if (to->distance)
        to->distance[i] = answer->distance;
    pir_batch_set(to->normal, i, answer->normal);
    pir_batch_set(to->point_p, i, answer->point_p);
    pir_batch_set(to->point_q, i, answer->point_q);
    if (to->piece_p)
        to->piece_p[i] = answer->piece_p;
    if (to->piece_q)
        to->piece_q[i] = answer->piece_q;
}

static void answer_run(const void *data, pir_batch_lane *lane, size_t begin, size_t end) {
    const solid_job *job = data;
    const pir_vec3 none = {NAN, NAN, NAN};
    pir_pair_input input = pir_pair_input_default();
    input.radius_p = job->input->radius_p;
    input.radius_q = job->input->radius_q;
    input.cutoff = job->input->cutoff;
    input.margin = job->input->margin;
    for (size_t i = begin; i < end; i++) {
        solid_answer answer = {0};
        pir_pose_array_get(&job->input->poses_p, i, &input.pose_p);
        pir_pose_array_get(&job->input->poses_q, i, &input.pose_q);
        const pir_status status = job->ask(lane->object, lane->workspace, &input, &answer);
        if (status != PIR_OK) {
            answer = (solid_answer){PIR_OUTSIDE, NAN, none, none, none, 0, 0};
            pir_batch_count_bad(lane, i, status);
        }
        write_answer(job->arrays, i, status, &answer);
    }
}

static pir_status ask_many(pir_solid_query_batch *batch, solid_asker *ask, const pir_pair_batch_input *input,
                           size_t count, const pir_solid_query_batch_arrays *arrays,
                           pir_pair_batch_summary *ret_summary) {
    if (!batch || !input || !arrays)
        return PIR_ERR_ARGUMENT;
    const pir_status status = pir_batch_check_input(input);
    if (status != PIR_OK)
        return status;
    const solid_job job = {ask, input, arrays};
    pir_batch_lanes_ask(&batch->lanes, answer_run, &job, count, ret_summary);
    return PIR_OK;
}

pir_status pir_solid_query_batch_overlap(pir_solid_query_batch *batch, const pir_pair_batch_input *input, size_t count,
                                         const pir_solid_query_batch_arrays *arrays,
                                         pir_pair_batch_summary *ret_summary) {
    return ask_many(batch, ask_overlap, input, count, arrays, ret_summary);
}

pir_status pir_solid_query_batch_distance(pir_solid_query_batch *batch, const pir_pair_batch_input *input, size_t count,
                                          const pir_solid_query_batch_arrays *arrays,
                                          pir_pair_batch_summary *ret_summary) {
    return ask_many(batch, ask_distance, input, count, arrays, ret_summary);
}

pir_status pir_solid_query_batch_depth(pir_solid_query_batch *batch, const pir_pair_batch_input *input, size_t count,
                                       const pir_solid_query_batch_arrays *arrays,
                                       pir_pair_batch_summary *ret_summary) {
    return ask_many(batch, ask_depth, input, count, arrays, ret_summary);
}
