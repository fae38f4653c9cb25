/* SPDX-License-Identifier: MIT */
/*
 * Shared by the ways to an answer: the question, the proofs so far, and the answers that follow from a nearest
 * point or a facet. See answer.c for the ways.
 */
#ifndef PIR_PAIR_TASK_H
#define PIR_PAIR_TASK_H

#include "pair/pair.h"
#include "query/answer/result.h"

typedef struct pir_task {
    pir_pair *pair;
    pir_workspace *workspace;
    const pir_placement *placement;
    pir_exact *exact;
    int want;
    double limit;    /* the cutoff and the radii, in the frame */
    bool is_outside; /* proven */
    bool has_same;   /* the next is proven */
    bool in_doubt;   /* it may be the facet of the last answer, which doubles do not tell */
    pir_same_facet same;
    pir_simplex simplex;
    pir_query_result *result;
} pir_task;

static inline void pir_task_end(const pir_task *task, pir_level level) {
    task->pair->level = (uint8_t)level;
}

/* Keeps a facet as a hint. */
static inline void pir_task_keep_facet(pir_pair *pair, const pir_facet *facet) {
    pair->facet = facet->piece;
    pair->has_facet = true;
}

/* --- answers --- */

void pir_task_near(pir_task *task, const pir_nearest *nearest);

/* x inside of D; `facet` is the one of least slack. */
void pir_task_inside(pir_task *task, const pir_facet *facet, double slack);

/* x on the boundary of D; `facet` is the first that touches. */
void pir_task_touching(pir_task *task, const pir_facet *facet);

/* The answer from a true facet, where that is enough. */
bool pir_task_settle(pir_task *task, const pir_facet *facet);

/* --- outside.c --- */

/* The answer by a descent to the nearest point. False where x is not proven to be outside, and not settled. */
bool pir_task_descend(pir_task *task);

#endif
