/* SPDX-License-Identifier: MIT */
/*
 * The lists of pairs that appeared and disappeared in a refresh. They are gathered as keys, numbers that order them by
 * kind, p, q, sorted by merging in room that was made before, and then written out for callers.
 */
#include "dymsum/live/live_pairs.h"

#include "base/layout.h"
#include "base/sort.h"

#include <string.h>

/* Runs of so many are sorted by insertion, longer ones merged. */
#define RUN 8

static pir_layout layout_of(pir_live_pairs *pairs) {
    return (pir_layout){{PIR_ROW(pairs->at, pairs->capacity), PIR_ROW(pairs->key, pairs->capacity),
                         PIR_ROW(pairs->spare, pairs->capacity)}};
}

void pir_live_pairs_finish(pir_live_pairs *pairs, const pir_allocator *a) {
    pir_layout layout = layout_of(pairs);
    pir_layout_free(a, &layout);
    *pairs = (pir_live_pairs){0};
}

bool pir_live_pairs_reserve(pir_live_pairs *pairs, const pir_allocator *a, uint32_t capacity) {
    if (capacity <= pairs->capacity)
        return true;
    pir_live_pairs grown = {.count = pairs->count, .capacity = capacity};
    pir_layout fresh = layout_of(&grown);
    if (!pir_layout_new(a, &fresh)) {
        pir_layout_free(a, &fresh);
        return false;
    }
    // what the last refresh has found stays readable
    if (pairs->count > 0)
        memcpy(grown.at, pairs->at, pairs->count * sizeof *grown.at);
    pir_live_pairs_finish(pairs, a);
    *pairs = grown;
    return true;
}

/* Merges two sorted runs, one behind the other. */
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
        pir_sort_short(pairs->key + i, least(RUN, count - i));
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

/* Removes from both sorted lists what is in both. */
static void cancel(pir_live_pairs *appeared, pir_live_pairs *disappeared) {
    uint32_t i = 0, j = 0, kept_i = 0, kept_j = 0;
    while (i < appeared->count && j < disappeared->count) {
        uint64_t a = appeared->key[i], b = disappeared->key[j];
        appeared->key[kept_i] = a;
        disappeared->key[kept_j] = b;
        kept_i += a < b;
        kept_j += b < a;
        i += a <= b;
        j += b <= a;
    }
    while (i < appeared->count)
        appeared->key[kept_i++] = appeared->key[i++];
    while (j < disappeared->count)
        disappeared->key[kept_j++] = disappeared->key[j++];
    appeared->count = kept_i;
    disappeared->count = kept_j;
}

static void write_out(pir_live_pairs *pairs) {
    const uint32_t mask = ((uint32_t)1 << PIR_LIVE_NUMBER_BITS) - 1;
    for (uint32_t i = 0; i < pairs->count; i++) {
        uint64_t key = pairs->key[i];
        pairs->at[i] = (pir_sum_pair){(pir_facet_kind)(key >> 2 * PIR_LIVE_NUMBER_BITS),
                                      (uint32_t)(key >> PIR_LIVE_NUMBER_BITS) & mask, (uint32_t)key & mask};
    }
}

void pir_live_pairs_settle(pir_live_pairs *appeared, pir_live_pairs *disappeared) {
    sort(appeared);
    sort(disappeared);
    cancel(appeared, disappeared);
    write_out(appeared);
    write_out(disappeared);
}
