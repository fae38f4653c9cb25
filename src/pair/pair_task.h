/* SPDX-License-Identifier: MIT */
/* A question to a pair, on the ways of query/answer/ladder.h. */
#ifndef PIR_PAIR_PAIR_TASK_H
#define PIR_PAIR_PAIR_TASK_H

#include "pair/pair.h"

typedef struct pir_pair_task {
    pir_task task; /* first: what the ladder knows */
    pir_pair *pair;
    pir_workspace *workspace;
} pir_pair_task;

static inline pir_pair_task *pir_pair_task_of(pir_task *task) {
    return (pir_pair_task *)task;
}

/* --- apart.c --- */

/* Keeps that the bodies are apart by a distance along n, in the frame, for certain: see pir_facet_source. */
void pir_pair_keep_apart(pir_task *task, pir_vec3 n, double distance);

/* Whether x is outside of D along the direction of the descent's simplex: see pir_facet_source. */
bool pir_pair_is_outside(pir_task *task, double *ret_distance);

/* The answer, where x is apart by more than the cutoff along the unit vector n: then that is the direction kept. */
bool pir_pair_apart_along(pir_task *task, pir_vec3 n);

/*
 * Whether the bodies are apart by more than a length of the world along the direction that is kept, or along others
 * that it tells; that is the proof that is kept then. Takes no frame. False too where the input is wrong. The pair has
 * such a direction, and the length is finite.
 */
bool pir_pair_apart(pir_pair *pair, const pir_walker *walker, const pir_pair_input *input, double least);

/* --- pair_depth.c --- */

/* The answer from facets: see pir_facet_source. */
bool pir_pair_depth(pir_task *task, bool anew);

#endif
