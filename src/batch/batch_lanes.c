/* SPDX-License-Identifier: MIT */
/*
 * Lanes take runs of successive poses from a counter until all are taken. Answers do not depend on what was asked
 * before, so it does not matter which lane takes which run.
 */
#include "batch/batch_lanes.h"

#include <math.h>
#include <stdatomic.h>

#include "base/memory.h"
#include "base/options.h"

#define THREADS_MAX 64
/* A run is worth waking a thread for: some ten microseconds. */
#define RUN_LEAST 64
#define RUN_MOST  4096
/* Runs for each thread, so that all end at about the same time. */
#define RUNS_EACH 8

/* One call. */
typedef struct batch_call {
    pir_batch_lanes *lanes;
    pir_batch_answerer *answer;
    const void *job;
    size_t count, run;
    atomic_size_t next; /* poses below have been taken */
} batch_call;

static pir_status make_threads(const pir_pair_batch_options *options, pir_batch_lanes *lanes) {
    if (options->tasks) {
        lanes->tasks = *options->tasks;
        return PIR_OK;
    }
    if (lanes->threads == 1)
        return PIR_OK;
    pir_status status = pir_task_pool_create(&lanes->allocator, lanes->threads, &lanes->pool);
    if (status == PIR_OK)
        lanes->tasks = pir_task_pool_interface(lanes->pool);
    return status;
}

/* Sets lanes of zeros; what is there after an error is ended by pir_batch_lanes_destroy. */
static pir_status fill(const void *p, const void *q, const pir_pair_batch_options *options, pir_batch_lanes *lanes) {
    lanes->run = options->run;
    lanes->lane = PIR_ZEROED(&lanes->allocator, pir_batch_lane, options->threads);
    if (!lanes->lane)
        return PIR_ERR_MEMORY;
    lanes->threads = options->threads;
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i < lanes->threads && status == PIR_OK; i++) {
        status = pir_workspace_create(&lanes->allocator, &lanes->lane[i].workspace);
        if (status == PIR_OK)
            status = lanes->kind->make(p, q, &lanes->allocator, &lanes->lane[i].object);
    }
    return status == PIR_OK ? make_threads(options, lanes) : status;
}

pir_status pir_batch_lanes_create(const pir_batch_kind *kind, const void *p, const void *q,
                                  const pir_pair_batch_options *options, pir_batch_lanes **ret_lanes) {
    pir_pair_batch_options used = pir_pair_batch_options_default();
    pir_status status = pir_options_take("pir_pair_batch_options", options, &used, NULL);
    if (status != PIR_OK)
        return status;
    if (!p || !q || !ret_lanes || used.threads < 1 || used.threads > THREADS_MAX ||
        (used.tasks && (!used.tasks->start || !used.tasks->finish)))
        return PIR_ERR_ARGUMENT;
    const pir_allocator allocator = pir_allocator_or_default(used.allocator);
    pir_batch_lanes *lanes = PIR_ZEROED(&allocator, pir_batch_lanes, 1);
    if (!lanes)
        return PIR_ERR_MEMORY;
    lanes->kind = kind;
    lanes->allocator = allocator;
    status = fill(p, q, &used, lanes);
    if (status == PIR_OK)
        *ret_lanes = lanes;
    else
        pir_batch_lanes_destroy(lanes);
    return status;
}

void pir_batch_lanes_destroy(pir_batch_lanes *lanes) {
    if (!lanes)
        return;
    const pir_allocator allocator = lanes->allocator;
    pir_task_pool_destroy(lanes->pool);
    for (uint32_t i = 0; i < lanes->threads; i++) {
        lanes->kind->destroy(lanes->lane[i].object);
        pir_workspace_destroy(lanes->lane[i].workspace);
    }
    if (lanes->lane)
        PIR_FREE(&allocator, lanes->lane, lanes->threads);
    PIR_FREE(&allocator, lanes, 1);
}

static void work(void *data, uint32_t task) {
    batch_call *call = data;
    pir_batch_lane *lane = &call->lanes->lane[task];
    for (;;) {
        const size_t begin = atomic_fetch_add_explicit(&call->next, call->run, memory_order_relaxed);
        if (begin >= call->count)
            break;
        const size_t left = call->count - begin;
        call->answer(call->job, lane, begin, begin + (left < call->run ? left : call->run));
    }
}

static size_t run_of(const pir_batch_lanes *lanes, size_t count) {
    if (lanes->run)
        return lanes->run;
    const size_t run = count / ((size_t)lanes->threads * RUNS_EACH);
    return run < RUN_LEAST ? RUN_LEAST : run > RUN_MOST ? RUN_MOST : run;
}

static pir_pair_batch_summary sum_up(const pir_batch_lanes *lanes, size_t count) {
    pir_pair_batch_summary summary = {0, count, PIR_OK};
    for (uint32_t i = 0; i < lanes->threads; i++) {
        const pir_batch_lane *lane = &lanes->lane[i];
        summary.bad += lane->bad;
        if (lane->first_bad < summary.first_bad) {
            summary.first_bad = lane->first_bad;
            summary.first_status = lane->first_status;
        }
    }
    return summary;
}

void pir_batch_lanes_ask(pir_batch_lanes *lanes, pir_batch_answerer *answer, const void *job, size_t count,
                         pir_pair_batch_summary *ret_summary) {
    batch_call call = {.lanes = lanes, .answer = answer, .job = job, .count = count, .run = run_of(lanes, count)};
    atomic_init(&call.next, 0);
    for (uint32_t i = 0; i < lanes->threads; i++) {
        lanes->lane[i].bad = 0;
        lanes->lane[i].first_bad = count;
        lanes->lane[i].first_status = PIR_OK;
    }
    const size_t runs = count / call.run + (count % call.run != 0);
    const uint32_t tasks = runs < lanes->threads ? (uint32_t)runs : lanes->threads;
    if (tasks > 1) {
        lanes->tasks.start(lanes->tasks.context, work, &call, tasks);
        lanes->tasks.finish(lanes->tasks.context);
    } else {
        answer(job, &lanes->lane[0], 0, count);
    }
    if (ret_summary)
        *ret_summary = sum_up(lanes, count);
}

pir_status pir_batch_check_input(const pir_pair_batch_input *input) {
    if (!pir_pose_array_is_good(&input->poses_p) || !pir_pose_array_is_good(&input->poses_q))
        return PIR_ERR_ARGUMENT;
    if (isnan(input->radius_p) || isnan(input->radius_q) || isnan(input->cutoff) || isnan(input->margin))
        return PIR_ERR_NOT_FINITE;
    if (!(input->radius_p >= 0 && input->radius_p < HUGE_VAL && input->radius_q >= 0 && input->radius_q < HUGE_VAL &&
          input->margin >= 0))
        return PIR_ERR_ARGUMENT;
    return PIR_OK;
}
