/* SPDX-License-Identifier: MIT */
/*
 * The arrays that an object owns, in one table from which they are both made and freed, so that no size is stated
 * twice. They are one block of memory.
 *
 *     static pir_layout layout_of(pir_thing *thing) {
 *         return (pir_layout){{PIR_ROW(thing->vertices, thing->vertex_count),
 *                              PIR_ROW(thing->marks, thing->edge_count)}};
 *     }
 *
 * The table ends at its first empty row. The sizes in it must be the same when the arrays are made and when they are
 * freed.
 */
#ifndef PIR_BASE_LAYOUT_H
#define PIR_BASE_LAYOUT_H

#include "base/assert.h"
#include "base/memory.h"

/* An array: where the pointer to it stands, the size of an element, the number of elements. */
typedef struct pir_layout_row {
    void *pointer;
    size_t size, count;
} pir_layout_row;

#define PIR_LAYOUT_ROWS 32

typedef struct pir_layout {
    pir_layout_row row[PIR_LAYOUT_ROWS + 1];
} pir_layout;

/* A row of a table: `member` is the pointer, a member of the object that owns the array. */
#define PIR_ROW(member, elements)                                                                                      \
    { &(member), sizeof *(member), (elements) }

/* Adds a row. There must be room for it. */
void pir_layout_add(pir_layout *layout, pir_layout_row row);

/* The bytes of the block; SIZE_MAX where that is beyond what can be addressed. */
size_t pir_layout_bytes(const pir_layout *layout);

/* Makes every array, of zeros. False when out of memory: all pointers are NULL then. */
bool pir_layout_new(const pir_allocator *allocator, const pir_layout *layout);

/* Frees the arrays, whose pointers may have changed places; none where they are NULL. */
void pir_layout_free(const pir_allocator *allocator, const pir_layout *layout);

#endif
