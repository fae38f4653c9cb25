/* SPDX-License-Identifier: MIT */
/* The clock and order statistics. */
#include "measure.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

int64_t clock_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void sort_numbers(double *numbers, size_t count) {
    qsort(numbers, count, sizeof *numbers, by_size);
}

double median_of_sorted(const double *numbers, size_t count) {
    return (numbers[(count - 1) / 2] + numbers[count / 2]) / 2;
}

bool order_of(const double *times, size_t count, struct order *ret_order) {
    double *sorted = malloc((count ? count : 1) * sizeof *sorted);
    if (!sorted)
        return false;
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (!isnan(times[i]))
            sorted[kept++] = times[i];
    *ret_order = (struct order){.count = kept, .median = NAN, .p99 = NAN, .max = NAN};
    if (kept > 0) {
        sort_numbers(sorted, kept);
        // the 99th percentile by nearest rank: the least time that 99 of 100 do not exceed
        ret_order->median = median_of_sorted(sorted, kept);
        ret_order->p99 = sorted[(kept * 99 + 99) / 100 - 1];
        ret_order->max = sorted[kept - 1];
    }
    free(sorted);
    return true;
}
