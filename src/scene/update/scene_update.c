/* SPDX-License-Identifier: MIT */
/*
 * An update, in steps of which all that can fail come before the last:
 *
 *   1. places are checked, and boxes made for them;
 *   2. bodies go to their places, and pieces whose boxes leave those of the tree are reinserted;
 *   3. pairs that these lack are made;
 *   4. pairs of moved bodies are looked at, and asked where neither boxes nor distances tell;
 *   5. fast bodies are cast along their way;
 *   6. events are made, pairs without a meeting of boxes dropped.
 *
 * A failure from step 3 on takes bodies and boxes back to where they were. Pairs that were made stay: they are not in
 * contact, and more pairs than needed break no invariant.
 */
#include "scene/answer/ask.h"
#include "scene/answer/candidates.h"
#include "scene/answer/events.h"
#include "scene/answer/motion.h"
#include "scene/answer/surface_contacts.h"
#include "scene/update/fast_bodies.h"
#include "scene/update/profile.h"
#include "scene/world/grow.h"

/* --- 1. what is asked for --- */

/* Lists a body with the pose that it goes to. */
static void put_move(pir_scene *scene, uint32_t body, pir_pose pose) {
    scene->lists.moved[scene->lists.moved_count++] = (pir_scene_moved){.body = body, .pose = pose};
    scene->bodies.body[body].moved = scene->update;
}

/* A moved body, once; `moved` of a body is set to this update so that the second time is seen. */
static pir_status take_move(pir_scene *scene, const pir_scene_move *move, size_t number) {
    const unsigned long at = (unsigned long)number;
    const unsigned named = move->body;
    const uint32_t index = pir_bodies_find(&scene->bodies, move->body);
    if (index == PIR_SCENE_NONE)
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "update: move %lu: there is no body %u", at, named);
    const pir_scene_body *body = &scene->bodies.body[index];
    if (body->kind == PIR_BODY_STATIC)
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "update: move %lu: body %u is static", at, named);
    if (body->moved == scene->update)
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "update: move %lu: body %u comes twice", at, named);
    put_move(scene, index, move->pose);
    return PIR_OK;
}

/* Fresh bodies that no move was given for stay where they are. */
static void take_fresh(pir_scene *scene) {
    for (uint32_t i = 0; i < scene->fresh_count; i++) {
        const pir_scene_body *body = &scene->bodies.body[scene->fresh[i]];
        if (body->moved != scene->update)
            put_move(scene, scene->fresh[i], body->pose);
    }
}

static pir_status take_moves(pir_scene *scene, const pir_scene_move *moves, size_t count) {
    pir_scene_lists *lists = &scene->lists;
    if (count > scene->bodies.body_count)
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "update: more moves than the %u bodies",
                        (unsigned)scene->bodies.body_count);
    uint32_t most = (uint32_t)count + scene->fresh_count;
    if (!PIR_GROW(&scene->allocator, lists->moved, lists->moved_capacity, most))
        return pir_fail(scene->report, PIR_ERR_MEMORY, "update: %s", pir_status_text(PIR_ERR_MEMORY));
    pir_status status = PIR_OK;
    for (size_t i = 0; i < count && status == PIR_OK; i++)
        status = take_move(scene, &moves[i], i);
    if (status != PIR_OK)
        return status;
    take_fresh(scene);
    return pir_scene_make_boxes(scene, "update", scene->report);
}

/* --- the call --- */

/* Pairs, their answers and events. Fills the report. */
static pir_status answer(pir_scene *scene) {
    pir_scene_profile *profile = &scene->profile;
    pir_status status = pir_scene_find_pairs(scene);
    pir_profile_part(scene, &profile->pairs_ns);
    if (status == PIR_OK)
        status = pir_scene_list_questions(scene);
    pir_profile_part(scene, &profile->looks_ns);
    if (status != PIR_OK)
        return pir_fail(scene->report, status, "update: its pairs: %s", pir_status_text(status));
    status = pir_scene_ask(scene);
    pir_profile_part(scene, &profile->questions_ns);
    if (status == PIR_OK && (scene->unions || scene->bodies.triangle_count > 0))
        status = pir_scene_find_surface_contacts(scene);
    pir_profile_part(scene, &profile->unions_ns);
    if (status != PIR_OK)
        return status;
    status = pir_scene_find_impacts(scene);
    if (status != PIR_OK)
        return status;
    status = pir_scene_make_events(scene);
    return status == PIR_OK ? PIR_OK
                            : pir_fail(scene->report, status, "update: its events: %s", pir_status_text(status));
}

pir_status pir_scene_update(pir_scene *scene, const pir_scene_move *moves, size_t count) {
    pir_status status = pir_scene_given(scene, "update", !moves && count > 0 ? "moves" : NULL);
    if (status != PIR_OK)
        return status;
    pir_scene_lists *lists = &scene->lists;
    scene->update++;
    scene->event_count = scene->impact_count = scene->looked = 0;
    lists->moved_count = lists->replaced_count = lists->asked_count = lists->ended_count = 0;
    pir_profile_begin(scene);
    status = take_moves(scene, moves, count);
    pir_profile_part(scene, &scene->profile.places_ns);
    if (status != PIR_OK)
        return status;
    pir_scene_move_bodies(scene);
    pir_profile_part(scene, &scene->profile.tree_ns);
    status = answer(scene);
    if (status != PIR_OK) {
        scene->impact_count = 0;
        pir_scene_move_back(scene);
        return status;
    }
    pir_scene_drop_pairs(scene);
    for (uint32_t i = 0; i < scene->fresh_count; i++)
        scene->bodies.body[scene->fresh[i]].fresh = false;
    scene->fresh_count = 0;
    pir_profile_part(scene, &scene->profile.events_ns);
    pir_profile_end(scene);
    return PIR_OK;
}
