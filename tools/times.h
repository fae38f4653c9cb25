/* SPDX-License-Identifier: MIT */
/* The times of a run's frames, in memory that does not grow with their number. */
#ifndef TOOLS_TIMES_H
#define TOOLS_TIMES_H

#include "measure.h"

/*
 * Runs of up to so many frames keep every time; of longer ones it keeps one in `stride`, for the chart, and counts
 * all by size.
 */
#define TIMES_KEPT 65536

struct times {
    uint64_t stride;
    size_t kept_count;
    double *kept;   /* nanoseconds, of the frame measured last in each stretch of `stride`; NaN where none was */
    uint64_t *bins; /* how many times there were of each size; NULL where all are kept */
    uint64_t count;
    int64_t most;
};

/* False when out of memory; times_finish releases what there is either way. */
bool times_init(struct times *times, uint64_t frames);
void times_finish(struct times *times);

/* Takes in the time of a frame. */
void times_add(struct times *times, uint64_t frame, int64_t nanoseconds);

/* Exact where all are kept or below 2048 nanoseconds, else within one part in 2,000. False when out of memory. */
bool times_order(const struct times *times, struct order *ret_order);

#endif
