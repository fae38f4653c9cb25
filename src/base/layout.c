/* SPDX-License-Identifier: MIT */
/*
 * Arrays made and freed by one table: see layout.h.
 *
 * The block is freed at its lowest array, so an object may exchange pointers of its own. Under AddressSanitizer arrays
 * are apart by poisoned bytes, so that running out of one is found.
 */
#include "base/layout.h"

#include <string.h>

#if defined(__SANITIZE_ADDRESS__)
#define PIR_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PIR_ADDRESS_SANITIZER 1
#endif
#endif

#ifdef PIR_ADDRESS_SANITIZER
#include <sanitizer/asan_interface.h>
#define GAP                   32
#define FORBID(address, size) ASAN_POISON_MEMORY_REGION(address, size)
#define ALLOW(address, size)  ASAN_UNPOISON_MEMORY_REGION(address, size)
#else
#define GAP                   0
#define FORBID(address, size) ((void)(address), (void)(size))
#define ALLOW(address, size)  ((void)(address), (void)(size))
#endif

/* Every array begins at a multiple of so many bytes. */
#define ALIGNMENT 16

/* The bytes of a row; SIZE_MAX on overflow. */
static size_t row_bytes(const pir_layout_row *row) {
    return row->count > (SIZE_MAX / 2) / row->size ? SIZE_MAX : row->count * row->size;
}

/* Where the row after one of `bytes` bytes at `offset` begins; SIZE_MAX on overflow. */
static size_t next_offset(size_t offset, size_t bytes) {
    if (bytes == SIZE_MAX || offset > SIZE_MAX / 2 - bytes - GAP - ALIGNMENT)
        return SIZE_MAX;
    return (offset + bytes + GAP + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
}

size_t pir_layout_bytes(const pir_layout *layout) {
    size_t offset = 0;
    for (const pir_layout_row *row = layout->row; row->size != 0 && offset != SIZE_MAX; row++)
        offset = next_offset(offset, row_bytes(row));
    return offset;
}

void pir_layout_add(pir_layout *layout, pir_layout_row row) {
    uint32_t count = 0;
    while (layout->row[count].size != 0)
        count++;
    PIR_ASSERT(count < PIR_LAYOUT_ROWS);
    layout->row[count] = row;
}

bool pir_layout_new(const pir_allocator *allocator, const pir_layout *layout) {
    size_t bytes = pir_layout_bytes(layout), offset = 0;
    unsigned char *block = bytes == SIZE_MAX ? NULL : pir_memory_lasting(allocator, bytes);
    for (const pir_layout_row *row = layout->row; row->size != 0; row++) {
        void *at = block ? block + offset : NULL;
        // object pointers of all types have one representation here, but not one type: their bytes are copied
        memcpy(row->pointer, &at, sizeof at);
        if (!block)
            continue;
        size_t size = row_bytes(row);
        offset = next_offset(offset, size);
        FORBID(block + offset - GAP, GAP);
    }
    return block != NULL;
}

void pir_layout_free(const pir_allocator *allocator, const pir_layout *layout) {
    unsigned char *block = NULL;
    for (const pir_layout_row *row = layout->row; row->size != 0; row++) {
        unsigned char *at;
        memcpy(&at, row->pointer, sizeof at);
        block = !block || (at && at < block) ? at : block;
    }
    if (!block)
        return;
    size_t bytes = pir_layout_bytes(layout);
    ALLOW(block, bytes);
    pir_memory_free(allocator, block, bytes, 1);
}
