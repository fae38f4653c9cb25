/* SPDX-License-Identifier: MIT */
/* Sorting in place, without memory of its own, which qsort does not promise. */
#ifndef PIR_MESH_SIGNS_HEAP_SORT_H
#define PIR_MESH_SIGNS_HEAP_SORT_H

#include <stddef.h>

#define PIR_HEAP_MOST 128 /* bytes of an element, at most */

/* Sorts `count` elements of `size` bytes. Equal ones are in no order. */
void pir_heap_sort(void *elements, size_t count, size_t size, int (*compare)(const void *a, const void *b));

#endif
