/* SPDX-License-Identifier: MIT */
/* Items shared out to tasks: see share.h. */
#include "scene/answer/share.h"

#include <stdatomic.h>

struct share {
    pir_scene *scene;
    pir_share_items *items;
    uint32_t count;
    atomic_uint next;
};

static void work(void *data, uint32_t task) {
    struct share *share = data;
    for (;;) {
        uint32_t begin = atomic_fetch_add_explicit(&share->next, PIR_SHARE_RUN, memory_order_relaxed);
        if (begin >= share->count)
            break;
        uint32_t left = share->count - begin;
        share->items(share->scene, task, begin, begin + (left < PIR_SHARE_RUN ? left : PIR_SHARE_RUN));
    }
}

void pir_scene_share(pir_scene *scene, uint32_t count, uint32_t worth, pir_share_items *items) {
    struct share share = {.scene = scene, .items = items, .count = count};
    uint32_t tasks = count / worth < scene->threads ? count / worth : scene->threads;
    atomic_init(&share.next, 0);
    if (tasks > 1) {
        scene->tasks.start(scene->tasks.context, work, &share, tasks);
        scene->tasks.finish(scene->tasks.context);
    } else {
        work(&share, 0);
    }
}
