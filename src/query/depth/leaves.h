/* SPDX-License-Identifier: MIT */
/* All planes of D at one rotation, in leaves, for many translations: see leaves.c. */
#ifndef PIR_QUERY_DEPTH_LEAVES_H
#define PIR_QUERY_DEPTH_LEAVES_H

#include "query/decide/facet.h"
#include "query/depth/groups.h"

typedef struct pir_leaves {
    uint64_t stamp; /* the groups' stamp when they were made */
    uint32_t plane_count, leaf_count, capacity;
    pir_lanes n;
    double *h, *err;
    uint32_t *slot;              /* the slot of each plane in the groups' planes */
    uint32_t *cell, *cell_start; /* the cells of planes while they are sorted, work space afterwards */
    pir_box_lanes box;           /* per leaf */
    double *low;
    uint32_t *looked;
} pir_leaves;

/* Makes the leaves at the present rotation, unless they are there: PIR_ERR_MEMORY. Begins with a struct of zeros. */
pir_status pir_leaves_make(pir_leaves *leaves, pir_groups *groups, const pir_allocator *allocator);
void pir_leaves_finish(pir_leaves *leaves, const pir_allocator *allocator);

/* The state. False where doubles leave it open. */
bool pir_leaves_state(pir_leaves *leaves, const pir_groups *groups, const pir_placement *placement,
                      pir_state *ret_state);

/* The true facet of least slack. False where D has none. */
bool pir_leaves_depth(pir_leaves *leaves, pir_groups *groups, const pir_placement *placement, pir_facet *ret_facet);

/* A lower bound on all slacks. */
double pir_leaves_least(pir_leaves *leaves, const pir_groups *groups, const pir_placement *placement);

#endif
