/* SPDX-License-Identifier: MIT */
/* Facets as loops of indices in canonical order. */
#include "polytope/hull/loops.h"

#include <stdlib.h>
#include <string.h>

bool pir_loops_init(pir_loops *loops, const pir_allocator *allocator, uint32_t count, uint32_t corners) {
    *loops = (pir_loops){.count = count};
    loops->start = PIR_ZEROED(allocator, uint32_t, (size_t)count + 1);
    loops->corner = PIR_NEW(allocator, uint32_t, corners);
    if (loops->start && loops->corner)
        return true;
    pir_loops_finish(loops, allocator, corners);
    return false;
}

void pir_loops_finish(pir_loops *loops, const pir_allocator *allocator, uint32_t corners) {
    PIR_FREE(allocator, loops->start, (size_t)loops->count + 1);
    PIR_FREE(allocator, loops->corner, corners);
    *loops = (pir_loops){0};
}

struct loop {
    const uint32_t *corner;
    uint32_t count;
    uint8_t tag;
};

static int compare_loops(const void *left, const void *right) {
    const struct loop *a = left, *b = right;
    uint32_t n = a->count < b->count ? a->count : b->count;
    for (uint32_t i = 0; i < n; i++)
        if (a->corner[i] != b->corner[i])
            return a->corner[i] < b->corner[i] ? -1 : 1;
    return (a->count > b->count) - (a->count < b->count);
}

/* Sorts loops that start at their smallest corner: by that corner, counting, then each corner's few by comparison. */
static bool sort_loops(struct loop *order, uint32_t count, const pir_allocator *allocator) {
    uint32_t corners = 0;
    for (uint32_t f = 0; f < count; f++)
        corners = order[f].corner[0] >= corners ? order[f].corner[0] + 1 : corners;
    uint32_t *bucket = PIR_ZEROED(allocator, uint32_t, (size_t)corners + 1);
    struct loop *from = PIR_NEW(allocator, struct loop, count);
    bool done = bucket && from;
    if (done) {
        memcpy(from, order, count * sizeof *from);
        for (uint32_t f = 0; f < count; f++)
            bucket[from[f].corner[0] + 1]++;
        for (uint32_t c = 0; c < corners; c++)
            bucket[c + 1] += bucket[c];
        for (uint32_t f = 0; f < count; f++)
            order[bucket[from[f].corner[0]]++] = from[f];
        // a bucket now ends where the next one began
        for (uint32_t c = 0, start = 0; c < corners; start = bucket[c++])
            if (bucket[c] - start > 1)
                qsort(order + start, bucket[c] - start, sizeof *order, compare_loops);
    }
    PIR_FREE(allocator, bucket, (size_t)corners + 1);
    PIR_FREE(allocator, from, count);
    return done;
}

bool pir_loops_canonicalise(pir_loops *loops, uint8_t *tags, const pir_allocator *allocator) {
    uint32_t corners = pir_loops_corners(loops);
    struct loop *order = PIR_NEW(allocator, struct loop, loops->count);
    uint32_t *turned = PIR_NEW(allocator, uint32_t, corners);
    bool done = order && turned;
    if (done) {
        // turn each loop to begin with its smallest corner
        for (uint32_t f = 0; f < loops->count; f++) {
            const uint32_t *from = loops->corner + loops->start[f];
            uint32_t *to = turned + loops->start[f], n = loops->start[f + 1] - loops->start[f], first = 0;
            for (uint32_t i = 1; i < n; i++)
                if (from[i] < from[first])
                    first = i;
            for (uint32_t i = 0; i < n; i++)
                to[i] = from[(first + i) % n];
            order[f] = (struct loop){to, n, tags ? tags[f] : 0};
        }
        // sort, and lay them down again
        done = sort_loops(order, loops->count, allocator);
        uint32_t at = 0;
        for (uint32_t f = 0; f < loops->count && done; f++) {
            loops->start[f] = at;
            memcpy(loops->corner + at, order[f].corner, order[f].count * sizeof(uint32_t));
            at += order[f].count;
            if (tags)
                tags[f] = order[f].tag;
        }
    }
    PIR_FREE(allocator, order, loops->count);
    PIR_FREE(allocator, turned, corners);
    return done;
}
