/* SPDX-License-Identifier: MIT */
/* Questions of pairs: see ask.h. */
#include "scene/answer/ask.h"

#include "scene/answer/events.h"
#include "scene/answer/share.h"
#include "scene/answer/surface_contacts.h"
#include "scene/change/changes.h"
#include "scene/world/grow.h"

/* How many questions are worth another thread. */
#define WORTH_MORE 32

/* Distances are within this of the exact ones, relative to bodies and coordinates, with room to spare. */
#define DISTANCE_ERROR 1e-11

static double length(pir_vec3 v) {
    return sqrt(pir_vec_dot(v, v));
}

void pir_scene_keep_apart(pir_scene_pair *pair, const pir_scene_body *p, const pir_scene_body *q, double distance) {
    double size =
        p->reach + q->reach + p->radius + q->radius + length(p->pose.translation) + length(q->pose.translation);
    pair->apart = distance - DISTANCE_ERROR * size;
    pair->travelled = p->travel + q->travel;
}

/* The contacts of an answer, behind those that the worker has. */
static pir_status add_contacts(pir_scene *scene, pir_scene_worker *worker, pir_pair *pair, const pir_pair_input *input,
                               const pir_query_result *answer) {
    pir_scene_found *found = &worker->found[worker->found_count];
    size_t count = 8, capacity = 0;
    pir_status status = PIR_OK;
    while (status == PIR_OK && count > capacity) {
        uint32_t need = worker->contact_count + (uint32_t)count;
        if (!PIR_GROW(&scene->allocator, worker->contact, worker->contact_capacity, need))
            return PIR_ERR_MEMORY;
        capacity = worker->contact_capacity - worker->contact_count;
        status = pir_pair_manifold(pair, worker->workspace, input, answer, capacity,
                                   worker->contact + worker->contact_count, &count);
    }
    if (status == PIR_OK) {
        found->count = (uint32_t)count;
        worker->contact_count += found->count;
    }
    return status;
}

/* Whether two bodies are in contact by an answer. */
static bool in_contact(const pir_scene *scene, const pir_query_result *answer, bool sensor) {
    if (answer->state != PIR_OUTSIDE)
        return true;
    return !sensor && scene->margin > 0 && answer->outcome != PIR_BEYOND_CUTOFF && answer->distance <= scene->margin;
}

/* A surface counts as no larger than what is near it. */
static double size_of(const pir_scene_body *p, const pir_scene_body *q) {
    if (pir_body_has_surface(p) || pir_body_has_surface(q))
        return 2 * fmin(p->reach, q->reach);
    return p->reach + q->reach;
}

/* Adds the ways that a pair has taken since `before` to those of a worker. */
static void count_ways(pir_scene_worker *worker, const pir_pair *pair, const pir_pair_statistics *before) {
    const pir_pair_statistics now = pir_pair_get_statistics(pair);
    pir_pair_statistics *ways = &worker->ways;
    ways->by_proof += now.by_proof - before->by_proof;
    ways->by_walk += now.by_walk - before->by_walk;
    ways->by_nearest += now.by_nearest - before->by_nearest;
    ways->by_depth += now.by_depth - before->by_depth;
    ways->by_whole += now.by_whole - before->by_whole;
    ways->manifolds += now.manifolds - before->manifolds;
}

static pir_status ask(pir_scene *scene, pir_scene_worker *worker, uint32_t number) {
    pir_scene_pair *pair = &scene->pairs.at[number];
    const pir_scene_piece *piece = scene->bodies.piece;
    const pir_scene_body *p = &scene->bodies.body[piece[pair->piece[0]].body];
    const pir_scene_body *q = &scene->bodies.body[piece[pair->piece[1]].body];
    bool sensor = p->sensor || q->sensor, numbers = !sensor && scene->detail > PIR_SCENE_STATES;
    pir_pair_input input = {.pose_p = p->pose,
                            .pose_q = q->pose,
                            .radius_p = p->radius,
                            .radius_q = q->radius,
                            .cutoff = scene->margin + PIR_SKIN * size_of(p, q),
                            .margin = scene->margin};
    pir_query_result answer;
    pir_status status =
        (numbers ? pir_pair_signed_distance : pir_pair_overlap)(pair->asked, worker->workspace, &input, &answer);
    if (status != PIR_OK)
        return status;
    pair->apart = 0;
    if (numbers && (answer.outcome == PIR_SEPARATED || answer.outcome == PIR_BEYOND_CUTOFF))
        pir_scene_keep_apart(pair, p, q, answer.distance);
    if (!in_contact(scene, &answer, sensor))
        return PIR_OK;
    if (!PIR_GROW(&scene->allocator, worker->found, worker->found_capacity, worker->found_count + 1))
        return PIR_ERR_MEMORY;
    pir_scene_found *found = &worker->found[worker->found_count];
    *found = (pir_scene_found){.pair = number, .first = worker->contact_count, .state = answer.state};
    if (numbers) {
        found->distance = answer.distance;
        found->normal = answer.normal;
        found->witness = answer.witness;
    }
    if (numbers && scene->detail == PIR_SCENE_MANIFOLDS && !pir_scene_is_with_surface(scene, number))
        status = add_contacts(scene, worker, pair->asked, &input, &answer);
    worker->found_count += status == PIR_OK;
    return status;
}

static void ask_items(pir_scene *scene, uint32_t task, uint32_t begin, uint32_t end) {
    pir_scene_worker *worker = &scene->worker[task];
    for (uint32_t i = begin; i < end; i++) {
        const pir_pair *pair = scene->pairs.at[scene->lists.asked[i]].asked;
        pir_pair_statistics before;
        if (scene->profiles)
            before = pir_pair_get_statistics(pair);
        pir_scene_worker_note(worker, ask(scene, worker, scene->lists.asked[i]), i);
        if (scene->profiles)
            count_ways(worker, pair, &before);
    }
}

pir_status pir_scene_ask(pir_scene *scene) {
    for (uint32_t i = 0; i < scene->threads; i++) {
        scene->worker[i].found_count = scene->worker[i].on_surface_count = scene->worker[i].contact_count = 0;
        scene->worker[i].ways = (pir_pair_statistics){0};
    }
    pir_scene_workers_begin(scene);
    pir_scene_share(scene, scene->lists.asked_count, WORTH_MORE, ask_items);
    const pir_status status = pir_scene_workers_status(scene);
    if (status == PIR_OK)
        return PIR_OK;
    const pir_scene_key key = pir_scene_key_of(scene, scene->lists.asked[pir_scene_workers_failed(scene)]);
    return pir_fail(scene->report, status, "update: bodies %u and %u, pieces %u and %u: %s",
                    (unsigned)pir_key_body(key, 0), (unsigned)pir_key_body(key, 1), (unsigned)(key.pieces >> 32),
                    (unsigned)key.pieces, pir_status_text(status));
}
