/* SPDX-License-Identifier: MIT */
/* Searches on a sum with a region: see regional.c. */
#ifndef PIR_QUERY_DEPTH_REGIONAL_H
#define PIR_QUERY_DEPTH_REGIONAL_H

#include "dymsum/view.h"
#include "query/decide/line.h"
#include "query/depth/groups.h"

/*
 * Lower bounds on slacks, per facet of P, facet of Q and edge of P; how much all of them may have changed; and where
 * the last search was.
 */
typedef struct pir_regional {
    const pir_sum *sum;
    double *known_p, *known_q, *known_edge;
    double change_p, change_q;
    pir_quat last_unit;
    pir_vec3 last_x;
} pir_regional;

/* Makes the memory for a frame, with no bounds yet. `sum` must be set, which is borrowed. False when out of memory. */
bool pir_regional_init(pir_regional *regional, const pir_allocator *allocator, const pir_frame *frame);
void pir_regional_finish(pir_regional *regional, const pir_allocator *allocator, const pir_frame *frame);

/* Forgets all bounds. */
void pir_regional_forget(pir_regional *regional, const pir_frame *frame);

/*
 * The state that the facets in the region tell. *ret_least is the facet that separates, the one that touches, or the
 * one of least slack. There is none where no facet is in the region.
 */
pir_state pir_regional_find(pir_regional *regional, pir_groups *groups, const pir_placement *placement,
                            const pir_query_cache *cache, pir_least *ret_least, uint32_t *steps);

/* From inside: where a line leaves the half-spaces of the facets in the region. False where it crosses none of them. */
bool pir_regional_exit(pir_regional *regional, pir_groups *groups, const pir_line *line, pir_arrival *ret_arrival,
                       uint32_t *steps);

#endif
