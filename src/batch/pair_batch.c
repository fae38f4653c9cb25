/* SPDX-License-Identifier: MIT */
/*
 * Many poses of one pair. A lane is a pair and a workspace, of one thread at a time.
 *
 * Invariant: nothing is written before all of the input but the poses has been checked; from then on the call cannot
 * fail, and what goes wrong at a pose is that pose's.
 */
#include <pirouette/pair_batch.h>

#include <math.h>

#include "batch/batch_lanes.h"

struct pir_pair_batch {
    pir_batch_lanes lanes;
};

typedef pir_status asker(pir_pair *, pir_workspace *, const pir_pair_input *, pir_query_result *);

/* One call. */
typedef struct batch_job {
    asker *ask;
    const pir_pair_batch_input *input;
    const pir_pair_batch_arrays *arrays;
} batch_job;

/* --- the object --- */

static pir_status make(const void *p, const void *q, const pir_allocator *allocator, void **ret_object) {
    pir_pair_options options = pir_pair_options_default();
    pir_pair *pair = NULL;
    options.allocator = allocator;
    // a pair takes references, which is no change of what the bodies say
    const pir_status status = pir_pair_create((pir_polytope *)p, (pir_polytope *)q, &options, &pair);
    *ret_object = pair;
    return status;
}

static void destroy(void *object) {
    pir_pair_destroy(object);
}

static const pir_batch_kind kind = {make, destroy};

pir_status pir_pair_batch_create(pir_polytope *p, pir_polytope *q, const pir_pair_batch_options *options,
                                 pir_pair_batch **ret_batch) {
    pir_batch_lanes *lanes = NULL;
    const pir_status status = pir_batch_lanes_create(&kind, p, q, options, ret_batch ? &lanes : NULL);
    if (status == PIR_OK)
        *ret_batch = (pir_pair_batch *)lanes;
    return status;
}

void pir_pair_batch_destroy(pir_pair_batch *batch) {
    pir_batch_lanes_destroy((pir_batch_lanes *)batch);
}

pir_pair_batch_input pir_pair_batch_input_default(void) {
    return (pir_pair_batch_input){.cutoff = HUGE_VAL};
}

/* --- one pose --- */

/* The normal, and the moment that it has at P's point about P's origin. */
static void set_gradient(const pir_pose *p, const pir_query_result *result, double gradient[6]) {
    const pir_vec3 n = result->normal;
    const pir_vec3 arm = {result->point_p.x - p->translation.x, result->point_p.y - p->translation.y,
                          result->point_p.z - p->translation.z};
    const bool is_set = n.x != 0 || n.y != 0 || n.z != 0;
    gradient[0] = n.x;
    gradient[1] = n.y;
    gradient[2] = n.z;
    gradient[3] = is_set ? arm.y * n.z - arm.z * n.y : 0;
    gradient[4] = is_set ? arm.z * n.x - arm.x * n.z : 0;
    gradient[5] = is_set ? arm.x * n.y - arm.y * n.x : 0;
}

static inline void write_answer(const pir_pair_batch_arrays *to, size_t i, const pir_pose *p,
                                const pir_query_result *result) {
    if (to->state)
        to->state[i] = (uint8_t)result->state;
    if (to->outcome)
        to->outcome[i] = (uint8_t)result->outcome;
    if (to->status)
        to->status[i] = PIR_OK;
    if (to->distance)
        to->distance[i] = result->distance;
    pir_batch_set(to->normal, i, result->normal);
    pir_batch_set(to->point_p, i, result->point_p);
    pir_batch_set(to->point_q, i, result->point_q);
    if (to->gradient)
        set_gradient(p, result, to->gradient[i]);
    if (to->witness)
        to->witness[i] = result->witness;
}

/* A pose without an answer. */
static void write_bad(const batch_job *job, pir_batch_lane *lane, size_t i, pir_status status) {
    const pir_pair_batch_arrays *to = job->arrays;
    const pir_vec3 none = {NAN, NAN, NAN};
    if (to->state)
        to->state[i] = PIR_POSE_BAD;
    if (to->outcome)
        to->outcome[i] = PIR_POSE_BAD;
    if (to->status)
        to->status[i] = (uint8_t)status;
    if (to->distance)
        to->distance[i] = NAN;
    pir_batch_set(to->normal, i, none);
    pir_batch_set(to->point_p, i, none);
    pir_batch_set(to->point_q, i, none);
    for (int k = 0; to->gradient && k < 6; k++)
        to->gradient[i][k] = NAN;
    if (to->witness)
        to->witness[i] = (pir_witness){{PIR_FEATURE_NONE, 0}, {PIR_FEATURE_NONE, 0}};
    if (to->contact_counts)
        to->contact_counts[i] = 0;
    pir_batch_count_bad(lane, i, status);
}

/* The manifold of an answer. */
static pir_status write_contacts(const batch_job *job, pir_batch_lane *lane, size_t i, const pir_pair_input *input,
                                 const pir_query_result *result) {
    const pir_pair_batch_arrays *to = job->arrays;
    size_t count = 0;
    pir_status status =
        pir_pair_manifold(lane->object, lane->workspace, input, result, to->contacts ? to->contact_capacity : 0,
                          to->contacts ? to->contacts + i * to->contact_capacity : NULL, &count);
    if (status == PIR_OK)
        to->contact_counts[i] = (uint32_t)count;
    return status;
}

/* --- all poses --- */

static void answer_run(const void *data, pir_batch_lane *lane, size_t begin, size_t end) {
    const batch_job *job = data;
    pir_pair_input input = pir_pair_input_default();
    input.radius_p = job->input->radius_p;
    input.radius_q = job->input->radius_q;
    input.cutoff = job->input->cutoff;
    input.margin = job->input->margin;
    for (size_t i = begin; i < end; i++) {
        pir_query_result result;
        pir_pose_array_get(&job->input->poses_p, i, &input.pose_p);
        pir_pose_array_get(&job->input->poses_q, i, &input.pose_q);
        pir_status status = job->ask(lane->object, lane->workspace, &input, &result);
        if (status == PIR_OK && job->arrays->contact_counts)
            status = write_contacts(job, lane, i, &input, &result);
        if (status == PIR_OK)
            write_answer(job->arrays, i, &input.pose_p, &result);
        else
            write_bad(job, lane, i, status);
    }
}

/* --- the calls --- */

static pir_status check(const pir_pair_batch_input *input, const pir_pair_batch_arrays *arrays, bool may_contacts) {
    if (arrays->contacts ? !arrays->contact_counts : arrays->contact_capacity > 0)
        return PIR_ERR_ARGUMENT;
    if (arrays->contact_counts && !may_contacts)
        return PIR_ERR_ARGUMENT;
    return pir_batch_check_input(input);
}

static pir_status ask_many(pir_pair_batch *batch, asker *ask, const pir_pair_batch_input *input, size_t count,
                           const pir_pair_batch_arrays *arrays, pir_pair_batch_summary *ret_summary) {
    if (!batch || !input || !arrays)
        return PIR_ERR_ARGUMENT;
    const pir_status status = check(input, arrays, ask == pir_pair_signed_distance);
    if (status != PIR_OK)
        return status;
    const batch_job job = {ask, input, arrays};
    pir_batch_lanes_ask(&batch->lanes, answer_run, &job, count, ret_summary);
    return PIR_OK;
}

pir_status pir_pair_batch_overlap(pir_pair_batch *batch, const pir_pair_batch_input *input, size_t count,
                                  const pir_pair_batch_arrays *arrays, pir_pair_batch_summary *ret_summary) {
    return ask_many(batch, pir_pair_overlap, input, count, arrays, ret_summary);
}

pir_status pir_pair_batch_distance(pir_pair_batch *batch, const pir_pair_batch_input *input, size_t count,
                                   const pir_pair_batch_arrays *arrays, pir_pair_batch_summary *ret_summary) {
    return ask_many(batch, pir_pair_distance, input, count, arrays, ret_summary);
}

pir_status pir_pair_batch_penetration(pir_pair_batch *batch, const pir_pair_batch_input *input, size_t count,
                                      const pir_pair_batch_arrays *arrays, pir_pair_batch_summary *ret_summary) {
    return ask_many(batch, pir_pair_penetration, input, count, arrays, ret_summary);
}

pir_status pir_pair_batch_signed_distance(pir_pair_batch *batch, const pir_pair_batch_input *input, size_t count,
                                          const pir_pair_batch_arrays *arrays, pir_pair_batch_summary *ret_summary) {
    return ask_many(batch, pir_pair_signed_distance, input, count, arrays, ret_summary);
}
