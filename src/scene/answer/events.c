/* SPDX-License-Identifier: MIT */
/*
 * The events of an update: see events.h.
 *
 * Each has a key, the numbers of both bodies, then those of both pieces, so that a radix sort puts them in an order
 * that depends on these numbers alone.
 */
#include "scene/answer/events.h"

#include "scene/answer/share.h"
#include "scene/answer/surface_contacts.h"
#include "scene/change/changes.h"
#include "scene/reuse/keep.h"
#include "scene/world/grow.h"

/* How many events are worth another thread. */
#define WORTH_MORE 256

/* Digits of 8 bits, or of 11 where there are so many items that counters for these pay. */
#define NARROW 8
#define WIDE   11
#define MANY   1000

/* A digit of a key, the lowest first: each half of its two numbers has as many as it takes. */
static inline uint32_t digit_of(const pir_scene_key *key, uint32_t digit, uint32_t bits) {
    const uint32_t each = 32 / bits + (32 % bits != 0), at = digit % (2 * each);
    const uint64_t number = digit < 2 * each ? key->pieces : key->bodies;
    return (uint32_t)(number >> at / each * 32) >> at % each * bits & ((1u << bits) - 1);
}

/* A digit at a time; digits that all keys share are left out. */
static inline void sort_by_digits(pir_scene_item *item, pir_scene_item *work, uint32_t count, uint32_t bits) {
    const uint32_t digits = bits == NARROW ? 16 : 12, values = 1u << bits;
    pir_scene_key differ = {0, 0};
    pir_scene_item *from = item, *to = work;
    for (uint32_t i = 1; i < count; i++) {
        differ.bodies |= item[i].key.bodies ^ item[0].key.bodies;
        differ.pieces |= item[i].key.pieces ^ item[0].key.pieces;
    }
    for (uint32_t digit = 0; digit < digits; digit++) {
        uint32_t start[(1 << WIDE) + 1];
        if (digit_of(&differ, digit, bits) == 0)
            continue;
        memset(start, 0, (values + 1) * sizeof *start);
        for (uint32_t i = 0; i < count; i++)
            start[digit_of(&from[i].key, digit, bits) + 1]++;
        for (uint32_t value = 0; value < values; value++)
            start[value + 1] += start[value];
        for (uint32_t i = 0; i < count; i++)
            to[start[digit_of(&from[i].key, digit, bits)]++] = from[i];
        pir_scene_item *sorted = to;
        to = from;
        from = sorted;
    }
    if (from != item)
        memcpy(item, from, count * sizeof *item);
}

void pir_scene_sort_items(pir_scene_item *item, pir_scene_item *work, uint32_t count) {
    if (count < MANY)
        sort_by_digits(item, work, count, NARROW);
    else
        sort_by_digits(item, work, count, WIDE);
}

/* Lists what a worker found, but for what a union has in its place. The count of all. */
static uint32_t list_found(pir_scene *scene, const pir_scene_worker *worker, pir_scene_found *found, uint32_t of_found,
                           uint32_t count) {
    for (uint32_t i = 0; i < of_found; i++)
        if (found == worker->on_surface || !found[i].in_union)
            scene->lists.item[count++] = (pir_scene_item){found[i].key, worker, &found[i], found[i].pair, 0};
    return count;
}

/* Lists what is gone, what was found, and what was a contact and is none. */
static uint32_t list_items(pir_scene *scene) {
    pir_scene_lists *lists = &scene->lists;
    uint32_t count = 0;
    // first, so that of equal keys an end stands before a new begin
    for (; count < scene->gone_count; count++)
        lists->item[count] = (pir_scene_item){scene->gone[count].key, NULL, NULL, PIR_END_NONE, count};
    for (uint32_t w = 0; w < scene->threads; w++) {
        const pir_scene_worker *worker = &scene->worker[w];
        count = list_found(scene, worker, worker->found, worker->found_count, count);
        count = list_found(scene, worker, worker->on_surface, worker->on_surface_count, count);
    }
    for (uint32_t i = 0; i < lists->ended_count; i++) {
        uint32_t pair = lists->ended[i];
        lists->item[count++] = (pir_scene_item){pir_scene_key_of(scene, pair), NULL, NULL, pair, 0};
    }
    return count;
}

/* Where the point of a body that is at `point` was before this update. */
static pir_vec3 point_before(const pir_scene *scene, const pir_scene_body *body, pir_vec3 point) {
    if (body->moved != scene->update)
        return point;
    return pir_pose_apply(body->previous, pir_pose_apply_inverse(body->pose, point));
}

static double approach_of(const pir_scene *scene, const pir_scene_item *item, const pir_scene_event *event) {
    const uint32_t *of = scene->pairs.at[item->pair].piece;
    const pir_scene_body *p = &scene->bodies.body[scene->bodies.piece[of[0]].body];
    const pir_scene_body *q = &scene->bodies.body[scene->bodies.piece[of[1]].body];
    const pir_contact *contact = &event->contacts[0];
    pir_vec3 way_p = pir_vec_sub(contact->point_p, point_before(scene, p, contact->point_p));
    pir_vec3 way_q = pir_vec_sub(contact->point_q, point_before(scene, q, contact->point_q));
    return pir_vec_dot(pir_vec_sub(way_q, way_p), event->normal);
}

/* The end of a contact, from all that has to be known of it. */
static pir_scene_event end_of(const pir_scene_gone *gone) {
    return (pir_scene_event){.kind = PIR_EVENT_ENDED,
                             .body_p = pir_key_body(gone->key, 0),
                             .body_q = pir_key_body(gone->key, 1),
                             .piece_p = (uint32_t)(gone->key.pieces >> 32),
                             .piece_q = (uint32_t)gone->key.pieces,
                             .user_p = gone->user[0],
                             .user_q = gone->user[1],
                             .piece_user_p = gone->piece_user[0],
                             .piece_user_q = gone->piece_user[1],
                             .sensor = gone->sensor};
}

static pir_scene_event event_of(const pir_scene *scene, const pir_scene_item *item) {
    if (item->pair == PIR_END_NONE)
        return end_of(&scene->gone[item->group]);
    const pir_scene_pair *pair = &scene->pairs.at[item->pair];
    const pir_scene_gone named = pir_scene_name_contact(scene, item->pair);
    pir_scene_event event = end_of(&named);
    const pir_scene_found *found = item->found;
    if (!found)
        return event;
    event.kind = pair->touching ? PIR_EVENT_PERSISTED : PIR_EVENT_BEGAN;
    event.state = found->state;
    event.distance = found->distance;
    event.normal = found->normal;
    event.witness = found->witness;
    event.contact_count = found->count;
    event.error = found->error;
    if (found->count > 0)
        event.contacts = item->worker->contact + found->first;
    if (scene->approach && found->count > 0)
        event.approach = approach_of(scene, item, &event);
    return event;
}

/* Adds the pairs that were asked, were in contact and are not to the list of those that ended. */
static bool list_ended(pir_scene *scene) {
    pir_scene_lists *lists = &scene->lists;
    uint32_t most = lists->ended_count + lists->asked_count;
    if (!PIR_GROW(&scene->allocator, lists->ended, lists->ended_capacity, most))
        return false;
    for (uint32_t w = 0; w < scene->threads; w++)
        for (uint32_t i = 0; i < scene->worker[w].noted_count; i++)
            lists->ended[lists->ended_count++] = scene->worker[w].noted[i].pair;
    return true;
}

static void make_items(pir_scene *scene, uint32_t task, uint32_t begin, uint32_t end) {
    pir_scene_worker *worker = &scene->worker[task];
    for (uint32_t i = begin; i < end; i++) {
        const pir_scene_event event = event_of(scene, &scene->lists.item[i]);
        scene->event[i] = event;
        worker->told[event.kind]++;
        worker->told_contacts += event.contact_count;
        worker->told_again += event.error > 0;
    }
}

pir_status pir_scene_make_events(pir_scene *scene) {
    pir_scene_lists *lists = &scene->lists;
    const pir_allocator *a = &scene->allocator;
    if (!list_ended(scene))
        return PIR_ERR_MEMORY;
    uint32_t most = lists->ended_count + scene->gone_count, found = 0;
    for (uint32_t w = 0; w < scene->threads; w++) {
        most += scene->worker[w].found_count + scene->worker[w].on_surface_count;
        found += scene->worker[w].found_count;
        memset(scene->worker[w].told, 0, sizeof scene->worker[w].told);
        scene->worker[w].told_contacts = scene->worker[w].told_again = 0;
    }
    if (!PIR_GROW(a, scene->gone, scene->gone_capacity, scene->touching + found) ||
        !PIR_GROW(a, lists->item, lists->item_capacity, most) ||
        !PIR_GROW(a, lists->work, lists->work_capacity, most) ||
        !PIR_GROW(a, scene->event, scene->event_capacity, most))
        return PIR_ERR_MEMORY;
    if (scene->reuse > 0 && pir_reserve_records(scene) != PIR_OK)
        return PIR_ERR_MEMORY;
    uint32_t count = list_items(scene);
    if (count > 1)
        pir_scene_sort_items(lists->item, lists->work, count);
    pir_scene_share(scene, count, WORTH_MORE, make_items);
    // a pair may have several events, so this waits for all of them
    for (uint32_t i = 0; i < count; i++)
        if (lists->item[i].pair != PIR_END_NONE) {
            pir_scene_pair *pair = &scene->pairs.at[lists->item[i].pair];
            const bool was = pair->touching;
            pair->touching = lists->item[i].found != NULL;
            scene->touching = scene->touching + pair->touching - was;
            if (!pair->touching)
                pir_scene_pairs_forget(&scene->pairs, lists->item[i].pair);
        }
    if (scene->reuse > 0)
        pir_keep_found(scene);
    scene->gone_count = 0;
    scene->event_count = count;
    return PIR_OK;
}
