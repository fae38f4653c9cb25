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

#endif
