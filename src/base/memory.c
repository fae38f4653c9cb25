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

#ifdef MADV_HUGEPAGE

#define HUGE_PAGE ((size_t)2 << 20)
/* Blocks of so many bytes are worth it; what they take beyond what is used of them is at most one huge page. */
#define HUGE_FROM (2 * HUGE_PAGE)

/* Asks for huge pages inside of a large block: reads of it all over miss the tables of pages less often. A hint. */
static void *in_huge_pages(void *block, size_t size) {
    if (block && size >= HUGE_FROM) {
        size_t before = (HUGE_PAGE - (uintptr_t)block % HUGE_PAGE) % HUGE_PAGE;
        (void)madvise((unsigned char *)block + before, (size - before) / HUGE_PAGE * HUGE_PAGE, MADV_HUGEPAGE);
    }
    return block;
}

/* A block that begins with a huge page where it is large. */
static void *new_block(size_t size) {
    void *aligned = NULL;
    if (size < HUGE_FROM || posix_memalign(&aligned, HUGE_PAGE, size) != 0)
        return malloc(size);
    return in_huge_pages(aligned, size);
}

#else

static void *in_huge_pages(void *block, size_t size) {
    (void)size;
    return block;
}

static void *new_block(size_t size) {
    return malloc(size);
}

#endif

static void *malloc_resize(void *context, void *block, size_t old_size, size_t new_size) {
    (void)context;
    (void)old_size;
    if (new_size == 0) {
        free(block);
        return NULL;
    }
    return block ? in_huge_pages(realloc(block, new_size), new_size) : new_block(new_size);
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
