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
#include "support/bodies.h"
#include "support/hash.h"
#include "support/memory.h"
#include "support/meshes.h"

#define FRAMES 16

/* Where things stand in a snapshot: the checksum, the generations, a body's size, its pose. */
#define CHECKSUM_AT 32
#define HEADER      40
#define BODY        112
#define POSE        56

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
    for (size_t i = 0; i < bytes->size; i += 8) {
        uint64_t word = 0;
        for (size_t k = 0; k < 8; k++)
            word |= (uint64_t)bytes->data[i + k] << (8 * k);
        if (i != CHECKSUM_AT)
            hash = (hash ^ word) * UINT64_C(0x100000001b3);
    }
    for (int k = 0; k < 8; k++)
        bytes->data[CHECKSUM_AT + k] = (unsigned char)(hash >> (8 * k));
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
        unsigned char *pose = bad.data + HEADER + 4 * 6 + 2 * BODY + POSE;
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
    bytes.data[8] = 3;
    // a body that came since is dropped; one that went cannot be made, for its shape was not kept
    pir_report report = {PIR_OK, ""};
    uint32_t added = PIR_SCENE_NONE;
    assert_int_equal(pir_scene_add(c.scene, &c.body[0].options, &added), PIR_OK);
    assert_int_equal(pir_scene_restore(c.scene, bytes.data, bytes.size, NULL), PIR_OK);
    assert_false(pir_scene_has(c.scene, added));
    crowd_remove(&c, 2);
    assert_int_equal(pir_scene_restore(c.scene, bytes.data, bytes.size, &report), PIR_ERR_ARGUMENT);
    assert_string_equal(report.text, "snapshot: body 2 is none of the scene, and its own shape is not kept");
    assert_int_equal(pir_scene_get_statistics(c.scene).bodies, 4);
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

/* --- bodies that come and go --- */

#define SHAPES 8
#define LONG   64

/* A frame of a life that depends on the state of the scene and on numbers alone. */
static uint64_t live(pir_scene *scene, pir_polytope *const *shape, uint64_t number, int frame) {
    test_random random = test_random_case("lives", number * 1000 + (uint64_t)frame);
    static pir_scene_move move[256];
    size_t moves = 0;
    for (uint32_t id = pir_scene_next(scene, PIR_SCENE_NONE); id != PIR_SCENE_NONE; id = pir_scene_next(scene, id)) {
        const uint32_t what = test_random_below(&random, 24);
        pir_body_state body;
        assert_int_equal(pir_scene_get_body(scene, id, &body), PIR_OK);
        if (what < 2)
            assert_int_equal(pir_scene_remove(scene, id), PIR_OK);
        else if (what == 2)
            assert_int_equal(pir_scene_set_disabled(scene, id, !body.disabled), PIR_OK);
        else if (what == 3)
            assert_int_equal(pir_scene_set_filter(scene, id, 1u << frame % 3, body.mask ^ 2u), PIR_OK);
        else if (what == 4)
            assert_int_equal(pir_scene_set_user(scene, id, body.user + 1), PIR_OK);
        if (what < 2 || what > 14 || body.kind == PIR_BODY_STATIC)
            continue;
        const pir_vec3 velocity = test_random_direction(&random), spin = test_random_direction(&random);
        move[moves++] = (pir_scene_move){id, pir_pose_integrate(body.pose, velocity, spin, 0.25)};
    }
    for (uint32_t i = 0; i < 3 && pir_scene_get_statistics(scene).bodies < 24; i++) {
        pir_body_options body = pir_body_options_default();
        const uint64_t users[2] = {1 + test_random_below(&random, 3), 7};
        uint32_t id;
        body.pieces = &shape[test_random_below(&random, SHAPES - 1)];
        body.piece_count = 1 + test_random_below(&random, 2);
        body.kind = (pir_body_kind)(test_random_below(&random, 5) % 3);
        body.sensor = test_random_below(&random, 6) == 0;
        body.user = number;
        body.piece_users = test_random_below(&random, 3) == 0 ? users : NULL;
        body.radius = test_random_below(&random, 4) == 0 ? 0.125 : 0;
        const pir_vec3 at = test_random_direction(&random);
        body.pose.translation = (pir_vec3){at.x, at.y, at.z};
        assert_int_equal(pir_scene_add(scene, &body, &id), PIR_OK);
    }
    assert_int_equal(pir_scene_update(scene, move, moves), PIR_OK);
    return crowd_hash_events(TEST_HASH_START, scene);
}

static void make_shapes(uint64_t number, pir_polytope **shape) {
    test_random random = test_random_case("shapes", number);
    for (uint32_t i = 0; i < SHAPES; i++) {
        test_points points;
        test_body_points(&random, i % 2 ? TEST_BOX : TEST_SPHERE, 12, &points);
        for (size_t k = 0; k < points.count; k++)
            points.at[k] = (pir_vec3){points.at[k].x / 4, points.at[k].y / 4, points.at[k].z / 4};
        shape[i] = test_polytope(&points);
    }
}

/* The frames of a life, and the snapshots before them. */
struct life {
    uint64_t number;
    pir_polytope *shape[SHAPES];
    pir_scene *scene[3]; /* with 1, 2 and 4 threads */
    struct bytes before[LONG];
    uint64_t hash[LONG];
};

/* The first time, in all three scenes: their frames are the same. */
static void begin_life(struct life *life, uint64_t number) {
    static const uint32_t threads[3] = {1, 2, 4};
    pir_scene_options options = pir_scene_options_default();
    life->number = number;
    options.margin = number % 2 ? 0.03125 : 0;
    options.unions = number % 4 == 3;
    options.reuse = number % 3 == 1 ? 0.125 : 0;
    options.keep_shapes = true;
    make_shapes(number, life->shape);
    for (int k = 0; k < 3; k++) {
        options.threads = threads[k];
        assert_int_equal(pir_scene_create(&options, &life->scene[k]), PIR_OK);
        for (int f = 0; f < LONG; f++) {
            struct bytes before = snapshot(life->scene[k]);
            const uint64_t hash = live(life->scene[k], life->shape, number, f);
            if (k == 0) {
                life->before[f] = before;
                life->hash[f] = hash;
                continue;
            }
            expect(same_bytes(&before, &life->before[f]) && hash == life->hash[f], "life %llu, frame %d, %u threads",
                   (unsigned long long)number, f, threads[k]);
            free(before.data);
        }
    }
}

/* Frames from one on, gone again in a scene; how many. */
static uint64_t live_again(const struct life *life, pir_scene *scene, int from, int to) {
    assert_int_equal(pir_scene_restore(scene, life->before[from].data, life->before[from].size, NULL), PIR_OK);
    for (int f = from; f < to; f++) {
        struct bytes again = snapshot(scene);
        expect(same_bytes(&again, &life->before[f]), "life %llu, frame %d", (unsigned long long)life->number, f);
        free(again.data);
        expect(pir_scene_is_valid(scene), "life %llu, frame %d", (unsigned long long)life->number, f);
        expect(live(scene, life->shape, life->number, f) == life->hash[f], "life %llu from %d, frame %d",
               (unsigned long long)life->number, from, f);
    }
    return (uint64_t)(to - from);
}

/* Back and forth over bodies that come, go and change, with 1, 2 and 4 threads: all bits as the first time. */
static void a_scene_goes_back_over_bodies_that_come_and_go(void **state) {
    (void)state;
    const char *asked = getenv("PIR_TEST_LIVES");
    const uint64_t lives = asked ? strtoull(asked, NULL, 10) : 6;
    uint64_t frames = 0;
    for (uint64_t n = 0; n < lives; n++) {
        test_random random = test_random_case("ways back", n);
        struct life life;
        begin_life(&life, n);
        for (int back = 0; back < 40; back++) {
            const int from = (int)test_random_below(&random, LONG), to = from + 1 + (int)test_random_below(&random, 8);
            pir_scene *scene = life.scene[back % 3];
            frames += live_again(&life, scene, from, to < LONG ? to : LONG);
            // a way that is not gone again: other bodies under the numbers
            if (back % 4 == 0)
                live(scene, life.shape, n + 77, back);
        }
        for (int f = 0; f < LONG; f++)
            free(life.before[f].data);
        for (int k = 0; k < 3; k++)
            pir_scene_destroy(life.scene[k]);
        for (uint32_t i = 0; i < SHAPES; i++)
            pir_polytope_release(life.shape[i]);
    }
    print_message("%llu frames gone again\n", (unsigned long long)frames);
}

/* A scene without bodies that was given the shapes becomes any other; where it has forgotten them it says which. */
static void a_scene_of_shapes_alone_becomes_another(void **state) {
    (void)state;
    pir_polytope *shape[SHAPES];
    pir_scene *scene, *other;
    pir_report report = {PIR_OK, ""};
    make_shapes(3, shape);
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    assert_int_equal(pir_scene_create(NULL, &other), PIR_OK);
    for (uint32_t i = 0; i + 1 < SHAPES; i++)
        for (uint32_t pieces = 1; pieces < 3; pieces++) {
            pir_body_options body = pir_body_options_default();
            body.pieces = &shape[i];
            body.piece_count = pieces;
            assert_int_equal(pir_scene_keep(other, &body), PIR_OK);
            assert_int_equal(pir_scene_keep(other, &body), PIR_OK);
        }
    assert_int_equal(pir_scene_keep(other, NULL), PIR_ERR_ARGUMENT);
    for (int f = 0; f < 12; f++) {
        struct bytes now = snapshot(scene), again;
        assert_int_equal(pir_scene_restore(other, now.data, now.size, &report), PIR_OK);
        assert_true(pir_scene_is_valid(other));
        again = snapshot(other);
        assert_true(same_bytes(&now, &again));
        assert_true(live(scene, shape, 3, f) == live(other, shape, 3, f));
        free(now.data);
        free(again.data);
    }
    struct bytes now = snapshot(scene), empty;
    pir_scene_destroy(other);
    assert_int_equal(pir_scene_create(NULL, &other), PIR_OK);
    empty = snapshot(other);
    pir_scene_forget_shapes(other);
    assert_int_equal(pir_scene_restore(other, now.data, now.size, &report), PIR_ERR_ARGUMENT);
    assert_non_null(strstr(report.text, "is none of the scene, and its own shape is not kept"));
    assert_int_equal(pir_scene_restore(scene, empty.data, empty.size, &report), PIR_OK);
    assert_int_equal(pir_scene_get_statistics(scene).bodies, 0);
    free(now.data);
    free(empty.data);
    pir_scene_destroy(scene);
    pir_scene_destroy(other);
    for (uint32_t i = 0; i < SHAPES; i++)
        pir_polytope_release(shape[i]);
}

/* Memory that fails at any request of a restore which makes and drops bodies changes nothing. */
static void bodies_stay_where_memory_fails(void **state) {
    (void)state;
    pir_polytope *shape[SHAPES];
    uint64_t failures = 0;
    make_shapes(1, shape);
    for (int from = 4; from < 20; from += 5) {
        pir_status status = PIR_ERR_MEMORY;
        for (uint64_t request = 1; status == PIR_ERR_MEMORY; request++) {
            test_memory memory = {0};
            const pir_allocator allocator = test_allocator(&memory);
            pir_scene_options options = pir_scene_options_default();
            options.allocator = &allocator;
            options.keep_shapes = true;
            pir_scene *scene;
            struct bytes early = {NULL, 0}, late, after;
            assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
            for (int f = 0; f < from + 8; f++) {
                if (f == from)
                    early = snapshot(scene);
                live(scene, shape, 1, f);
            }
            late = snapshot(scene);
            memory.fail_at = memory.requests + request;
            status = pir_scene_restore(scene, early.data, early.size, NULL);
            memory.fail_at = 0;
            after = snapshot(scene);
            expect(pir_scene_is_valid(scene), "request %llu", (unsigned long long)request);
            expect(same_bytes(&after, status == PIR_OK ? &early : &late), "request %llu", (unsigned long long)request);
            failures += status == PIR_ERR_MEMORY;
            free(early.data);
            free(late.data);
            free(after.data);
            pir_scene_destroy(scene);
            assert_int_equal(memory.blocks, 0);
        }
        assert_int_equal(status, PIR_OK);
    }
    assert_true(failures > 0);
    for (uint32_t i = 0; i < SHAPES; i++)
        pir_polytope_release(shape[i]);
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
        cmocka_unit_test(a_scene_goes_back_over_bodies_that_come_and_go),
        cmocka_unit_test(a_scene_of_shapes_alone_becomes_another),
        cmocka_unit_test(bodies_stay_where_memory_fails),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
