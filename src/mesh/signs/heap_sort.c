/* SPDX-License-Identifier: MIT */
/* A heap whose greatest element is exchanged for the last, again and again (Floyd, CACM 7(12), 1964). */
#include "mesh/signs/heap_sort.h"

#include <string.h>

#include "base/assert.h"

struct heap {
    char *base;
    size_t size;
    int (*compare)(const void *a, const void *b);
};

static char *at(const struct heap *heap, size_t i) {
    return heap->base + i * heap->size;
}

static void exchange(const struct heap *heap, size_t i, size_t j) {
    char work[PIR_HEAP_MOST];
    memcpy(work, at(heap, i), heap->size);
    memcpy(at(heap, i), at(heap, j), heap->size);
    memcpy(at(heap, j), work, heap->size);
}

/* Moves element i down until none below it is greater, in the first `count`. */
static void sift(const struct heap *heap, size_t i, size_t count) {
    for (size_t child; (child = 2 * i + 1) < count; i = child) {
        if (child + 1 < count && heap->compare(at(heap, child), at(heap, child + 1)) < 0)
            child++;
        if (heap->compare(at(heap, i), at(heap, child)) >= 0)
            return;
        exchange(heap, i, child);
    }
}

void pir_heap_sort(void *elements, size_t count, size_t size, int (*compare)(const void *a, const void *b)) {
    const struct heap heap = {elements, size, compare};
    PIR_ASSERT(size <= PIR_HEAP_MOST);
    for (size_t i = count / 2; i-- > 0;)
        sift(&heap, i, count);
    for (size_t left = count; left > 1; left--) {
        exchange(&heap, 0, left - 1);
        sift(&heap, 0, left - 1);
    }
}
