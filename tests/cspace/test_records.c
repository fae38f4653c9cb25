/* SPDX-License-Identifier: MIT */
/*
 * Records of sums that turn: what is read back is the pairing at every rotation; bytes do not depend on the way there;
 * bytes that were changed are refused or give some pairing, and never more.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cspace/record/recorder.h"
#include "cspace/record/replay.h"
#include "support/bodies.h"
#include "support/memory.h"

#define STEPS 40

static unsigned rounds(void) {
    const char *text = getenv("PIR_TEST_ROUNDS");
    return text ? (unsigned)strtoul(text, NULL, 10) : 1;
}

static pir_sum *make_difference(const test_pose *pose, const pir_allocator *allocator) {
    pir_polytope *p = test_polytope(&pose->p), *q = test_polytope(&pose->q);
    pir_sum *sum = NULL;
    pir_sum_options options = {.size = sizeof options, .allocator = allocator, .difference = true};
    assert_int_equal(pir_sum_create(p, q, pose->rotation, &options, &sum), PIR_OK);
    pir_polytope_release(p);
    pir_polytope_release(q);
    return sum;
}

/* The next rotation: a turn of about `size` more, or now and then anywhere. */
static pir_quat step_from(test_random *random, pir_quat from, double size) {
    double most = fmax(fmax(fabs(from.x), fabs(from.y)), fmax(fabs(from.z), fabs(from.w)));
    if (test_random_below(random, 12) == 0 || most > 0x1p100 || most < 0x1p-100)
        return test_rotation(random);
    pir_vec3 axis = test_random_direction(random);
    double half = size * test_random_unit(random);
    pir_quat next = test_compose((pir_quat){axis.x * half, axis.y * half, axis.z * half, 1}, from, 1);
    return next;
}

/* Whether the replay holds what the sum's pairing holds, array for array. */
static void expect_same_slice(pir_record_replay *replay, const pir_sum *sum, const char *situation, int step) {
    const pir_pairing *pairing = pir_sum_pairing(sum);
    const pir_record_replay_crossing *crossing;
    uint32_t count, at = 0;
    assert_memory_equal(replay->fv, pairing->fv, pairing->p->facet_count * sizeof *replay->fv);
    assert_memory_equal(replay->vf, pairing->vf, pairing->q->facet_count * sizeof *replay->vf);
    assert_int_equal(pir_record_replay_crossings(replay, &crossing, &count), PIR_OK);
    expect(count == pairing->crossings.count, "%s, step %d", situation, step);
    for (uint32_t e = 0; e < pairing->p->edge_count; e++)
        for (uint32_t slot = pir_crossing_first(pairing, e); slot != PIR_NO_CROSSING;
             slot = pir_crossing_next(pairing, slot), at++)
            expect(crossing[at].edge == e && crossing[at].half == pir_crossing_half(pairing, slot), "%s, step %d",
                   situation, step);
}

static void replay_random_walk(uint32_t number) {
    test_random random = test_random_case("records", number);
    test_pose pose;
    test_random_pose(&random, 40, &pose);
    const pir_allocator a = pir_allocator_or_default(NULL);
    pir_sum *sum = make_difference(&pose, NULL);
    pir_recorder recorder;
    pir_record_replay replay;
    pir_bytes bytes = {0};
    assert_true(pir_recorder_init(&recorder, sum, &a));
    assert_true(pir_record_replay_init(&replay, pir_sum_p(sum), pir_sum_q(sum), &a));
    pir_quat q = pose.rotation;
    double size = number % 3 == 0 ? 0.01 : number % 3 == 1 ? 0.1 : 1;
    for (int i = 0; i < STEPS; i++) {
        if (i > 0)
            assert_int_equal(pir_sum_rotate(sum, q = step_from(&random, q, size), PIR_METHOD_AUTO), PIR_OK);
        bytes.used = 0;
        assert_true(pir_recorder_write(&recorder, i % 16 == 0, &bytes));
        assert_int_equal(pir_record_replay_record(&replay, bytes.data, bytes.used), PIR_OK);
        expect_same_slice(&replay, sum, pose.situation, i);
    }
    pir_record_replay_finish(&replay);
    pir_recorder_finish(&recorder);
    pir_bytes_finish(&bytes, &a);
    pir_sum_destroy(sum);
}

static void what_is_read_is_what_was_written(void **state) {
    (void)state;
    for (uint32_t number = 0; number < 300 * rounds(); number++)
        replay_random_walk(number);
}

/* The record of `to` after `from`, made along a way of `detours` rotations in between. */
static void record_between(const test_pose *pose, pir_quat from, pir_quat to, int detours, pir_bytes *bytes) {
    test_random random = test_random_case("detours", (uint64_t)detours);
    const pir_allocator a = pir_allocator_or_default(NULL);
    pir_sum *sum = make_difference(pose, NULL);
    pir_recorder recorder;
    assert_true(pir_recorder_init(&recorder, sum, &a));
    assert_int_equal(pir_sum_rotate(sum, from, PIR_METHOD_UPDATE), PIR_OK);
    assert_true(pir_recorder_write(&recorder, true, bytes));
    for (int i = 0; i < detours; i++)
        assert_int_equal(pir_sum_rotate(sum, test_rotation(&random), PIR_METHOD_AUTO), PIR_OK);
    assert_int_equal(pir_sum_rotate(sum, to, detours ? PIR_METHOD_WALK : PIR_METHOD_UPDATE), PIR_OK);
    bytes->used = 0;
    assert_true(pir_recorder_write(&recorder, false, bytes));
    pir_recorder_finish(&recorder);
    pir_sum_destroy(sum);
}

static void bytes_do_not_depend_on_the_way(void **state) {
    (void)state;
    const pir_allocator a = pir_allocator_or_default(NULL);
    for (uint32_t number = 0; number < 100 * rounds(); number++) {
        test_random random = test_random_case("records of ways", number);
        test_pose pose;
        test_random_pose(&random, 30, &pose);
        pir_quat to = step_from(&random, pose.rotation, number % 2 ? 0.3 : 0.03);
        pir_bytes direct = {0}, round_about = {0};
        record_between(&pose, pose.rotation, to, 0, &direct);
        record_between(&pose, pose.rotation, to, 5, &round_about);
        expect(direct.used == round_about.used && memcmp(direct.data, round_about.data, direct.used) == 0,
               "%s, case %u", pose.situation, number);
        pir_bytes_finish(&direct, &a);
        pir_bytes_finish(&round_about, &a);
    }
}

/* Applies the bytes, whatever they are; what is taken can be put in order, or says that it cannot. */
static void replay_any(pir_record_replay *replay, const uint8_t *bytes, size_t size) {
    const pir_record_replay_crossing *crossing;
    uint32_t count;
    pir_status status = pir_record_replay_record(replay, bytes, size);
    assert_true(status == PIR_OK || status == PIR_ERR_FORMAT);
    if (status != PIR_OK)
        return;
    for (uint32_t f = 0; f < replay->p->facet_count; f++)
        assert_true(replay->fv[f] < replay->q->vertex_count);
    for (uint32_t g = 0; g < replay->q->facet_count; g++)
        assert_true(replay->vf[g] < replay->p->vertex_count);
    status = pir_record_replay_crossings(replay, &crossing, &count);
    assert_true(status == PIR_OK || status == PIR_ERR_FORMAT);
    for (uint32_t i = 0; status == PIR_OK && i < count; i++)
        assert_true(crossing[i].edge < replay->p->edge_count && crossing[i].half < replay->q->half_count);
}

static void changed_bytes_are_refused_or_harmless(void **state) {
    (void)state;
    const pir_allocator a = pir_allocator_or_default(NULL);
    for (uint32_t number = 0; number < 60 * rounds(); number++) {
        test_random random = test_random_case("hostile records", number);
        test_pose pose;
        test_random_pose(&random, 20, &pose);
        pir_sum *sum = make_difference(&pose, NULL);
        pir_recorder recorder;
        pir_record_replay replay;
        pir_bytes whole = {0}, changes = {0};
        assert_true(pir_recorder_init(&recorder, sum, &a));
        assert_true(pir_record_replay_init(&replay, pir_sum_p(sum), pir_sum_q(sum), &a));
        assert_true(pir_recorder_write(&recorder, true, &whole));
        assert_int_equal(pir_sum_rotate(sum, step_from(&random, pose.rotation, 0.1), PIR_METHOD_AUTO), PIR_OK);
        assert_true(pir_recorder_write(&recorder, false, &changes));
        for (int i = 0; i < 200; i++) {
            pir_bytes *hit = i % 2 ? &whole : &changes;
            uint32_t at = test_random_below(&random, (uint32_t)hit->used);
            uint8_t before = hit->data[at];
            hit->data[at] = (uint8_t)test_random_bits(&random);
            size_t cut = i % 5 == 0 ? test_random_below(&random, 4) : 0;
            replay_any(&replay, whole.data, whole.used);
            replay_any(&replay, changes.data, changes.used - (cut < changes.used ? cut : 0));
            hit->data[at] = before;
        }
        // and the right ones are taken again
        assert_int_equal(pir_record_replay_record(&replay, whole.data, whole.used), PIR_OK);
        assert_int_equal(pir_record_replay_record(&replay, changes.data, changes.used), PIR_OK);
        expect_same_slice(&replay, sum, pose.situation, 1);
        pir_record_replay_finish(&replay);
        pir_recorder_finish(&recorder);
        pir_bytes_finish(&whole, &a);
        pir_bytes_finish(&changes, &a);
        pir_sum_destroy(sum);
    }
}

static void changes_before_a_whole_record_are_refused(void **state) {
    (void)state;
    test_random random = test_random_case("first record", 0);
    pir_polytope *p = test_sphere(&random, 8);
    const pir_allocator a = pir_allocator_or_default(NULL);
    pir_record_replay replay;
    const uint8_t nothing_changes[] = {PIR_RECORD_CHANGES, 0, 0, 0};
    const pir_record_replay_crossing *crossing;
    uint32_t count;
    assert_true(pir_record_replay_init(&replay, p, p, &a));
    assert_int_equal(pir_record_replay_record(&replay, nothing_changes, sizeof nothing_changes), PIR_ERR_FORMAT);
    assert_int_equal(pir_record_replay_crossings(&replay, &crossing, &count), PIR_ERR_FORMAT);
    pir_record_replay_finish(&replay);
    pir_polytope_release(p);
}

/* One run in memory that fails at a request; returns whether anything failed. */
static bool try_records(test_memory *memory) {
    const pir_allocator a = test_allocator(memory);
    test_random random = test_random_case("records out of memory", 0);
    test_pose pose = {.situation = "spheres", .rotation = {0.1, 0.2, 0.3, 1}};
    test_body_points(&random, TEST_SPHERE, 30, &pose.p);
    test_body_points(&random, TEST_SPHERE, 30, &pose.q);
    pir_sum *sum = make_difference(&pose, NULL);
    pir_recorder recorder;
    pir_record_replay replay;
    pir_bytes bytes = {0};
    bool enough = pir_recorder_init(&recorder, sum, &a);
    if (!pir_record_replay_init(&replay, pir_sum_p(sum), pir_sum_q(sum), &a))
        enough = false;
    for (int i = 0; enough && i < 3; i++) {
        const pir_record_replay_crossing *crossing;
        uint32_t count;
        pir_quat next = test_general_rotation(&random);
        assert_int_equal(pir_sum_rotate(sum, i == 2 ? next : pose.rotation, PIR_METHOD_AUTO), PIR_OK);
        bytes.used = 0;
        enough = pir_recorder_write(&recorder, i == 0, &bytes);
        pir_status status = enough ? pir_record_replay_record(&replay, bytes.data, bytes.used) : PIR_ERR_MEMORY;
        if (status == PIR_OK)
            status = pir_record_replay_crossings(&replay, &crossing, &count);
        enough = status == PIR_OK;
        assert_true(enough || status == PIR_ERR_MEMORY);
    }
    pir_record_replay_finish(&replay);
    pir_recorder_finish(&recorder);
    pir_bytes_finish(&bytes, &a);
    pir_sum_destroy(sum);
    return !enough;
}

static void memory_runs_out_anywhere(void **state) {
    (void)state;
    bool failed = true;
    for (uint64_t n = 1; failed; n++) {
        test_memory memory = {.fail_at = n};
        failed = try_records(&memory);
        expect(memory.blocks == 0 && !memory.wrong_size && !memory.overrun, "failure at request %llu",
               (unsigned long long)n);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_read_is_what_was_written),
        cmocka_unit_test(bytes_do_not_depend_on_the_way),
        cmocka_unit_test(changed_bytes_are_refused_or_harmless),
        cmocka_unit_test(changes_before_a_whole_record_are_refused),
        cmocka_unit_test(memory_runs_out_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
