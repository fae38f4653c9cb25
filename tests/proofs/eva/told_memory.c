/* SPDX-License-Identifier: MIT */
/* Memory as base/memory.h tells of it: each request may fail, and what is freed is not read again. */
#include <stdlib.h>

#include "base/memory.h"

void *pir_memory_new(const pir_allocator *allocator, size_t count, size_t size) {
    (void)allocator;
    return malloc((count == 0 ? 1 : count) * size);
}

void *pir_memory_zeroed(const pir_allocator *allocator, size_t count, size_t size) {
    (void)allocator;
    return calloc(count == 0 ? 1 : count, size);
}

void pir_memory_free(const pir_allocator *allocator, void *block, size_t count, size_t size) {
    (void)allocator;
    (void)count;
    (void)size;
    free(block);
}
