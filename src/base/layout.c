/* SPDX-License-Identifier: MIT */
/* Arrays made and freed by one table: see layout.h. */
#include "base/layout.h"

#include <string.h>

bool pir_layout_new(const pir_allocator *allocator, const pir_layout *layout) {
    bool done = true;
    for (const pir_layout_row *row = layout->row; row->size != 0; row++) {
        void *block = pir_memory_zeroed(allocator, row->count, row->size);
        // object pointers of all types have one representation here, but not one type: their bytes are copied
        memcpy(row->pointer, &block, sizeof block);
        done = done && block;
    }
    return done;
}

void pir_layout_free(const pir_allocator *allocator, const pir_layout *layout) {
    for (const pir_layout_row *row = layout->row; row->size != 0; row++) {
        void *block;
        memcpy(&block, row->pointer, sizeof block);
        pir_memory_free(allocator, block, row->count, row->size);
    }
}
