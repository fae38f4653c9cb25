/* SPDX-License-Identifier: MIT */
/* All planes of D at one rotation, in leaves, for many translations: see leaves.c. */
#ifndef PIR_QUERY_PLANES_LEAVES_H
#define PIR_QUERY_PLANES_LEAVES_H

#include "query/decide/facet.h"
#include "query/planes/group_planes.h"

typedef struct pir_leaves {
    uint64_t stamp; /* of the groups, when they were made */
    uint32_t plane_count, leaf_count, capacity;
    pir_lanes n;
    double *h, *err;
    uint32_t *slot;              /* where each stands in the planes of the groups */
    uint32_t *cell, *cell_start; /* cells while planes are sorted, work space after */
    pir_box_lanes box;           /* per leaf */
    double *low;
    uint32_t *looked;
} pir_leaves;

/* Makes the leaves of the rotation; PIR_ERR_MEMORY. Begins with leaves of zeros. */
pir_status pir_leaves_make(pir_leaves *leaves, pir_groups *groups, const pir_allocator *allocator);
void pir_leaves_finish(pir_leaves *leaves, const pir_allocator *allocator);

/* The state where doubles tell it; false where they leave it open. */
bool pir_leaves_state(pir_leaves *leaves, const pir_groups *groups, const pir_placement *placement,
                      pir_state *ret_state);

/* The true facet of least slack; false where D has none. */
bool pir_leaves_depth(pir_leaves *leaves, pir_groups *groups, const pir_placement *placement, pir_facet *ret_facet);

/* A number that no slack is below. */
double pir_leaves_least(pir_leaves *leaves, const pir_groups *groups, const pir_placement *placement);

#endif
