/* SPDX-License-Identifier: MIT */
/* Arrays that grow and never shrink. */
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

#endif
