/* SPDX-License-Identifier: MIT */
/*
 * Memory through a pir_allocator.
 *
 * Invariant: a block's size in bytes is max(count, 1) · size, computed the same way when it is made, resized and
 * freed, so an allocator that counts bytes gets the same number each time.
 */
#if defined(__linux__)
#define _DEFAULT_SOURCE /* madvise */
#endif

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>
#if defined(__linux__)
#include <sys/mman.h>
#endif

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

#ifdef MADV_HUGEPAGE

#define HUGE_PAGE ((size_t)2 << 20)
/* Blocks of so many bytes are worth it; what they take beyond what is used of them is at most one huge page. */
#define HUGE_FROM (2 * HUGE_PAGE)

/* A block of malloc's that begins with a huge page and asks for more. NULL where there is none. */
static void *huge_block(const pir_allocator *allocator, size_t bytes) {
    void *block = NULL;
    if (allocator->resize != malloc_resize || bytes < HUGE_FROM || posix_memalign(&block, HUGE_PAGE, bytes) != 0)
        return NULL;
    // a hint: where it fails, pages are small
    (void)madvise(block, bytes / HUGE_PAGE * HUGE_PAGE, MADV_HUGEPAGE);
    return block;
}

#else

static void *huge_block(const pir_allocator *allocator, size_t bytes) {
    (void)allocator;
    (void)bytes;
    return NULL;
}

#endif

void *pir_memory_lasting(const pir_allocator *allocator, size_t bytes) {
    void *block = huge_block(allocator, bytes);
    if (!block)
        return pir_memory_zeroed(allocator, bytes, 1);
    return memset(block, 0, bytes);
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
