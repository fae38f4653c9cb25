/* SPDX-License-Identifier: MIT */
/* The ways to an answer that search for its facet: see answer.c. */
#ifndef PIR_PAIR_SEEK_H
#define PIR_PAIR_SEEK_H

#include "pair/task.h"

/*
 * The answer by searching for its facet, on the levels that the option allows: from the facet and the surface of the
 * last answer on, the latter where that was deep, and anew.
 */
bool pir_task_seek(pir_task *task, bool near, bool deep, bool was_deep);

#endif
