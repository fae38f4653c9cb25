/* SPDX-License-Identifier: MIT */
/* A list of rotations in the order of visiting. */
#ifndef PIR_CSPACE_GRID_LIST_H
#define PIR_CSPACE_GRID_LIST_H

#include "cspace/grid/quat_tree.h"

typedef struct pir_list {
    uint32_t count;
    pir_quat *given;  /* in the order of visiting, as given */
    pir_quat *unit;   /* the same, of length 1 */
    uint32_t *source; /* the row that each was given in */
    uint32_t *item;   /* of the tree */
    double spacing;   /* the mean turn to the nearest other rotation, 0 where there is one */
} pir_list;

/* Copies the rotations, which are finite and not zero; false when out of memory, and then nothing is held. */
bool pir_list_init(pir_list *list, const pir_quat *rotations, uint32_t count, bool keep_order,
                   const pir_allocator *allocator);
void pir_list_finish(pir_list *list, const pir_allocator *allocator);

/* Fills `near`, which is empty, for a unit quaternion. */
void pir_list_nearest(const pir_list *list, pir_quat unit, pir_near *near);

#endif
