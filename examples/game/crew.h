/* SPDX-License-Identifier: MIT */
/* A game's own memory and threads, as it may have them: blocks that are counted, threads that share out tasks. And what
   it does where a call fails, and numbers from 0 to 1 that are the same everywhere. */
#ifndef GAME_CREW_H
#define GAME_CREW_H

#include <inttypes.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#include <pirouette/scene.h>

static atomic_size_t crew_memory_left; /* that are not given back */

static void *crew_resize(void *context, void *block, size_t old_size, size_t new_size) {
    (void)context;
    void *moved = new_size > 0 ? realloc(block, new_size) : (free(block), NULL);
    if (moved || new_size == 0)
        atomic_fetch_add(&crew_memory_left, new_size - old_size);
    return moved;
}

static const pir_allocator crew_memory = {crew_resize, NULL};

struct crew {
    uint32_t threads; /* the caller's among them; at most 8 */
    pthread_t thread[8];
    void (*task)(void *data, uint32_t index);
    void *data;
    uint32_t count;
    atomic_uint next;
};

static void *crew_work(void *context) {
    struct crew *crew = context;
    for (uint32_t i; (i = atomic_fetch_add(&crew->next, 1)) < crew->count;)
        crew->task(crew->data, i);
    return NULL;
}

static void crew_start(void *context, void (*task)(void *data, uint32_t index), void *data, uint32_t count) {
    struct crew *crew = context;
    crew->task = task;
    crew->data = data;
    crew->count = count;
    atomic_store(&crew->next, 0);
    for (uint32_t i = 1; i < crew->threads; i++)
        if (pthread_create(&crew->thread[i], NULL, crew_work, crew) != 0)
            abort();
}

static void crew_finish(void *context) {
    struct crew *crew = context;
    (void)crew_work(crew);
    for (uint32_t i = 1; i < crew->threads; i++)
        pthread_join(crew->thread[i], NULL);
}

/* The options of a scene on that memory, within a budget, and on the crew, which outlives it. */
static inline pir_scene_options crew_options(struct crew *crew, size_t budget) {
    static pir_tasks tasks = {NULL, crew_start, crew_finish}; // copied by the scene
    pir_scene_options options = pir_scene_options_default();
    tasks.context = crew;
    options.allocator = &crew_memory;
    options.budget = budget;
    options.threads = crew->threads;
    options.detail = PIR_SCENE_DEPTHS; // hulls are pushed along normals: no manifolds
    options.tasks = &tasks;
    options.keep_shapes = true; // of bodies that are gone, for restores
    return options;
}

static inline uint64_t hash_of(const unsigned char *data, size_t size, uint64_t hash) {
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ data[i]) * 1099511628211u;
    return hash;
}

static inline void must(pir_status status) {
    if (status == PIR_OK)
        return;
    fprintf(stderr, "game: %s\n", pir_status_text(status));
    exit(EXIT_FAILURE);
}

static inline double chance(void) {
    static uint32_t state = 1;
    return ((state = state * 1664525u + 1013904223u) >> 8) / 16777216.;
}

#endif
