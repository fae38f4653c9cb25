/* SPDX-License-Identifier: MIT */
/*
 * Active sets, for queries on sums and pairs: the members are found in Q's frame, as answers about bodies without
 * radii, and become gradients where the caller's frame is.
 */
#ifndef PIR_QUERY_ANSWER_ACTIVE_H
#define PIR_QUERY_ANSWER_ACTIVE_H

#include <pirouette/gradient.h>

#include "query/answer/follow.h"
#include "query/gradient/derivative.h"

/* A list of members that is being made. */
typedef struct pir_active_list {
    const pir_frame *frame;
    const pir_mat3 *turn;  /* Q's rotation, or NULL where members stay in Q's frame */
    pir_query_input radii; /* of which the radii count */
    pir_deriving deriving; /* without radii; the origins where members come to be */
    /* Brings an answer from Q's frame; NULL where it stays there. */
    void (*arrive)(const void *context, pir_query_result *result);
    const void *context;
    uint32_t facet; /* the number of the facet whose corners are being added */
    size_t capacity, count;
    pir_active *at;
} pir_active_list;

/* Checks the arguments that all calls have. */
static inline pir_status pir_active_check(double slack, size_t capacity, const pir_active *ret_active,
                                          const size_t *ret_count) {
    return (!ret_active && capacity > 0) || !ret_count || !(slack >= 0 && slack < HUGE_VAL) ? PIR_ERR_ARGUMENT : PIR_OK;
}

/* Input for the bodies without radii, which are beyond its cutoff where those with radii are beyond theirs. */
pir_query_input pir_active_bare(const pir_query_input *input);

/* Whether an answer has points. */
static inline bool pir_active_has_points(const pir_query_result *result) {
    return result->normal.x != 0 || result->normal.y != 0 || result->normal.z != 0;
}

/* Adds an answer in Q's frame, without radii, by the features that decide it. */
void pir_active_add(pir_active_list *list, const pir_query_result *result, pir_witness features);

/*
 * Adds the corners of the polygon of nearest points, the bodies being apart or touching without a facet. `answer`: that
 * of the bodies without radii, in the list's frame.
 */
void pir_active_apart(pir_active_list *list, pir_exact *exact, const pir_placement *placement,
                      const pir_query_result *answer);

/* Adds all facets within `slack` of the least, the one of `decided`, the bodies touching or overlapping. */
void pir_active_facets(pir_active_list *list, pir_query *query, const pir_placement *placement, pir_piece decided,
                       double slack);

#endif
