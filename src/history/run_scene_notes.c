/* SPDX-License-Identifier: MIT */
/* The calls of histories of scenes. */
#include "base/byte_block.h"
#include "history/history_file.h"
#include "history/replay_hash.h"
#include "history/run_notes.h"

pir_status pir_replay_scene(pir_replay *replay) {
    pir_history_reader *reader = &replay->reader;
    pir_scene_options options = pir_scene_options_default();
    options.allocator = &replay->allocator;
    options.detail = (pir_scene_detail)pir_history_take(reader, 1);
    const uint64_t told = pir_history_take(reader, 1);
    options.approach = (told & 1) != 0;
    options.unions = (told & 2) != 0;
    options.margin = pir_history_take_double(reader);
    if (told & 4)
        options.reuse = pir_history_take_double(reader);
    if (options.detail > PIR_SCENE_MANIFOLDS)
        reader->broken = true;
    return reader->broken ? PIR_ERR_FORMAT : pir_scene_create(&options, &replay->scene);
}

pir_status pir_replay_add(pir_replay *replay) {
    pir_history_reader *reader = &replay->reader;
    const pir_allocator *a = &replay->allocator;
    pir_body_options options = pir_body_options_default();
    uint32_t id = 0;
    options.kind = (pir_body_kind)pir_history_take(reader, 1);
    const uint64_t flags = pir_history_take(reader, 1);
    options.sensor = (flags & 1) != 0;
    options.disabled = (flags & 2) != 0;
    options.category = (uint32_t)pir_history_take(reader, 4);
    options.mask = (uint32_t)pir_history_take(reader, 4);
    options.radius = pir_history_take_double(reader);
    options.pose = pir_history_take_pose(reader);
    options.piece_count = (uint32_t)pir_history_take(reader, 4);
    if (options.kind > PIR_BODY_STATIC || options.piece_count > PIR_HISTORY_PIECES_MAX ||
        !pir_history_has(reader, (size_t)4 * options.piece_count)) {
        reader->broken = true;
        return PIR_ERR_FORMAT;
    }
    pir_polytope **pieces = PIR_NEW(a, pir_polytope *, options.piece_count);
    if (!pieces)
        return PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < options.piece_count; i++)
        pieces[i] = pir_replay_take_body(replay);
    options.pieces = pieces;
    pir_status status = reader->broken ? PIR_ERR_FORMAT : pir_scene_add(replay->scene, &options, &id);
    const uint8_t number[4] = {(uint8_t)id, (uint8_t)(id >> 8), (uint8_t)(id >> 16), (uint8_t)(id >> 24)};
    replay->hash = pir_hash_bytes(replay->hash, number, sizeof number);
    PIR_FREE(a, pieces, options.piece_count);
    return status;
}

pir_status pir_replay_remove(pir_replay *replay) {
    uint32_t body = (uint32_t)pir_history_take(&replay->reader, 4);
    return replay->reader.broken ? PIR_ERR_FORMAT : pir_scene_remove(replay->scene, body);
}

pir_status pir_replay_change(pir_replay *replay) {
    pir_history_reader *reader = &replay->reader;
    const uint32_t body = (uint32_t)pir_history_take(reader, 4), what = (uint32_t)pir_history_take(reader, 1),
                   value = (uint32_t)pir_history_take(reader, 4), other = (uint32_t)pir_history_take(reader, 4);
    if (what > PIR_CHANGE_DISABLED || (what != PIR_CHANGE_FILTER && (value > 1 || other != 0)))
        reader->broken = true;
    if (reader->broken)
        return PIR_ERR_FORMAT;
    return what == PIR_CHANGE_FILTER   ? pir_scene_set_filter(replay->scene, body, value, other)
           : what == PIR_CHANGE_SENSOR ? pir_scene_set_sensor(replay->scene, body, value == 1)
                                       : pir_scene_set_disabled(replay->scene, body, value == 1);
}

pir_status pir_replay_update(pir_replay *replay) {
    pir_history_reader *reader = &replay->reader;
    const pir_allocator *a = &replay->allocator;
    uint32_t count = (uint32_t)pir_history_take(reader, 4);
    if (count > PIR_HISTORY_MOVES_MAX || !pir_history_has(reader, (size_t)PIR_HISTORY_MOVE * count)) {
        reader->broken = true;
        return PIR_ERR_FORMAT;
    }
    pir_scene_move *moves = PIR_NEW(a, pir_scene_move, count);
    if (!moves)
        return PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        moves[i].body = (uint32_t)pir_history_take(reader, 4);
        moves[i].pose = pir_history_take_pose(reader);
    }
    pir_status status = pir_scene_update(replay->scene, moves, count);
    PIR_FREE(a, moves, count);
    if (status == PIR_OK)
        replay->hash = pir_replay_hash_events(replay->hash, replay->scene);
    return status;
}
