/* SPDX-License-Identifier: MIT */
/**
 * Histories: what was asked of a sum, a pair or a scene, call by call, as a small file that `pirouette replay` runs.
 *
 * A program that sees something wrong notes its calls in a history, writes it, and whoever gets the file runs the same
 * calls with the same bits. A history holds bodies in exact coordinates, each once, and the arguments of the calls. It
 * calls nothing itself: a note beside a call takes O(size of its arguments), and a body O(its size) the first time.
 *
 * A history is of one object, which its first note makes. Later notes must be of that kind of object.
 *
 * Threads: a history belongs to one thread at a time.
 */
#ifndef PIROUETTE_HISTORY_H
#define PIROUETTE_HISTORY_H

#include <stdio.h>

#include <pirouette/base.h>
#include <pirouette/pair.h>
#include <pirouette/polytope.h>
#include <pirouette/query.h>
#include <pirouette/scene.h>
#include <pirouette/sum.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_history pir_history;

/* --- notes of calls --- */

/**
 * A history without notes.
 *
 * allocator  NULL for malloc; copied, its context must outlive the history.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_create(const pir_allocator *allocator, pir_history **ret_history);

/** Frees, and gives its references to bodies back; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_history_destroy(pir_history *history);

/**
 * Notes pir_sum_create, as the first note.
 *
 * p, q, rotation, difference  as they were given, the last in the options.
 *
 * Cost: O(size of the bodies).
 *
 * Errors: PIR_ERR_ARGUMENT (there is a note already), PIR_ERR_MEMORY; the history is then as it was. So with all notes.
 */
PIR_API pir_status pir_history_sum(pir_history *history, pir_polytope *p, pir_polytope *q, pir_quat rotation,
                                   bool difference);

/**
 * Notes pir_sum_rotate.
 *
 * rotation, method  as they were given.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT (not of a sum), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_rotate(pir_history *history, pir_quat rotation, pir_method method);

/**
 * Notes pir_sum_set_tolerance.
 *
 * tolerance  as it was given.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT (not of a sum), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_tolerance(pir_history *history, double tolerance);

/**
 * Notes pir_sum_set_region.
 *
 * axis, half_angle  as they were given.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT (not of a sum), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_region(pir_history *history, pir_vec3 axis, double half_angle);

/**
 * Notes pir_query_signed_distance and pir_query_manifold on the sum, with a cache that is kept.
 *
 * input  as it was given.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT (not of a sum), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_query(pir_history *history, const pir_query_input *input);

/**
 * Notes pir_pair_create, as the first note.
 *
 * p, q     as they were given.
 * options  NULL for the defaults; its levels count.
 *
 * Cost: O(size of the bodies).
 *
 * Errors: PIR_ERR_ARGUMENT (there is a note already), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_pair(pir_history *history, pir_polytope *p, pir_polytope *q,
                                    const pir_pair_options *options);

/**
 * Notes pir_pair_signed_distance and pir_pair_manifold.
 *
 * input  as it was given.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT (not of a pair), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_ask(pir_history *history, const pir_pair_input *input);

/**
 * Notes pir_scene_create, as the first note.
 *
 * options  NULL for the defaults; its detail, margin, approach, unions and reuse count, `meets` does not.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT (there is a note already), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_scene(pir_history *history, const pir_scene_options *options);

/**
 * Notes pir_scene_add.
 *
 * body  as it was given; its coarse bodies and users, on which no event depends but that it tells these, are left out.
 *
 * Cost: O(size of its pieces).
 *
 * Errors: PIR_ERR_ARGUMENT (not of a scene; more than 4096 pieces; a surface), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_add(pir_history *history, const pir_body_options *body);

/**
 * Notes pir_scene_remove.
 *
 * body  the id of the body.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT (not of a scene), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_remove(pir_history *history, uint32_t body);

/**
 * Notes pir_scene_set_filter.
 *
 * body, category, mask  as they were given.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT (not of a scene), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_filter(pir_history *history, uint32_t body, uint32_t category, uint32_t mask);

/**
 * Notes pir_scene_set_sensor.
 *
 * body, sensor  as they were given.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT (not of a scene), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_sensor(pir_history *history, uint32_t body, bool sensor);

/**
 * Notes pir_scene_set_disabled.
 *
 * body, disabled  as they were given.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT (not of a scene), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_disabled(pir_history *history, uint32_t body, bool disabled);

/**
 * Notes pir_scene_update.
 *
 * moves, count  as they were given.
 *
 * Cost: O(count).
 *
 * Errors: PIR_ERR_ARGUMENT (not of a scene, more than 2^20 moves), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_update(pir_history *history, const pir_scene_move *moves, size_t count);

/**
 * Writes the file to a stream, from its position on. The stream stays open; notes may go on. Bytes are the same on
 * every machine.
 *
 * file    a stream open for writing.
 * report  NULL, or filled when the call fails.
 *
 * Cost: O(size of the history).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_FILE.
 */
PIR_API pir_status pir_history_write(const pir_history *history, FILE *file, pir_report *report);

/* --- running them again --- */

/** The outcome of one call of a history that is run again. */
typedef struct pir_history_step {
    uint64_t index;    /**< from 0 */
    const char *call;  /**< "sum", "rotate", "ask", …: as the notes are called */
    pir_status status; /**< of the call that was noted */
    uint64_t hash;     /**< of all that it gave, the same on every machine; 0 where it failed */
} pir_history_step;

/** Who is told. */
typedef struct pir_history_visitor {
    const pir_allocator *allocator; /**< of all that is made; NULL for malloc */
    void *context;
    /** Called for each step in order; may be NULL. */
    void (*step)(void *context, const pir_history_step *step);
} pir_history_visitor;

/**
 * Runs a history. The bytes are not trusted: they have a version and a checksum, bodies are made anew as exact hulls,
 * and calls are checked as any other. A call that is refused is a step with a status, and those after it are run.
 *
 * data, size  the bytes, which may come from anyone.
 * visitor     borrowed for the call.
 * report      NULL, or filled with what, where and why.
 *
 * Cost: that of the calls.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_FORMAT, PIR_ERR_VERSION, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_history_replay_bytes(const void *data, size_t size, const pir_history_visitor *visitor,
                                            pir_report *report);

/**
 * Runs the history in a file again.
 *
 * path             of the file.
 * visitor, report  as of pir_history_replay_bytes.
 *
 * Cost: as of pir_history_replay_bytes.
 *
 * Errors: as of pir_history_replay_bytes, and PIR_ERR_FILE, PIR_ERR_LIMIT (above 2 GiB).
 */
PIR_API pir_status pir_history_replay(const char *path, const pir_history_visitor *visitor, pir_report *report);

#ifdef __cplusplus
}
#endif

#endif
