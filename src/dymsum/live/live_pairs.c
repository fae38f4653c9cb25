/* SPDX-License-Identifier: MIT */
/*
 * The lists of pairs that came and went in a refresh. They are gathered as keys, numbers that order them by kind, p, q;
 * sorted by merging, in room that was made before; and then written out for callers.
 */
#include <string.h>

#include "dymsum/live/live_mesh.h"

/* Runs of so many are sorted by insertion, longer ones merged. */
#define RUN 8

void pir_live_pairs_finish(pir_live_pairs *pairs, const pir_allocator *a) {
    PIR_FREE(a, pairs->at, pairs->capacity);
    PIR_FREE(a, pairs->key, pairs->capacity);
    PIR_FREE(a, pairs->spare, pairs->capacity);
    *pairs = (pir_live_pairs){0};
}

bool pir_live_pairs_reserve(pir_live_pairs *pairs, const pir_allocator *a, uint32_t capacity) {
    if (capacity <= pairs->capacity)
        return true;
    pir_live_pairs grown = {.at = PIR_NEW(a, pir_sum_pair, capacity),
                            .key = PIR_NEW(a, uint64_t, capacity),
                            .spare = PIR_NEW(a, uint64_t, capacity),
                            .count = pairs->count,
                            .capacity = capacity};
    if (!grown.at || !grown.key || !grown.spare) {
        pir_live_pairs_finish(&grown, a);
        return false;
    }
    // what the last refresh has found stays there to be read
    if (pairs->count > 0)
        memcpy(grown.at, pairs->at, pairs->count * sizeof *grown.at);
    pir_live_pairs_finish(pairs, a);
    *pairs = grown;
    return true;
}

static void sort_run(uint64_t *key, uint32_t count) {
    for (uint32_t i = 1; i < count; i++) {
        uint64_t k = key[i];
        uint32_t at = i;
        for (; at > 0 && key[at - 1] > k; at--)
            key[at] = key[at - 1];
        key[at] = k;
    }
}

/* Two sorted runs, one behind the other, into one. */
static void merge(const uint64_t *from, uint32_t first, uint32_t count, uint64_t *to) {
    uint32_t i = 0, j = first;
    while (i < first && j < count) {
        bool second = from[j] < from[i];
        *to++ = second ? from[j] : from[i];
        j += second;
        i += !second;
    }
    memcpy(to, from + i, (first - i) * sizeof *to);
    memcpy(to + (first - i), from + j, (count - j) * sizeof *to);
}

static uint32_t least(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

static void sort(pir_live_pairs *pairs) {
    uint32_t count = pairs->count;
    for (uint32_t i = 0; i < count; i += RUN)
        sort_run(pairs->key + i, least(RUN, count - i));
    for (uint64_t width = RUN; width < count; width *= 2) {
        for (uint64_t i = 0; i < count; i += 2 * width) {
            uint32_t left = count - (uint32_t)i;
            merge(pairs->key + i, least((uint32_t)width, left), least((uint32_t)(2 * width), left), pairs->spare + i);
        }
        uint64_t *sorted = pairs->spare;
        pairs->spare = pairs->key;
        pairs->key = sorted;
    }
}

/* Takes what is in both sorted lists out of both. */
static void cancel(pir_live_pairs *came, pir_live_pairs *went) {
    uint32_t i = 0, j = 0, kept_i = 0, kept_j = 0;
    while (i < came->count && j < went->count) {
        uint64_t a = came->key[i], b = went->key[j];
        came->key[kept_i] = a;
        went->key[kept_j] = b;
        kept_i += a < b;
        kept_j += b < a;
        i += a <= b;
        j += b <= a;
    }
    while (i < came->count)
        came->key[kept_i++] = came->key[i++];
    while (j < went->count)
        went->key[kept_j++] = went->key[j++];
    came->count = kept_i;
    went->count = kept_j;
}

static void write_out(pir_live_pairs *pairs) {
    const uint32_t mask = ((uint32_t)1 << PIR_LIVE_NUMBER_BITS) - 1;
    for (uint32_t i = 0; i < pairs->count; i++) {
        uint64_t key = pairs->key[i];
        pairs->at[i] = (pir_sum_pair){(pir_facet_kind)(key >> 2 * PIR_LIVE_NUMBER_BITS),
                                      (uint32_t)(key >> PIR_LIVE_NUMBER_BITS) & mask, (uint32_t)key & mask};
    }
}

void pir_live_pairs_settle(pir_live_pairs *came, pir_live_pairs *went) {
    sort(came);
    sort(went);
    cancel(came, went);
    write_out(came);
    write_out(went);
}
