/* SPDX-License-Identifier: MIT */
/* The progress bar. */
#include "progress.h"

#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

#include "measure.h"

#define FIRST_AFTER 1000000000 /* nanoseconds */
#define THEN_EVERY  100000000
#define BAR_WIDTH   30

struct progress progress_new(uint64_t total) {
    int64_t now = clock_now();
    return (struct progress){
        .terminal = total > 0 && isatty(STDERR_FILENO) == 1, .total = total, .start = now, .next = now + FIRST_AFTER};
}

void progress_show(struct progress *progress, uint64_t done) {
    if (!progress->terminal)
        return;
    int64_t now = clock_now();
    if (now < progress->next)
        return;
    progress->next = now + THEN_EVERY;
    progress->shown = true;
    double part = (double)done / (double)progress->total;
    double rate = (double)done / ((double)(now - progress->start) / 1e9);
    double left = done ? (double)(now - progress->start) / 1e9 * (1 - part) / part : 0;
    char bar[BAR_WIDTH + 1];
    for (int i = 0; i < BAR_WIDTH; i++)
        bar[i] = i < part * BAR_WIDTH ? '#' : '.';
    bar[BAR_WIDTH] = '\0';
    fprintf(stderr, "\r[%s] %3.0f %%  %" PRIu64 " of %" PRIu64 ", %.3g a second, %.0f s left\033[K", bar, 100 * part,
            done, progress->total, rate, left);
    fflush(stderr);
}

void progress_end(struct progress *progress) {
    if (progress->shown) {
        fputs("\r\033[K", stderr);
        fflush(stderr);
    }
    progress->shown = false;
}
