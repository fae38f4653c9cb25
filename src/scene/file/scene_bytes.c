/* SPDX-License-Identifier: MIT */
/* A scene to bytes, in the order that snapshot.h tells. */
#include <pirouette/scene_file.h>

#include <string.h>

#include "base/byte_block.h"
#include "base/report.h"
#include "scene/answer/events.h"
#include "scene/change/changes.h"
#include "scene/file/snapshot.h"
#include "scene/world/grow.h"

static void put(uint8_t **at, uint64_t value, int bytes) {
    for (int k = 0; k < bytes; k++)
        *(*at)++ = (uint8_t)(value >> (8 * k));
}

static void put_double(uint8_t **at, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(at, bits, 8);
}

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

size_t pir_scene_serialised_size(const pir_scene *scene) {
    const pir_snapshot_counts counts = counts_of(scene);
    return (size_t)pir_snapshot_size(&counts);
}

static void put_header(uint8_t **at, const pir_snapshot_counts *counts) {
    memcpy(*at, PIR_SNAPSHOT_MAGIC, 8);
    *at += 8;
    put(at, PIR_SNAPSHOT_VERSION, 4);
    put(at, counts->numbers, 4);
    put(at, counts->bodies, 4);
    put(at, counts->users, 4);
    put(at, counts->contacts, 4);
    put(at, counts->ends, 4);
    *at += 8;
}

static void put_body(uint8_t **at, const pir_scene *scene, uint32_t number) {
    const pir_scene_body *body = &scene->bodies.body[number];
    const pir_quat q = body->pose.rotation;
    const pir_vec3 t = body->pose.translation;
    const double numbers[9] = {body->radius, body->fast, q.x, q.y, q.z, q.w, t.x, t.y, t.z};
    put(at, pir_body_id(&scene->bodies, number), 4);
    put(at, body->pieces, 4);
    put(at, body->kind, 1);
    put(at,
        (body->sensor ? PIR_SNAPSHOT_SENSOR : 0u) | (body->disabled ? PIR_SNAPSHOT_DISABLED : 0u) |
            (body->fresh ? PIR_SNAPSHOT_FRESH : 0u) | (has_users(scene, body) ? PIR_SNAPSHOT_USERS : 0u),
        3);
    put(at, body->category, 4);
    put(at, body->mask, 4);
    put(at, 0, 4);
    put(at, body->user, 8);
    put(at, body->shape, 8);
    for (int k = 0; k < 9; k++)
        put_double(at, numbers[k]);
}

static void put_bodies(uint8_t **at, const pir_scene *scene, uint32_t numbers) {
    const pir_bodies *bodies = &scene->bodies;
    for (uint32_t b = 0; b < numbers + numbers % 2; b++)
        put(at, b < numbers ? bodies->body[b].generation : 0, 4);
    for (uint32_t b = 0; b < bodies->body_end; b++)
        if (bodies->body[b].used)
            put_body(at, scene, b);
    for (uint32_t b = 0; b < bodies->body_end; b++)
        if (bodies->body[b].used && has_users(scene, &bodies->body[b]))
            for (uint32_t i = bodies->body[b].first; i != PIR_PIECE_NONE; i = bodies->piece[i].next)
                put(at, bodies->piece[i].user, 8);
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
        put(at, item->key.bodies, 8);
        put(at, item->key.pieces, 8);
        if (item->pair != PIR_END_NONE)
            continue;
        const pir_scene_gone *gone = &scene->gone[item->group];
        const uint64_t told[5] = {gone->user[0], gone->user[1], gone->piece_user[0], gone->piece_user[1], gone->sensor};
        for (int k = 0; k < 5; k++)
            put(at, told[k], 8);
    }
}

pir_status pir_scene_serialise(pir_scene *scene, void *memory, size_t size) {
    const pir_status status = pir_scene_given(scene, "snapshot", memory ? NULL : "memory");
    if (status != PIR_OK)
        return status;
    const pir_snapshot_counts counts = counts_of(scene);
    if (size != pir_snapshot_size(&counts))
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "snapshot: room for %zu bytes, not the %zu that it takes",
                        size, (size_t)pir_snapshot_size(&counts));
    pir_scene_lists *lists = &scene->lists;
    const uint32_t items = counts.contacts + counts.ends;
    if (!PIR_GROW(&scene->allocator, lists->item, lists->item_capacity, items) ||
        !PIR_GROW(&scene->allocator, lists->work, lists->work_capacity, items))
        return pir_fail(scene->report, PIR_ERR_MEMORY, "snapshot: no memory to sort %u contacts",
                        (unsigned)counts.contacts);
    sort_contacts(scene);
    uint8_t *at = memory;
    put_header(&at, &counts);
    put_bodies(&at, scene, counts.numbers);
    put_contacts(&at, scene, items);
    at = (uint8_t *)memory + PIR_SNAPSHOT_CHECKSUM_AT;
    put(&at, pir_snapshot_checksum(memory, size), 8);
    return PIR_OK;
}
