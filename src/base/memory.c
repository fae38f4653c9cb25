/* SPDX-License-Identifier: MIT */
/*
 * Memory through a pir_allocator.
 *
 * Invariant: a block's size in bytes is max(count, 1) · size, computed the same way when it is made, resized and
 * freed, so an allocator that counts bytes gets the same number each time.
 */
#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

static void *malloc_resize(void *context, void *block, size_t old_size, size_t new_size) {
    (void)context;
    (void)old_size;
    if (new_size == 0) {
        free(block);
        return NULL;
    }
    return realloc(block, new_size);
}

pir_allocator pir_allocator_or_default(const pir_allocator *allocator) {
    return allocator ? *allocator : (pir_allocator){.resize = malloc_resize, .context = NULL};
}

/* Bytes of a block; 0 on overflow. */
static size_t block_size(size_t count, size_t size) {
    if (count == 0)
        count = 1;
    return count > SIZE_MAX / size ? 0 : count * size;
}

void *pir_memory_new(const pir_allocator *allocator, size_t count, size_t size) {
    size_t bytes = block_size(count, size);
    return bytes ? allocator->resize(allocator->context, NULL, 0, bytes) : NULL;
}

void *pir_memory_zeroed(const pir_allocator *allocator, size_t count, size_t size) {
    void *block = pir_memory_new(allocator, count, size);
    if (block)
        memset(block, 0, block_size(count, size));
    return block;
}

void *pir_memory_resize(const pir_allocator *allocator, void *block, size_t old_count, size_t count, size_t size) {
    size_t bytes = block_size(count, size);
    if (bytes == 0)
        return NULL;
    return allocator->resize(allocator->context, block, block ? block_size(old_count, size) : 0, bytes);
}

void pir_memory_free(const pir_allocator *allocator, void *block, size_t count, size_t size) {
    if (block)
        allocator->resize(allocator->context, block, block_size(count, size), 0);
}
