/* SPDX-License-Identifier: MIT */
/*
 * A sum restored from its bytes is the sum, whatever its history: bodies of all kinds turn by steps of 1e-9 to half a
 * turn, turn to and fro, and jump, by any method or brute force, and in between they are scaled, reset and cloned,
 * tolerances and regions are set, moved and cleared, and memory runs out. After every step the sum is written and
 * restored: its bytes come back bit for bit. A companion that was restored some time ago goes the same way, and its
 * bytes are the sum's after every step too. They may only differ in what is kept beyond a region's cone, and only after
 * a choice between update and walk, which is made from counted work.
 *
 * PIR_TEST_STEPS in the environment sets the number of steps, PIR_TEST_FIRST the first history; a failure names the
 * history, its step, and what was done last.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/baseline.h>

#include "dymsum/sum.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/sum_bytes.h"

#define STEPS         40000
#define HISTORY_STEPS 60

struct history {
    uint64_t number;
    int step;
    const char *situation, *last;
    test_random random;
    test_memory memory;
    pir_sum *sum, *companion;
    bool counted; /* since they were alike a method was chosen, maybe, from counted work, which they do not share */
    double size;
    /* the motion: an axis, tan of half the angle of a step, and the poses that a motion to and fro repeats */
    pir_vec3 axis;
    double turn;
    pir_quat base;
};

#define hold(history, condition)                                                                                       \
    expect(condition, "history %llu, step %d, %s, last: %s", (unsigned long long)(history)->number, (history)->step,   \
           (history)->situation, (history)->last)

static uint32_t below(struct history *h, uint32_t count) {
    return test_random_below(&h->random, count);
}

static test_bytes bytes_of(struct history *h, const pir_sum *sum) {
    test_bytes bytes = test_bytes_of(sum);
    hold(h, bytes.data != NULL);
    return bytes;
}

static bool same_bytes(const test_bytes *a, const test_bytes *b) {
    return a->size == b->size && memcmp(a->data, b->data, a->size) == 0;
}

/* --- what is done to both --- */

static pir_quat next_rotation(struct history *h) {
    pir_quat now = pir_sum_rotation(h->sum);
    double square = now.x * now.x + now.y * now.y + now.z * now.z + now.w * now.w, turn = h->turn;
    bool middling = square > 0x1p-100 && square < 0x1p100;
    switch (below(h, 12)) {
    case 0:
        return test_rotation(&h->random);
    case 1:
        return now;
    case 2:
        return test_integer_rotation(&h->random);
    case 3:
    case 4:
        // to and fro: a few poses, the same ones again and again
        now = h->base;
        turn *= test_random_between(&h->random, -3, 3);
        break;
    case 5:
        h->axis = test_random_direction(&h->random);
        h->turn = fabs(test_random_scaled(&h->random, -28, 2));
        h->base = middling ? now : h->base;
        break;
    default:
        break;
    }
    if (!middling)
        return test_integer_rotation(&h->random);
    return test_compose((pir_quat){h->axis.x * turn, h->axis.y * turn, h->axis.z * turn, 1}, now, 1);
}

static pir_status rotate(pir_sum *sum, uint32_t how, pir_quat to) {
    static const pir_method methods[] = {PIR_METHOD_UPDATE, PIR_METHOD_UPDATE, PIR_METHOD_UPDATE,
                                         PIR_METHOD_AUTO,   PIR_METHOD_WALK,   PIR_METHOD_CGM};
    return how < 6    ? pir_sum_rotate(sum, to, methods[how])
           : how == 6 ? pir_sum_rotate_brute_force(sum, to)
                      : pir_sum_reset(sum, to);
}

/* Before calls that settle, and choose how where there is something to settle. */
static void note_choice(struct history *h) {
    h->counted |= pir_sum_shortfall_bound(h->sum) > 0;
}

static void turn_history(struct history *h) {
    static const char *const names[] = {"update", "update", "update", "auto", "walk", "cgm", "brute force", "reset"};
    uint32_t how = below(h, 8);
    pir_quat to = next_rotation(h);
    h->last = names[how];
    h->counted |= how == 3;
    hold(h, rotate(h->sum, how, to) == PIR_OK && rotate(h->companion, how, to) == PIR_OK);
}

static void scale(struct history *h) {
    static const double scales[] = {1, 0.7, 3, 0x1p-20};
    pir_operand operand = below(h, 2) ? PIR_OPERAND_P : PIR_OPERAND_Q;
    double by = scales[below(h, 4)];
    h->last = "scale";
    note_choice(h);
    hold(h, pir_sum_set_scale(h->sum, operand, by) == PIR_OK && pir_sum_set_scale(h->companion, operand, by) == PIR_OK);
}

static void set_tolerance(struct history *h) {
    double tolerance = below(h, 3) ? h->size * ldexp(1, -test_random_between(&h->random, 1, 12)) : 0;
    h->last = "tolerance";
    note_choice(h);
    hold(h, pir_sum_set_tolerance(h->sum, tolerance) == PIR_OK);
    hold(h, pir_sum_set_tolerance(h->companion, tolerance) == PIR_OK);
}

static void set_region(struct history *h) {
    pir_vec3 axis, was;
    double half_angle = 4 * fabs(test_random_unit(&h->random));
    h->last = "region";
    note_choice(h);
    axis = below(h, 3) ? test_random_direction(&h->random) : (pir_vec3){1, 0, 0};
    if (below(h, 2) && pir_sum_region(h->sum, &was, &half_angle)) {
        // the same cone, moved a little or far
        double by = ldexp(1, -test_random_between(&h->random, 0, 12));
        axis = (pir_vec3){was.x + by * axis.x, was.y + by * axis.y, was.z + by * axis.z};
    }
    if (axis.x == 0 && axis.y == 0 && axis.z == 0)
        axis.z = 1;
    hold(h, pir_sum_set_region(h->sum, axis, half_angle) == PIR_OK);
    hold(h, pir_sum_set_region(h->companion, axis, half_angle) == PIR_OK);
}

static void settle(struct history *h) {
    h->last = "settle";
    note_choice(h);
    hold(h, pir_sum_settle(h->sum) == PIR_OK && pir_sum_settle(h->companion) == PIR_OK);
}

/* A rotation of the sum without memory: where it fails nothing has happened, else the companion follows. */
static void run_out_of_memory(struct history *h) {
    uint32_t how = below(h, 7);
    pir_quat to = next_rotation(h);
    h->last = "no memory";
    h->counted |= how == 3;
    h->memory.fail_at = h->memory.requests + 1 + below(h, 3);
    h->memory.fail_after = true;
    pir_status status = rotate(h->sum, how, to);
    h->memory.fail_at = 0;
    hold(h, status == PIR_OK || status == PIR_ERR_MEMORY);
    if (status == PIR_OK)
        hold(h, rotate(h->companion, how, to) == PIR_OK);
}

static void clone(struct history *h) {
    pir_sum *copy = NULL;
    h->last = "clone";
    hold(h, pir_sum_clone(h->sum, NULL, &copy) == PIR_OK);
    pir_sum_destroy(h->sum);
    h->sum = copy;
}

static void change(struct history *h) {
    static void (*const acts[])(struct history * h) = {scale,  set_tolerance,     set_region, set_region,
                                                       settle, run_out_of_memory, clone};
    acts[below(h, 7)](h);
}

/* --- checks --- */

static pir_sum *restored(struct history *h, const test_bytes *bytes) {
    pir_report report = {PIR_OK, ""};
    pir_sum *back = NULL;
    pir_status status = pir_sum_restore(bytes->data, bytes->size, NULL, &report, &back);
    expect(status == PIR_OK, "history %llu, step %d, %s, last: %s: %s", (unsigned long long)h->number, h->step,
           h->situation, h->last, report.text);
    return back;
}

/*
 * Another cover, for another method, may keep other pairs beyond the cone: but the same in it. Within a tolerance one
 * of the two may stay behind where the other does not.
 */
static void check_strayed(struct history *h) {
    pir_vec3 axis;
    double half_angle;
    hold(h, h->counted && (pir_sum_tolerance(h->sum) > 0 || pir_sum_region(h->sum, &axis, &half_angle)));
    pir_quat one = pir_sum_rotation(h->sum), other = pir_sum_rotation(h->companion);
    hold(h, memcmp(&one, &other, sizeof one) == 0);
    one = pir_sum_pairing_rotation(h->sum);
    other = pir_sum_pairing_rotation(h->companion);
    hold(h, memcmp(&one, &other, sizeof one) != 0 || pir_sum_same_pairing(h->sum, h->companion));
}

static void check_history(struct history *h) {
    test_bytes written = bytes_of(h, h->sum);
    pir_sum *back = restored(h, &written);
    test_bytes again = bytes_of(h, back), beside = bytes_of(h, h->companion);
    hold(h, same_bytes(&written, &again));
    bool alike = same_bytes(&written, &beside);
    if (!alike)
        check_strayed(h);
    free(again.data);
    free(beside.data);
    free(written.data);
    // from now on this one goes along
    if (!alike || below(h, 6) == 0) {
        pir_sum *before = h->companion;
        h->companion = back;
        h->counted = false;
        back = before;
    }
    pir_sum_destroy(back);
}

static void make_history(struct history *h) {
    test_pose pose;
    test_random_pose(&h->random, below(h, 8) ? 8 : 30, &pose);
    pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
    pir_allocator allocator = test_allocator(&h->memory);
    pir_sum_options options = {.size = sizeof options, .allocator = &allocator, .difference = below(h, 2) != 0};
    h->situation = pose.situation;
    h->last = "nothing";
    h->base = test_integer_rotation(&h->random);
    h->axis = test_random_direction(&h->random);
    h->turn = fabs(test_random_scaled(&h->random, -28, 2));
    h->size = fmin(test_size_of(p), test_size_of(q));
    hold(h, pir_sum_create(p, q, pose.rotation, &options, &h->sum) == PIR_OK);
    hold(h, pir_sum_clone(h->sum, NULL, &h->companion) == PIR_OK);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

/* All arcs of P are active, and not all facets of Q: rebuilds that pair everything let go of those again. */
static void rebuilds_keep_what_the_cover_asks_for(void **state) {
    (void)state;
    const pir_vec3 spike[4] = {{1, 2, 0}, {1, -1, 2}, {1, -1, -2}, {-3, 0, 0}};
    pir_vec3 corners[8];
    for (int i = 0; i < 8; i++)
        corners[i] = (pir_vec3){i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1};
    const pir_quat there = {0.001, 0.002, -0.001, 1};
    pir_polytope *p = NULL, *q = NULL;
    pir_sum *sum = NULL, *back = NULL;
    assert_int_equal(pir_polytope_create(spike, 4, NULL, &p), PIR_OK);
    assert_int_equal(pir_polytope_create(corners, 8, NULL, &q), PIR_OK);
    assert_int_equal(pir_sum_create(p, q, there, NULL, &sum), PIR_OK);
    assert_int_equal(pir_sum_set_region(sum, (pir_vec3){1, 0, 0}, 1.8929), PIR_OK);
    uint32_t left_out = 0;
    for (int how = 4; how < 8; how++) {
        assert_int_equal(rotate(sum, (uint32_t)how, there), PIR_OK);
        for (uint32_t f = 0; f < 4; f++)
            assert_int_not_equal(pir_sum_fv(sum)[f], PIR_NO_PAIR);
        left_out = 0;
        for (uint32_t g = 0; g < 6; g++)
            left_out += pir_sum_vf(sum)[g] == PIR_NO_PAIR;
        assert_int_equal(left_out, 1);
        test_bytes bytes = test_bytes_of(sum);
        assert_non_null(bytes.data);
        assert_int_equal(pir_sum_restore(bytes.data, bytes.size, NULL, NULL, &back), PIR_OK);
        pir_sum_destroy(back);
        free(bytes.data);
    }
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static uint64_t asked_for(const char *name, uint64_t otherwise) {
    const char *asked = getenv(name);
    return asked ? strtoull(asked, NULL, 10) : otherwise;
}

static void bytes_come_back_whatever_the_history(void **state) {
    (void)state;
    uint64_t histories = asked_for("PIR_TEST_STEPS", STEPS) / HISTORY_STEPS;
    uint64_t first = asked_for("PIR_TEST_FIRST", 0);
    for (uint64_t number = first; number < first + histories; number++) {
        struct history h = {.number = number, .random = test_random_case("restored", number)};
        make_history(&h);
        for (h.step = 0; h.step < HISTORY_STEPS; h.step++) {
            if (below(&h, 3))
                turn_history(&h);
            else
                change(&h);
            check_history(&h);
        }
        pir_sum_destroy(h.sum);
        pir_sum_destroy(h.companion);
        hold(&h, h.memory.blocks == 0 && !h.memory.wrong_size);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(rebuilds_keep_what_the_cover_asks_for),
                                       cmocka_unit_test(bytes_come_back_whatever_the_history)};
    return cmocka_run_group_tests_name("restored", tests, NULL, NULL);
}
