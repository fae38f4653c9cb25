/* SPDX-License-Identifier: MIT */
/*
 * Times, kept and counted. Bins are a nanosecond wide up to 2^11; above, each power of two has 2^10 of them.
 */
#include "times.h"

#include <math.h>
#include <stdlib.h>

#define FINE_BITS 11
#define FINE      (1 << FINE_BITS)
#define PER_POWER (FINE / 2)
#define BINS      (FINE + (63 - FINE_BITS) * PER_POWER)

static size_t bin_of(int64_t nanoseconds) {
    uint64_t ns = nanoseconds > 0 ? (uint64_t)nanoseconds : 0;
    if (ns < FINE)
        return (size_t)ns;
    int power = 63 - __builtin_clzll(ns);
    return FINE + (size_t)(power - FINE_BITS) * PER_POWER + (size_t)(ns >> (power - FINE_BITS + 1)) - PER_POWER;
}

/* The middle of a bin. */
static double time_of(size_t bin) {
    if (bin < FINE)
        return (double)bin;
    size_t above = bin - FINE;
    int power = (int)(above / PER_POWER) + 1;
    return ldexp((double)(PER_POWER + above % PER_POWER) + 0.5, power);
}

bool times_init(struct times *times, uint64_t frames) {
    uint64_t stride = frames / TIMES_KEPT + (frames % TIMES_KEPT != 0);
    *times = (struct times){.stride = stride > 0 ? stride : 1};
    times->kept_count = (size_t)(frames / times->stride + (frames % times->stride != 0));
    times->kept = malloc(TIMES_KEPT * sizeof *times->kept);
    if (times->stride > 1)
        times->bins = calloc(BINS, sizeof *times->bins);
    for (size_t i = 0; times->kept && i < times->kept_count; i++)
        times->kept[i] = NAN;
    return times->kept && (times->bins || times->stride == 1);
}

void times_finish(struct times *times) {
    free(times->kept);
    free(times->bins);
}

void times_add(struct times *times, uint64_t frame, int64_t nanoseconds) {
    times->kept[frame / times->stride] = (double)nanoseconds;
    times->count++;
    times->most = nanoseconds > times->most ? nanoseconds : times->most;
    if (times->bins)
        times->bins[bin_of(nanoseconds)]++;
}

/* The time of the given rank, the least being of rank 1. */
static double time_of_rank(const struct times *times, uint64_t rank) {
    size_t bin = 0;
    for (uint64_t seen = times->bins[0]; seen < rank; seen += times->bins[bin])
        bin++;
    return time_of(bin);
}

bool times_order(const struct times *times, struct order *ret_order) {
    if (!times->bins)
        return order_of(times->kept, times->kept_count, ret_order);
    uint64_t count = times->count;
    *ret_order = (struct order){.count = (size_t)count, .median = NAN, .p99 = NAN, .max = NAN};
    if (count > 0) {
        ret_order->median = (time_of_rank(times, (count + 1) / 2) + time_of_rank(times, count / 2 + 1)) / 2;
        ret_order->p99 = time_of_rank(times, (count * 99 + 99) / 100);
        ret_order->max = (double)times->most;
    }
    return true;
}
