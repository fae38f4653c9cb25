/* SPDX-License-Identifier: MIT */
/* The measurement of trial.h. A time is the difference of two readings of a clock, and includes what they take. */
#include "trial.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <pirouette/baseline.h>

#include "results.h"
#include "spin.h"

void trial_need(pir_status status, const char *what) {
    if (status == PIR_OK)
        return;
    fprintf(stderr, "bench: %s: %s\n", what, pir_status_text(status));
    exit(1);
}

pir_polytope *trial_model(const char *name) {
    pir_polytope *polytope;
    trial_need(pir_shape_create(name, NULL, NULL, &polytope), name);
    return polytope;
}

static double read_clock(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

double trial_now(void) {
    return read_clock(CLOCK_MONOTONIC);
}

/* What two readings of a clock take. */
static double reading_cost(clockid_t clock) {
    enum { LOOKS = 2001 };
    double times[LOOKS];
    for (int i = 0; i < LOOKS; i++) {
        double before = read_clock(clock);
        times[i] = read_clock(clock) - before;
    }
    return trial_median(times, LOOKS);
}

double trial_clock_cost(void) {
    return reading_cost(CLOCK_MONOTONIC);
}

static int compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double trial_median(double *times, uint32_t count) {
    qsort(times, count, sizeof *times, compare);
    return times[count / 2];
}

/* --- the times of one way --- */

struct lap {
    pir_sum *sum; /* NULL where the way is left out */
    double *times;
    uint32_t count, stride; /* timed in every stride-th frame */
    clockid_t clock;
    double reading; /* what is taken off each time */
};

/* Of a way that is short, timed by the monotonic clock, or of one that takes long enough for the thread's own. */
static struct lap lap_new(pir_polytope *p, pir_polytope *q, pir_quat start, uint32_t frames, uint32_t samples,
                          bool is_short) {
    struct lap lap = {0};
    if (samples == 0)
        return lap;
    // of fewer frames than samples, one is timed
    lap.stride = samples <= frames ? frames / samples : frames;
    lap.clock = is_short ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID;
    lap.reading = is_short ? 0 : reading_cost(lap.clock);
    lap.times = malloc(frames * sizeof *lap.times);
    trial_need(lap.times ? PIR_OK : PIR_ERR_MEMORY, "times");
    trial_need(pir_sum_create(p, q, start, NULL, &lap.sum), "sum");
    return lap;
}

static struct trial_times lap_finish(struct lap *lap) {
    struct trial_times times = {NAN, NAN, NAN};
    if (lap->count > 0) {
        double sum = 0, median = trial_median(lap->times, lap->count);
        for (uint32_t i = 0; i < lap->count; i++)
            sum += lap->times[i];
        times = (struct trial_times){median, sum / lap->count, lap->times[0]};
    }
    pir_sum_destroy(lap->sum);
    free(lap->times);
    return times;
}

/* Brings the lap's sum to `rotation` when its turn has come. Returns whether it had. */
static bool lap_rotate(struct lap *lap, pir_quat rotation, uint64_t frame, bool timed, pir_method method, bool brute) {
    if (!lap->sum || frame % lap->stride != 0)
        return false;
    double before = read_clock(lap->clock);
    pir_status status =
        brute ? pir_sum_rotate_brute_force(lap->sum, rotation) : pir_sum_rotate(lap->sum, rotation, method);
    double after = read_clock(lap->clock);
    trial_need(status, "rotation");
    if (timed)
        lap->times[lap->count++] = after - before - lap->reading;
    return timed;
}

/* --- the run --- */

/* One pass of the motion: the tracked sum by update, with walk and brute force beside it in some
   frames; or by auto, alone. */
static struct trial_times pass(const struct trial_request *request, pir_polytope *p, pir_polytope *q,
                               trial_motion *motion, void *context, bool alone, struct trial_result *result) {
    uint32_t frames = results_count(request->frames), warm_up = results_count(request->warm_up);
    pir_method method = alone || request->choose ? PIR_METHOD_AUTO : PIR_METHOD_UPDATE;
    pir_quat start = motion(context, 0);
    struct lap tracked = lap_new(p, q, start, frames, frames, true),
               walk = lap_new(p, q, start, frames, alone ? 0 : request->walk_samples, false),
               brute = lap_new(p, q, start, frames, alone ? 0 : request->brute_samples, false);
    pir_sum_statistics before = {0};
    for (uint64_t i = 1; i <= (uint64_t)warm_up + frames; i++) {
        pir_quat rotation = motion(context, i);
        bool timed = i > warm_up;
        if (i == warm_up + 1)
            before = pir_sum_get_statistics(tracked.sum);
        lap_rotate(&tracked, rotation, i, timed, method, false);
        lap_rotate(&walk, rotation, i, timed, PIR_METHOD_WALK, false);
        if (lap_rotate(&brute, rotation, i, timed, PIR_METHOD_WALK, true)) {
            result->compared++;
            result->mismatches += !pir_sum_same_pairing(tracked.sum, brute.sum);
        }
    }
    if (!alone) {
        pir_sum_statistics after = pir_sum_get_statistics(tracked.sum);
        result->checked = (double)(after.checked - before.checked) / frames;
        result->repaired = (double)(after.repaired - before.repaired) / frames;
        result->events = result->checked + result->repaired;
        result->allocations = after.allocations - before.allocations;
        result->walk = lap_finish(&walk);
        result->brute = lap_finish(&brute);
    }
    return lap_finish(&tracked);
}

struct trial_result trial_run_along(const struct trial_request *request, pir_polytope *p, pir_polytope *q,
                                    trial_motion *motion, void *context) {
    struct trial_result result = {.automatic = {NAN, NAN, NAN}};
    result.update = pass(request, p, q, motion, context, false, &result);
    if (request->automatic)
        result.automatic = pass(request, p, q, motion, context, true, &result);
    return result;
}

/* The spin of a request, made anew for frame 0. */
struct spinning {
    const struct trial_request *request;
    struct spin spin;
};

static pir_quat spin_motion(void *context, uint64_t frame) {
    struct spinning *spinning = context;
    if (frame > 0)
        return spin_next(&spinning->spin);
    spinning->spin = spin_new(spinning->request->steps, spinning->request->seed, spinning->request->from_identity);
    return spinning->spin.now;
}

struct trial_result trial_run(const struct trial_request *request, pir_polytope *p, pir_polytope *q) {
    struct spinning spinning = {.request = request};
    return trial_run_along(request, p, q, spin_motion, &spinning);
}
