/* SPDX-License-Identifier: MIT */
/*
 * Random histories of one sum: bodies of all kinds turn by steps of 1e-9 to half a turn, about steady, alternating,
 * ever new and aligned axes or to and fro about one, by any method, and in between the sum is cloned, reset, scaled,
 * written and read again, let stay behind, limited to a region, refused nonsense, and left without memory. After every
 * step its pairing is that of a second sum, which has no history because it walks each time; now and then that one goes
 * by brute force, the whole pairing is proven, and meshes are held against the hull of all sums of vertices.
 *
 * PIR_TEST_HISTORIES in the environment sets the number of histories; a failure names the one and its step.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/baseline.h>
#include <pirouette/live_mesh.h>
#include <pirouette/sum.h>

#include "support/bodies.h"
#include "support/memory.h"

#define HISTORIES 300
#define RUNS      8  /* a history's motions, each with an axis and a size of step */
#define RUN_STEPS 24 /* the most steps of one */

/* How a run's axis goes on. */
enum axes { STEADY, ALTERNATING, SWINGING, EVER_NEW, ALIGNED, AXES_COUNT };

struct history {
    uint64_t number;
    int step;
    const char *situation, *last; /* what was done last besides turning */
    test_random random;
    test_memory memory; /* of the sum */
    pir_sum *sum, *walked;
    pir_live_mesh *live;
    double size; /* of the bodies, roughly */

    /* the motion */
    enum axes axes;
    pir_vec3 axis;
    double turn; /* tan of half the angle of a step */
    int steps;   /* so far in this run */
    pir_quat base, rotation;
};

#define hold(history, condition)                                                                                       \
    expect(condition, "history %llu, step %d, %s, last: %s", (unsigned long long)(history)->number, (history)->step,   \
           (history)->situation, (history)->last)

static uint32_t below(struct history *history, uint32_t count) {
    return test_random_below(&history->random, count);
}

/* --- motion --- */

static void begin_run(struct history *h) {
    static const pir_vec3 aligned[] = {{1, 0, 0}, {0, 0, 1}, {1, 1, 0}, {1, 1, 1}, {-1, 2, 0}};
    h->axes = (enum axes)below(h, AXES_COUNT);
    h->axis = h->axes == ALIGNED ? aligned[below(h, 5)] : test_random_direction(&h->random);
    // from a half of 1e-9 up; the last few are nearly half turns
    h->turn = fabs(test_random_scaled(&h->random, -31, 4));
    h->steps = 0;
    h->base = h->rotation;
    if (h->axes == ALIGNED) {
        h->base = test_integer_rotation(&h->random);
        h->turn = ldexp(1, test_random_between(&h->random, -29, 0));
    } else if (below(h, 4) == 0) {
        h->base = test_rotation(&h->random);
    }
}

static int is_middling(pir_quat q) {
    double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    return square > 0x1p-100 && square < 0x1p100;
}

static pir_quat next_rotation(struct history *h) {
    double turn = h->turn;
    pir_quat from = is_middling(h->rotation) ? h->rotation : test_integer_rotation(&h->random);
    h->steps++;
    switch (h->axes) {
    case ALTERNATING:
        turn = h->steps % 2 ? turn : -turn;
        break;
    case SWINGING:
        // some places of a swing, the same ones time and again
        from = is_middling(h->base) ? h->base : from;
        turn *= test_random_between(&h->random, -3, 3);
        break;
    case EVER_NEW:
        h->axis = test_random_direction(&h->random);
        break;
    case ALIGNED:
        // exactly about the axis of the body: all of its ties stay
        from = is_middling(h->base) ? h->base : from;
        turn *= h->steps;
        break;
    default:
        break;
    }
    pir_quat step = {h->axis.x * turn, h->axis.y * turn, h->axis.z * turn, 1};
    if (h->axes != ALIGNED && h->axes != SWINGING && below(h, 40) == 0)
        step.w = 0; // half a turn
    pir_quat next = test_compose(step, from, h->axes != ALIGNED);
    switch (below(h, 30)) {
    case 0:
        return test_hard_rotation(below(h, TEST_HARD_ROTATIONS));
    case 1:
        return h->rotation; // no motion at all
    case 2:
        return (pir_quat){-next.x, -next.y, -next.z, -next.w};
    case 3:
        return (pir_quat){next.x * 0x1p30, next.y * 0x1p30, next.z * 0x1p30, next.w * 0x1p30};
    case 4:
        return test_rotation(&h->random);
    default:
        return next;
    }
}

/* --- what happens in between --- */

static void follow_anew(struct history *h) {
    pir_live_mesh_destroy(h->live);
    h->live = NULL;
    assert_int_equal(pir_live_mesh_create(h->sum, &h->live), PIR_OK);
}

static void take(struct history *h, pir_sum *sum) {
    pir_live_mesh_destroy(h->live);
    h->live = NULL;
    pir_sum_destroy(h->sum);
    h->sum = sum;
    follow_anew(h);
}

static void clone(struct history *h) {
    pir_sum *copy = NULL;
    assert_int_equal(pir_sum_clone(h->sum, NULL, &copy), PIR_OK);
    hold(h, pir_sum_same_pairing(copy, h->sum));
    hold(h, pir_sum_tolerance(copy) == pir_sum_tolerance(h->sum));
    take(h, copy);
}

static void write_and_read(struct history *h) {
    size_t size = pir_sum_serialised_size(h->sum);
    void *bytes = malloc(size);
    pir_sum *back = NULL;
    pir_report report = {PIR_OK, ""};
    pir_allocator allocator = test_allocator(&h->memory);
    assert_non_null(bytes);
    assert_int_equal(pir_sum_serialise(h->sum, bytes, size), PIR_OK);
    expect(pir_sum_restore(bytes, size, &allocator, &report, &back) == PIR_OK, "%s", report.text);
    free(bytes);
    hold(h, pir_sum_same_pairing(back, h->sum));
    take(h, back);
}

static void scale(struct history *h) {
    static const double scales[] = {1, 0.7, 3, 0x1p-20, 1e6};
    pir_operand operand = below(h, 2) ? PIR_OPERAND_P : PIR_OPERAND_Q;
    double by = scales[below(h, 5)];
    assert_int_equal(pir_sum_set_scale(h->sum, operand, by), PIR_OK);
    assert_int_equal(pir_sum_set_scale(h->walked, operand, by), PIR_OK);
}

static void set_tolerance(struct history *h) {
    double tolerance = below(h, 3) ? h->size * ldexp(1, -test_random_between(&h->random, 2, 20)) : 0;
    assert_int_equal(pir_sum_set_tolerance(h->sum, tolerance), PIR_OK);
}

/* A cone that is kept from here on, or the whole again. */
static void set_region(struct history *h) {
    pir_vec3 axis = below(h, 2) ? test_random_direction(&h->random) : (pir_vec3){0, 0, 1};
    double half_angle = below(h, 3) ? 0.05 + 0.1 * below(h, 16) : 4;
    assert_int_equal(pir_sum_set_region(h->sum, axis, half_angle), PIR_OK);
    hold(h, pir_sum_is_valid(h->sum));
}

/* Rotations that are none, and a rotation without memory: either it is done or nothing has happened. */
static void try_in_vain(struct history *h) {
    assert_int_equal(pir_sum_rotate(h->sum, (pir_quat){0, 0, 0, 0}, PIR_METHOD_UPDATE), PIR_ERR_ZERO_QUATERNION);
    assert_int_equal(pir_sum_rotate(h->sum, (pir_quat){0, NAN, 0, 1}, PIR_METHOD_AUTO), PIR_ERR_NOT_FINITE);
    pir_quat next = test_general_rotation(&h->random), before = pir_sum_rotation(h->sum);
    static const pir_method methods[] = {PIR_METHOD_UPDATE, PIR_METHOD_WALK, PIR_METHOD_CGM};
    h->memory.fail_at = h->memory.requests + 1 + below(h, 3);
    h->memory.fail_after = true;
    pir_status status = pir_sum_rotate(h->sum, next, methods[below(h, 3)]);
    h->memory.fail_at = 0;
    hold(h, status == PIR_OK || status == PIR_ERR_MEMORY);
    pir_quat now = pir_sum_rotation(h->sum), right = status == PIR_OK ? next : before;
    hold(h, now.x == right.x && now.y == right.y && now.z == right.z && now.w == right.w);
    hold(h, pir_sum_is_valid(h->sum));
}

static void happen(struct history *h) {
    static const struct {
        const char *name;
        void (*act)(struct history *h);
    } acts[] = {{"clone", clone},       {"file", write_and_read}, {"scale", scale}, {"tolerance", set_tolerance},
                {"region", set_region}, {"vain", try_in_vain}};
    uint32_t act = below(h, 8);
    if (act < 6) {
        h->last = acts[act].name;
        acts[act].act(h);
    } else if (act == 6) {
        h->last = "reset";
        h->rotation = test_rotation(&h->random);
        assert_int_equal(pir_sum_reset(h->sum, h->rotation), PIR_OK);
    } else {
        h->last = "settle";
        assert_int_equal(pir_sum_settle(h->sum), PIR_OK);
        hold(h, pir_sum_shortfall_bound(h->sum) == 0);
        pir_sum_reset_statistics(h->sum);
    }
}

/* --- checks --- */

/* The pairing is the walk's, at the rotation that it is exact at. */
static void check_pairing(struct history *h) {
    pir_quat at = pir_sum_pairing_rotation(h->sum);
    hold(h, pir_sum_shortfall_bound(h->sum) <= pir_sum_tolerance(h->sum));
    assert_int_equal(pir_sum_rotate(h->walked, at, PIR_METHOD_WALK), PIR_OK);
    hold(h, pir_sum_same_pairing(h->sum, h->walked));
}

static void check_brute_force(struct history *h) {
    pir_quat at = pir_sum_pairing_rotation(h->sum);
    assert_int_equal(pir_sum_rotate_brute_force(h->walked, at), PIR_OK);
    hold(h, pir_sum_same_pairing(h->sum, h->walked) && pir_sum_is_valid(h->sum));
}

/* The true mesh is the hull of all sums of vertices. */
static void check_mesh(struct history *h) {
    pir_mesh *mesh = NULL, *hull = NULL;
    assert_int_equal(pir_sum_settle(h->sum), PIR_OK);
    assert_int_equal(pir_sum_mesh(h->sum, PIR_DOUBLE, &mesh), PIR_OK);
    // as the sum holds them: P reflected already where it keeps the difference
    assert_int_equal(
        pir_hull_sum(pir_sum_p(h->sum), pir_sum_q(h->sum), pir_sum_rotation(h->sum), NULL, PIR_DOUBLE, &hull), PIR_OK);
    hold(h, pir_mesh_equal(mesh, hull));
    pir_mesh_destroy(hull);
    pir_mesh_destroy(mesh);
}

/* The pairs in facet slots, empty ones left out, and the number of vertices. */
static uint32_t count_pairs(const pir_live_mesh *live, uint64_t *ret_hash, uint32_t *ret_vertices) {
    uint32_t count = 0, ends[2];
    *ret_hash = 0;
    *ret_vertices = 0;
    for (uint32_t slot = 0; slot < pir_live_mesh_facet_slots(live); slot++) {
        pir_sum_pair pair;
        if (!pir_live_mesh_pair(live, slot, &pair))
            continue;
        // slots may stand in another order: a sum of hashes does not mind
        uint64_t z = ((uint64_t)pair.kind << 62 ^ (uint64_t)pair.p << 31 ^ pair.q) * 0x9e3779b97f4a7c15u;
        *ret_hash += (z ^ z >> 29) * 0xbf58476d1ce4e5b9u;
        count++;
    }
    for (uint32_t slot = 0; slot < pir_live_mesh_vertex_slots(live); slot++)
        *ret_vertices += pir_live_mesh_vertex_pair(live, slot, ends) != 0;
    return count;
}

/* The mesh that followed holds what one made now holds. */
static void check_live(struct history *h) {
    pir_live_mesh *fresh = NULL;
    uint64_t followed_hash, fresh_hash;
    uint32_t followed_vertices, fresh_vertices;
    assert_int_equal(pir_live_mesh_refresh(h->live), PIR_OK);
    assert_int_equal(pir_live_mesh_create(h->sum, &fresh), PIR_OK);
    uint32_t followed = count_pairs(h->live, &followed_hash, &followed_vertices);
    uint32_t made = count_pairs(fresh, &fresh_hash, &fresh_vertices);
    hold(h, followed == made && followed_hash == fresh_hash && followed_vertices == fresh_vertices);
    pir_live_mesh_destroy(fresh);
}

static void take_step(struct history *h) {
    static const pir_method methods[] = {PIR_METHOD_UPDATE, PIR_METHOD_UPDATE, PIR_METHOD_UPDATE, PIR_METHOD_AUTO,
                                         PIR_METHOD_AUTO,   PIR_METHOD_AUTO,   PIR_METHOD_WALK,   PIR_METHOD_CGM};
    h->step++;
    h->rotation = next_rotation(h);
    assert_int_equal(pir_sum_rotate(h->sum, h->rotation, methods[below(h, 8)]), PIR_OK);
    check_pairing(h);
    if (below(h, 8) == 0)
        check_live(h);
    if (below(h, 24) == 0)
        check_brute_force(h);
    if (below(h, 48) == 0)
        check_mesh(h);
    if (below(h, 12) == 0) {
        happen(h);
        check_pairing(h);
    }
}

static void make_history(struct history *h) {
    test_pose pose;
    // mostly small bodies, where much happens at once; some that update by a few certificates at a time
    test_random_pose(&h->random, below(h, 4) ? 16 : below(h, 4) ? 60 : 250, &pose);
    pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
    pir_allocator allocator = test_allocator(&h->memory);
    pir_sum_options options = {.size = sizeof options, .allocator = NULL, .difference = below(h, 2) != 0};
    h->situation = pose.situation;
    h->last = "nothing";
    h->rotation = pose.rotation;
    h->size = fmin(test_size_of(p), test_size_of(q));
    assert_int_equal(pir_sum_create(p, q, pose.rotation, &options, &h->walked), PIR_OK);
    options.allocator = &allocator;
    assert_int_equal(pir_sum_create(p, q, pose.rotation, &options, &h->sum), PIR_OK);
    follow_anew(h);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void sum_is_right_whatever_its_history(void **state) {
    (void)state;
    const char *asked = getenv("PIR_TEST_HISTORIES");
    uint64_t histories = asked ? strtoull(asked, NULL, 10) : HISTORIES;
    for (uint64_t number = 0; number < histories; number++) {
        struct history h = {.number = number, .random = test_random_case("histories", number)};
        make_history(&h);
        for (int run = 0; run < RUNS; run++) {
            begin_run(&h);
            for (uint32_t left = 1 + below(&h, RUN_STEPS); left > 0; left--)
                take_step(&h);
        }
        check_brute_force(&h);
        pir_live_mesh_destroy(h.live);
        pir_sum_destroy(h.sum);
        pir_sum_destroy(h.walked);
        expect(h.memory.blocks == 0 && !h.memory.wrong_size, "history %llu: memory", (unsigned long long)number);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(sum_is_right_whatever_its_history)};
    return cmocka_run_group_tests_name("histories", tests, NULL, NULL);
}
