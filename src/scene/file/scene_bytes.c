/* SPDX-License-Identifier: MIT */
/*
 * Scenes in bytes, little endian:
 *
 *     "PIRSCENE"; u32 version, bodies, contacts, 0; u64 checksum of all bytes but its own (FNV-1a)
 *     per body, by number:       u32 number, pieces, kind, fresh; f64 quaternion[4], translation[3];
 *                                u64 hash of its surface, 0 for none
 *     per contact, by its key:   u64 of bodies, of pieces
 *
 * A key holds the numbers of both bodies and both pieces (scene/world/scene.h).
 */
#include <pirouette/scene_file.h>

#include <string.h>

#include "base/report.h"
#include "scene/answer/candidates.h"
#include "scene/answer/events.h"
#include "scene/answer/motion.h"
#include "scene/world/grow.h"
#include "scene/world/triangles.h"

#define VERSION      2u
#define HEADER_SIZE  32
#define CHECKSUM_AT  24
#define BODY_SIZE    80
#define CONTACT_SIZE 16

static const char magic[8] = {'P', 'I', 'R', 'S', 'C', 'E', 'N', 'E'};

static void put(uint8_t **at, uint64_t value, int bytes) {
    for (int k = 0; k < bytes; k++)
        *(*at)++ = (uint8_t)(value >> (8 * k));
}

static void put_double(uint8_t **at, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(at, bits, 8);
}

static uint64_t take(const uint8_t **at, int bytes) {
    uint64_t value = 0;
    for (int k = 0; k < bytes; k++)
        value |= (uint64_t) * (*at)++ << (8 * k);
    return value;
}

static double take_double(const uint8_t **at) {
    uint64_t bits = take(at, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint64_t checksum(const uint8_t *data, size_t size) {
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < size; i++)
        if (i < CHECKSUM_AT || i >= HEADER_SIZE)
            hash = (hash ^ data[i]) * UINT64_C(0x100000001b3);
    return hash;
}

/* --- to bytes --- */

static uint32_t count_contacts(const pir_scene *scene) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->pairs.capacity; i++)
        count += scene->pairs.at[i].touching;
    return count;
}

size_t pir_scene_serialised_size(const pir_scene *scene) {
    return HEADER_SIZE + (size_t)scene->bodies.body_count * BODY_SIZE + (size_t)count_contacts(scene) * CONTACT_SIZE;
}

static void put_body(uint8_t **at, const pir_scene_body *body, uint32_t number) {
    pir_quat q = body->pose.rotation;
    pir_vec3 t = body->pose.translation;
    const double numbers[7] = {q.x, q.y, q.z, q.w, t.x, t.y, t.z};
    put(at, number, 4);
    put(at, body->pieces, 4);
    put(at, body->kind, 4);
    put(at, body->fresh, 4);
    for (int k = 0; k < 7; k++)
        put_double(at, numbers[k]);
    put(at, body->surface.hash, 8);
}

/* The contacts in order, in scene->lists.item. */
static void sort_contacts(pir_scene *scene) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->pairs.capacity; i++)
        if (scene->pairs.at[i].touching)
            scene->lists.item[count++] = (pir_scene_item){.key = pir_scene_key_of(scene, i), .pair = i};
    if (count > 1)
        pir_scene_sort_items(scene->lists.item, scene->lists.work, count);
}

pir_status pir_scene_serialise(pir_scene *scene, void *memory, size_t size) {
    const pir_status status = pir_scene_given(scene, "snapshot", memory ? NULL : "memory");
    if (status != PIR_OK)
        return status;
    if (size != pir_scene_serialised_size(scene))
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "snapshot: room for %zu bytes, not the %zu that it takes",
                        size, pir_scene_serialised_size(scene));
    pir_scene_lists *lists = &scene->lists;
    uint32_t contacts = count_contacts(scene);
    if (!PIR_GROW(&scene->allocator, lists->item, lists->item_capacity, contacts) ||
        !PIR_GROW(&scene->allocator, lists->work, lists->work_capacity, contacts))
        return pir_fail(scene->report, PIR_ERR_MEMORY, "snapshot: no memory to sort %u contacts", contacts);
    sort_contacts(scene);
    uint8_t *at = memory;
    memcpy(at, magic, sizeof magic);
    at += sizeof magic;
    put(&at, VERSION, 4);
    put(&at, scene->bodies.body_count, 4);
    put(&at, contacts, 4);
    put(&at, 0, 4);
    at += 8;
    for (uint32_t b = 0; b < scene->bodies.body_end; b++)
        if (scene->bodies.body[b].used)
            put_body(&at, &scene->bodies.body[b], b);
    for (uint32_t i = 0; i < contacts; i++) {
        put(&at, lists->item[i].key.bodies, 8);
        put(&at, lists->item[i].key.pieces, 8);
    }
    at = (uint8_t *)memory + CHECKSUM_AT;
    put(&at, checksum(memory, size), 8);
    return PIR_OK;
}

/* --- from bytes --- */

struct snapshot {
    const uint8_t *body, *contact;
    uint32_t bodies, contacts;
    pir_report *report;
};

static pir_status read_header(const uint8_t *data, size_t size, struct snapshot *s) {
    if (size < HEADER_SIZE || memcmp(data, magic, sizeof magic) != 0)
        return pir_fail(s->report, PIR_ERR_FORMAT, "snapshot: no snapshot of a scene");
    const uint8_t *at = data + sizeof magic;
    uint32_t version = (uint32_t)take(&at, 4);
    if (version != VERSION)
        return pir_fail(s->report, PIR_ERR_VERSION, "snapshot: version %u, not %u", version, VERSION);
    s->bodies = (uint32_t)take(&at, 4);
    s->contacts = (uint32_t)take(&at, 4);
    if (take(&at, 4) != 0 ||
        size - HEADER_SIZE != (uint64_t)s->bodies * BODY_SIZE + (uint64_t)s->contacts * CONTACT_SIZE)
        return pir_fail(s->report, PIR_ERR_FORMAT, "snapshot: %zu bytes are not those of %u bodies and %u contacts",
                        size, s->bodies, s->contacts);
    if (take(&at, 8) != checksum(data, size))
        return pir_fail(s->report, PIR_ERR_FORMAT, "snapshot: the checksum does not hold");
    s->body = data + HEADER_SIZE;
    s->contact = s->body + (size_t)s->bodies * BODY_SIZE;
    return PIR_OK;
}

/* The place of one body, in order; `least` is the least number that it may have. */
static pir_status read_body(pir_scene *scene, const struct snapshot *s, const uint8_t **at, uint32_t least) {
    uint32_t number = (uint32_t)take(at, 4), pieces = (uint32_t)take(at, 4), kind = (uint32_t)take(at, 4);
    uint64_t fresh = take(at, 4);
    pir_pose pose;
    pose.rotation.x = take_double(at);
    pose.rotation.y = take_double(at);
    pose.rotation.z = take_double(at);
    pose.rotation.w = take_double(at);
    pose.translation.x = take_double(at);
    pose.translation.y = take_double(at);
    pose.translation.z = take_double(at);
    const uint64_t hash = take(at, 8);
    if (fresh > 1 || number < least)
        return pir_fail(s->report, PIR_ERR_FORMAT, "snapshot: body %u is out of order, or neither fresh nor not",
                        number);
    const pir_scene_body *body = pir_bodies_has(&scene->bodies, number) ? &scene->bodies.body[number] : NULL;
    if (!body || body->pieces != pieces || body->kind != kind)
        return pir_fail(s->report, PIR_ERR_ARGUMENT, "snapshot: the scene has no such body %u", number);
    if (body->surface.hash != hash)
        return pir_fail(s->report, PIR_ERR_ARGUMENT, "snapshot: body %u has another surface in the scene", number);
    scene->lists.moved[scene->lists.moved_count++] = (pir_scene_moved){.body = number, .pose = pose};
    return PIR_OK;
}

static pir_status read_bodies(pir_scene *scene, const struct snapshot *s) {
    pir_scene_lists *lists = &scene->lists;
    const uint8_t *at = s->body;
    uint32_t least = 0;
    if (s->bodies != scene->bodies.body_count)
        return pir_fail(s->report, PIR_ERR_ARGUMENT, "snapshot: %u bodies, and the scene has %u", s->bodies,
                        scene->bodies.body_count);
    if (!PIR_GROW(&scene->allocator, lists->moved, lists->moved_capacity, s->bodies) ||
        !PIR_GROW(&scene->allocator, scene->fresh, scene->fresh_capacity, s->bodies) ||
        !PIR_GROW(&scene->allocator, lists->asked, lists->asked_capacity, s->contacts))
        return pir_fail(s->report, PIR_ERR_MEMORY, "snapshot: no memory for %u bodies", s->bodies);
    for (uint32_t i = 0; i < s->bodies; i++) {
        pir_status status = read_body(scene, s, &at, least);
        if (status != PIR_OK)
            return status;
        least = lists->moved[i].body + 1;
    }
    pir_report why;
    pir_status status = pir_scene_make_boxes(scene, "snapshot", &why);
    if (status == PIR_OK)
        return PIR_OK;
    // a pose that no body can have was never written
    return pir_fail(s->report, status == PIR_ERR_MEMORY ? status : PIR_ERR_FORMAT, "%s", why.text);
}

/* The piece of a body with a number, or PIR_PIECE_NONE. */
static uint32_t piece_of(const pir_scene *scene, uint32_t body, uint32_t number) {
    if (!pir_bodies_has(&scene->bodies, body))
        return PIR_PIECE_NONE;
    if (pir_body_has_surface(&scene->bodies.body[body]))
        return pir_triangles_find(&scene->bodies, body, number);
    uint32_t piece = scene->bodies.body[body].first;
    while (piece != PIR_PIECE_NONE && scene->bodies.piece[piece].number != number)
        piece = scene->bodies.piece[piece].next;
    return piece;
}

/* The pair of a key, or PIR_END_NONE. */
static uint32_t pair_of(const pir_scene *scene, pir_scene_key key) {
    const uint32_t piece = piece_of(scene, (uint32_t)(key.bodies >> 32), (uint32_t)(key.pieces >> 32));
    for (uint32_t end = piece == PIR_PIECE_NONE ? PIR_END_NONE : scene->bodies.piece[piece].first; end != PIR_END_NONE;
         end = scene->pairs.at[end / 2].next[end % 2]) {
        const pir_scene_key at = pir_scene_key_of(scene, end / 2);
        if (at.bodies == key.bodies && at.pieces == key.pieces)
            return end / 2;
    }
    return PIR_END_NONE;
}

/* The pairs of all contacts, in scene->lists.asked. */
static pir_status read_contacts(pir_scene *scene, const struct snapshot *s) {
    const uint8_t *at = s->contact;
    for (uint32_t i = 0; i < s->contacts; i++) {
        pir_scene_key key = {0, 0};
        key.bodies = take(&at, 8);
        key.pieces = take(&at, 8);
        uint32_t pair = pair_of(scene, key);
        if (pair == PIR_END_NONE)
            return pir_fail(s->report, PIR_ERR_FORMAT, "snapshot: contact %u is of pieces that are apart or not there",
                            i);
        scene->lists.asked[i] = pair;
    }
    return PIR_OK;
}

/* Sets the pairs in contact and the fresh bodies, which cannot fail. */
static void commit(pir_scene *scene, const struct snapshot *s) {
    for (uint32_t i = 0; i < scene->pairs.capacity; i++)
        scene->pairs.at[i].touching = false;
    for (uint32_t i = 0; i < s->contacts; i++)
        scene->pairs.at[scene->lists.asked[i]].touching = true;
    pir_scene_drop_pairs(scene);
    scene->fresh_count = 0;
    for (uint32_t i = 0; i < s->bodies; i++) {
        uint32_t number = scene->lists.moved[i].body;
        bool fresh = s->body[(size_t)i * BODY_SIZE + 12] != 0;
        scene->bodies.body[number].fresh = fresh;
        if (fresh)
            scene->fresh[scene->fresh_count++] = number;
    }
}

pir_status pir_scene_restore(pir_scene *scene, const void *data, size_t size, pir_report *report) {
    struct snapshot s = {.report = report || !scene ? report : scene->report};
    if (!scene || !data)
        return pir_fail(s.report, PIR_ERR_ARGUMENT, "snapshot: %s is NULL", scene ? "data" : "scene");
    scene->update++;
    scene->event_count = scene->looked = 0;
    scene->lists.moved_count = scene->lists.replaced_count = 0;
    scene->lists.asked_count = scene->lists.ended_count = 0;
    pir_status status = read_header(data, size, &s);
    if (status == PIR_OK)
        status = read_bodies(scene, &s);
    if (status != PIR_OK)
        return status;
    pir_scene_move_bodies(scene);
    status = pir_scene_find_pairs(scene);
    if (status != PIR_OK)
        pir_fail(s.report, status, "snapshot: no memory for pairs");
    else
        status = read_contacts(scene, &s);
    if (status != PIR_OK)
        pir_scene_move_back(scene);
    else
        commit(scene, &s);
    return status;
}
