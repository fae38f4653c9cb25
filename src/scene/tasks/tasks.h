/* SPDX-License-Identifier: MIT */
/*
 * A pool of threads behind the task interface of scene.h. The thread that calls works too, so a pool for n tasks at a
 * time has n − 1 threads; they wait without work on a condition.
 */
#ifndef PIR_SCENE_TASKS_TASKS_H
#define PIR_SCENE_TASKS_TASKS_H

#include <pirouette/scene.h>

#include "base/memory.h"

typedef struct pir_task_pool pir_task_pool;

/* PIR_ERR_MEMORY also where the system has no more threads. */
pir_status pir_task_pool_create(const pir_allocator *allocator, uint32_t threads, pir_task_pool **ret_pool);
void pir_task_pool_destroy(pir_task_pool *pool);

/* The pool as the interface that callers may bring themselves. */
pir_tasks pir_task_pool_interface(pir_task_pool *pool);

#endif
