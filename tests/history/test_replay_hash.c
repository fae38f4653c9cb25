/* SPDX-License-Identifier: MIT */
/*
 * Every number that a replay compares counts in its hash: a change of one of them, by a bit, changes the hash. Steps do
 * not count, since they depend on what was asked before.
 */
#include "support/test.h"

#include <stdbool.h>
#include <string.h>

#include <pirouette/shape.h>

#include "history/replay_hash.h"
#include "support/bodies.h"

#define START 0x1234567890abcdefull

/* A double's last bit. */
static void nudge(double *x) {
    uint64_t bits;
    memcpy(&bits, x, sizeof bits);
    bits ^= 1;
    memcpy(x, &bits, sizeof bits);
}

static void each_number_of_an_answer_counts(void **state) {
    (void)state;
    pir_query_result answer = {.state = PIR_OUTSIDE, .outcome = PIR_SEPARATED, .distance = 1.5, .steps = 3};
    answer.normal = (pir_vec3){0.25, 0.5, 0.75};
    answer.point_p = (pir_vec3){1, 2, 3};
    answer.point_q = (pir_vec3){4, 5, 6};
    const uint64_t hash = pir_replay_hash_answer(START, &answer);
    double *numbers[] = {&answer.distance,  &answer.normal.x,  &answer.normal.y,  &answer.normal.z,  &answer.point_p.x,
                         &answer.point_p.y, &answer.point_p.z, &answer.point_q.x, &answer.point_q.y, &answer.point_q.z};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        nudge(numbers[i]);
        expect(pir_replay_hash_answer(START, &answer) != hash, "number %zu", i);
        nudge(numbers[i]);
        expect(pir_replay_hash_answer(START, &answer) == hash, "number %zu", i);
    }
    pir_query_result others[] = {answer, answer, answer, answer, answer, answer};
    others[0].state = PIR_BOUNDARY;
    others[1].outcome = PIR_BEYOND_CUTOFF;
    others[2].witness.p.kind++;
    others[3].witness.p.index++;
    others[4].witness.q.kind++;
    others[5].witness.q.index++;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        expect(pir_replay_hash_answer(START, &others[i]) != hash, "member %zu", i);
    answer.steps++;
    assert_true(pir_replay_hash_answer(START, &answer) == hash);
    assert_true(pir_replay_hash_answer(START + 1, &answer) != hash);
}

static void each_number_of_a_contact_counts(void **state) {
    (void)state;
    pir_contact contacts[2] = {{.point_p = {1, 2, 3}, .point_q = {4, 5, 6}, .distance = -0.5, .id = 7},
                               {.point_p = {8, 9, 10}, .point_q = {11, 12, 13}, .distance = 0.25, .id = 14}};
    const uint64_t hash = pir_replay_hash_contacts(START, contacts, 2);
    for (int k = 0; k < 2; k++) {
        pir_contact *c = &contacts[k];
        double *numbers[] = {&c->point_p.x, &c->point_p.y, &c->point_p.z, &c->point_q.x,
                             &c->point_q.y, &c->point_q.z, &c->distance};
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
            nudge(numbers[i]);
            expect(pir_replay_hash_contacts(START, contacts, 2) != hash, "contact %d, number %zu", k, i);
            nudge(numbers[i]);
        }
        c->id++;
        expect(pir_replay_hash_contacts(START, contacts, 2) != hash, "contact %d, id", k);
        c->id--;
    }
    assert_true(pir_replay_hash_contacts(START, contacts, 2) == hash);
    assert_true(pir_replay_hash_contacts(START, contacts, 1) != hash);
    assert_true(pir_replay_hash_contacts(START, contacts, 0) != START);
}

/* Sums of the same bodies at rotations with other pairs. */
static void each_pair_of_a_sum_counts(void **state) {
    (void)state;
    static uint32_t pairs[10000][2];
    pir_polytope *p = NULL, *q = NULL;
    pir_sum *sum = NULL, *swapped = NULL;
    assert_int_equal(pir_shape_create("icosahedron", NULL, NULL, &p), PIR_OK);
    assert_int_equal(pir_shape_create("dodecahedron", NULL, NULL, &q), PIR_OK);
    assert_int_equal(pir_sum_create(p, q, (pir_quat){0, 0, 0, 1}, NULL, &sum), PIR_OK);
    assert_int_equal(pir_sum_create(q, p, (pir_quat){0, 0, 0, 1}, NULL, &swapped), PIR_OK);
    const uint64_t hash = pir_replay_hash_sum(START, sum, pairs);
    assert_true(pir_replay_hash_sum(START, swapped, pairs) != hash);
    uint64_t hashes[20];
    for (int k = 0; k < 20; k++) {
        // 15 degrees a step: some pair changes in most
        assert_int_equal(pir_sum_rotate(sum, (pir_quat){0.1 * k, 0.07 * k, 0.03 * k, 1}, PIR_METHOD_AUTO), PIR_OK);
        hashes[k] = pir_replay_hash_sum(START, sum, pairs);
    }
    int changes = 0;
    for (int k = 1; k < 20; k++)
        changes += hashes[k] != hashes[k - 1];
    expect(changes >= 15, "%d changes", changes);
    assert_true(hashes[0] == hash);
    pir_sum_destroy(swapped);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

/* What an update of two cubes tells, under one change at a time. */
static uint64_t hash_of_update(double x, double margin, bool sensor, int pieces) {
    pir_polytope *cube = NULL, *piece[2];
    pir_scene *scene = NULL;
    pir_scene_options options = pir_scene_options_default();
    options.margin = margin;
    assert_int_equal(pir_shape_create("cube", NULL, NULL, &cube), PIR_OK);
    assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
    pir_body_options body = pir_body_options_default();
    piece[0] = piece[1] = cube;
    body.pieces = piece;
    uint32_t number;
    for (int k = 0; k < 2; k++) {
        body.piece_count = k ? 1 : (uint32_t)pieces;
        body.sensor = k && sensor;
        body.pose.translation.x = k * x;
        assert_int_equal(pir_scene_add(scene, &body, &number), PIR_OK);
    }
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    uint64_t hash = pir_replay_hash_events(START, scene);
    pir_scene_destroy(scene);
    pir_polytope_release(cube);
    return hash;
}

static void events_count(void **state) {
    (void)state;
    const uint64_t hash = hash_of_update(0.5, 0, false, 1);
    assert_true(hash_of_update(0.5, 0, false, 1) == hash);
    const uint64_t others[] = {hash_of_update(5, 0, false, 1), hash_of_update(0.4375, 0, false, 1),
                               hash_of_update(0.5, 0, true, 1), hash_of_update(0.5, 0, false, 2), START};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        expect(others[i] != hash, "other %zu", i);
    assert_true(others[0] != START);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_number_of_an_answer_counts),
        cmocka_unit_test(each_number_of_a_contact_counts),
        cmocka_unit_test(each_pair_of_a_sum_counts),
        cmocka_unit_test(events_count),
    };
    return cmocka_run_group_tests_name("hashes of a replay", tests, NULL, NULL);
}
