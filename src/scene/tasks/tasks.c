/* SPDX-License-Identifier: MIT */
/*
 * A pool of threads: see tasks.h.
 *
 * Invariant, under the mutex: tasks with numbers below `next` have been taken, `done` of them have ended, and there are
 * `count` in all. A batch is over when done = count.
 */
#include "scene/tasks/tasks.h"

#include <pthread.h>
#include <stdbool.h>

struct pir_task_pool {
    pir_allocator allocator;
    pthread_mutex_t mutex;
    pthread_cond_t work, over;
    pthread_t *thread;
    uint32_t threads, started; /* in the table; running */
    bool closing;
    void (*task)(void *data, uint32_t index);
    void *data;
    uint32_t next, done, count;
};

/* Runs tasks while there are some; begins and ends with the mutex held. */
static void work_off(pir_task_pool *pool) {
    while (pool->next < pool->count) {
        uint32_t index = pool->next++;
        pthread_mutex_unlock(&pool->mutex);
        pool->task(pool->data, index);
        pthread_mutex_lock(&pool->mutex);
        if (++pool->done == pool->count)
            pthread_cond_signal(&pool->over);
    }
}

static void *run(void *data) {
    pir_task_pool *pool = data;
    pthread_mutex_lock(&pool->mutex);
    while (!pool->closing) {
        work_off(pool);
        if (!pool->closing)
            pthread_cond_wait(&pool->work, &pool->mutex);
    }
    pthread_mutex_unlock(&pool->mutex);
    return NULL;
}

static void start(void *context, void (*task)(void *data, uint32_t index), void *data, uint32_t count) {
    pir_task_pool *pool = context;
    pthread_mutex_lock(&pool->mutex);
    pool->task = task;
    pool->data = data;
    pool->next = pool->done = 0;
    pool->count = count;
    pthread_cond_broadcast(&pool->work);
    pthread_mutex_unlock(&pool->mutex);
}

static void finish(void *context) {
    pir_task_pool *pool = context;
    pthread_mutex_lock(&pool->mutex);
    work_off(pool);
    while (pool->done < pool->count)
        pthread_cond_wait(&pool->over, &pool->mutex);
    pthread_mutex_unlock(&pool->mutex);
}

pir_status pir_task_pool_create(const pir_allocator *allocator, uint32_t threads, pir_task_pool **ret_pool) {
    pir_task_pool *pool = PIR_ZEROED(allocator, pir_task_pool, 1);
    if (!pool)
        return PIR_ERR_MEMORY;
    pool->allocator = *allocator;
    pool->threads = threads;
    pool->thread = PIR_NEW(allocator, pthread_t, threads);
    pthread_mutex_init(&pool->mutex, NULL);
    pthread_cond_init(&pool->work, NULL);
    pthread_cond_init(&pool->over, NULL);
    while (pool->thread && pool->started + 1 < threads &&
           pthread_create(&pool->thread[pool->started], NULL, run, pool) == 0)
        pool->started++;
    if (!pool->thread || pool->started + 1 < threads) {
        pir_task_pool_destroy(pool);
        return PIR_ERR_MEMORY;
    }
    *ret_pool = pool;
    return PIR_OK;
}

void pir_task_pool_destroy(pir_task_pool *pool) {
    if (!pool)
        return;
    pthread_mutex_lock(&pool->mutex);
    pool->closing = true;
    pthread_cond_broadcast(&pool->work);
    pthread_mutex_unlock(&pool->mutex);
    for (uint32_t i = 0; i < pool->started; i++)
        pthread_join(pool->thread[i], NULL);
    pthread_cond_destroy(&pool->over);
    pthread_cond_destroy(&pool->work);
    pthread_mutex_destroy(&pool->mutex);
    const pir_allocator a = pool->allocator;
    PIR_FREE(&a, pool->thread, pool->threads);
    PIR_FREE(&a, pool, 1);
}

pir_tasks pir_task_pool_interface(pir_task_pool *pool) {
    return (pir_tasks){pool, start, finish};
}
