/* SPDX-License-Identifier: MIT */
/* Times: a clock that only goes forward, and order statistics of what it measured. */
#ifndef TOOLS_MEASURE_H
#define TOOLS_MEASURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Nanoseconds since a moment that stays the same while the program runs. */
int64_t clock_now(void);

/* Of a series of times, those that are NaN left out; all NaN when none is left. */
struct order {
    size_t count;
    double median, p99, max;
};

/* False when out of memory. */
bool order_of(const double *times, size_t count, struct order *ret_order);

/* Sorts numbers, none of them NaN, from small to large. */
void sort_numbers(double *numbers, size_t count);

/* The median of sorted numbers, at least one. */
double median_of_sorted(const double *numbers, size_t count);

#endif
