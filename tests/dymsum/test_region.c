/* SPDX-License-Identifier: MIT */
/*
 * Regions: what a sum with a cone keeps is the whole sum's part in it, however the bodies turn and the cone moves; a
 * sum whose memory runs out stays whole at the region it had; and nothing allocates after the warm-up.
 *
 * PIR_TEST_ROUNDS in the environment makes the random tests so many times as long.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/baseline.h>
#include <pirouette/live_mesh.h>
#include <pirouette/sum.h>

#include "support/bodies.h"
#include "support/memory.h"
#include "support/meshes.h"

struct sums {
    pir_polytope *p, *q;
    pir_sum *tracked, *whole;
    pir_vec3 axis;
    double half_angle;
};

static void sums_init(struct sums *s, const test_pose *pose, int difference) {
    pir_sum_options options = pir_sum_options_default();
    options.difference = difference;
    s->p = test_polytope(&pose->p);
    s->q = test_polytope(&pose->q);
    assert_int_equal(pir_sum_create(s->p, s->q, pose->rotation, &options, &s->tracked), PIR_OK);
    assert_int_equal(pir_sum_create(s->p, s->q, pose->rotation, &options, &s->whole), PIR_OK);
}

static void sums_clear(struct sums *s) {
    pir_sum_destroy(s->whole);
    pir_sum_destroy(s->tracked);
    pir_polytope_release(s->q);
    pir_polytope_release(s->p);
}

static void set_region(struct sums *s, pir_vec3 axis, double half_angle) {
    s->axis = axis;
    s->half_angle = half_angle;
    assert_int_equal(pir_sum_set_region(s->tracked, axis, half_angle), PIR_OK);
}

static void clear_region(struct sums *s) {
    s->half_angle = 4;
    assert_int_equal(pir_sum_clear_region(s->tracked), PIR_OK);
}

/* A pose of two bodies with so many points of the sphere each. */
static test_pose spheres(test_random *random, size_t of_p, size_t of_q) {
    test_pose pose = {.situation = "many facets", .rotation = {0.1, 0.2, 0.3, 0.9}};
    test_body_points(random, TEST_SPHERE, of_p, &pose.p);
    test_body_points(random, TEST_SPHERE, of_q, &pose.q);
    return pose;
}

/* An update of the tracked sum, and a proof of all that it keeps. */
static void update_and_prove(struct sums *s, pir_quat r, uint64_t number, int frame) {
    assert_int_equal(pir_sum_rotate(s->tracked, r, PIR_METHOD_UPDATE), PIR_OK);
    expect(pir_sum_is_valid(s->tracked), "case %llu, frame %d", (unsigned long long)number, frame);
}

/* Whether every pair that is in the tracked sum is one of the whole sum, and those in the cone are all there. */
static const char *compare(const struct sums *s) {
    const uint32_t *fv = pir_sum_fv(s->tracked), *vf = pir_sum_vf(s->tracked);
    const uint32_t *all_fv = pir_sum_fv(s->whole), *all_vf = pir_sum_vf(s->whole);
    for (uint32_t f = 0; f < pir_polytope_facet_count(s->p); f++)
        if (fv[f] != PIR_NO_PAIR && fv[f] != all_fv[f])
            return "an fv pair that is none";
    for (uint32_t g = 0; g < pir_polytope_facet_count(s->q); g++)
        if (vf[g] != PIR_NO_PAIR && vf[g] != all_vf[g])
            return "a vf pair that is none";
    if (!pir_sum_same_pairing(s->tracked, s->whole) || !pir_sum_same_pairing(s->whole, s->tracked))
        return "a pair in the cone that is missing";
    // a part of the whole list, in its order
    uint32_t count = pir_sum_ee_count(s->tracked), all = pir_sum_ee_count(s->whole), at = 0;
    uint32_t(*ee)[2] = test_calloc((count + all + 1), sizeof *ee), (*all_ee)[2] = ee + count;
    pir_sum_ee(s->tracked, ee);
    pir_sum_ee(s->whole, all_ee);
    for (uint32_t i = 0; i < all && at < count; i++)
        at += memcmp(ee[at], all_ee[i], sizeof *ee) == 0;
    test_free(ee);
    return at == count ? NULL : "an ee pair that is none";
}

/* Whether it differs from the whole sum at all. */
static int is_partial(const struct sums *s) {
    const uint32_t *fv = pir_sum_fv(s->tracked), *vf = pir_sum_vf(s->tracked);
    for (uint32_t f = 0; f < pir_polytope_facet_count(s->p); f++)
        if (fv[f] == PIR_NO_PAIR)
            return 1;
    for (uint32_t g = 0; g < pir_polytope_facet_count(s->q); g++)
        if (vf[g] == PIR_NO_PAIR)
            return 1;
    return 0;
}

/* The axis turned by about `angle` some way. */
static pir_vec3 nudge(test_random *random, pir_vec3 axis, double angle) {
    pir_vec3 d = test_random_direction(random);
    double n = sqrt(axis.x * axis.x + axis.y * axis.y + axis.z * axis.z);
    return (pir_vec3){axis.x / n + angle * d.x, axis.y / n + angle * d.y, axis.z / n + angle * d.z};
}

/* `by` after `from`, or by itself where the lengths of the two leave nothing of the product. */
static pir_quat after(pir_quat by, pir_quat from) {
    pir_quat r = test_compose(by, from, 1);
    double sum = fabs(r.x) + fabs(r.y) + fabs(r.z) + fabs(r.w);
    return isfinite(sum) && sum > 0.5 ? r : by;
}

static pir_quat turn(pir_quat from, pir_vec3 axis, double angle) {
    double s = sin(angle / 2);
    return after((pir_quat){axis.x * s, axis.y * s, axis.z * s, cos(angle / 2)}, from);
}

static void run_frames(struct sums *s, test_random *random, uint64_t number, const char *situation, pir_quat r,
                       int frames, uint32_t *partial) {
    static const double steps[] = {1e-4, 2e-3, 0.0126, 0.05, 0.4}, drifts[] = {0, 1e-3, 0.01, 0.1};
    static const double sizes[] = {0, 0.1, 0.26, 0.52, 1.05, 1.57, 2.5, 3.1};
    double step = steps[test_random_below(random, 5)], drift = drifts[test_random_below(random, 4)];
    bool returns = test_random_below(random, 3) == 0;
    pir_quat middle = r;
    pir_vec3 axis = test_random_direction(random);
    set_region(s, test_random_below(random, 2) ? test_random_direction(random) : (pir_vec3){0, 0, 5},
               sizes[test_random_below(random, 8)]);
    for (int frame = 0; frame < frames; frame++) {
        uint32_t what = (uint32_t)test_random_below(random, 40);
        if (what == 0)
            axis = test_random_direction(random);
        if (what == 1)
            r = test_rotation(random);
        else if (what == 2)
            r = after(test_integer_rotation(random), r);
        else
            r = returns ? turn(middle, axis, step * test_random_between(random, -2, 2)) : turn(r, axis, step);
        if (what < 3)
            middle = r;
        pir_method method = what == 3   ? PIR_METHOD_AUTO
                            : what == 4 ? PIR_METHOD_WALK
                            : what == 5 ? PIR_METHOD_CGM
                                        : PIR_METHOD_UPDATE;
        if (what == 6)
            assert_int_equal(pir_sum_rotate_brute_force(s->tracked, r), PIR_OK);
        else
            assert_int_equal(pir_sum_rotate(s->tracked, r, method), PIR_OK);
        assert_int_equal(pir_sum_rotate(s->whole, r, PIR_METHOD_WALK), PIR_OK);
        if (what == 7)
            set_region(s, test_random_direction(random), sizes[test_random_below(random, 8)]);
        else if (what == 8)
            clear_region(s);
        else if (drift > 0)
            set_region(s, nudge(random, s->axis, drift), s->half_angle);
        const char *wrong = compare(s);
        expect(!wrong, "case %llu, frame %d, %s, cone %g, step %g, drift %g, %u: %s", (unsigned long long)number, frame,
               situation, s->half_angle, step, drift, what, wrong);
        if (frame % 8 == 0)
            expect(pir_sum_is_valid(s->tracked), "case %llu, frame %d, %s", (unsigned long long)number, frame,
                   situation);
        *partial += (uint32_t)is_partial(s);
    }
}

static uint64_t rounds(void) {
    const char *asked = getenv("PIR_TEST_ROUNDS");
    return asked ? strtoull(asked, NULL, 10) : 1;
}

static void tracked_region_is_the_part_of_the_whole_sum_in_the_cone(void **state) {
    (void)state;
    uint32_t partial = 0;
    for (uint64_t i = 0; i < 300 * rounds(); i++) {
        test_random random = test_random_case("region", i);
        test_pose pose;
        struct sums s;
        test_random_pose(&random, i % 4 ? 16 : 60, &pose);
        sums_init(&s, &pose, i % 2);
        run_frames(&s, &random, i, pose.situation, pose.rotation, 40, &partial);
        sums_clear(&s);
    }
    assert_true(partial > 2000);
}

static void many_facets_are_tracked_in_a_cone(void **state) {
    (void)state;
    uint32_t partial = 0;
    for (uint64_t i = 0; i < 40 * rounds(); i++) {
        test_random random = test_random_case("region of spheres", i);
        test_pose pose = {.situation = "two spheres"};
        struct sums s;
        test_body_points(&random, i % 3 ? TEST_SPHERE : TEST_BALL, 120, &pose.p);
        test_body_points(&random, TEST_SPHERE, 140, &pose.q);
        pose.rotation = test_general_rotation(&random);
        sums_init(&s, &pose, i % 2);
        run_frames(&s, &random, i, pose.situation, pose.rotation, 60, &partial);
        sums_clear(&s);
    }
    assert_true(partial > 1000);
}

static void jumps_out_of_a_thin_skin_are_right(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 300; i++) {
        test_random random = test_random_case("region jumps", i);
        test_pose pose = {.situation = "short arcs over large cells"};
        struct sums s;
        test_body_points(&random, TEST_SPHERE, 40, &pose.p);
        test_body_points(&random, TEST_SPHERE, 8, &pose.q);
        pose.rotation = after(test_general_rotation(&random), (pir_quat){0, 0, 0, 1});
        sums_init(&s, &pose, i % 2);
        set_region(&s, test_random_direction(&random), 0.1 + 0.2 * (double)test_random_below(&random, 3));
        pir_quat r = pose.rotation;
        for (int frame = 0; frame < 60; frame++) {
            // small steps make the skin thin, then one leads far
            double angle = frame % 5 < 4 ? 1e-4 : 0.05 + 0.05 * (1 + test_random_unit(&random));
            r = turn(r, test_random_direction(&random), angle);
            assert_int_equal(pir_sum_rotate(s.tracked, r, PIR_METHOD_UPDATE), PIR_OK);
            assert_int_equal(pir_sum_rotate(s.whole, r, PIR_METHOD_WALK), PIR_OK);
            const char *wrong = compare(&s);
            expect(!wrong, "case %llu, frame %d: %s", (unsigned long long)i, frame, wrong);
        }
        sums_clear(&s);
    }
}

/*
 * A jump out of the cover can carry the edges at its rim over facets that were inactive before and are active after it.
 * No event tells the edges. Only a proof of what is kept beyond the cone shows that, for one frame.
 */
static void jumps_over_inactive_facets_are_right(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 8; i++) {
        test_random random = test_random_case("region jumps", i);
        test_pose pose = spheres(&random, 500, 200);
        struct sums s;
        sums_init(&s, &pose, i % 2);
        pir_quat r = pose.rotation;
        for (int frame = 0; frame < 100; frame++) {
            pir_vec3 a = test_random_direction(&random), d = test_random_direction(&random);
            pir_vec3 k = {a.y * d.z - a.z * d.y, a.z * d.x - a.x * d.z, a.x * d.y - a.y * d.x};
            double length = sqrt(k.x * k.x + k.y * k.y + k.z * k.z);
            set_region(&s, a, 4);
            set_region(&s, a, 0.3 + fabs(test_random_unit(&random)));
            r = turn(r, (pir_vec3){k.x / length, k.y / length, k.z / length},
                     0.1 + 0.024 * fabs(test_random_unit(&random)));
            update_and_prove(&s, r, i, frame);
        }
        sums_clear(&s);
    }
}

/* About the region's own axis, where the cover holds for good, and about axes near it; more
   than a radian a step too. */
static void spins_within_the_skin_are_right(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 12; i++) {
        test_random random = test_random_case("region spins", i);
        test_pose pose = spheres(&random, 20 + 20 * (size_t)i, 240);
        struct sums s;
        sums_init(&s, &pose, 0);
        pir_quat r = pose.rotation;
        pir_vec3 axis = test_random_direction(&random);
        set_region(&s, axis, 0.2 * (double)(i + 1));
        for (int frame = 0; frame < 40; frame++) {
            r = turn(r, i % 2 ? axis : nudge(&random, axis, 0.02), 0.03 * (double)test_random_below(&random, 40));
            update_and_prove(&s, r, i, frame);
        }
        sums_clear(&s);
    }
}

/* Whatever a motion has needed once, it does not ask for again. */
static void tracking_a_region_allocates_nothing_after_the_warm_up(void **state) {
    (void)state;
    test_random random = test_random_case("region allocations", 0);
    pir_polytope *p = test_sphere(&random, 100), *q = test_sphere(&random, 90);
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_sum_options options = {.size = sizeof options, .allocator = &allocator, .difference = true};
    pir_sum *sum = NULL;
    pir_quat r = {0.1, 0.2, 0.3, 0.9};
    pir_vec3 axis = {1, 2, 2}, about = {0, 0, 1};
    uint64_t requests = 0;
    assert_int_equal(pir_sum_create(p, q, r, &options, &sum), PIR_OK);
    for (int frame = 0; frame < 3000; frame++) {
        if (frame % 50 == 0)
            about = test_random_direction(&random);
        r = turn(r, about, frame % 500 == 499 ? 1 : 0.0126);
        axis = nudge(&random, axis, 0.02);
        assert_int_equal(pir_sum_rotate(sum, r, PIR_METHOD_AUTO), PIR_OK);
        assert_int_equal(pir_sum_set_region(sum, axis, frame % 200 < 150 ? 0.5 : frame % 200 < 175 ? 1 : 4), PIR_OK);
        if (frame == 300)
            requests = memory.requests;
    }
    assert_int_equal(memory.requests, requests);
    pir_sum_destroy(sum);
    assert_int_equal(memory.blocks, 0);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void bad_regions_are_refused(void **state) {
    (void)state;
    test_random random = test_random_case("region arguments", 0);
    pir_polytope *p = test_sphere(&random, 20);
    pir_sum *sum = NULL;
    pir_vec3 axis = {7, 7, 7};
    double half_angle = 7;
    assert_int_equal(pir_sum_create(p, p, (pir_quat){0, 0, 0, 1}, NULL, &sum), PIR_OK);
    assert_int_equal(pir_sum_set_region(NULL, (pir_vec3){0, 0, 1}, 1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_set_region(sum, (pir_vec3){0, 0, 0}, 1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_set_region(sum, (pir_vec3){0, 0, 1}, -1e-9), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_set_region(sum, (pir_vec3){0, NAN, 1}, 1), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_sum_set_region(sum, (pir_vec3){0, 0, 1}, INFINITY), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_sum_region(sum, &axis, &half_angle), 0);
    assert_true(axis.x == 7 && half_angle == 7);
    // of any length
    assert_int_equal(pir_sum_set_region(sum, (pir_vec3){0, 0, 1e-320}, 0.5), PIR_OK);
    assert_int_equal(pir_sum_region(sum, &axis, &half_angle), 1);
    assert_true(axis.x == 0 && axis.y == 0 && axis.z == 1 && half_angle == 0.5);
    assert_int_equal(pir_sum_set_region(sum, (pir_vec3){1e308, 1e308, 1e308}, 0.5), PIR_OK);
    assert_true(pir_sum_is_valid(sum));
    assert_int_equal(pir_sum_set_region(sum, (pir_vec3){1, 0, 0}, 3.15), PIR_OK);
    assert_int_equal(pir_sum_region(sum, &axis, &half_angle), 0);
    assert_true(pir_sum_is_valid(sum));
    pir_sum_destroy(sum);
    pir_polytope_release(p);
}

static void a_cleared_region_leaves_the_whole_sum(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 20; i++) {
        test_random random = test_random_case("cleared regions", i);
        test_pose pose;
        struct sums s;
        test_random_pose(&random, 24, &pose);
        sums_init(&s, &pose, i % 2);
        assert_int_equal(pir_sum_clear_region(s.tracked), PIR_OK);
        set_region(&s, test_random_direction(&random), 0.4);
        pir_quat there = test_general_rotation(&random);
        assert_int_equal(pir_sum_rotate(s.tracked, there, PIR_METHOD_UPDATE), PIR_OK);
        assert_int_equal(pir_sum_rotate(s.whole, there, PIR_METHOD_WALK), PIR_OK);
        clear_region(&s);
        pir_vec3 axis;
        double half_angle;
        assert_int_equal(pir_sum_region(s.tracked, &axis, &half_angle), 0);
        size_t of_p = pir_polytope_facet_count(s.p), of_q = pir_polytope_facet_count(s.q);
        assert_memory_equal(pir_sum_fv(s.tracked), pir_sum_fv(s.whole), of_p * sizeof(uint32_t));
        assert_memory_equal(pir_sum_vf(s.tracked), pir_sum_vf(s.whole), of_q * sizeof(uint32_t));
        assert_int_equal(pir_sum_ee_count(s.tracked), pir_sum_ee_count(s.whole));
        assert_true(pir_sum_is_valid(s.tracked) && pir_sum_same_pairing(s.tracked, s.whole));
        sums_clear(&s);
    }
    assert_int_equal(pir_sum_clear_region(NULL), PIR_ERR_ARGUMENT);
}

static void clone_mesh_reset_and_scale_go_with_a_region(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 30; i++) {
        test_random random = test_random_case("region copies", i);
        test_pose pose;
        struct sums s;
        test_random_pose(&random, 24, &pose);
        pose.rotation = after(test_general_rotation(&random), (pir_quat){0, 0, 0, 1});
        sums_init(&s, &pose, i % 2);
        set_region(&s, test_random_direction(&random), 0.4);
        pir_sum *clone = NULL;
        assert_int_equal(pir_sum_clone(s.tracked, NULL, &clone), PIR_OK);
        assert_true(pir_sum_is_valid(clone) && pir_sum_same_pairing(clone, s.tracked));
        assert_memory_equal(pir_sum_fv(clone), pir_sum_fv(s.tracked), pir_polytope_facet_count(s.p) * sizeof(uint32_t));
        assert_int_equal(pir_sum_ee_count(clone), pir_sum_ee_count(s.tracked));
        pir_mesh *mine = NULL, *all = NULL;
        assert_int_equal(pir_sum_mesh(clone, PIR_EXACT, &mine), PIR_OK);
        assert_int_equal(pir_sum_mesh(s.whole, PIR_EXACT, &all), PIR_OK);
        assert_true(pir_mesh_equal(mine, all));
        pir_mesh_destroy(mine);
        pir_mesh_destroy(all);
        assert_int_equal(pir_sum_set_scale(clone, PIR_OPERAND_P, 0.37), PIR_OK);
        pir_quat r = pose.rotation;
        for (int frame = 0; frame < 20; frame++) {
            r = turn(r, (pir_vec3){0.6, 0, 0.8}, 0.03);
            if (frame % 7 == 6)
                assert_int_equal(pir_sum_reset(clone, r), PIR_OK);
            assert_int_equal(pir_sum_rotate(clone, r, PIR_METHOD_UPDATE), PIR_OK);
            assert_int_equal(pir_sum_rotate(s.whole, r, PIR_METHOD_WALK), PIR_OK);
            assert_true(pir_sum_same_pairing(clone, s.whole) && pir_sum_is_valid(clone));
        }
        pir_sum_destroy(clone);
        sums_clear(&s);
    }
}

/* A live mesh with the same cone holds the same facets whether the sum under it is whole or not. */
static void live_mesh_of_a_region_has_its_facets(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 20; i++) {
        test_random random = test_random_case("region live", i);
        test_pose pose = {.situation = "two spheres"};
        struct sums s;
        test_body_points(&random, TEST_SPHERE, 40, &pose.p);
        test_body_points(&random, TEST_SPHERE, 30, &pose.q);
        pose.rotation = after(test_general_rotation(&random), (pir_quat){0, 0, 0, 1});
        sums_init(&s, &pose, 0);
        pir_live_mesh *live[2];
        assert_int_equal(pir_live_mesh_create(s.tracked, &live[0]), PIR_OK);
        assert_int_equal(pir_live_mesh_create(s.whole, &live[1]), PIR_OK);
        pir_quat r = pose.rotation;
        pir_vec3 axis = test_random_direction(&random);
        for (int frame = 0; frame < 30; frame++) {
            r = turn(r, (pir_vec3){0.6, 0, 0.8}, 0.03);
            axis = nudge(&random, axis, 0.05);
            set_region(&s, axis, 0.7);
            assert_int_equal(pir_sum_rotate(s.tracked, r, PIR_METHOD_UPDATE), PIR_OK);
            assert_int_equal(pir_sum_rotate(s.whole, r, PIR_METHOD_UPDATE), PIR_OK);
            uint32_t pairs[2][3] = {{0}};
            for (int k = 0; k < 2; k++) {
                assert_int_equal(pir_live_mesh_set_region(live[k], axis, 0.7), PIR_OK);
                assert_int_equal(pir_live_mesh_refresh(live[k]), PIR_OK);
                for (uint32_t slot = 0; slot < pir_live_mesh_facet_slots(live[k]); slot++) {
                    pir_sum_pair pair;
                    if (pir_live_mesh_pair(live[k], slot, &pair))
                        pairs[k][pair.kind]++;
                }
            }
            assert_memory_equal(pairs[0], pairs[1], sizeof pairs[0]);
        }
        pir_live_mesh_destroy(live[0]);
        pir_live_mesh_destroy(live[1]);
        sums_clear(&s);
    }
}

/* With a tolerance the pairing stays behind only while what it keeps is what the region needs at either rotation. */
static void region_and_tolerance_agree(void **state) {
    (void)state;
    uint32_t behind = 0;
    for (uint64_t i = 0; i < 20; i++) {
        test_random random = test_random_case("region tolerance", i);
        test_pose pose = {.situation = "two spheres"};
        struct sums s;
        test_body_points(&random, TEST_SPHERE, 40, &pose.p);
        test_body_points(&random, TEST_SPHERE, 30, &pose.q);
        pose.rotation = after(test_general_rotation(&random), (pir_quat){0, 0, 0, 1});
        sums_init(&s, &pose, 0);
        assert_int_equal(pir_sum_set_tolerance(s.tracked, 0.05), PIR_OK);
        pir_quat r = pose.rotation;
        pir_vec3 axis = test_random_direction(&random);
        for (int frame = 0; frame < 60; frame++) {
            r = turn(r, (pir_vec3){0.6, 0, 0.8}, 0.004);
            axis = nudge(&random, axis, 0.004);
            set_region(&s, axis, 0.5);
            assert_int_equal(pir_sum_rotate(s.tracked, r, PIR_METHOD_UPDATE), PIR_OK);
            behind += pir_sum_shortfall_bound(s.tracked) > 0;
            assert_int_equal(pir_sum_rotate(s.whole, pir_sum_pairing_rotation(s.tracked), PIR_METHOD_WALK), PIR_OK);
            assert_true(pir_sum_same_pairing(s.tracked, s.whole) && pir_sum_is_valid(s.tracked));
        }
        assert_int_equal(pir_sum_settle(s.tracked), PIR_OK);
        assert_int_equal(pir_sum_rotate(s.whole, r, PIR_METHOD_WALK), PIR_OK);
        assert_true(pir_sum_same_pairing(s.tracked, s.whole) && pir_sum_is_valid(s.tracked));
        sums_clear(&s);
    }
    assert_true(behind > 100);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tracked_region_is_the_part_of_the_whole_sum_in_the_cone),
        cmocka_unit_test(many_facets_are_tracked_in_a_cone),
        cmocka_unit_test(jumps_out_of_a_thin_skin_are_right),
        cmocka_unit_test(jumps_over_inactive_facets_are_right),
        cmocka_unit_test(spins_within_the_skin_are_right),
        cmocka_unit_test(tracking_a_region_allocates_nothing_after_the_warm_up),
        cmocka_unit_test(bad_regions_are_refused),
        cmocka_unit_test(a_cleared_region_leaves_the_whole_sum),
        cmocka_unit_test(clone_mesh_reset_and_scale_go_with_a_region),
        cmocka_unit_test(live_mesh_of_a_region_has_its_facets),
        cmocka_unit_test(region_and_tolerance_agree),
    };
    return cmocka_run_group_tests_name("region", tests, NULL, NULL);
}
