/* SPDX-License-Identifier: MIT */
/* A scene from bytes, which are not trusted: see snapshot.h. */
#include <pirouette/scene_file.h>

#include <string.h>

#include "base/report.h"
#include "scene/answer/candidates.h"
#include "scene/answer/motion.h"
#include "scene/change/changes.h"
#include "scene/file/kept_bytes.h"
#include "scene/file/target_bodies.h"

static pir_status read_header(const uint8_t *data, size_t size, pir_snapshot *s) {
    if (size < PIR_SNAPSHOT_HEADER || memcmp(data, PIR_SNAPSHOT_MAGIC, 8) != 0)
        return pir_fail(s->report, PIR_ERR_FORMAT, "snapshot: no snapshot of a scene");
    const uint8_t *at = data + 8;
    const uint32_t version = (uint32_t)pir_snapshot_take(&at, 4);
    if (version != PIR_SNAPSHOT_VERSION && version != PIR_SNAPSHOT_LAST)
        return pir_fail(s->report, PIR_ERR_VERSION, "snapshot: version %u, not %u or %u", (unsigned)version,
                        PIR_SNAPSHOT_VERSION, PIR_SNAPSHOT_LAST);
    uint32_t *const count[5] = {&s->counts.numbers, &s->counts.bodies, &s->counts.users, &s->counts.contacts,
                                &s->counts.ends};
    for (int k = 0; k < 5; k++)
        *count[k] = (uint32_t)pir_snapshot_take(&at, 4);
    const uint64_t least = pir_snapshot_size(&s->counts);
    if (size < least || (version == PIR_SNAPSHOT_VERSION && size != least))
        return pir_fail(s->report, PIR_ERR_FORMAT, "snapshot: %zu bytes are not those of %u bodies and %u contacts",
                        size, (unsigned)s->counts.bodies, (unsigned)s->counts.contacts);
    if (pir_snapshot_take(&at, 8) != pir_snapshot_checksum(data, size))
        return pir_fail(s->report, PIR_ERR_FORMAT, "snapshot: the checksum does not hold");
    s->generation = at;
    s->body = s->generation + (size_t)4 * (s->counts.numbers + s->counts.numbers % 2);
    s->user = s->body + (size_t)s->counts.bodies * PIR_SNAPSHOT_BODY;
    s->contact = s->user + (size_t)8 * s->counts.users;
    s->end = s->contact + (size_t)s->counts.contacts * PIR_SNAPSHOT_CONTACT;
    s->kept = version == PIR_SNAPSHOT_LAST ? data + least : NULL;
    s->behind = data + size;
    return PIR_OK;
}

/* Brings bodies that stay or came to their poses. */
static pir_status move(pir_scene *scene, const pir_snapshot *s) {
    pir_report why;
    const pir_status status = pir_scene_make_boxes(scene, "snapshot", &why);
    if (status == PIR_OK) {
        pir_scene_move_bodies(scene);
        return PIR_OK;
    }
    // a pose that no body can have was never written
    return pir_fail(s->report, status == PIR_ERR_MEMORY ? status : PIR_ERR_FORMAT, "%s", why.text);
}

/* --- contacts --- */

/* A piece of a body by id, or PIR_PIECE_NONE. */
static uint32_t piece_of(const pir_scene *scene, uint32_t id, uint32_t number) {
    const uint32_t body = pir_bodies_find(&scene->bodies, id);
    return body == PIR_SCENE_NONE ? PIR_PIECE_NONE : pir_bodies_piece(&scene->bodies, body, number);
}

/* The pair of a key, or PIR_END_NONE. */
static uint32_t pair_of(const pir_scene *scene, pir_scene_key key) {
    const uint32_t p = piece_of(scene, pir_key_body(key, 0), (uint32_t)(key.pieces >> 32)),
                   q = piece_of(scene, pir_key_body(key, 1), (uint32_t)key.pieces);
    if (p == PIR_PIECE_NONE || q == PIR_PIECE_NONE)
        return PIR_END_NONE;
    if (!pir_bodies_meet(&scene->bodies, scene->bodies.piece[p].body, scene->bodies.piece[q].body))
        return PIR_END_NONE;
    // the list of a triangle is the shorter one
    const bool from_q = scene->bodies.piece[q].kind == PIR_PIECE_TRIANGLE;
    for (uint32_t end = scene->bodies.piece[from_q ? q : p].first; end != PIR_END_NONE;
         end = scene->pairs.at[end / 2].next[end % 2]) {
        const uint32_t *piece = scene->pairs.at[end / 2].piece;
        if (piece[0] == p && piece[1] == q)
            return end / 2;
    }
    return PIR_END_NONE;
}

static pir_scene_key take_key(const uint8_t **at) {
    pir_scene_key key;
    key.bodies = pir_snapshot_take(at, 8);
    key.pieces = pir_snapshot_take(at, 8);
    return key;
}

/* Whether keys rise. */
static bool comes_after(pir_scene_key key, pir_scene_key before) {
    return key.bodies != before.bodies ? key.bodies > before.bodies : key.pieces > before.pieces;
}

/* The pairs of all contacts, in scene->lists.asked. */
static pir_status read_contacts(pir_scene *scene, const pir_snapshot *s) {
    const uint8_t *at = s->contact;
    pir_scene_key before = {0, 0};
    for (uint32_t i = 0; i < s->counts.contacts; i++) {
        const pir_scene_key key = take_key(&at);
        const uint32_t pair = i > 0 && !comes_after(key, before) ? PIR_END_NONE : pair_of(scene, key);
        if (pair == PIR_END_NONE)
            return pir_fail(s->report, PIR_ERR_FORMAT, "snapshot: contact %u is of pieces that are apart or not there",
                            (unsigned)i);
        scene->lists.asked[i] = pair;
        before = key;
    }
    at = s->end;
    for (uint32_t i = 0; i < s->counts.ends; i++) {
        const pir_scene_key key = take_key(&at);
        at += 32;
        if (pir_snapshot_take(&at, 8) > 1 || (i > 0 && !comes_after(key, before)))
            return pir_fail(s->report, PIR_ERR_FORMAT, "snapshot: end %u of a contact is out of order", (unsigned)i);
        before = key;
    }
    return PIR_OK;
}

/* Records of all contacts, in a list. */
static pir_status read_kept(pir_scene *scene, const pir_snapshot *s, pir_kept_record **ret_first) {
    pir_kept_reader reader = {.at = s->kept, .end = s->behind, .last = ret_first, .keeps = scene->reuse > 0};
    pir_status status = PIR_OK;
    uint32_t i = 0;
    for (; s->kept && i < s->counts.contacts && status == PIR_OK; i++)
        status = pir_take_kept(scene, &reader, i, &scene->pairs.at[scene->lists.asked[i]]);
    if (s->kept && status == PIR_OK && reader.at != reader.end)
        status = PIR_ERR_FORMAT;
    if (status == PIR_ERR_FORMAT)
        return pir_fail(s->report, status, "snapshot: what contact %u keeps cannot be", (unsigned)(i > 0 ? i - 1 : 0));
    return status == PIR_OK ? status : pir_fail(s->report, status, "snapshot: no memory for what contacts keep");
}

/* Gives a list of records back. */
static void give_back(pir_scene *scene, pir_kept_record *record) {
    while (record) {
        pir_kept_record *next = record->next;
        pir_kept_pool_give(&scene->pairs.kept, record);
        record = next;
    }
}

/* Puts a list of records in place of those of pairs. */
static void put_kept(pir_scene *scene, const pir_snapshot *s, pir_kept_record *record) {
    for (uint32_t i = 0; i < scene->pairs.capacity; i++)
        pir_scene_pairs_forget(&scene->pairs, i);
    while (record) {
        pir_kept_record *next = record->next;
        pir_scene_pair *pair = &scene->pairs.at[scene->lists.asked[record->label]];
        *(record->union_number > 0 ? &pair->united : &pair->kept) = record;
        record = next;
    }
    scene->unions_asked += s->counts.contacts;
}

static void read_ends(pir_scene *scene, const pir_snapshot *s) {
    const uint8_t *at = s->end;
    for (uint32_t i = 0; i < s->counts.ends; i++) {
        pir_scene_gone *gone = &scene->gone[i];
        gone->key = take_key(&at);
        for (int k = 0; k < 4; k++)
            *(k < 2 ? &gone->user[k] : &gone->piece_user[k - 2]) = pir_snapshot_take(&at, 8);
        gone->sensor = pir_snapshot_take(&at, 8) != 0;
    }
    scene->gone_count = s->counts.ends;
}

/* --- the call --- */

/* All that cannot fail. */
static void commit(pir_scene *scene, const pir_snapshot *s, pir_kept_record *kept) {
    put_kept(scene, s, kept);
    for (uint32_t i = 0; i < scene->pairs.capacity; i++)
        scene->pairs.at[i].touching = false;
    for (uint32_t i = 0; i < s->counts.contacts; i++)
        scene->pairs.at[scene->lists.asked[i]].touching = true;
    scene->touching = s->counts.contacts;
    pir_target_commit(scene, s);
    pir_scene_drop_pairs(scene);
    read_ends(scene, s);
}

pir_status pir_scene_restore(pir_scene *scene, const void *data, size_t size, pir_report *report) {
    pir_snapshot s = {.report = report || !scene ? report : scene->report};
    if (!scene || !data)
        return pir_fail(s.report, PIR_ERR_ARGUMENT, "snapshot: %s is NULL", scene ? "data" : "scene");
    scene->update++;
    scene->event_count = scene->impact_count = scene->looked = 0;
    scene->lists.moved_count = scene->lists.replaced_count = 0;
    scene->lists.asked_count = scene->lists.ended_count = 0;
    pir_status status = read_header(data, size, &s);
    if (status != PIR_OK)
        return status;
    status = pir_target_apply(scene, &s);
    if (status == PIR_OK)
        status = move(scene, &s);
    if (status != PIR_OK) {
        pir_target_undo(scene);
        return status;
    }
    status = pir_scene_find_pairs(scene);
    if (status != PIR_OK)
        pir_fail(s.report, status, "snapshot: no memory for pairs");
    else
        status = read_contacts(scene, &s);
    pir_kept_record *kept = NULL;
    if (status == PIR_OK)
        status = read_kept(scene, &s, &kept);
    if (status != PIR_OK) {
        give_back(scene, kept);
        pir_scene_move_back(scene);
        pir_target_undo(scene);
        return status;
    }
    commit(scene, &s, kept);
    return PIR_OK;
}
