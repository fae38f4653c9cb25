/* SPDX-License-Identifier: MIT */
/*
 * Points in the order of a space-filling curve, so that a hull of many reads memory that it has read of late.
 *
 * The key of a point is its cell in a grid of 2^10 cells an axis, the bits of the three indices interleaved (Morton,
 * 1966). Sorting is by counting and stable: equal points keep their order. Cells are of `near`, so the order of
 * points that differ by rounding alone is not exact; nothing but speed depends on it.
 */
#include "polytope/hull/orient.h"

#define CELL_BITS  10
#define DIGIT_BITS (CELL_BITS * 3 / 2)
#define DIGITS     ((uint32_t)1 << DIGIT_BITS)

/* Spreads the low 10 bits of x to every third bit. */
static uint32_t spread(uint32_t x) {
    x = (x | x << 16) & 0x030000ff;
    x = (x | x << 8) & 0x0300f00f;
    x = (x | x << 4) & 0x030c30c3;
    return (x | x << 2) & 0x09249249;
}

/* The cell of a coordinate in [−1, 1]. */
static uint32_t cell_of(double c) {
    double scaled = (c + 1) * (1 << (CELL_BITS - 1));
    return scaled < (1 << CELL_BITS) ? (uint32_t)scaled : (1 << CELL_BITS) - 1;
}

static uint32_t key_of(pir_vec3 at) {
    return spread(cell_of(at.x)) | spread(cell_of(at.y)) << 1 | spread(cell_of(at.z)) << 2;
}

/* Stable, by one digit of the keys of `near`: from `from`, NULL for the numbers themselves, to `to`. */
static void sort_by_digit(const pir_vec3 *near, const uint32_t *from, uint32_t count, int shift, uint32_t *start,
                          uint32_t *to) {
    for (uint32_t d = 0; d <= DIGITS; d++)
        start[d] = 0;
    for (uint32_t p = 0; p < count; p++)
        start[(key_of(near[p]) >> shift & (DIGITS - 1)) + 1]++;
    for (uint32_t d = 0; d < DIGITS; d++)
        start[d + 1] += start[d];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t p = from ? from[i] : i;
        to[start[key_of(near[p]) >> shift & (DIGITS - 1)]++] = p;
    }
}

bool pir_points_sort(pir_points *points, const pir_allocator *allocator) {
    uint32_t count = points->exact->count;
    uint32_t *start = PIR_NEW(allocator, uint32_t, DIGITS + 1), *half = PIR_NEW(allocator, uint32_t, count),
             *source = PIR_NEW(allocator, uint32_t, count);
    pir_vec3 *near = PIR_NEW(allocator, pir_vec3, count);
    bool done = start && half && source && near;
    if (done) {
        sort_by_digit(points->near, NULL, count, 0, start, half);
        sort_by_digit(points->near, half, count, DIGIT_BITS, start, source);
        for (uint32_t i = 0; i < count; i++)
            near[i] = points->near[source[i]];
        pir_vec3 *before = points->near;
        points->near = near;
        near = before;
        points->source = source;
        source = NULL;
    }
    PIR_FREE(allocator, start, DIGITS + 1);
    PIR_FREE(allocator, half, count);
    PIR_FREE(allocator, source, count);
    PIR_FREE(allocator, near, count);
    return done;
}
