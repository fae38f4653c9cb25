/* SPDX-License-Identifier: MIT */
/*
 * One measurement: two bodies, one motion, every way to bring the sum from frame to frame timed in the same run.
 *
 * Each way has a sum of its own. Update is timed in every frame; walk and brute force, which do not depend on the step,
 * in frames spread evenly over the same run, so that what else the machine does falls on all alike. Where brute force
 * is timed its pairing is held against the updated one's. Update and auto, which may take less than a reading of the
 * thread's own clock, are timed by the monotonic one: the few frames in which the machine did something else do not
 * move a median. Walk and brute force are in CPU time of the thread, less what reading its clock takes. Auto
 * goes through the same motion afterwards, alone, so as not to find or leave a cache that another tracked sum has
 * warmed.
 */
#ifndef BENCH_TRIAL_H
#define BENCH_TRIAL_H

#include <stdbool.h>
#include <stdint.h>

#include <pirouette/pirouette.h>

struct trial_request {
    uint32_t frames; /* that are timed */
    uint32_t warm_up;
    uint32_t walk_samples, brute_samples; /* 0: that way is left out */
    bool automatic;                       /* time PIR_METHOD_AUTO as well */
    bool choose;  /* what is called update may be a walk where that is cheaper, as `pirouette track` has it */
    double steps; /* to a full turn */
    uint64_t seed;
    bool from_identity; /* where identical bodies lie on each other, all ties; else from a random pose */
};

/* Of a way's times, in nanoseconds; NaN where it was left out. */
struct trial_times {
    double median, mean, fastest;
};

struct trial_result {
    struct trial_times update, automatic, walk, brute;
    double checked, repaired; /* certificates and pairs, by update, a frame */
    double events;            /* both */
    uint32_t compared;        /* frames in which brute force was run */
    uint32_t mismatches;      /* how many of those gave another pairing */
    uint64_t allocations;
};

/* The rotation of frame `frame`; called for 0, 1, 2 and so on, and then perhaps once more from
   0. `context` as given. */
typedef pir_quat trial_motion(void *context, uint64_t frame);

/* Runs it about random axes. Ends the program with a message when something fails. */
struct trial_result trial_run(const struct trial_request *request, pir_polytope *p, pir_polytope *q);

/* The same along a motion of the caller's; the last three members of *request are not read. */
struct trial_result trial_run_along(const struct trial_request *request, pir_polytope *p, pir_polytope *q,
                                    trial_motion *motion, void *context);

/* A built-in model; ends the program with a message when there is none. */
pir_polytope *trial_model(const char *name);

/* Ends the program with a message unless status is PIR_OK. */
void trial_need(pir_status status, const char *what);

/* The monotonic clock in nanoseconds; the median of times, which are sorted. */
double trial_now(void);
double trial_median(double *times, uint32_t count);

/*
 * What two readings of the monotonic clock take by themselves, in nanoseconds: it is in every time of update and auto.
 */
double trial_clock_cost(void);

#endif
