/* SPDX-License-Identifier: MIT */
/* Searches on a sum with a region: see regional.c. */
#ifndef PIR_QUERY_SEARCH_REGIONAL_H
#define PIR_QUERY_SEARCH_REGIONAL_H

#include "dymsum/view.h"
#include "query/decide/line.h"
#include "query/planes/groups.h"

/*
 * Bounds on slacks, per facet of P, facet of Q and edge of P; how far all may have fallen since; where the last
 * search was.
 */
typedef struct pir_regional {
    const pir_sum *sum;
    double *known_p, *known_q, *known_edge;
    double way_p, way_q;
    pir_quat way_unit;
    pir_vec3 way_x;
} pir_regional;

/*
 * Memory, for a frame whose operands are known and a sum, which is borrowed; false when out of memory:
 * pir_regional_finish frees what is there.
 */
bool pir_regional_init(pir_regional *regional, const pir_allocator *allocator, const pir_frame *frame,
                       const pir_sum *sum);
void pir_regional_finish(pir_regional *regional, const pir_allocator *allocator, const pir_frame *frame);

/* Begins without a bound. */
void pir_regional_forget(pir_regional *regional, const pir_frame *frame);

/*
 * The state as the facets in the region of the sum tell it. *ret_least is the facet that separates, or touches, or is
 * the one of least slack; there is none where the region has none.
 */
pir_state pir_regional_find(pir_regional *regional, pir_groups *groups, const pir_placement *placement,
                            const pir_query_cache *cache, pir_least *ret_least, uint32_t *steps);

/*
 * From inside: where the line leaves what the facets in the region of the sum bound; false where none of them is
 * passed.
 */
bool pir_regional_exit(pir_regional *regional, pir_groups *groups, const pir_line *line, pir_arrival *ret_arrival,
                       uint32_t *steps);

#endif
