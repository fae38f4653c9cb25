/* SPDX-License-Identifier: MIT */
/* Scenes against brute force over all pairs: events, their order, their numbers bit for bit; with threads. */
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#include "scene/crowd.h"
#include "support/meshes.h"

static uint64_t crowds(void) {
    const char *text = getenv("PIR_TEST_SCENES");
    return text ? strtoull(text, NULL, 10) : 24;
}

static pir_scene_options options_of(uint64_t number) {
    pir_scene_options options = pir_scene_options_default();
    options.detail = number % 6 == 4 ? PIR_SCENE_STATES : number % 6 == 5 ? PIR_SCENE_DEPTHS : PIR_SCENE_MANIFOLDS;
    options.margin = number % 6 < 2 ? 0.125 : 0;
    options.approach = number % 2 == 0;
    return options;
}

/* Bodies come, go and move; some updates move all, most a few. */
static void live(crowd *c, uint64_t number, uint32_t updates) {
    for (uint32_t i = 0; i < updates; i++) {
        if (i % 5 == 3)
            crowd_add(c);
        if (i % 5 == 4)
            crowd_remove(c, test_random_below(&c->random, CROWD_BODIES));
        if (i % 3 == 1)
            for (int k = 0; k < 3; k++)
                crowd_change(c, test_random_below(&c->random, CROWD_BODIES));
        crowd_move(c, i % 4 == 0 ? 1 : 0.25);
        crowd_update_and_check(c, number);
    }
}

static void events_are_those_of_all_pairs(void **state) {
    (void)state;
    static crowd c;
    uint64_t contacts = 0;
    for (uint64_t i = 0; i < crowds(); i++) {
        pir_scene_options options = options_of(i);
        crowd_init(&c, i, 8 + (uint32_t)(i % 12), &options);
        live(&c, i, 12);
        contacts += c.contacts;
        crowd_finish(&c);
    }
    // crowded enough to mean something
    assert_true(contacts > 20 * crowds());
}

/* The events of a run with so many threads. */
static uint64_t hash_of(uint64_t number, uint32_t threads, const pir_tasks *tasks) {
    static crowd c;
    pir_scene_options options = options_of(number);
    options.threads = threads;
    options.tasks = tasks;
    crowd_init(&c, number, CROWD_BODIES, &options);
    c.size *= 0.7;
    uint64_t hash = TEST_HASH_START, asked = 0;
    for (uint32_t i = 0; i < 16; i++) {
        crowd_move(&c, 1);
        assert_int_equal(pir_scene_update(c.scene, c.move, c.moves), PIR_OK);
        hash = crowd_hash_events(hash, c.scene);
        asked += pir_scene_get_statistics(c.scene).asked;
    }
    // enough for several tasks
    assert_true(asked > 16 * 48);
    crowd_finish(&c);
    return hash;
}

static void threads_change_nothing(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 6; i++) {
        uint64_t alone = hash_of(i, 1, NULL);
        expect(hash_of(i, 2, NULL) == alone, "crowd %llu with 2 threads", (unsigned long long)i);
        expect(hash_of(i, 4, NULL) == alone, "crowd %llu with 4 threads", (unsigned long long)i);
    }
}

static uint64_t hash_number(uint64_t hash, uint32_t number) {
    for (int k = 0; k < 4; k++)
        hash = (hash ^ (number >> 8 * k & 0xff)) * 0x100000001b3u;
    return hash;
}

/* What is decided exactly: which contacts there are, their states and witnesses, and their order. */
static uint64_t hash_facts(uint64_t hash, const pir_scene *scene) {
    size_t count;
    const pir_scene_event *event = pir_scene_events(scene, &count);
    for (size_t i = 0; i < count; i++) {
        const pir_witness *w = &event[i].witness;
        const uint32_t numbers[10] = {event[i].kind,    event[i].body_p, event[i].body_q, event[i].piece_p,
                                      event[i].piece_q, event[i].state,  w->p.kind,       w->p.index,
                                      w->q.kind,        w->q.index};
        for (int k = 0; k < 10; k++)
            hash = hash_number(hash, numbers[k]);
    }
    return hash;
}

/* With every compiler, on every machine. */
static void facts_are_the_same_everywhere(void **state) {
    (void)state;
    static crowd c;
    static const uint64_t golden[3] = {0xe9ebf59fa6e79ff6u, 0xcd80731aab43e258u, 0x47df9b513add3001u};
    if (test_seed() != 1)
        skip();
    for (uint64_t i = 0; i < 3; i++) {
        pir_scene_options options = options_of(i);
        uint64_t hash = TEST_HASH_START;
        crowd_init(&c, 500 + i, CROWD_BODIES, &options);
        for (uint32_t step = 0; step < 16; step++) {
            crowd_move(&c, 0.5);
            assert_int_equal(pir_scene_update(c.scene, c.move, c.moves), PIR_OK);
            hash = hash_facts(hash, c.scene);
        }
        crowd_finish(&c);
        expect(hash == golden[i], "crowd %llu: %016llx", (unsigned long long)i, (unsigned long long)hash);
    }
}

/* A task interface that runs tasks from the last to the first, in finish. */
struct backwards {
    void (*task)(void *data, uint32_t index);
    void *data;
    uint32_t count, batches;
};

static void start_backwards(void *context, void (*task)(void *data, uint32_t index), void *data, uint32_t count) {
    struct backwards *b = context;
    b->task = task;
    b->data = data;
    b->count = count;
    b->batches++;
}

static void finish_backwards(void *context) {
    struct backwards *b = context;
    while (b->count > 0)
        b->task(b->data, --b->count);
}

static void callers_may_bring_their_own_threads(void **state) {
    (void)state;
    struct backwards backwards = {0};
    pir_tasks tasks = {&backwards, start_backwards, finish_backwards};
    assert_true(hash_of(2, 3, &tasks) == hash_of(2, 1, NULL));
    assert_true(backwards.batches > 8);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(events_are_those_of_all_pairs),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(facts_are_the_same_everywhere),
        cmocka_unit_test(callers_may_bring_their_own_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
