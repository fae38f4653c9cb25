/* SPDX-License-Identifier: MIT */
/*
 * The results of queries, from the facet or the faces that decide it. The numbers depend on these, the bodies and
 * the placement alone, so that every way of finding them gives the same bits.
 */
#ifndef PIR_QUERY_ANSWER_RESULT_H
#define PIR_QUERY_ANSWER_RESULT_H

#include "query/nearest/nearest.h"

/*
 * Distances above this, relative to the placement's reach, are tried for a quick proof; nearer ones go to the exact
 * search at once.
 */
#define PIR_CLEARLY_APART 0x1p-40

/* Distances are known this well, relative to the placement's reach, however they are found. */
#define PIR_DISTANCE_ERROR 0x1p-42

/* The numbers that a call wants. */
enum { PIR_WANT_SEPARATION = 1, PIR_WANT_DEPTH = 2 };

/* Member by member: a compiler's way of clearing the whole takes a fifth of a query. */
static inline void pir_result_clear(pir_query_result *result) {
    const pir_vec3 none = {0, 0, 0};
    result->state = PIR_OUTSIDE;
    result->outcome = PIR_SEPARATED;
    result->distance = 0;
    result->normal = result->point_p = result->point_q = none;
    result->witness.p = result->witness.q = (pir_feature){PIR_FEATURE_NONE, 0};
    result->steps = 0;
}

static inline void pir_result_set_state(pir_query_result *result, pir_state state) {
    result->state = state;
    result->outcome = state == PIR_OUTSIDE ? PIR_SEPARATED : state == PIR_BOUNDARY ? PIR_TOUCHING : PIR_OVERLAPPING;
}

/* Where t lies on the boundary: `touching` is the first true facet that it is on. */
void pir_result_touching(pir_exact *exact, const pir_placement *placement, const pir_least *touching,
                         pir_query_result *result);

/* Keeps what a query about overlap gives: state, outcome and steps, and of a boundary the contact. */
void pir_result_keep_state(pir_query_result *result);

void pir_result_separation(const pir_frame *frame, const pir_nearest *nearest, pir_query_result *result);
void pir_result_beyond(pir_query_result *result);

/* The best distance so far, of a descent that found no nearest point. */
void pir_result_unfinished(const pir_frame *frame, const pir_simplex *simplex, pir_query_result *result);

/* The depth: the facet of least slack, and that as pir_facet_slack gives it. */
void pir_result_depth_of(pir_exact *exact, const pir_placement *placement, const pir_facet *facet, double slack,
                         pir_query_result *result);

/* The depth, given the slack and what touches at the foot of x. */
void pir_result_depth_at(const pir_frame *frame, pir_vec3 normal, double slack, const pir_touch *touch,
                         pir_query_result *result);

/* Grows both bodies by their radii in an answer that knows the signed distance. */
void pir_result_add_radii(const pir_query_input *input, pir_query_result *result);

#endif
