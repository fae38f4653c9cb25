/* SPDX-License-Identifier: MIT */
/**
 * Threads of the caller's: scenes (scene.h) and batches (pair_batch.h) share their work out through one interface.
 *
 * Threads: `start` and `finish` are called from the thread that called Pirouette; tasks run where the caller has them.
 */
#ifndef PIROUETTE_TASKS_H
#define PIROUETTE_TASKS_H

#include <pirouette/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Where a caller's own threads do the work of a call. The two functions are called in turn, start first, from the
 * thread that called Pirouette.
 */
typedef struct pir_tasks {
    void *context;
    /** Has task(data, i) run for each i below `count`, each once, on any threads, at once where there are some. */
    void (*start)(void *context, void (*task)(void *data, uint32_t index), void *data, uint32_t count);
    /** Returns when all of them have; may run some itself. */
    void (*finish)(void *context);
} pir_tasks;

#ifdef __cplusplus
}
#endif

#endif
