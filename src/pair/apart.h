/* SPDX-License-Identifier: MIT */
/* Apart by more than the cutoff, along a direction that is kept: see apart.c. */
#ifndef PIR_PAIR_APART_H
#define PIR_PAIR_APART_H

#include "pair/task.h"

/* A distance from D along the unit vector n that is certain, where climbs along n found `distance`. */
double pir_task_certain(const pir_task *task, pir_vec3 n, double distance);

/* Whether a certain distance is an answer: more than the cutoff. */
bool pir_task_is_beyond(const pir_task *task, double distance);

/* Keeps a proof: at the poses of this call the bodies are a distance apart along n, in the frame, for certain. */
void pir_task_keep_proof(const pir_task *task, pir_vec3 n, double distance);

/* Keeps the direction of such an answer as a hint, and the distance along it that is certain. */
void pir_task_keep_axis(const pir_task *task, pir_vec3 n, double distance);

/* The answer, where x is apart by more than the cutoff along the unit vector n: then that is the direction kept. */
bool pir_task_apart_along(pir_task *task, pir_vec3 n);

/* The answer, where x is apart by more than the cutoff along the direction that is kept. */
bool pir_task_apart(pir_task *task);

#endif
