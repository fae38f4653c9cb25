/* SPDX-License-Identifier: MIT */
/*
 * Notes of calls, in the bytes of the file as they stand there.
 *
 * Invariants: bytes.used ends behind a whole note. `piece` holds the bodies in the order of their numbers. A note that
 * fails leaves both as they were.
 */
#include <pirouette/history.h>

#include <string.h>

#include "base/byte_block.h"
#include "base/options.h"
#include "base/report.h"
#include "history/history_file.h"
#include "polytope/write/off_text.h"

struct pir_history {
    pir_allocator allocator;
    pir_bytes bytes; /* the header, not yet filled, and the notes */
    pir_note object; /* the first note: what the history is of; PIR_NOTE_NONE before it */
    pir_polytope **piece;
    uint32_t pieces, room; /* references held; what `piece` has room for */
    bool reuses;           /* of a scene that does: only later versions know of it */
};

/* Bytes of any note but its pieces and moves. */
#define NOTE_MOST 256

pir_status pir_history_create(const pir_allocator *allocator, pir_history **ret_history) {
    if (!ret_history)
        return PIR_ERR_ARGUMENT;
    pir_allocator a = pir_allocator_or_default(allocator);
    pir_history *history = PIR_ZEROED(&a, pir_history, 1);
    if (!history || !pir_bytes_reserve(&history->bytes, &a, PIR_HISTORY_HEADER)) {
        PIR_FREE(&a, history, 1);
        return PIR_ERR_MEMORY;
    }
    history->allocator = a;
    memset(history->bytes.data, 0, PIR_HISTORY_HEADER);
    history->bytes.used = PIR_HISTORY_HEADER;
    *ret_history = history;
    return PIR_OK;
}

void pir_history_destroy(pir_history *history) {
    if (!history)
        return;
    pir_allocator a = history->allocator;
    for (uint32_t i = 0; i < history->pieces; i++)
        pir_polytope_release(history->piece[i]);
    PIR_FREE(&a, history->piece, history->room);
    pir_bytes_finish(&history->bytes, &a);
    PIR_FREE(&a, history, 1);
}

/* --- numbers, where there is room --- */

static void put(pir_history *history, uint64_t value, int bytes) {
    for (int k = 0; k < bytes; k++)
        history->bytes.data[history->bytes.used++] = (uint8_t)(value >> (8 * k));
}

static void put_double(pir_history *history, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(history, bits, 8);
}

static void put_vec(pir_history *history, pir_vec3 v) {
    put_double(history, v.x);
    put_double(history, v.y);
    put_double(history, v.z);
}

static void put_quat(pir_history *history, pir_quat q) {
    put_vec(history, (pir_vec3){q.x, q.y, q.z});
    put_double(history, q.w);
}

static void put_pose(pir_history *history, pir_pose pose) {
    put_quat(history, pose.rotation);
    put_vec(history, pose.translation);
}

/* --- bodies --- */

/* The number of a body that is known, or how many are. */
static uint32_t number_of(const pir_history *history, const pir_polytope *polytope) {
    uint32_t i = 0;
    while (i < history->pieces && history->piece[i] != polytope)
        i++;
    return i;
}

/* Gives a body a number, and notes it, where it has none yet. */
static pir_status add_body(pir_history *history, pir_polytope *polytope) {
    const pir_allocator *a = &history->allocator;
    if (!polytope)
        return PIR_ERR_ARGUMENT;
    if (number_of(history, polytope) < history->pieces)
        return PIR_OK;
    if (history->pieces == history->room) {
        uint32_t room = history->room ? 2 * history->room : 4;
        pir_polytope **grown = PIR_RESIZE(a, history->piece, history->room, room);
        if (!grown)
            return PIR_ERR_MEMORY;
        history->piece = grown;
        history->room = room;
    }
    pir_bytes text = {0};
    pir_status status = pir_off_text(polytope, a, &text);
    if (status == PIR_OK && text.used > UINT32_MAX)
        status = PIR_ERR_LIMIT;
    if (status == PIR_OK && !pir_bytes_reserve(&history->bytes, a, text.used + NOTE_MOST))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        put(history, PIR_NOTE_BODY, 1);
        put(history, text.used, 4);
        memcpy(history->bytes.data + history->bytes.used, text.data, text.used);
        history->bytes.used += text.used;
        history->piece[history->pieces++] = pir_polytope_retain(polytope);
    }
    pir_bytes_finish(&text, a);
    return status;
}

/* --- notes --- */

/*
 * Begins a note with its kind, where it may stand: makes room for NOTE_MOST bytes and `more`. `object` is what the
 * history has to be of; PIR_NOTE_NONE for the first note.
 */
static pir_status begin(pir_history *history, pir_note kind, pir_note object, size_t more) {
    if (!history || history->object != object)
        return PIR_ERR_ARGUMENT;
    if (!pir_bytes_reserve(&history->bytes, &history->allocator, NOTE_MOST + more))
        return PIR_ERR_MEMORY;
    if (object == PIR_NOTE_NONE)
        history->object = kind;
    put(history, kind, 1);
    return PIR_OK;
}

/* The first note, of two bodies. */
static pir_status begin_bodies(pir_history *history, pir_note kind, pir_polytope *p, pir_polytope *q) {
    if (!history || history->object != PIR_NOTE_NONE || !p || !q)
        return PIR_ERR_ARGUMENT;
    pir_status status = add_body(history, p);
    if (status == PIR_OK)
        status = add_body(history, q);
    if (status == PIR_OK)
        status = begin(history, kind, PIR_NOTE_NONE, 0);
    if (status != PIR_OK)
        return status;
    put(history, number_of(history, p), 4);
    put(history, number_of(history, q), 4);
    return PIR_OK;
}

pir_status pir_history_sum(pir_history *history, pir_polytope *p, pir_polytope *q, pir_quat rotation, bool difference) {
    pir_status status = begin_bodies(history, PIR_NOTE_SUM, p, q);
    if (status != PIR_OK)
        return status;
    put(history, difference != 0, 1);
    put_quat(history, rotation);
    return PIR_OK;
}

pir_status pir_history_rotate(pir_history *history, pir_quat rotation, pir_method method) {
    pir_status status = begin(history, PIR_NOTE_ROTATE, PIR_NOTE_SUM, 0);
    if (status != PIR_OK)
        return status;
    put_quat(history, rotation);
    put(history, (uint64_t)method, 1);
    return PIR_OK;
}

pir_status pir_history_tolerance(pir_history *history, double tolerance) {
    pir_status status = begin(history, PIR_NOTE_TOLERANCE, PIR_NOTE_SUM, 0);
    if (status == PIR_OK)
        put_double(history, tolerance);
    return status;
}

pir_status pir_history_region(pir_history *history, pir_vec3 axis, double half_angle) {
    pir_status status = begin(history, PIR_NOTE_REGION, PIR_NOTE_SUM, 0);
    if (status != PIR_OK)
        return status;
    put_vec(history, axis);
    put_double(history, half_angle);
    return PIR_OK;
}

static void put_bounds(pir_history *history, double radius_p, double radius_q, double cutoff, double margin) {
    put_double(history, radius_p);
    put_double(history, radius_q);
    put_double(history, cutoff);
    put_double(history, margin);
}

pir_status pir_history_query(pir_history *history, const pir_query_input *input) {
    pir_status status = input ? begin(history, PIR_NOTE_QUERY, PIR_NOTE_SUM, 0) : PIR_ERR_ARGUMENT;
    if (status != PIR_OK)
        return status;
    put_vec(history, input->translation);
    put_bounds(history, input->radius_p, input->radius_q, input->cutoff, input->margin);
    return PIR_OK;
}

pir_status pir_history_pair(pir_history *history, pir_polytope *p, pir_polytope *q, const pir_pair_options *options) {
    pir_pair_options used = pir_pair_options_default();
    pir_status status = pir_options_take("pir_pair_options", options, &used, NULL);
    if (status == PIR_OK)
        status = begin_bodies(history, PIR_NOTE_PAIR, p, q);
    if (status != PIR_OK)
        return status;
    put(history, (uint64_t)used.least, 1);
    put(history, (uint64_t)used.most, 1);
    return PIR_OK;
}

pir_status pir_history_ask(pir_history *history, const pir_pair_input *input) {
    pir_status status = input ? begin(history, PIR_NOTE_ASK, PIR_NOTE_PAIR, 0) : PIR_ERR_ARGUMENT;
    if (status != PIR_OK)
        return status;
    put_pose(history, input->pose_p);
    put_pose(history, input->pose_q);
    put_bounds(history, input->radius_p, input->radius_q, input->cutoff, input->margin);
    return PIR_OK;
}

pir_status pir_history_scene(pir_history *history, const pir_scene_options *options) {
    pir_scene_options used = pir_scene_options_default();
    pir_status status = pir_options_take("pir_scene_options", options, &used, &used.report);
    if (status == PIR_OK)
        status = begin(history, PIR_NOTE_SCENE, PIR_NOTE_NONE, 0);
    if (status != PIR_OK)
        return status;
    put(history, (uint64_t)used.detail, 1);
    put(history, (used.approach ? 1u : 0u) | (used.unions ? 2u : 0u) | (used.reuse > 0 ? 4u : 0u), 1);
    put_double(history, used.margin);
    history->reuses = used.reuse > 0;
    if (history->reuses)
        put_double(history, used.reuse);
    return PIR_OK;
}

/* The note of a body of pieces. */
static pir_status add(pir_history *history, const pir_body_options *body) {
    if (body->piece_count > PIR_HISTORY_PIECES_MAX || body->mesh || body->field)
        return PIR_ERR_ARGUMENT;
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i < body->piece_count && status == PIR_OK; i++)
        status = add_body(history, body->pieces[i]);
    if (status == PIR_OK)
        status = begin(history, PIR_NOTE_ADD, PIR_NOTE_SCENE, (size_t)4 * body->piece_count);
    if (status != PIR_OK)
        return status;
    put(history, (uint64_t)body->kind, 1);
    put(history, (body->sensor ? 1u : 0u) | (body->disabled ? 2u : 0u), 1);
    put(history, body->category, 4);
    put(history, body->mask, 4);
    put_double(history, body->radius);
    put_pose(history, body->pose);
    put(history, body->piece_count, 4);
    for (uint32_t i = 0; i < body->piece_count; i++)
        put(history, number_of(history, body->pieces[i]), 4);
    return PIR_OK;
}

pir_status pir_history_add(pir_history *history, const pir_body_options *body) {
    if (!history || history->object != PIR_NOTE_SCENE || !body)
        return PIR_ERR_ARGUMENT;
    pir_body_options used = pir_body_options_default();
    const pir_status status = pir_options_take("pir_body_options", body, &used, NULL);
    return status == PIR_OK ? add(history, &used) : status;
}

pir_status pir_history_remove(pir_history *history, uint32_t body) {
    pir_status status = begin(history, PIR_NOTE_REMOVE, PIR_NOTE_SCENE, 0);
    if (status == PIR_OK)
        put(history, body, 4);
    return status;
}

static pir_status note_change(pir_history *history, uint32_t body, pir_note_change what, uint32_t value,
                              uint32_t other) {
    const pir_status status = begin(history, PIR_NOTE_CHANGE, PIR_NOTE_SCENE, 0);
    if (status != PIR_OK)
        return status;
    put(history, body, 4);
    put(history, (uint64_t)what, 1);
    put(history, value, 4);
    put(history, other, 4);
    return PIR_OK;
}

pir_status pir_history_filter(pir_history *history, uint32_t body, uint32_t category, uint32_t mask) {
    return note_change(history, body, PIR_CHANGE_FILTER, category, mask);
}

pir_status pir_history_sensor(pir_history *history, uint32_t body, bool sensor) {
    return note_change(history, body, PIR_CHANGE_SENSOR, sensor, 0);
}

pir_status pir_history_disabled(pir_history *history, uint32_t body, bool disabled) {
    return note_change(history, body, PIR_CHANGE_DISABLED, disabled, 0);
}

pir_status pir_history_update(pir_history *history, const pir_scene_move *moves, size_t count) {
    if ((!moves && count > 0) || count > PIR_HISTORY_MOVES_MAX)
        return PIR_ERR_ARGUMENT;
    pir_status status = begin(history, PIR_NOTE_UPDATE, PIR_NOTE_SCENE, count * PIR_HISTORY_MOVE);
    if (status != PIR_OK)
        return status;
    put(history, count, 4);
    for (size_t i = 0; i < count; i++) {
        put(history, moves[i].body, 4);
        put_pose(history, moves[i].pose);
    }
    return PIR_OK;
}

/* --- the file --- */

pir_status pir_history_write(const pir_history *history, FILE *file, pir_report *report) {
    if (!history || !file)
        return pir_fail(report, PIR_ERR_ARGUMENT, "history: no history, or no file");
    uint8_t header[PIR_HISTORY_HEADER] = PIR_HISTORY_MAGIC;
    const uint8_t *notes = history->bytes.data + PIR_HISTORY_HEADER;
    size_t size = history->bytes.used - PIR_HISTORY_HEADER;
    header[8] = history->reuses ? PIR_HISTORY_LAST : PIR_HISTORY_VERSION;
    for (int k = 0; k < 8; k++)
        header[PIR_HISTORY_SIZE_AT + k] = (uint8_t)((uint64_t)history->bytes.used >> (8 * k));
    uint64_t checksum = pir_hash_bytes(PIR_HASH_START, header, PIR_HISTORY_CHECKSUM_AT);
    checksum = pir_hash_bytes(checksum, notes, size);
    for (int k = 0; k < 8; k++)
        header[PIR_HISTORY_CHECKSUM_AT + k] = (uint8_t)(checksum >> (8 * k));
    if (fwrite(header, 1, sizeof header, file) != sizeof header || fwrite(notes, 1, size, file) != size ||
        fflush(file) != 0)
        return pir_fail(report, PIR_ERR_FILE, "history: cannot write: %s", pir_status_text(PIR_ERR_FILE));
    return PIR_OK;
}
