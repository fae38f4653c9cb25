/* SPDX-License-Identifier: MIT */
/* Apart by more than the cutoff, along a direction that is kept: see apart.c. */
#ifndef PIR_PAIR_APART_H
#define PIR_PAIR_APART_H

#include "pair/pair_task.h"

/* Keeps that the bodies are apart by a distance along n, in the frame, for certain: see pir_facet_source. */
void pir_pair_keep_apart(pir_task *task, pir_vec3 n, double distance);

/* Whether x is outside of D along the direction of the descent's simplex: see pir_facet_source. */
bool pir_pair_is_outside(pir_task *task, double *ret_distance);

/* The answer, where x is apart by more than the cutoff along the unit vector n: then that is the direction kept. */
bool pir_pair_apart_along(pir_task *task, pir_vec3 n);

/* The answer, where x is apart by more than the cutoff along the direction that is kept. */
bool pir_pair_apart(pir_task *task);

#endif
