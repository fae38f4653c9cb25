/* SPDX-License-Identifier: MIT */
/*
 * Snapshots: after a restore at any frame the events are those that followed it the first time, bit for bit, with 1, 2
 * and 4 threads; bytes depend on the state alone; what is refused, and changes nothing; memory that fails.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/scene_file.h>

#include "scene/crowd.h"
#include "support/memory.h"
#include "support/meshes.h"

#define FRAMES 16

struct bytes {
    unsigned char *data;
    size_t size;
};

static struct bytes snapshot(pir_scene *scene) {
    struct bytes bytes = {NULL, pir_scene_serialised_size(scene)};
    bytes.data = malloc(bytes.size);
    assert_non_null(bytes.data);
    assert_int_equal(pir_scene_serialise(scene, bytes.data, bytes.size), PIR_OK);
    return bytes;
}

static bool same_bytes(const struct bytes *a, const struct bytes *b) {
    return a->size == b->size && memcmp(a->data, b->data, a->size) == 0;
}

/* A crowd's motion, kept, so that it can be run again from any frame. */
struct film {
    pir_scene_move move[FRAMES][CROWD_BODIES];
    size_t moves[FRAMES];
    uint64_t hash[FRAMES];
    struct bytes before[FRAMES];
};

static uint64_t step(crowd *c, const struct film *film, int frame) {
    assert_int_equal(pir_scene_update(c->scene, film->move[frame], film->moves[frame]), PIR_OK);
    return crowd_hash_events(TEST_HASH_START, c->scene);
}

static void a_restored_scene_goes_on_as_it_did(void **state) {
    (void)state;
    static crowd c, other;
    static struct film film;
    for (uint64_t n = 0; n < 12; n++) {
        unsigned long long number = n;
        pir_scene_options options = pir_scene_options_default();
        options.margin = n % 2 ? 0.125 : 0;
        options.approach = true;
        static const uint32_t threads[3] = {1, 2, 4};
        options.threads = threads[n % 3];
        crowd_init(&c, 2000 + n, 12 + 3 * (uint32_t)n, &options);
        // the same bodies, in a scene with a life and with threads of its own
        options.threads = threads[(n + 1) % 3];
        crowd_init(&other, 2000 + n, 12 + 3 * (uint32_t)n, &options);
        for (int f = 0; f < FRAMES; f++) {
            crowd_move(&c, f % 3 ? 0.4 : 1);
            film.moves[f] = c.moves;
            memcpy(film.move[f], c.move, sizeof c.move);
            film.before[f] = snapshot(c.scene);
            film.hash[f] = step(&c, &film, f);
        }
        for (int back = 0; back < 4; back++) {
            int from = (int)test_random_below(&c.random, FRAMES);
            crowd *in = back % 2 ? &other : &c;
            assert_int_equal(pir_scene_restore(in->scene, film.before[from].data, film.before[from].size, NULL),
                             PIR_OK);
            size_t count = 42;
            pir_scene_events(in->scene, &count);
            assert_int_equal(count, 0);
            for (int f = from; f < FRAMES; f++) {
                struct bytes again = snapshot(in->scene);
                expect(same_bytes(&again, &film.before[f]), "crowd %llu, frame %d", number, f);
                free(again.data);
                expect(pir_scene_is_valid(in->scene), "crowd %llu, frame %d", number, f);
                expect(step(in, &film, f) == film.hash[f], "crowd %llu from %d, frame %d", number, from, f);
            }
        }
        for (int f = 0; f < FRAMES; f++)
            free(film.before[f].data);
        crowd_finish(&c);
        crowd_finish(&other);
    }
}

/* Sets the checksum right, so that what was changed is found by what reads it. */
static void seal(struct bytes *bytes) {
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < bytes->size; i++)
        if (i < 24 || i >= 32)
            hash = (hash ^ bytes->data[i]) * UINT64_C(0x100000001b3);
    for (int k = 0; k < 8; k++)
        bytes->data[24 + k] = (unsigned char)(hash >> (8 * k));
}

/* Every byte changed, with and without a checksum that holds: an error that says why, or a state that is valid. */
static void bytes_that_lie_harm_nothing(void **state) {
    (void)state;
    static crowd c;
    pir_scene_options options = pir_scene_options_default();
    crowd_init(&c, 3000, 6, &options);
    c.size *= 0.4;
    crowd_move(&c, 1);
    assert_int_equal(pir_scene_update(c.scene, c.move, c.moves), PIR_OK);
    struct bytes good = snapshot(c.scene), bad = snapshot(c.scene), now;
    uint32_t refused = 0;
    for (size_t i = 0; i < 2 * good.size; i++) {
        pir_report report = {PIR_OK, ""};
        memcpy(bad.data, good.data, good.size);
        bad.data[i / 2] ^= (unsigned char)(1u << i % 8);
        if (i % 2)
            seal(&bad);
        pir_status status = pir_scene_restore(c.scene, bad.data, bad.size, &report);
        expect(pir_scene_is_valid(c.scene), "byte %zu", i / 2);
        if (status == PIR_OK) {
            expect(i % 2, "byte %zu without a checksum", i / 2);
            assert_int_equal(pir_scene_update(c.scene, NULL, 0), PIR_OK);
            assert_int_equal(pir_scene_restore(c.scene, good.data, good.size, NULL), PIR_OK);
            continue;
        }
        refused++;
        expect(report.status == status && strncmp(report.text, "snapshot: ", 10) == 0, "byte %zu", i / 2);
        now = snapshot(c.scene);
        expect(same_bytes(&now, &good), "byte %zu: a refused snapshot changed the scene", i / 2);
        free(now.data);
    }
    assert_true(refused > good.size);
    for (size_t size = 0; size < good.size; size += 5)
        assert_int_equal(pir_scene_restore(c.scene, good.data, size, NULL), PIR_ERR_FORMAT);
    free(good.data);
    free(bad.data);
    crowd_finish(&c);
}

/* A pose that no body can have is told by the body and the value, and changes nothing. */
static void poses_that_are_none_are_named(void **state) {
    (void)state;
    static crowd c;
    pir_scene_options options = pir_scene_options_default();
    crowd_init(&c, 3003, 5, &options);
    struct bytes good = snapshot(c.scene), bad = snapshot(c.scene), now;
    // number `at` of the seven of a pose, or all four of the rotation where it is 7
    static const struct {
        int at;
        double value;
        const char *text;
    } wrong[] = {
        {1, NAN, "snapshot: body 2: its rotation: y is nan"},
        {6, INFINITY, "snapshot: body 2: its pose: z is inf"},
        {4, 1e300, "snapshot: body 2: its pose: x is 1e+300, beyond 2^60"},
        {5, 0x1p60, "snapshot: body 2: it reaches beyond 2^60"},
        {7, 0, "snapshot: body 2: its pose: zero quaternion"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        pir_report report = {PIR_OK, ""};
        unsigned char *pose = bad.data + 32 + 2 * 80 + 16;
        memcpy(bad.data, good.data, good.size);
        for (int k = 0; k < 4; k++)
            if (wrong[i].at == 7 || wrong[i].at == k)
                memcpy(pose + 8 * k, &wrong[i].value, sizeof wrong[i].value);
        if (wrong[i].at >= 4 && wrong[i].at < 7)
            memcpy(pose + 8 * wrong[i].at, &wrong[i].value, sizeof wrong[i].value);
        seal(&bad);
        assert_int_equal(pir_scene_restore(c.scene, bad.data, bad.size, &report), PIR_ERR_FORMAT);
        expect(report.status == PIR_ERR_FORMAT && strcmp(report.text, wrong[i].text) == 0, "'%s'", report.text);
        now = snapshot(c.scene);
        expect(same_bytes(&now, &good), "pose %zu: a refused snapshot changed the scene", i);
        free(now.data);
    }
    free(good.data);
    free(bad.data);
    crowd_finish(&c);
}

static void what_is_no_snapshot_of_the_scene_is_refused(void **state) {
    (void)state;
    static crowd c;
    pir_scene_options options = pir_scene_options_default();
    crowd_init(&c, 3001, 5, &options);
    struct bytes bytes = snapshot(c.scene);
    assert_int_equal(pir_scene_serialise(NULL, bytes.data, bytes.size), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_serialise(c.scene, NULL, bytes.size), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_serialise(c.scene, bytes.data, bytes.size - 1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_restore(NULL, bytes.data, bytes.size, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_restore(c.scene, NULL, bytes.size, NULL), PIR_ERR_ARGUMENT);
    bytes.data[8] = 1;
    assert_int_equal(pir_scene_restore(c.scene, bytes.data, bytes.size, NULL), PIR_ERR_VERSION);
    bytes.data[8] = 2;
    crowd_add(&c);
    assert_int_equal(pir_scene_restore(c.scene, bytes.data, bytes.size, NULL), PIR_ERR_ARGUMENT);
    crowd_remove(&c, 2);
    assert_int_equal(pir_scene_restore(c.scene, bytes.data, bytes.size, NULL), PIR_ERR_ARGUMENT);
    free(bytes.data);
    crowd_finish(&c);
}

/* Restores a scene, which was updated before or was not, with memory that fails at every request in turn. */
static void restore_short_of_memory(bool updated) {
    static crowd c;
    uint64_t failures = 0;
    pir_status status = PIR_ERR_MEMORY;
    for (uint64_t request = 1; status == PIR_ERR_MEMORY; request++) {
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        pir_scene_options options = pir_scene_options_default();
        crowd_init(&c, 3002, 30, &options);
        c.size *= 0.4;
        crowd_move(&c, 1);
        assert_int_equal(pir_scene_update(c.scene, c.move, c.moves), PIR_OK);
        struct bytes bytes = snapshot(c.scene), before, after;
        crowd_finish(&c);
        // the same bodies, apart, in a scene whose memory fails
        options.allocator = &allocator;
        crowd_init(&c, 3002, 30, &options);
        if (updated)
            assert_int_equal(pir_scene_update(c.scene, NULL, 0), PIR_OK);
        before = snapshot(c.scene);
        memory.fail_at = memory.requests + request;
        status = pir_scene_restore(c.scene, bytes.data, bytes.size, NULL);
        memory.fail_at = 0;
        after = snapshot(c.scene);
        expect(pir_scene_is_valid(c.scene), "request %llu", (unsigned long long)request);
        expect(same_bytes(&after, status == PIR_OK ? &bytes : &before), "request %llu", (unsigned long long)request);
        failures += status == PIR_ERR_MEMORY;
        free(bytes.data);
        free(before.data);
        free(after.data);
        crowd_finish(&c);
        assert_int_equal(memory.blocks, 0);
    }
    assert_int_equal(status, PIR_OK);
    assert_true(failures > 0);
}

static void memory_that_fails_leaves_the_scene_as_it_was(void **state) {
    (void)state;
    restore_short_of_memory(true);
    restore_short_of_memory(false);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_restored_scene_goes_on_as_it_did),
        cmocka_unit_test(bytes_that_lie_harm_nothing),
        cmocka_unit_test(poses_that_are_none_are_named),
        cmocka_unit_test(what_is_no_snapshot_of_the_scene_is_refused),
        cmocka_unit_test(memory_that_fails_leaves_the_scene_as_it_was),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
