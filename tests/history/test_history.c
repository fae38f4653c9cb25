/* SPDX-License-Identifier: MIT */
/*
 * Histories: what is run again gives the bits of the first run; a file that is cut or changed anywhere is refused;
 * memory that runs out changes nothing.
 */
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#include <pirouette/history.h>

#include "base/byte_block.h"
#include "history/replay_hash.h"
#include "support/bodies.h"
#include "support/memory.h"

#define STEPS_MAX 256

/* What a run told. */
struct told {
    uint64_t count, refused, hash[STEPS_MAX];
    const char *call[STEPS_MAX];
};

static void tell(void *context, const pir_history_step *step) {
    struct told *told = context;
    assert_int_equal(step->index, told->count);
    assert_true(told->count < STEPS_MAX);
    told->refused += step->status != PIR_OK;
    told->call[told->count] = step->call;
    told->hash[told->count++] = step->hash;
}

struct bytes {
    uint8_t *data;
    size_t size;
};

/* The file of a history, to be freed. */
static struct bytes written(const pir_history *history) {
    struct bytes bytes = {NULL, 0};
    FILE *file = tmpfile();
    assert_non_null(file);
    assert_int_equal(pir_history_write(history, file, NULL), PIR_OK);
    long size = ftell(file);
    assert_true(size > 0);
    bytes.size = (size_t)size;
    bytes.data = malloc(bytes.size);
    assert_non_null(bytes.data);
    rewind(file);
    assert_int_equal(fread(bytes.data, 1, bytes.size, file), bytes.size);
    fclose(file);
    return bytes;
}

static struct told run_again(const struct bytes *bytes) {
    struct told told = {0};
    const pir_history_visitor visitor = {NULL, &told, tell};
    pir_report report = {PIR_OK, ""};
    pir_status status = pir_history_replay_bytes(bytes->data, bytes->size, &visitor, &report);
    expect(status == PIR_OK, "%s", report.text);
    return told;
}

/* --- what is noted beside the calls --- */

/* A sum that turns, with a tolerance, a region and questions; what each gave, as a replay hashes it. */
static void note_sum(pir_history *history, struct told *right) {
    test_random random = test_random_case("history of a sum", 0);
    pir_polytope *p = test_sphere(&random, 20), *q = test_random_polytope(&random, TEST_GRID, 20);
    pir_sum_options options = pir_sum_options_default();
    pir_sum *sum;
    pir_query *query;
    pir_query_cache cache = {0};
    pir_quat r = {1, 2, 3, 4};
    uint32_t pairs[4096][2];
    options.difference = true;
    assert_int_equal(pir_sum_create(p, q, r, &options, &sum), PIR_OK);
    assert_int_equal(pir_query_create(sum, &query), PIR_OK);
    assert_int_equal(pir_history_sum(history, p, q, r, 1), PIR_OK);
    right->hash[right->count++] = pir_replay_hash_sum(PIR_HASH_START, sum, pairs);
    for (int step = 0; step < 12; step++) {
        pir_status set = PIR_OK, noted = PIR_OK;
        r = test_compose((pir_quat){0.01, 0.02, -0.03, 1}, r, 1);
        if (step == 4) {
            set = pir_sum_set_tolerance(sum, 0.25);
            noted = pir_history_tolerance(history, 0.25);
        } else if (step == 8) {
            set = pir_sum_set_region(sum, (pir_vec3){0, 0, 1}, 1);
            noted = pir_history_region(history, (pir_vec3){0, 0, 1}, 1);
        } else {
            set = pir_sum_rotate(sum, r, PIR_METHOD_UPDATE);
            noted = pir_history_rotate(history, r, PIR_METHOD_UPDATE);
        }
        assert_true(set == PIR_OK && noted == PIR_OK);
        assert_true(pir_sum_ee_count(sum) <= 4096);
        right->hash[right->count++] = pir_replay_hash_sum(PIR_HASH_START, sum, pairs);
        pir_query_input input = pir_query_input_default();
        pir_query_result answer = {0};
        pir_contact contacts[64];
        size_t count = 0;
        input.translation = test_random_direction(&random);
        uint64_t hash = 0;
        if (pir_query_signed_distance(query, &input, &cache, &answer) == PIR_OK) {
            hash = pir_replay_hash_answer(PIR_HASH_START, &answer);
            pir_status status = pir_query_manifold(query, &input, &answer, 64, contacts, &count);
            hash = status == PIR_OK ? pir_replay_hash_contacts(hash, contacts, count) : 0;
        }
        assert_int_equal(pir_history_query(history, &input), PIR_OK);
        right->hash[right->count++] = hash;
    }
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void note_pair(pir_history *history, struct told *right) {
    test_random random = test_random_case("history of a pair", 0);
    pir_polytope *p = test_sphere(&random, 20), *q = test_random_polytope(&random, TEST_BOX, 8);
    pir_pair *pair;
    pir_workspace *workspace;
    pir_pair_input input = pir_pair_input_default();
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, q, NULL, &pair), PIR_OK);
    assert_int_equal(pir_history_pair(history, p, q, NULL), PIR_OK);
    right->hash[right->count++] = PIR_HASH_START;
    for (int step = 0; step < 20; step++) {
        pir_query_result answer = {0};
        pir_contact contacts[64];
        size_t count = 0;
        pir_vec3 d = test_random_direction(&random);
        input.pose_p.rotation = test_general_rotation(&random);
        input.pose_p.translation = (pir_vec3){2 * d.x, 2 * d.y, 2 * d.z};
        input.margin = 0.5;
        assert_int_equal(pir_pair_signed_distance(pair, workspace, &input, &answer), PIR_OK);
        assert_int_equal(pir_pair_manifold(pair, workspace, &input, &answer, 64, contacts, &count), PIR_OK);
        uint64_t hash = pir_replay_hash_answer(PIR_HASH_START, &answer);
        right->hash[right->count++] = pir_replay_hash_contacts(hash, contacts, count);
        assert_int_equal(pir_history_ask(history, &input), PIR_OK);
    }
    // what is refused is a step with a status
    input.pose_p.rotation = (pir_quat){0, 0, 0, 0};
    assert_int_equal(pir_history_ask(history, &input), PIR_OK);
    right->hash[right->count++] = 0;
    right->refused++;
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

#define BODIES 6

static uint64_t hash_of_id(uint32_t id) {
    const uint8_t bytes[4] = {(uint8_t)id, 0, 0, 0};
    return pir_hash_bytes(PIR_HASH_START, bytes, 4);
}

static void note_scene(pir_history *history, struct told *right) {
    test_random random = test_random_case("history of a scene", 0);
    pir_scene_options options = pir_scene_options_default();
    pir_polytope *piece[2] = {test_sphere(&random, 12), test_random_polytope(&random, TEST_OCTAHEDRON, 6)};
    pir_scene_move moves[BODIES];
    pir_scene *scene;
    options.margin = 0.125;
    options.unions = true;
    options.reuse = 0.25;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
    assert_int_equal(pir_history_scene(history, &options), PIR_OK);
    right->hash[right->count++] = PIR_HASH_START;
    for (uint32_t i = 0; i < BODIES; i++) {
        pir_body_options body = pir_body_options_default();
        body.pieces = i % 2 ? piece : piece + 1;
        body.piece_count = i % 2 ? 2 : 1;
        body.pose.translation = test_random_direction(&random);
        assert_int_equal(pir_scene_add(scene, &body, &moves[i].body), PIR_OK);
        assert_int_equal(pir_history_add(history, &body), PIR_OK);
        right->hash[right->count++] = hash_of_id(moves[i].body);
        moves[i].pose = body.pose;
    }
    for (int step = 0; step < 8; step++) {
        for (uint32_t i = 0; i < BODIES; i++) {
            pir_vec3 velocity = test_random_direction(&random), spin = test_random_direction(&random);
            moves[i].pose = pir_pose_integrate(moves[i].pose, velocity, spin, 0.25);
        }
        size_t count = step < 6 ? BODIES : BODIES - 1;
        if (step == 6) {
            assert_int_equal(pir_scene_remove(scene, moves[BODIES - 1].body), PIR_OK);
            assert_int_equal(pir_history_remove(history, moves[BODIES - 1].body), PIR_OK);
            right->hash[right->count++] = PIR_HASH_START;
        }
        if (step == 2 || step == 5) {
            const bool on = step == 2;
            assert_int_equal(pir_scene_set_disabled(scene, moves[1].body, on), PIR_OK);
            assert_int_equal(pir_history_disabled(history, moves[1].body, on), PIR_OK);
            assert_int_equal(pir_scene_set_sensor(scene, moves[0].body, on), PIR_OK);
            assert_int_equal(pir_history_sensor(history, moves[0].body, on), PIR_OK);
            assert_int_equal(pir_scene_set_filter(scene, moves[2].body, 1, on ? 2 : UINT32_MAX), PIR_OK);
            assert_int_equal(pir_history_filter(history, moves[2].body, 1, on ? 2 : UINT32_MAX), PIR_OK);
            for (int k = 0; k < 3; k++)
                right->hash[right->count++] = PIR_HASH_START;
        }
        assert_int_equal(pir_scene_update(scene, moves, count), PIR_OK);
        assert_int_equal(pir_history_update(history, moves, count), PIR_OK);
        right->hash[right->count++] = pir_replay_hash_events(PIR_HASH_START, scene);
    }
    pir_scene_destroy(scene);
    pir_polytope_release(piece[1]);
    pir_polytope_release(piece[0]);
}

static void (*const notes[3])(pir_history *history, struct told *right) = {note_sum, note_pair, note_scene};

static struct bytes history_of(int which, struct told *right) {
    pir_history *history;
    assert_int_equal(pir_history_create(NULL, &history), PIR_OK);
    notes[which](history, right);
    struct bytes bytes = written(history), again = written(history);
    assert_int_equal(bytes.size, again.size);
    assert_memory_equal(bytes.data, again.data, bytes.size);
    free(again.data);
    pir_history_destroy(history);
    return bytes;
}

/* --- tests --- */

static void what_is_run_again_has_the_same_bits(void **state) {
    (void)state;
    for (int which = 0; which < 3; which++) {
        struct told right = {0};
        struct bytes bytes = history_of(which, &right);
        struct told told = run_again(&bytes);
        expect(told.count == right.count, "history %d: %llu steps", which, (unsigned long long)told.count);
        for (uint64_t i = 0; i < told.count; i++)
            expect(told.hash[i] == right.hash[i], "history %d, step %d, %s", which, (int)i, told.call[i]);
        expect(which != 1 || told.refused == right.refused, "history %d: refused", which);
        free(bytes.data);
    }
}

static void what_is_cut_or_changed_is_refused(void **state) {
    (void)state;
    for (int which = 0; which < 3; which++) {
        struct told right = {0}, told = {0};
        struct bytes bytes = history_of(which, &right);
        const pir_history_visitor visitor = {NULL, &told, tell};
        for (size_t size = 0; size < bytes.size; size++)
            expect(pir_history_replay_bytes(bytes.data, size, &visitor, NULL) == PIR_ERR_FORMAT, "cut at %zu", size);
        for (size_t at = 0; at < bytes.size; at++) {
            bytes.data[at] ^= (uint8_t)(1u << at % 8);
            pir_status status = pir_history_replay_bytes(bytes.data, bytes.size, &visitor, NULL);
            // versions 2 and 3 are read
            const bool other = at >= 8 && at < 12 && !(at == 8 && (bytes.data[8] | 1) == 3);
            bytes.data[at] ^= (uint8_t)(1u << at % 8);
            expect(status == (other ? PIR_ERR_VERSION : PIR_ERR_FORMAT), "byte %zu changed", at);
        }
        assert_int_equal(told.count, 0);
        free(bytes.data);
    }
}

/* Sets size and checksum right, so that what was changed is found by what reads it. */
static void seal(struct bytes *bytes) {
    for (int k = 0; k < 8; k++)
        bytes->data[16 + k] = (uint8_t)((uint64_t)bytes->size >> (8 * k));
    uint64_t checksum =
        pir_hash_bytes(pir_hash_bytes(PIR_HASH_START, bytes->data, 24), bytes->data + 32, bytes->size - 32);
    for (int k = 0; k < 8; k++)
        bytes->data[24 + k] = (uint8_t)(checksum >> (8 * k));
}

static void what_lies_with_a_right_checksum_does_no_harm(void **state) {
    (void)state;
    for (int which = 0; which < 3; which++) {
        struct told right = {0};
        struct bytes bytes = history_of(which, &right);
        const pir_history_visitor visitor = {NULL, NULL, NULL};
        uint32_t refused = 0;
        for (size_t at = 32; at < bytes.size; at += 7) {
            struct bytes changed = {malloc(bytes.size), bytes.size};
            assert_non_null(changed.data);
            memcpy(changed.data, bytes.data, bytes.size);
            changed.data[at] ^= (uint8_t)(1u << at % 8);
            changed.size = at % 3 ? bytes.size : at;
            seal(&changed);
            pir_status status = pir_history_replay_bytes(changed.data, changed.size, &visitor, NULL);
            assert_true(status == PIR_OK || status == PIR_ERR_FORMAT);
            refused += status != PIR_OK;
            free(changed.data);
        }
        assert_true(refused > 0);
        free(bytes.data);
    }
}

/*
 * A file that ends between two notes is a history; one that ends within a note is none, though what stood behind it is
 * still in memory.
 */
static void files_end_between_notes(void **state) {
    (void)state;
    enum { UPDATES = 3 };
    const pir_history_visitor visitor = {NULL, NULL, NULL};
    test_random random = test_random_case("ends of notes", 0);
    pir_polytope *p = test_sphere(&random, 8);
    pir_body_options body = pir_body_options_default();
    pir_history *history;
    body.pieces = &p;
    body.piece_count = 1;
    assert_int_equal(pir_history_create(NULL, &history), PIR_OK);
    assert_int_equal(pir_history_scene(history, NULL), PIR_OK);
    assert_int_equal(pir_history_add(history, &body), PIR_OK);
    for (int i = 0; i < UPDATES; i++) {
        const pir_scene_move move = {0, {{0, 0, 0, 1}, {i, 0, 0}}};
        assert_int_equal(pir_history_update(history, &move, 1), PIR_OK);
    }
    assert_int_equal(pir_history_remove(history, 0), PIR_OK);
    struct bytes bytes = written(history);
    int whole = 0;
    for (size_t size = 33; size <= bytes.size; size++) {
        struct bytes cut = {malloc(bytes.size), size};
        assert_non_null(cut.data);
        memcpy(cut.data, bytes.data, bytes.size);
        seal(&cut);
        pir_status status = pir_history_replay_bytes(cut.data, cut.size, &visitor, NULL);
        expect(status == PIR_OK || status == PIR_ERR_FORMAT, "cut at %zu: status %d", size, (int)status);
        whole += status == PIR_OK;
        free(cut.data);
    }
    // the scene, the polytope, the body, the updates, the removal
    assert_int_equal(whole, 3 + UPDATES + 1);
    free(bytes.data);
    pir_history_destroy(history);
    pir_polytope_release(p);
}

/* Counts beyond what the file holds, or the format allows, are refused before memory is taken for them. */
static void counts_that_lie_are_refused_at_once(void **state) {
    (void)state;
    static const uint32_t counts[] = {2, 0xffff, (1u << 20) + 1, 0x7fffffff, UINT32_MAX};
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    const pir_history_visitor visitor = {&allocator, NULL, NULL};
    const pir_scene_move move = {0, {{0, 0, 0, 1}, {0, 0, 0}}};
    test_random random = test_random_case("counts that lie", 0);
    pir_polytope *p = test_sphere(&random, 8);
    pir_body_options body = pir_body_options_default();
    pir_history *history;
    body.pieces = &p;
    body.piece_count = 1;
    assert_int_equal(pir_history_create(NULL, &history), PIR_OK);
    assert_int_equal(pir_history_scene(history, NULL), PIR_OK);
    assert_int_equal(pir_history_add(history, &body), PIR_OK);
    struct bytes added = written(history);
    assert_int_equal(pir_history_update(history, &move, 1), PIR_OK);
    struct bytes bytes = written(history);
    assert_int_equal(pir_history_replay_bytes(bytes.data, bytes.size, &visitor, NULL), PIR_OK);
    // the update's count stands behind its kind; the body's count of pieces before its last number
    const size_t places[] = {added.size + 1, added.size - 8};
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
            uint8_t before[4];
            memcpy(before, bytes.data + places[k], 4);
            for (int b = 0; b < 4; b++)
                bytes.data[places[k] + (size_t)b] = (uint8_t)(counts[i] >> (8 * b));
            seal(&bytes);
            memory.peak = 0;
            pir_status status = pir_history_replay_bytes(bytes.data, bytes.size, &visitor, NULL);
            expect(status == PIR_ERR_FORMAT, "place %d, count %u: status %d", k, counts[i], (int)status);
            expect(memory.blocks == 0 && memory.peak < 1000000, "place %d, count %u: %zu bytes", k, counts[i],
                   memory.peak);
            memcpy(bytes.data + places[k], before, 4);
        }
    free(added.data);
    free(bytes.data);
    pir_history_destroy(history);
    pir_polytope_release(p);
}

static void run_short_of_memory(int kind) {
    struct told right = {0};
    struct bytes bytes = history_of(kind, &right);
    for (uint64_t fail_at = 1;; fail_at += 1 + fail_at / 16) {
        test_memory memory = {.fail_at = fail_at};
        pir_allocator allocator = test_allocator(&memory);
        struct told told = {0};
        const pir_history_visitor visitor = {&allocator, &told, tell};
        pir_status status = pir_history_replay_bytes(bytes.data, bytes.size, &visitor, NULL);
        bool reached = memory.requests >= fail_at;
        // what a call can do without changes nothing
        expect(status == PIR_ERR_MEMORY || status == PIR_OK, "kind %d, request %d", kind, (int)fail_at);
        expect(reached || status == PIR_OK, "kind %d, request %d", kind, (int)fail_at);
        for (uint64_t i = 0; i < told.count; i++)
            expect(told.hash[i] == right.hash[i], "kind %d, request %d, step %d", kind, (int)fail_at, (int)i);
        expect(memory.blocks == 0 && memory.bytes == 0, "kind %d, request %d: %zu blocks left", kind, (int)fail_at,
               memory.blocks);
        if (!reached)
            break;
    }
    free(bytes.data);
}

static void memory_that_runs_out_changes_nothing(void **state) {
    (void)state;
    for (int kind = 0; kind < 3; kind++)
        run_short_of_memory(kind);
}

/* Notes of a pair with memory that fails at a request: whether all were made. */
static bool note_with(test_memory *memory, pir_polytope *p, pir_polytope *q) {
    pir_allocator allocator = test_allocator(memory);
    pir_history *history = NULL;
    if (pir_history_create(&allocator, &history) != PIR_OK)
        return false;
    pir_pair_input input = pir_pair_input_default();
    pir_status status = pir_history_pair(history, p, q, NULL);
    for (int i = 0; i < 20 && status == PIR_OK; i++)
        status = pir_history_ask(history, &input);
    assert_true(status == PIR_OK || status == PIR_ERR_MEMORY);
    // what is there can be written
    struct bytes bytes = written(history);
    bool whole = status == PIR_OK;
    run_again(&bytes);
    free(bytes.data);
    pir_history_destroy(history);
    return whole;
}

static void notes_without_memory_leave_whole_ones(void **state) {
    (void)state;
    test_random random = test_random_case("history without memory", 0);
    pir_polytope *p = test_sphere(&random, 20), *q = test_sphere(&random, 20);
    for (uint64_t fail_at = 1;; fail_at++) {
        test_memory memory = {.fail_at = fail_at};
        bool whole = note_with(&memory, p, q);
        expect(memory.blocks == 0 && memory.bytes == 0, "request %d: %zu blocks left", (int)fail_at, memory.blocks);
        if (whole)
            break;
    }
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void notes_of_another_kind_are_refused(void **state) {
    (void)state;
    test_random random = test_random_case("history of another kind", 0);
    pir_polytope *p = test_sphere(&random, 8);
    pir_history *history;
    const pir_quat r = {0, 0, 0, 1};
    pir_query_input query = pir_query_input_default();
    pir_pair_input input = pir_pair_input_default();
    pir_body_options body = pir_body_options_default();
    assert_int_equal(pir_history_create(NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_create(NULL, &history), PIR_OK);
    assert_int_equal(pir_history_rotate(history, r, PIR_METHOD_AUTO), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_sum(history, p, NULL, r, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_sum(history, p, p, r, 0), PIR_OK);
    assert_int_equal(pir_history_sum(history, p, p, r, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_pair(history, p, p, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_scene(history, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_ask(history, &input), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_add(history, &body), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_remove(history, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_update(history, NULL, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_query(history, NULL), PIR_ERR_ARGUMENT);
    // a sum without a difference takes no queries: that is for the replay to tell
    assert_int_equal(pir_history_query(history, &query), PIR_OK);
    struct bytes bytes = written(history);
    struct told told = run_again(&bytes);
    assert_true(told.count == 2 && told.refused == 1);
    assert_int_equal(pir_history_write(history, NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_replay_bytes(bytes.data, bytes.size, NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_replay("/nowhere/at/all", &(pir_history_visitor){0}, NULL), PIR_ERR_FILE);
    free(bytes.data);
    pir_history_destroy(history);
    pir_history_destroy(NULL);
    pir_polytope_release(p);
}

/* A call that is refused leaves no body behind, in whatever way it is wrong. */
static void refused_notes_leave_no_bytes(void **state) {
    (void)state;
    test_random random = test_random_case("history of refused notes", 0);
    pir_polytope *p = test_sphere(&random, 8), *other = test_sphere(&random, 8), *pieces[] = {p, NULL};
    const pir_quat r = {0, 0, 0, 1};
    pir_query_input query = pir_query_input_default();
    pir_pair_input input = pir_pair_input_default();
    pir_body_options body = pir_body_options_default();
    pir_history *history;
    assert_int_equal(pir_history_sum(NULL, p, p, r, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_pair(NULL, p, p, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_scene(NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_rotate(NULL, r, PIR_METHOD_AUTO), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_tolerance(NULL, 1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_region(NULL, (pir_vec3){1, 0, 0}, 1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_query(NULL, &query), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_ask(NULL, &input), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_add(NULL, &body), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_remove(NULL, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_update(NULL, NULL, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_write(NULL, stdout, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_create(NULL, &history), PIR_OK);
    struct bytes empty = written(history);
    assert_int_equal(pir_history_sum(history, NULL, p, r, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_sum(history, p, NULL, r, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_ask(history, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_update(history, NULL, 1), PIR_ERR_ARGUMENT);
    struct bytes still = written(history);
    assert_true(still.size == empty.size && memcmp(still.data, empty.data, empty.size) == 0);
    assert_int_equal(pir_history_scene(history, NULL), PIR_OK);
    struct bytes begun = written(history);
    assert_int_equal(pir_history_sum(history, other, other, r, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_pair(history, other, other, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_history_add(history, NULL), PIR_ERR_ARGUMENT);
    struct bytes same = written(history);
    assert_true(same.size == begun.size && memcmp(same.data, begun.data, begun.size) == 0);
    body.pieces = pieces;
    body.piece_count = 2;
    assert_int_equal(pir_history_add(history, &body), PIR_ERR_ARGUMENT);
    struct bytes *all[] = {&empty, &still, &begun, &same};
    for (int i = 0; i < 4; i++)
        free(all[i]->data);
    pir_history_destroy(history);
    pir_polytope_release(other);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_run_again_has_the_same_bits),
        cmocka_unit_test(what_is_cut_or_changed_is_refused),
        cmocka_unit_test(what_lies_with_a_right_checksum_does_no_harm),
        cmocka_unit_test(files_end_between_notes),
        cmocka_unit_test(counts_that_lie_are_refused_at_once),
        cmocka_unit_test(memory_that_runs_out_changes_nothing),
        cmocka_unit_test(notes_without_memory_leave_whole_ones),
        cmocka_unit_test(notes_of_another_kind_are_refused),
        cmocka_unit_test(refused_notes_leave_no_bytes),
    };
    return cmocka_run_group_tests_name("histories of calls", tests, NULL, NULL);
}
