/* SPDX-License-Identifier: MIT */
/*
 * Running a history. Notes are read one after the other, and each is called as it is read.
 *
 * A breach of the file's form ends the run with PIR_ERR_FORMAT, and memory that runs out ends it with
 * PIR_ERR_MEMORY. Any other status is what the call came to when it was noted, too: a step that the visitor is told of.
 */
#include "history/run_notes.h"

#include <string.h>

#include <pirouette/io.h>

#include "base/byte_block.h"
#include "base/report.h"
#include "history/history_file.h"
#include "history/replay_hash.h"
#include "polytope/file/file_bytes.h"

/* --- bodies --- */

pir_polytope *pir_replay_take_body(pir_replay *replay) {
    uint32_t number = (uint32_t)pir_history_take(&replay->reader, 4);
    if (number >= replay->bodies)
        replay->reader.broken = true;
    return replay->reader.broken ? NULL : replay->body[number];
}

static pir_status take_body(pir_replay *replay) {
    pir_history_reader *reader = &replay->reader;
    const pir_allocator *a = &replay->allocator;
    size_t size = (size_t)pir_history_take(reader, 4);
    if (!pir_history_has(reader, size))
        return PIR_ERR_FORMAT;
    if (replay->bodies == replay->room) {
        uint32_t room = replay->room ? 2 * replay->room : 4;
        pir_polytope **grown = PIR_RESIZE(a, replay->body, replay->room, room);
        if (!grown)
            return PIR_ERR_MEMORY;
        replay->body = grown;
        replay->room = room;
    }
    pir_read_options options = pir_read_options_default();
    options.allocator = a;
    pir_status status =
        pir_polytope_read_bytes(&(pir_file_bytes){(const char *)reader->data + reader->at, size, "a body", "off"},
                                &options, NULL, NULL, &replay->body[replay->bodies]);
    reader->at += size;
    replay->bodies += status == PIR_OK;
    return status == PIR_OK || status == PIR_ERR_MEMORY ? status : PIR_ERR_FORMAT;
}

/* --- calls on sums and pairs --- */

/* After a call on the sum: the hash of what it holds. */
static pir_status hash_sum(pir_replay *replay, pir_status status) {
    if (status != PIR_OK)
        return status;
    uint32_t count = pir_sum_ee_count(replay->sum);
    uint32_t(*pairs)[2] = pir_memory_new(&replay->allocator, count, sizeof *pairs);
    if (!pairs)
        return PIR_ERR_MEMORY;
    replay->hash = pir_replay_hash_sum(replay->hash, replay->sum, pairs);
    PIR_FREE(&replay->allocator, pairs, count);
    return PIR_OK;
}

static pir_status call_sum(pir_replay *replay) {
    pir_history_reader *reader = &replay->reader;
    pir_polytope *p = pir_replay_take_body(replay), *q = pir_replay_take_body(replay);
    pir_sum_options options = pir_sum_options_default();
    options.allocator = &replay->allocator;
    options.difference = pir_history_take(reader, 1) != 0;
    pir_quat rotation = pir_history_take_quat(reader);
    if (reader->broken)
        return PIR_ERR_FORMAT;
    return hash_sum(replay, pir_sum_create(p, q, rotation, &options, &replay->sum));
}

static pir_status call_rotate(pir_replay *replay) {
    pir_history_reader *reader = &replay->reader;
    pir_quat rotation = pir_history_take_quat(reader);
    pir_method method = (pir_method)pir_history_take(reader, 1);
    return reader->broken ? PIR_ERR_FORMAT : hash_sum(replay, pir_sum_rotate(replay->sum, rotation, method));
}

static pir_status call_tolerance(pir_replay *replay) {
    double tolerance = pir_history_take_double(&replay->reader);
    return replay->reader.broken ? PIR_ERR_FORMAT : hash_sum(replay, pir_sum_set_tolerance(replay->sum, tolerance));
}

static pir_status call_region(pir_replay *replay) {
    pir_vec3 axis = pir_history_take_vec(&replay->reader);
    double half_angle = pir_history_take_double(&replay->reader);
    return replay->reader.broken ? PIR_ERR_FORMAT : hash_sum(replay, pir_sum_set_region(replay->sum, axis, half_angle));
}

/* An answer and its contacts, of which `count` were found. */
struct note_answer {
    pir_query_result answer;
    pir_contact contact[PIR_REPLAY_CONTACTS];
    size_t count;
};

/* The hash of what a query told; `status` says whether there are contacts. */
static pir_status hash_told(pir_replay *replay, pir_status status, const struct note_answer *told) {
    const size_t kept = told->count < PIR_REPLAY_CONTACTS ? told->count : PIR_REPLAY_CONTACTS;
    replay->hash = pir_replay_hash_answer(replay->hash, &told->answer);
    if (status == PIR_OK)
        replay->hash = pir_replay_hash_contacts(replay->hash, told->contact, kept);
    return status;
}

/* The lengths that the input of a query ends with. False where the note is broken. */
static bool take_lengths(pir_history_reader *reader, double *radius_p, double *radius_q, double *cutoff,
                         double *margin) {
    *radius_p = pir_history_take_double(reader);
    *radius_q = pir_history_take_double(reader);
    *cutoff = pir_history_take_double(reader);
    *margin = pir_history_take_double(reader);
    return !reader->broken;
}

static pir_status call_query(pir_replay *replay) {
    pir_history_reader *reader = &replay->reader;
    pir_query_input input = pir_query_input_default();
    struct note_answer told = {.count = 0};
    input.translation = pir_history_take_vec(reader);
    if (!take_lengths(reader, &input.radius_p, &input.radius_q, &input.cutoff, &input.margin))
        return PIR_ERR_FORMAT;
    pir_status status = replay->query ? PIR_OK : pir_query_create(replay->sum, &replay->query);
    if (status == PIR_OK)
        status = pir_query_signed_distance(replay->query, &input, &replay->cache, &told.answer);
    if (status != PIR_OK)
        return status;
    status = pir_query_manifold(replay->query, &input, &told.answer, PIR_REPLAY_CONTACTS, told.contact, &told.count);
    return hash_told(replay, status, &told);
}

static pir_status call_pair(pir_replay *replay) {
    pir_history_reader *reader = &replay->reader;
    pir_polytope *p = pir_replay_take_body(replay), *q = pir_replay_take_body(replay);
    pir_pair_options options = pir_pair_options_default();
    options.allocator = &replay->allocator;
    options.least = (pir_level)pir_history_take(reader, 1);
    options.most = (pir_level)pir_history_take(reader, 1);
    if (options.least > PIR_LEVEL_WHOLE || options.most > PIR_LEVEL_WHOLE)
        reader->broken = true;
    if (reader->broken)
        return PIR_ERR_FORMAT;
    pir_status status = pir_workspace_create(&replay->allocator, &replay->workspace);
    return status == PIR_OK ? pir_pair_create(p, q, &options, &replay->pair) : status;
}

static pir_status call_ask(pir_replay *replay) {
    pir_history_reader *reader = &replay->reader;
    pir_pair_input input = pir_pair_input_default();
    struct note_answer told = {.count = 0};
    input.pose_p = pir_history_take_pose(reader);
    input.pose_q = pir_history_take_pose(reader);
    if (!take_lengths(reader, &input.radius_p, &input.radius_q, &input.cutoff, &input.margin))
        return PIR_ERR_FORMAT;
    pir_status status = pir_pair_signed_distance(replay->pair, replay->workspace, &input, &told.answer);
    if (status != PIR_OK)
        return status;
    status = pir_pair_manifold(replay->pair, replay->workspace, &input, &told.answer, PIR_REPLAY_CONTACTS, told.contact,
                               &told.count);
    return hash_told(replay, status, &told);
}

/* --- all of it --- */

/* A note's name, its function, and the object that its history must be of; PIR_NOTE_NONE for first notes. */
static const struct note_call {
    const char *name;
    pir_status (*run)(pir_replay *replay);
    pir_note object;
} calls[PIR_NOTE_COUNT] = {
    [PIR_NOTE_SUM] = {"sum", call_sum, PIR_NOTE_NONE},
    [PIR_NOTE_ROTATE] = {"rotate", call_rotate, PIR_NOTE_SUM},
    [PIR_NOTE_TOLERANCE] = {"tolerance", call_tolerance, PIR_NOTE_SUM},
    [PIR_NOTE_REGION] = {"region", call_region, PIR_NOTE_SUM},
    [PIR_NOTE_QUERY] = {"query", call_query, PIR_NOTE_SUM},
    [PIR_NOTE_PAIR] = {"pair", call_pair, PIR_NOTE_NONE},
    [PIR_NOTE_ASK] = {"ask", call_ask, PIR_NOTE_PAIR},
    [PIR_NOTE_SCENE] = {"scene", pir_replay_scene, PIR_NOTE_NONE},
    [PIR_NOTE_ADD] = {"add", pir_replay_add, PIR_NOTE_SCENE},
    [PIR_NOTE_REMOVE] = {"remove", pir_replay_remove, PIR_NOTE_SCENE},
    [PIR_NOTE_UPDATE] = {"update", pir_replay_update, PIR_NOTE_SCENE},
    [PIR_NOTE_CHANGE] = {"change", pir_replay_change, PIR_NOTE_SCENE},
};

/* The object of the run so far: a first note that failed leaves none, and no other note may follow. */
static pir_note object_of(const pir_replay *replay) {
    return replay->sum ? PIR_NOTE_SUM : replay->pair ? PIR_NOTE_PAIR : replay->scene ? PIR_NOTE_SCENE : PIR_NOTE_NONE;
}

static pir_status fail_at(const pir_replay *replay, pir_status status, pir_report *report) {
    return pir_fail(report, status, "%s: byte %zu: %s", replay->name, replay->reader.at,
                    status == PIR_ERR_MEMORY ? "out of memory" : "not a note that may stand here");
}

static pir_status run_notes(pir_replay *replay, const pir_history_visitor *visitor, pir_report *report) {
    pir_history_reader *reader = &replay->reader;
    uint64_t index = 0;
    while (reader->at < reader->size) {
        pir_note kind = (pir_note)pir_history_take(reader, 1);
        if (kind == PIR_NOTE_BODY) {
            pir_status status = take_body(replay);
            if (status != PIR_OK)
                return fail_at(replay, status, report);
            continue;
        }
        if (kind >= PIR_NOTE_COUNT || !calls[kind].run || calls[kind].object != object_of(replay) ||
            (index > 0 && calls[kind].object == PIR_NOTE_NONE))
            return fail_at(replay, PIR_ERR_FORMAT, report);
        replay->hash = PIR_HASH_START;
        pir_status status = calls[kind].run(replay);
        if (reader->broken || status == PIR_ERR_MEMORY)
            return fail_at(replay, reader->broken ? PIR_ERR_FORMAT : status, report);
        const pir_history_step step = {index++, calls[kind].name, status, status == PIR_OK ? replay->hash : 0};
        if (visitor->step)
            visitor->step(visitor->context, &step);
    }
    return PIR_OK;
}

/* Magic, version, size and checksum. */
static pir_status check_header(const char *name, const uint8_t *data, size_t size, pir_report *report) {
    pir_history_reader reader = {data, size, 8, false};
    if (size < PIR_HISTORY_HEADER || memcmp(data, PIR_HISTORY_MAGIC, 8) != 0)
        return pir_fail(report, PIR_ERR_FORMAT, "%s: not a history, or cut", name);
    uint64_t version = pir_history_take(&reader, 4);
    if (version != PIR_HISTORY_VERSION && version != PIR_HISTORY_LAST)
        return pir_fail(report, PIR_ERR_VERSION, "%s: version %u, not %u or %u", name, (unsigned)version,
                        PIR_HISTORY_VERSION, PIR_HISTORY_LAST);
    bool zero = pir_history_take(&reader, 4) == 0, whole = pir_history_take(&reader, 8) == size;
    uint64_t checksum = pir_history_take(&reader, 8),
             right = pir_hash_bytes(PIR_HASH_START, data, PIR_HISTORY_CHECKSUM_AT);
    right = pir_hash_bytes(right, data + PIR_HISTORY_HEADER, size - PIR_HISTORY_HEADER);
    if (!zero || !whole || checksum != right)
        return pir_fail(report, PIR_ERR_FORMAT, "%s: cut, or changed since it was written", name);
    return PIR_OK;
}

static void finish(pir_replay *replay) {
    pir_query_destroy(replay->query);
    pir_sum_destroy(replay->sum);
    pir_pair_destroy(replay->pair);
    pir_workspace_destroy(replay->workspace);
    pir_scene_destroy(replay->scene);
    for (uint32_t i = 0; i < replay->bodies; i++)
        pir_polytope_release(replay->body[i]);
    PIR_FREE(&replay->allocator, replay->body, replay->room);
}

static pir_status replay_named(const char *name, const void *data, size_t size, const pir_history_visitor *visitor,
                               pir_report *report) {
    pir_status status = check_header(name, data, size, report);
    if (status != PIR_OK)
        return status;
    pir_replay replay = {
        .allocator = pir_allocator_or_default(visitor->allocator),
        .name = name,
        .reader = {data, size, PIR_HISTORY_HEADER, false},
    };
    status = run_notes(&replay, visitor, report);
    finish(&replay);
    return status;
}

pir_status pir_history_replay_bytes(const void *data, size_t size, const pir_history_visitor *visitor,
                                    pir_report *report) {
    if (!data || !visitor)
        return pir_fail(report, PIR_ERR_ARGUMENT, "history: no bytes, or nobody to tell");
    return replay_named("history", data, size, visitor, report);
}

pir_status pir_history_replay(const char *path, const pir_history_visitor *visitor, pir_report *report) {
    if (!path || !visitor)
        return pir_fail(report, PIR_ERR_ARGUMENT, "history: no path, or nobody to tell");
    pir_allocator a = pir_allocator_or_default(visitor->allocator);
    struct pir_read_bytes bytes = {0};
    pir_status status = pir_file_read(path, &a, report, &bytes);
    if (status == PIR_OK)
        status = replay_named(path, bytes.data ? bytes.data : "", bytes.size, visitor, report);
    PIR_FREE(&a, bytes.data, bytes.capacity);
    return status;
}
