/* SPDX-License-Identifier: MIT */
/* The nearest rotations found so far. */
#ifndef PIR_CSPACE_GRID_NEAR_H
#define PIR_CSPACE_GRID_NEAR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PIR_NEAR_MAX 64

/*
 * The best `count` of those offered, the best first. How close two rotations are is the cosine of half the angle
 * between them, the magnitude of the product of their unit quaternions; of equally close ones the lower number is
 * better.
 */
typedef struct pir_near {
    size_t capacity, count; /* capacity: 1 to PIR_NEAR_MAX */
    double close[PIR_NEAR_MAX];
    uint64_t number[PIR_NEAR_MAX];
} pir_near;

static inline bool pir_near_before(double close, uint64_t number, double other_close, uint64_t other) {
    return close > other_close || (close == other_close && number < other);
}

/* The closeness below which a rotation need not be offered; −1 while there is room. */
static inline double pir_near_least(const pir_near *near) {
    return near->count < near->capacity ? -1 : near->close[near->count - 1];
}

static inline void pir_near_offer(pir_near *near, double close, uint64_t number) {
    if (near->count == near->capacity) {
        if (!pir_near_before(close, number, near->close[near->count - 1], near->number[near->count - 1]))
            return;
        near->count--;
    }
    size_t at = near->count++;
    for (; at > 0 && pir_near_before(close, number, near->close[at - 1], near->number[at - 1]); at--) {
        near->close[at] = near->close[at - 1];
        near->number[at] = near->number[at - 1];
    }
    near->close[at] = close;
    near->number[at] = number;
}

#endif
