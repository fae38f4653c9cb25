/* SPDX-License-Identifier: MIT */
/* Arrays that grow and never shrink; some are in an order. */
#ifndef PIR_SCENE_WORLD_GROW_H
#define PIR_SCENE_WORLD_GROW_H

#include <string.h>

#include "base/memory.h"

/* Room for `need` elements; `array` is the address of the pointer. False when out of memory: it is as it was then. */
static inline bool pir_grow(const pir_allocator *allocator, void *array, uint32_t *capacity, uint32_t need,
                            size_t size) {
    void *block;
    if (need <= *capacity)
        return true;
    uint32_t more = *capacity + *capacity / 2 + 16, count = need > more ? need : more;
    memcpy(&block, array, sizeof block);
    block = pir_memory_resize(allocator, block, *capacity, count, size);
    if (!block)
        return false;
    memcpy(array, &block, sizeof block);
    *capacity = count;
    return true;
}

#define PIR_GROW(allocator, array, capacity, need) pir_grow((allocator), &(array), &(capacity), (need), sizeof *(array))

/* An array of items of `size` bytes in an order, of which the first `most` are kept. */
typedef struct pir_order {
    size_t size, most;
    bool (*comes_before)(const void *a, const void *b);
} pir_order;

/*
 * Puts an item in its place and counts it; `*count` is of all so far, also beyond `most`. `array` is the address of the
 * pointer. False when out of memory: all is as it was then.
 */
static inline bool pir_put_in_order(const pir_allocator *allocator, void *array, uint32_t *capacity,
                                    const pir_order *order, const void *item, size_t *count) {
    const size_t size = order->size;
    const bool is_full = *count >= order->most;
    size_t at = is_full ? order->most : *count;
    char *first;
    if (!is_full && !pir_grow(allocator, array, capacity, (uint32_t)at + 1, size))
        return false;
    memcpy(&first, array, sizeof first);
    ++*count;
    if (is_full && (at == 0 || !order->comes_before(item, first + --at * size)))
        return true;
    for (; at > 0 && order->comes_before(item, first + (at - 1) * size); at--)
        memcpy(first + at * size, first + (at - 1) * size, size);
    memcpy(first + at * size, item, size);
    return true;
}

#endif
