/* SPDX-License-Identifier: MIT */
/*
 * Many poses of one pair.
 *
 * A lane is a pair and a workspace, of one thread at a time. Lanes take runs of successive poses from a counter until
 * all are taken. Answers of a pair do not depend on what it was asked before, so it does not matter which lane takes
 * which run.
 *
 * Invariant: nothing is written before all of the input but the poses has been checked; from then on the call cannot
 * fail, and what goes wrong at a pose is that pose's.
 */
#include <pirouette/pair_batch.h>

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/memory.h"
#include "base/options.h"
#include "scene/tasks/tasks.h"

#define THREADS_MAX 64
/* A run is worth waking a thread for: some ten microseconds. */
#define RUN_LEAST 64
#define RUN_MOST  4096
/* Runs for each thread, so that all end at about the same time. */
#define RUNS_EACH 8

/* Padded to lines of the cache, which no two lanes share. */
typedef struct batch_lane {
    pir_pair *pair;
    pir_workspace *workspace;
    size_t bad, first_bad;
    pir_status first_status;
    char padding[128 - 4 * sizeof(void *) - sizeof(pir_status)];
} batch_lane;

struct pir_pair_batch {
    pir_allocator allocator;
    pir_tasks tasks;
    pir_task_pool *pool; /* NULL where the caller brings threads, or there is one */
    uint32_t threads, run;
    batch_lane *lane; /* `threads` of them */
};

typedef pir_status asker(pir_pair *, pir_workspace *, const pir_pair_input *, pir_query_result *);

/* One call. */
typedef struct batch_job {
    pir_pair_batch *batch;
    asker *ask;
    const pir_pair_batch_input *input;
    const pir_pair_batch_arrays *arrays;
    size_t count, run;
    atomic_size_t next; /* poses below have been taken */
} batch_job;

/* --- the object --- */

static pir_status make_lanes(pir_polytope *p, pir_polytope *q, pir_pair_batch *batch) {
    const pir_allocator *a = &batch->allocator;
    pir_pair_options options = pir_pair_options_default();
    options.allocator = a;
    batch->lane = PIR_ZEROED(a, batch_lane, batch->threads);
    pir_status status = batch->lane ? PIR_OK : PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < batch->threads && status == PIR_OK; i++) {
        status = pir_workspace_create(a, &batch->lane[i].workspace);
        if (status == PIR_OK)
            status = pir_pair_create(p, q, &options, &batch->lane[i].pair);
    }
    return status;
}

static pir_status make_threads(const pir_pair_batch_options *options, pir_pair_batch *batch) {
    if (options->tasks) {
        batch->tasks = *options->tasks;
        return PIR_OK;
    }
    if (batch->threads == 1)
        return PIR_OK;
    pir_status status = pir_task_pool_create(&batch->allocator, batch->threads, &batch->pool);
    if (status == PIR_OK)
        batch->tasks = pir_task_pool_interface(batch->pool);
    return status;
}

pir_status pir_pair_batch_create(pir_polytope *p, pir_polytope *q, const pir_pair_batch_options *options,
                                 pir_pair_batch **ret_batch) {
    pir_pair_batch_options used = pir_pair_batch_options_default();
    pir_status status = pir_options_take("pir_pair_batch_options", options, &used, NULL);
    if (status != PIR_OK)
        return status;
    if (!p || !q || !ret_batch || used.threads < 1 || used.threads > THREADS_MAX ||
        (used.tasks && (!used.tasks->start || !used.tasks->finish)))
        return PIR_ERR_ARGUMENT;
    const pir_allocator a = pir_allocator_or_default(used.allocator);
    pir_pair_batch *batch = PIR_ZEROED(&a, pir_pair_batch, 1);
    if (!batch)
        return PIR_ERR_MEMORY;
    batch->allocator = a;
    batch->threads = used.threads;
    batch->run = used.run;
    status = make_lanes(p, q, batch);
    if (status == PIR_OK)
        status = make_threads(&used, batch);
    if (status != PIR_OK) {
        pir_pair_batch_destroy(batch);
        return status;
    }
    *ret_batch = batch;
    return PIR_OK;
}

void pir_pair_batch_destroy(pir_pair_batch *batch) {
    if (!batch)
        return;
    const pir_allocator a = batch->allocator;
    pir_task_pool_destroy(batch->pool);
    for (uint32_t i = 0; batch->lane && i < batch->threads; i++) {
        pir_pair_destroy(batch->lane[i].pair);
        pir_workspace_destroy(batch->lane[i].workspace);
    }
    PIR_FREE(&a, batch->lane, batch->threads);
    PIR_FREE(&a, batch, 1);
}

pir_pair_batch_input pir_pair_batch_input_default(void) {
    return (pir_pair_batch_input){.cutoff = HUGE_VAL};
}

/* --- one pose --- */

static inline void read_pose(const pir_pose_array *array, size_t index, pir_pose *ret_pose) {
    const size_t i = array->is_one ? 0 : index;
    const size_t rotation_stride = array->rotation_stride ? array->rotation_stride : 4 * sizeof(double);
    const size_t translation_stride = array->translation_stride ? array->translation_stride : 3 * sizeof(double);
    if (array->rotations)
        memcpy(&ret_pose->rotation, (const char *)array->rotations + i * rotation_stride, sizeof ret_pose->rotation);
    if (array->translations)
        memcpy(&ret_pose->translation, (const char *)array->translations + i * translation_stride,
               sizeof ret_pose->translation);
}

static inline void set(double (*to)[3], size_t i, pir_vec3 v) {
    if (!to)
        return;
    to[i][0] = v.x;
    to[i][1] = v.y;
    to[i][2] = v.z;
}

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
    set(to->normal, i, result->normal);
    set(to->point_p, i, result->point_p);
    set(to->point_q, i, result->point_q);
    if (to->gradient)
        set_gradient(p, result, to->gradient[i]);
    if (to->witness)
        to->witness[i] = result->witness;
}

/* A pose without an answer. */
static void write_bad(const batch_job *job, batch_lane *lane, size_t i, pir_status status) {
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
    set(to->normal, i, none);
    set(to->point_p, i, none);
    set(to->point_q, i, none);
    for (int k = 0; to->gradient && k < 6; k++)
        to->gradient[i][k] = NAN;
    if (to->witness)
        to->witness[i] = (pir_witness){{PIR_FEATURE_NONE, 0}, {PIR_FEATURE_NONE, 0}};
    if (to->contact_counts)
        to->contact_counts[i] = 0;
    lane->bad++;
    if (i < lane->first_bad) {
        lane->first_bad = i;
        lane->first_status = status;
    }
}

/* The manifold of an answer. */
static pir_status write_contacts(const batch_job *job, batch_lane *lane, size_t i, const pir_pair_input *input,
                                 const pir_query_result *result) {
    const pir_pair_batch_arrays *to = job->arrays;
    size_t count = 0;
    pir_status status =
        pir_pair_manifold(lane->pair, lane->workspace, input, result, to->contacts ? to->contact_capacity : 0,
                          to->contacts ? to->contacts + i * to->contact_capacity : NULL, &count);
    if (status == PIR_OK)
        to->contact_counts[i] = (uint32_t)count;
    return status;
}

/* --- all poses --- */

static void answer_run(const batch_job *job, batch_lane *lane, size_t begin, size_t end) {
    pir_pair_input input = pir_pair_input_default();
    input.radius_p = job->input->radius_p;
    input.radius_q = job->input->radius_q;
    input.cutoff = job->input->cutoff;
    input.margin = job->input->margin;
    for (size_t i = begin; i < end; i++) {
        pir_query_result result;
        read_pose(&job->input->poses_p, i, &input.pose_p);
        read_pose(&job->input->poses_q, i, &input.pose_q);
        pir_status status = job->ask(lane->pair, lane->workspace, &input, &result);
        if (status == PIR_OK && job->arrays->contact_counts)
            status = write_contacts(job, lane, i, &input, &result);
        if (status == PIR_OK)
            write_answer(job->arrays, i, &input.pose_p, &result);
        else
            write_bad(job, lane, i, status);
    }
}

static void work(void *data, uint32_t task) {
    batch_job *job = data;
    batch_lane *lane = &job->batch->lane[task];
    for (;;) {
        const size_t begin = atomic_fetch_add_explicit(&job->next, job->run, memory_order_relaxed);
        if (begin >= job->count)
            break;
        const size_t left = job->count - begin;
        answer_run(job, lane, begin, begin + (left < job->run ? left : job->run));
    }
}

static size_t run_of(const pir_pair_batch *batch, size_t count) {
    if (batch->run)
        return batch->run;
    const size_t run = count / ((size_t)batch->threads * RUNS_EACH);
    return run < RUN_LEAST ? RUN_LEAST : run > RUN_MOST ? RUN_MOST : run;
}

static void answer_all(pir_pair_batch *batch, batch_job *job) {
    for (uint32_t i = 0; i < batch->threads; i++) {
        batch->lane[i].bad = 0;
        batch->lane[i].first_bad = job->count;
        batch->lane[i].first_status = PIR_OK;
    }
    job->run = run_of(batch, job->count);
    const size_t runs = job->count / job->run + (job->count % job->run != 0);
    const uint32_t tasks = runs < batch->threads ? (uint32_t)runs : batch->threads;
    if (tasks > 1) {
        batch->tasks.start(batch->tasks.context, work, job, tasks);
        batch->tasks.finish(batch->tasks.context);
    } else {
        answer_run(job, &batch->lane[0], 0, job->count);
    }
}

static pir_pair_batch_summary sum_up(const pir_pair_batch *batch, size_t count) {
    pir_pair_batch_summary summary = {0, count, PIR_OK};
    for (uint32_t i = 0; i < batch->threads; i++) {
        const batch_lane *lane = &batch->lane[i];
        summary.bad += lane->bad;
        if (lane->first_bad < summary.first_bad) {
            summary.first_bad = lane->first_bad;
            summary.first_status = lane->first_status;
        }
    }
    return summary;
}

/* --- the calls --- */

static bool is_stride(size_t stride, size_t numbers) {
    return stride == 0 || (stride % sizeof(double) == 0 && stride >= numbers * sizeof(double));
}

static pir_status check(const pir_pair_batch_input *input, const pir_pair_batch_arrays *arrays, bool may_contacts) {
    const pir_pose_array *poses[2] = {&input->poses_p, &input->poses_q};
    for (int i = 0; i < 2; i++)
        if (!is_stride(poses[i]->rotation_stride, 4) || !is_stride(poses[i]->translation_stride, 3))
            return PIR_ERR_ARGUMENT;
    if (arrays->contacts ? !arrays->contact_counts : arrays->contact_capacity > 0)
        return PIR_ERR_ARGUMENT;
    if (arrays->contact_counts && !may_contacts)
        return PIR_ERR_ARGUMENT;
    if (isnan(input->radius_p) || isnan(input->radius_q) || isnan(input->cutoff) || isnan(input->margin))
        return PIR_ERR_NOT_FINITE;
    if (!(input->radius_p >= 0 && input->radius_p < HUGE_VAL && input->radius_q >= 0 && input->radius_q < HUGE_VAL &&
          input->margin >= 0))
        return PIR_ERR_ARGUMENT;
    return PIR_OK;
}

static pir_status ask_many(pir_pair_batch *batch, asker *ask, const pir_pair_batch_input *input, size_t count,
                           const pir_pair_batch_arrays *arrays, pir_pair_batch_summary *ret_summary) {
    if (!batch || !input || !arrays)
        return PIR_ERR_ARGUMENT;
    const pir_status status = check(input, arrays, ask == pir_pair_signed_distance);
    if (status != PIR_OK)
        return status;
    batch_job job = {.batch = batch, .ask = ask, .input = input, .arrays = arrays, .count = count};
    atomic_init(&job.next, 0);
    answer_all(batch, &job);
    if (ret_summary)
        *ret_summary = sum_up(batch, count);
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
