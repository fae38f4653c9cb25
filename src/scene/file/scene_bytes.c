/* SPDX-License-Identifier: MIT */
/* A scene to bytes, in the order that snapshot.h tells. */
#include <pirouette/scene_file.h>

#include <string.h>

#include "base/byte_block.h"
#include "base/report.h"
#include "scene/answer/events.h"
#include "scene/change/changes.h"
#include "scene/file/kept_bytes.h"
#include "scene/file/put_bytes.h"
#include "scene/world/grow.h"

uint64_t pir_snapshot_checksum(const uint8_t *data, size_t size) {
    const uint64_t hash = pir_hash_words(PIR_HASH_START, data, PIR_SNAPSHOT_CHECKSUM_AT);
    return pir_hash_words(hash, data + PIR_SNAPSHOT_HEADER, size - PIR_SNAPSHOT_HEADER);
}

/* Whether a piece of a body has a number of the caller's. */
static bool has_users(const pir_scene *scene, const pir_scene_body *body) {
    bool has = false;
    for (uint32_t i = body->first; i != PIR_PIECE_NONE && !has; i = scene->bodies.piece[i].next)
        has = scene->bodies.piece[i].user != 0;
    return has;
}

static pir_snapshot_counts counts_of(const pir_scene *scene) {
    const pir_bodies *bodies = &scene->bodies;
    pir_snapshot_counts counts = {.numbers = bodies->body_slots,
                                  .bodies = bodies->body_count,
                                  .contacts = scene->touching,
                                  .ends = scene->gone_count};
    while (counts.numbers > bodies->body_end && bodies->body[counts.numbers - 1].generation == 0)
        counts.numbers--;
    for (uint32_t b = 0; b < bodies->body_end; b++)
        if (bodies->body[b].used && has_users(scene, &bodies->body[b]))
            counts.users += bodies->body[b].pieces;
    return counts;
}

/* The bytes of all that counts tell, and of what contacts keep. */
static size_t size_of(const pir_scene *scene, const pir_snapshot_counts *counts) {
    size_t size = (size_t)pir_snapshot_size(counts);
    for (uint32_t i = 0; scene->reuse > 0 && i < scene->pairs.capacity; i++)
        if (scene->pairs.at[i].touching)
            size += (size_t)pir_kept_size(&scene->pairs.at[i]);
    return size;
}

size_t pir_scene_serialised_size(const pir_scene *scene) {
    const pir_snapshot_counts counts = counts_of(scene);
    return size_of(scene, &counts);
}

static void put_header(uint8_t **at, const pir_scene *scene, const pir_snapshot_counts *counts) {
    memcpy(*at, PIR_SNAPSHOT_MAGIC, 8);
    *at += 8;
    pir_put_bytes(at, scene->reuse > 0 ? PIR_SNAPSHOT_LAST : PIR_SNAPSHOT_VERSION, 4);
    pir_put_bytes(at, counts->numbers, 4);
    pir_put_bytes(at, counts->bodies, 4);
    pir_put_bytes(at, counts->users, 4);
    pir_put_bytes(at, counts->contacts, 4);
    pir_put_bytes(at, counts->ends, 4);
    *at += 8;
}

static void put_body(uint8_t **at, const pir_scene *scene, uint32_t number) {
    const pir_scene_body *body = &scene->bodies.body[number];
    const pir_quat q = body->pose.rotation;
    const pir_vec3 t = body->pose.translation;
    const double numbers[9] = {body->radius, body->fast, q.x, q.y, q.z, q.w, t.x, t.y, t.z};
    pir_put_bytes(at, pir_body_id(&scene->bodies, number), 4);
    pir_put_bytes(at, body->pieces, 4);
    pir_put_bytes(at, body->kind, 1);
    pir_put_bytes(at,
                  (body->sensor ? PIR_SNAPSHOT_SENSOR : 0u) | (body->disabled ? PIR_SNAPSHOT_DISABLED : 0u) |
                      (body->fresh ? PIR_SNAPSHOT_FRESH : 0u) | (has_users(scene, body) ? PIR_SNAPSHOT_USERS : 0u),
                  3);
    pir_put_bytes(at, body->category, 4);
    pir_put_bytes(at, body->mask, 4);
    pir_put_bytes(at, 0, 4);
    pir_put_bytes(at, body->user, 8);
    pir_put_bytes(at, body->shape, 8);
    for (int k = 0; k < 9; k++)
        pir_put_double(at, numbers[k]);
}

static void put_bodies(uint8_t **at, const pir_scene *scene, uint32_t numbers) {
    const pir_bodies *bodies = &scene->bodies;
    for (uint32_t b = 0; b < numbers + numbers % 2; b++)
        pir_put_bytes(at, b < numbers ? bodies->body[b].generation : 0, 4);
    for (uint32_t b = 0; b < bodies->body_end; b++)
        if (bodies->body[b].used)
            put_body(at, scene, b);
    for (uint32_t b = 0; b < bodies->body_end; b++)
        if (bodies->body[b].used && has_users(scene, &bodies->body[b]))
            for (uint32_t i = bodies->body[b].first; i != PIR_PIECE_NONE; i = bodies->piece[i].next)
                pir_put_bytes(at, bodies->piece[i].user, 8);
}

/* The contacts and the ends in order, these behind those in scene->lists.item. */
static void sort_contacts(pir_scene *scene) {
    pir_scene_item *item = scene->lists.item;
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->pairs.capacity; i++)
        if (scene->pairs.at[i].touching)
            item[count++] = (pir_scene_item){.key = pir_scene_key_of(scene, i), .pair = i};
    for (uint32_t i = 0; i < scene->gone_count; i++)
        item[count + i] = (pir_scene_item){.key = scene->gone[i].key, .pair = PIR_END_NONE, .group = i};
    if (count > 1)
        pir_scene_sort_items(item, scene->lists.work, count);
    if (scene->gone_count > 1)
        pir_scene_sort_items(item + count, scene->lists.work, scene->gone_count);
}

static void put_contacts(uint8_t **at, const pir_scene *scene, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        const pir_scene_item *item = &scene->lists.item[i];
        pir_put_bytes(at, item->key.bodies, 8);
        pir_put_bytes(at, item->key.pieces, 8);
        if (item->pair != PIR_END_NONE)
            continue;
        const pir_scene_gone *gone = &scene->gone[item->group];
        const uint64_t told[5] = {gone->user[0], gone->user[1], gone->piece_user[0], gone->piece_user[1], gone->sensor};
        for (int k = 0; k < 5; k++)
            pir_put_bytes(at, told[k], 8);
    }
}

/* Labels records of unions by the first of the sorted contacts that is in it. */
static void label_unions(pir_scene *scene, uint32_t contacts) {
    pir_scene_item *item = scene->lists.item, *of_union = item + contacts;
    uint32_t count = 0;
    for (uint32_t i = 0; i < contacts; i++) {
        const pir_kept_record *united = scene->pairs.at[item[i].pair].united;
        if (united)
            of_union[count++] = (pir_scene_item){.key = {united->union_number, i}, .pair = item[i].pair};
    }
    if (count > 1)
        pir_scene_sort_items(of_union, scene->lists.work, count);
    for (uint32_t i = 0, first = 0; i < count; i++) {
        if (of_union[i].key.bodies != of_union[first].key.bodies)
            first = i;
        scene->pairs.at[of_union[i].pair].united->label = (uint32_t)of_union[first].key.pieces;
    }
}

static void put_kept(uint8_t **at, pir_scene *scene, uint32_t contacts) {
    label_unions(scene, contacts);
    for (uint32_t i = 0; i < contacts; i++) {
        const pir_scene_pair *pair = &scene->pairs.at[scene->lists.item[i].pair];
        pir_put_kept(at, pair, pair->united ? pair->united->label : 0);
    }
}

pir_status pir_scene_serialise(pir_scene *scene, void *memory, size_t size) {
    const pir_status status = pir_scene_given(scene, "snapshot", memory ? NULL : "memory");
    if (status != PIR_OK)
        return status;
    const pir_snapshot_counts counts = counts_of(scene);
    if (size != size_of(scene, &counts))
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "snapshot: room for %zu bytes, not the %zu that it takes",
                        size, size_of(scene, &counts));
    pir_scene_lists *lists = &scene->lists;
    // unions are sorted once all else is written
    const uint32_t items = counts.contacts + counts.ends, room = items + (scene->reuse > 0 ? counts.contacts : 0);
    if (!PIR_GROW(&scene->allocator, lists->item, lists->item_capacity, room) ||
        !PIR_GROW(&scene->allocator, lists->work, lists->work_capacity, items))
        return pir_fail(scene->report, PIR_ERR_MEMORY, "snapshot: no memory to sort %u contacts",
                        (unsigned)counts.contacts);
    sort_contacts(scene);
    uint8_t *at = memory;
    put_header(&at, scene, &counts);
    put_bodies(&at, scene, counts.numbers);
    put_contacts(&at, scene, items);
    if (scene->reuse > 0)
        put_kept(&at, scene, counts.contacts);
    at = (uint8_t *)memory + PIR_SNAPSHOT_CHECKSUM_AT;
    pir_put_bytes(&at, pir_snapshot_checksum(memory, size), 8);
    return PIR_OK;
}
