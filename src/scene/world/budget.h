/* SPDX-License-Identifier: MIT */
/*
 * An allocator that counts, stops at a bound, and lets in one thread at a time. Those that stand on it hold its
 * address.
 */
#ifndef PIR_SCENE_WORLD_BUDGET_H
#define PIR_SCENE_WORLD_BUDGET_H

#include <pthread.h>

#include "base/memory.h"

typedef struct pir_budget {
    pir_allocator base;
    size_t most; /* 0: no bound */
    size_t used, peak;
    pthread_mutex_t mutex;
} pir_budget;

void pir_budget_init(pir_budget *budget, const pir_allocator *base, size_t most);
void pir_budget_finish(pir_budget *budget);

/* The allocator that takes from it. */
pir_allocator pir_budget_allocator(pir_budget *budget);

#endif
