/* SPDX-License-Identifier: MIT */
/* An allocator with a bound: see budget.h. */
#include "scene/world/budget.h"

static void *resize(void *context, void *block, size_t old_size, size_t new_size) {
    pir_budget *budget = context;
    void *given = NULL;
    pthread_mutex_lock(&budget->mutex);
    size_t rest = budget->used - old_size;
    bool fits = budget->most == 0 || (new_size <= budget->most && rest <= budget->most - new_size);
    if (fits || new_size <= old_size) {
        given = budget->base.resize(budget->base.context, block, old_size, new_size);
        if (given || new_size == 0)
            budget->used = rest + new_size;
        budget->peak = budget->used > budget->peak ? budget->used : budget->peak;
    }
    pthread_mutex_unlock(&budget->mutex);
    return given;
}

void pir_budget_init(pir_budget *budget, const pir_allocator *base, size_t most) {
    *budget = (pir_budget){.base = *base, .most = most};
    pthread_mutex_init(&budget->mutex, NULL);
}

void pir_budget_finish(pir_budget *budget) {
    pthread_mutex_destroy(&budget->mutex);
}

pir_allocator pir_budget_allocator(pir_budget *budget) {
    return (pir_allocator){resize, budget};
}
