/* SPDX-License-Identifier: MIT */
/* A progress bar on stderr, for runs that take longer than a second and only where stderr is a terminal. */
#ifndef TOOLS_PROGRESS_H
#define TOOLS_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

struct progress {
    bool terminal, shown;
    uint64_t total;
    int64_t start, next; /* when it began and when to look again, in nanoseconds */
};

/* Starts the clock for `total` pieces of work; 0, when that is not known, shows no bar. */
struct progress progress_new(uint64_t total);

/* Says that `done` pieces are done; draws at most ten times a second. */
void progress_show(struct progress *progress, uint64_t done);

/* Wipes the bar away. */
void progress_end(struct progress *progress);

#endif
