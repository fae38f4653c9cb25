/* SPDX-License-Identifier: MIT */
/*
 * Memory through a pir_allocator. Sizes are checked for overflow here, once, so that callers count elements.
 */
#ifndef PIR_BASE_MEMORY_H
#define PIR_BASE_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <pirouette/base.h>

/* The given allocator, or malloc's when NULL. */
pir_allocator pir_allocator_or_default(const pir_allocator *allocator);

/* `count` elements of `size` bytes, not initialised; NULL when out of memory or when the product overflows. A count of
 * 0 gives a block of one element, so that NULL always means failure. */
void *pir_memory_new(const pir_allocator *allocator, size_t count, size_t size);

/* New memory for `count` elements, zeroed. */
void *pir_memory_zeroed(const pir_allocator *allocator, size_t count, size_t size);

/*
 * A zeroed block of bytes that lasts and is read all over. On Linux a large one of malloc's lies in huge pages where
 * the kernel has them, so that reads miss the tables of pages less often. They take longer to be had: what is soon
 * freed is better made above.
 */
void *pir_memory_lasting(const pir_allocator *allocator, size_t bytes);

/* Grows or shrinks a block made above from `old_count` to `count` elements; NULL leaves it as it
   was. `block` may be NULL. */
void *pir_memory_resize(const pir_allocator *allocator, void *block, size_t old_count, size_t count, size_t size);

/* Releases a block of `count` elements; NULL is accepted. */
void pir_memory_free(const pir_allocator *allocator, void *block, size_t count, size_t size);

#define PIR_NEW(allocator, type, count)        ((type *)pir_memory_new((allocator), (count), sizeof(type)))
#define PIR_ZEROED(allocator, type, count)     ((type *)pir_memory_zeroed((allocator), (count), sizeof(type)))
#define PIR_FREE(allocator, block, count)      pir_memory_free((allocator), (block), (count), sizeof *(block))
#define PIR_RESIZE(allocator, block, old, new) pir_memory_resize((allocator), (block), (old), (new), sizeof *(block))

#endif
