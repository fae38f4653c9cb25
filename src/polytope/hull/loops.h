/* SPDX-License-Identifier: MIT */
/*
 * Facets as loops of indices, counter-clockwise from outside, and their canonical order: each loop starts at its
 * smallest index, loops stand in lexicographic order. Loops of the same facets are then equal array for array, whoever
 * made them.
 */
#ifndef PIR_POLYTOPE_HULL_LOOPS_H
#define PIR_POLYTOPE_HULL_LOOPS_H

#include "base/memory.h"

typedef struct pir_loops {
    uint32_t count;  /* facets */
    uint32_t *start; /* count + 1 offsets into corner */
    uint32_t *corner;
} pir_loops;

/* Room for `count` loops and `corners` corners in all, nothing set; false when out of memory. */
bool pir_loops_init(pir_loops *loops, const pir_allocator *allocator, uint32_t count, uint32_t corners);
/* `corners` as given to init. */
void pir_loops_finish(pir_loops *loops, const pir_allocator *allocator, uint32_t corners);

static inline uint32_t pir_loops_corners(const pir_loops *loops) {
    return loops->start[loops->count];
}

/* Turns and sorts the loops; `tags`, one a loop, move with them and may be NULL. False when out of memory. */
bool pir_loops_canonicalise(pir_loops *loops, uint8_t *tags, const pir_allocator *allocator);

#endif
