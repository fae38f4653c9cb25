/* SPDX-License-Identifier: MIT */
/* The profile of an update: see profile.h. */
#include "scene/update/profile.h"

void pir_profile_begin(pir_scene *scene) {
    scene->profile = (pir_scene_profile){0};
    scene->part_began = scene->clock ? scene->clock(scene->clock_context) : 0;
}

void pir_profile_end(pir_scene *scene) {
    pir_scene_profile *profile = &scene->profile;
    profile->moved = scene->lists.moved_count;
    for (uint32_t i = 0; i < scene->lists.moved_count; i++)
        profile->boxes += scene->bodies.body[scene->lists.moved[i].body].pieces;
    profile->replaced = scene->lists.replaced_count;
    profile->looked = scene->looked;
    profile->asked = scene->lists.asked_count;
    for (uint32_t i = 0; scene->profiles && i < scene->threads; i++) {
        const pir_pair_statistics *ways = &scene->worker[i].ways;
        profile->by_proof += ways->by_proof;
        profile->by_walk += ways->by_walk;
        profile->by_nearest += ways->by_nearest;
        profile->by_depth += ways->by_depth;
        profile->by_whole += ways->by_whole;
        profile->manifolds += ways->manifolds;
    }
    for (uint32_t i = 0; i < scene->threads; i++) {
        const pir_scene_worker *worker = &scene->worker[i];
        profile->began += worker->told[PIR_EVENT_BEGAN];
        profile->persisted += worker->told[PIR_EVENT_PERSISTED];
        profile->ended += worker->told[PIR_EVENT_ENDED];
        profile->contacts += worker->told_contacts;
        profile->reused += worker->told_again;
    }
}
