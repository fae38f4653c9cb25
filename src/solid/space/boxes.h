/* SPDX-License-Identifier: MIT */
/* A tree over boxes that do not move: which of them meet a given one. O(n log n) to make, in flat arrays. */
#ifndef PIR_SOLID_SPACE_BOXES_H
#define PIR_SOLID_SPACE_BOXES_H

#include "solid/space/space.h"

typedef struct pir_space_box {
    double low[3], high[3];
} pir_space_box;

#define PIR_BOXES_LEAF 4

/* Node k has the box of all below it; its children are 2k + 1 and 2k + 2. A leaf has up to four boxes in a row. */
typedef struct pir_boxes {
    uint32_t count, leaf_count, node_count;
    pir_space_box *node;
    pir_space_box *box; /* in the order of the leaves */
    uint32_t *order;    /* which box each is */
} pir_boxes;

#define PIR_SPACE_BOX_EMPTY ((pir_space_box){{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}})

static inline bool pir_space_box_meets(const pir_space_box *a, const pir_space_box *b) {
    for (int k = 0; k < 3; k++)
        if (a->low[k] > b->high[k] || b->low[k] > a->high[k])
            return false;
    return true;
}

/* Makes `box` hold a point of the space, wherever it is within its error. */
void pir_space_box_add(pir_space_box *box, const pir_space_point *point);

/* False when out of memory. */
bool pir_boxes_init(pir_boxes *boxes, const pir_allocator *allocator, const pir_space_box *box, uint32_t count);

/* Puts as many others in place of the boxes. */
void pir_boxes_replace(pir_boxes *boxes, const pir_space_box *box);

void pir_boxes_finish(pir_boxes *boxes, const pir_allocator *allocator);

/* Writes the boxes that meet `box` into ret_found, which has room for all; how many they are. */
uint32_t pir_boxes_find(const pir_boxes *boxes, const pir_space_box *box, uint32_t *ret_found);

#endif
