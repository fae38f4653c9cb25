/* SPDX-License-Identifier: MIT */
/* Merge sort, top down; short lists by insertion. */
#include "base/sort.h"

#include <string.h>

#define SHORT_RUN 8

void pir_sort(uint32_t *item, uint32_t count, uint32_t *work, bool (*before)(void *context, uint32_t a, uint32_t b),
              void *context) {
    if (count <= SHORT_RUN) {
        for (uint32_t i = 1; i < count; i++) {
            uint32_t moved = item[i], j = i;
            for (; j > 0 && before(context, moved, item[j - 1]); j--)
                item[j] = item[j - 1];
            item[j] = moved;
        }
        return;
    }
    uint32_t half = count / 2;
    pir_sort(item, half, work, before, context);
    pir_sort(item + half, count - half, work, before, context);
    memcpy(work, item, half * sizeof *item);
    uint32_t left = 0, right = half, to = 0;
    while (left < half && right < count)
        item[to++] = before(context, item[right], work[left]) ? item[right++] : work[left++];
    while (left < half)
        item[to++] = work[left++];
}

void pir_sort_short(uint64_t *key, uint32_t count) {
    for (uint32_t i = 1; i < count; i++) {
        uint64_t moved = key[i];
        uint32_t at = i;
        for (; at > 0 && key[at - 1] > moved; at--)
            key[at] = key[at - 1];
        key[at] = moved;
    }
}
