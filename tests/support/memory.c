/* SPDX-License-Identifier: MIT */
/* See memory.h. Each block is preceded by its size, in a header as large as malloc's alignment, and followed by a guard
   that nobody may write to. */
#include "support/memory.h"

#include <stdlib.h>
#include <string.h>

#define HEADER (_Alignof(max_align_t) > sizeof(size_t) ? _Alignof(max_align_t) : sizeof(size_t))

#define GUARD      16
#define GUARD_BYTE 0xc3

static size_t size_of(const char *start) {
    size_t size;
    memcpy(&size, start, sizeof size);
    return size;
}

static void *give(test_memory *memory, size_t size) {
    char *start = malloc(HEADER + size + GUARD);
    if (!start)
        abort();
    memcpy(start, &size, sizeof size);
    // what nobody wrote must not look like zeros
    memset(start + HEADER, 0xa5, size);
    memset(start + HEADER + size, GUARD_BYTE, GUARD);
    memory->blocks++;
    memory->bytes += size;
    if (memory->bytes > memory->peak)
        memory->peak = memory->bytes;
    return start + HEADER;
}

static void take_back(test_memory *memory, char *start) {
    const unsigned char *guard = (const unsigned char *)start + HEADER + size_of(start);
    for (int i = 0; i < GUARD; i++)
        memory->overrun = memory->overrun || guard[i] != GUARD_BYTE;
    // those who ask about sizes hear of it
    memory->wrong_size = memory->wrong_size || memory->overrun;
    memory->blocks--;
    memory->bytes -= size_of(start);
    memset(start + HEADER, 0x5a, size_of(start));
    free(start);
}

/* Every growth moves the block, so that a pointer kept too long is found. */
static void *test_resize(void *context, void *block, size_t old_size, size_t new_size) {
    test_memory *memory = context;
    char *start = block ? (char *)block - HEADER : NULL;
    if (start ? size_of(start) != old_size : old_size != 0)
        memory->wrong_size = true;
    if (new_size == 0) {
        if (start)
            take_back(memory, start);
        return NULL;
    }
    memory->requests++;
    if (memory->fail_at &&
        (memory->requests == memory->fail_at || (memory->fail_after && memory->requests > memory->fail_at)))
        return NULL;
    void *fresh = give(memory, new_size);
    if (start) {
        size_t kept = size_of(start);
        memcpy(fresh, block, kept < new_size ? kept : new_size);
        take_back(memory, start);
    }
    return fresh;
}

pir_allocator test_allocator(test_memory *memory) {
    return (pir_allocator){test_resize, memory};
}
