/* SPDX-License-Identifier: MIT */
/* Questions of pairs: see ask.h. */
#include "scene/answer/ask.h"

#include "scene/answer/candidates.h"
#include "scene/answer/events.h"
#include "scene/answer/share.h"
#include "scene/answer/surface_contacts.h"
#include "scene/change/changes.h"
#include "scene/reuse/carried.h"
#include "scene/reuse/motion_since.h"
#include "scene/world/grow.h"

/* How many questions are worth another thread. */
#define WORTH_MORE 32

void pir_scene_keep_apart(pir_scene_pair *pair, const pir_scene_body *p, const pir_scene_body *q, double distance) {
    pair->apart = distance - pir_scene_distance_error(p, q);
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

/* The two bodies of a question, and what is asked. */
struct pair_question {
    pir_scene_pair *pair;
    const pir_scene_body *p, *q;
    bool numbers, manifold; /* whether it is about these */
    pir_pair_input input;
};

static struct pair_question question_of(const pir_scene *scene, uint32_t number) {
    pir_scene_pair *pair = &scene->pairs.at[number];
    const pir_scene_piece *piece = scene->bodies.piece;
    const pir_scene_body *p = &scene->bodies.body[piece[pair->piece[0]].body];
    const pir_scene_body *q = &scene->bodies.body[piece[pair->piece[1]].body];
    const bool numbers = !p->sensor && !q->sensor && scene->detail > PIR_SCENE_STATES;
    const bool manifold = numbers && scene->detail == PIR_SCENE_MANIFOLDS && !pir_scene_is_with_surface(scene, number);
    return (struct pair_question){.pair = pair,
                                  .p = p,
                                  .q = q,
                                  .numbers = numbers,
                                  .manifold = manifold,
                                  .input = {.pose_p = p->pose,
                                            .pose_q = q->pose,
                                            .radius_p = p->radius,
                                            .radius_q = q->radius,
                                            .cutoff = scene->margin + PIR_SKIN * size_of(p, q),
                                            .margin = scene->margin}};
}

/* Asks a pair; whether it is in contact. */
static pir_status ask_pair(const pir_scene *scene, pir_scene_worker *worker, const struct pair_question *question,
                           pir_query_result *ret_answer, bool *ret_contact) {
    pir_scene_pair *pair = question->pair;
    pir_status status = (question->numbers ? pir_pair_signed_distance : pir_pair_overlap)(
        pair->asked, worker->workspace, &question->input, ret_answer);
    if (status != PIR_OK)
        return status;
    pair->apart = 0;
    if (question->numbers && (ret_answer->outcome == PIR_SEPARATED || ret_answer->outcome == PIR_BEYOND_CUTOFF))
        pir_scene_keep_apart(pair, question->p, question->q, ret_answer->distance);
    *ret_contact = in_contact(scene, ret_answer, question->p->sensor || question->q->sensor);
    return PIR_OK;
}

/* Fills in what an answer tells. */
static void tell_answer(const struct pair_question *question, const pir_query_result *answer, pir_scene_found *found,
                        pir_scene_news *news) {
    found->state = answer->state;
    if (!question->numbers)
        return;
    found->distance = answer->distance;
    found->normal = news->told_normal = answer->normal;
    found->witness = answer->witness;
    news->told_point[0] = answer->point_p;
    news->told_point[1] = answer->point_q;
    news->new_answer = true;
}

/* Adds a contact to the list of a worker, and its contacts, told again or found; these are new where an answer is. */
static pir_status add_found(pir_scene *scene, pir_scene_worker *worker, const struct pair_question *question,
                            const pir_query_result *answer, const pir_scene_found *found, const pir_scene_news *news) {
    const pir_kept_record *kept = question->pair->kept;
    uint32_t first = 0;
    pir_status status = PIR_OK;
    if (!PIR_GROW(&scene->allocator, worker->found, worker->found_capacity, worker->found_count + 1) ||
        (scene->reuse > 0 &&
         !PIR_GROW(&scene->allocator, worker->news, worker->news_capacity, worker->found_count + 1)))
        return PIR_ERR_MEMORY;
    pir_scene_found *at = &worker->found[worker->found_count];
    *at = *found;
    if (question->manifold && news->new_contacts)
        status = add_contacts(scene, worker, question->pair->asked, &question->input, answer);
    else if (question->manifold)
        status = pir_carry_event(scene, worker, kept, &first, at);
    if (scene->reuse > 0)
        worker->news[worker->found_count] = *news;
    worker->found_count += status == PIR_OK;
    return status;
}

static pir_status ask(pir_scene *scene, pir_scene_worker *worker, uint32_t number) {
    const struct pair_question question = question_of(scene, number);
    pir_scene_found found = {.pair = number,
                             .first = worker->contact_count,
                             .news = worker->found_count,
                             .news_worker = (uint32_t)(worker - scene->worker)};
    pir_scene_news news = {.new_contacts = question.manifold};
    const pir_kept_record *kept = question.numbers ? question.pair->kept : NULL;
    pir_query_result answer;
    double moved = 0;
    if (question.numbers && scene->reuse > 0)
        news.seen = pir_see(scene, number);
    if (kept && question.manifold && kept->count > 0)
        news.new_contacts = !pir_is_near_kept(scene, number, &news.seen, &kept->made, &moved);
    if (!kept || news.new_contacts || !pir_carry_answer(scene, &news.seen, &found)) {
        bool contact = false;
        const pir_status status = ask_pair(scene, worker, &question, &answer, &contact);
        if (status == PIR_OK && !contact && question.pair->touching)
            return pir_scene_note(scene, worker, number, false);
        if (status != PIR_OK || !contact)
            return status;
        tell_answer(&question, &answer, &found, &news);
    }
    found.key = pir_scene_key_of(scene, number);
    found.error = news.new_contacts ? 0 : fmax(found.error, moved);
    return add_found(scene, worker, &question, &answer, &found, &news);
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
        scene->worker[i].noted_count = 0;
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
