/* SPDX-License-Identifier: MIT */
/*
 * What a region costs: it keeps what is near its cone and nothing else, and small steps ask for less than those of
 * the whole sum.
 */
#include <math.h>

#include "dymsum/region/cover.h"
#include "dymsum/sum.h"
#include "polytope/polytope.h"
#include "support/bodies.h"
#include "support/test.h"
#include "support/vectors.h"

/* Radians that the floats of the sweep may give away. */
#define SLACK 2e-3

struct sums {
    pir_polytope *p, *q;
    pir_sum *tracked, *whole;
};

static void sums_init(struct sums *s, pir_polytope *p, pir_polytope *q, pir_quat r) {
    *s = (struct sums){.p = p, .q = q};
    assert_int_equal(pir_sum_create(p, q, r, NULL, &s->tracked), PIR_OK);
    assert_int_equal(pir_sum_create(p, q, r, NULL, &s->whole), PIR_OK);
}

static void sums_clear(struct sums *s) {
    pir_sum_destroy(s->whole);
    pir_sum_destroy(s->tracked);
    pir_polytope_release(s->q);
    pir_polytope_release(s->p);
}

static double angle_between(pir_vec3 a, pir_vec3 b) {
    return atan2(test_length(test_cross(a, b)), test_dot(a, b));
}

/* How far a direction is from the arc of a halfedge in the Gaussian map. */
static double angle_to_arc(const pir_polytope *p, uint32_t half, pir_vec3 axis) {
    pir_vec3 from = p->normal[p->left[half]], to = p->normal[pir_right(p, half)], across = test_cross(from, to);
    if (test_dot(test_cross(from, axis), across) >= 0 && test_dot(test_cross(axis, to), across) >= 0)
        return asin(fmin(1, fabs(test_dot(axis, across)) / test_length(across)));
    return fmin(angle_between(axis, from), angle_between(axis, to));
}

/* How near to the axis any arc at a facet comes. */
static double nearest_arc(const pir_polytope *p, uint32_t f, pir_vec3 axis) {
    double least = 4;
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
        least = fmin(least, angle_to_arc(p, p->loop[i], axis));
    return least;
}

/* After a cone was set on a whole sum the skins and the stride are the least ones: what is kept follows from them. */
static void what_is_kept_is_what_comes_near_the_cone(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("region kept", i);
        pir_quat r = test_general_rotation(&random);
        pir_polytope *p = test_sphere(&random, 60 + 20 * (i % 5)), *q = test_sphere(&random, 150);
        pir_vec3 axis = test_random_direction(&random), axis_p = test_turn(r, axis, -1);
        double half_angle = 0.1 + 0.1 * (double)(i % 4), reach = half_angle + PIR_LEAST_SKIN, farthest = reach;
        struct sums s;
        sums_init(&s, p, q, r);
        assert_int_equal(pir_sum_set_region(s.tracked, axis, half_angle), PIR_OK);
        const uint32_t *fv = pir_sum_fv(s.tracked), *vf = pir_sum_vf(s.tracked);
        for (uint32_t f = 0; f < p->facet_count; f++) {
            double near = nearest_arc(p, f, axis_p);
            expect(fv[f] != PIR_NO_PAIR || near > reach - SLACK, "case %llu: facet %u of P at %g",
                   (unsigned long long)i, f, near);
            expect(fv[f] == PIR_NO_PAIR || near < reach + SLACK, "case %llu: facet %u of P at %g",
                   (unsigned long long)i, f, near);
            if (fv[f] != PIR_NO_PAIR)
                farthest = fmax(farthest, angle_between(axis_p, p->normal[f]));
        }
        assert_true(farthest < 1.5);
        double reach_q = farthest + 2 * PIR_LEAST_SKIN + PIR_LEAST_STRIDE;
        for (uint32_t g = 0; g < q->facet_count; g++) {
            double near = angle_between(axis, q->normal[g]);
            expect(vf[g] != PIR_NO_PAIR || near > reach_q - SLACK, "case %llu: facet %u of Q at %g",
                   (unsigned long long)i, g, near);
            expect(vf[g] == PIR_NO_PAIR || near < reach_q + SLACK, "case %llu: facet %u of Q at %g",
                   (unsigned long long)i, g, near);
        }
        uint32_t count = pir_sum_ee_count(s.tracked), (*ee)[2] = test_calloc(count + 1, sizeof *ee);
        pir_sum_ee(s.tracked, ee);
        for (uint32_t k = 0; k < count; k++)
            expect(angle_to_arc(p, p->edge_half[ee[k][0]], axis_p) < reach + SLACK, "case %llu: a crossing on edge %u",
                   (unsigned long long)i, ee[k][0]);
        test_free(ee);
        sums_clear(&s);
    }
}

/* Expects that the sum keeps the facets of Q within `reach` of the axis, and of P those with an arc within it. */
static void expect_kept(const struct sums *s, pir_quat r, pir_vec3 axis, double reach, const char *what, uint64_t i) {
    const uint32_t *fv = pir_sum_fv(s->tracked), *vf = pir_sum_vf(s->tracked);
    pir_vec3 axis_p = test_turn(r, axis, -1);
    for (uint32_t f = 0; f < s->p->facet_count; f++) {
        double near = nearest_arc(s->p, f, axis_p);
        expect(fabs(near - reach) < SLACK || (fv[f] != PIR_NO_PAIR) == (near < reach), "case %llu, %s: facet %u of P",
               (unsigned long long)i, what, f);
    }
    for (uint32_t g = 0; g < s->q->facet_count; g++) {
        double near = angle_between(axis, s->q->normal[g]);
        expect(fabs(near - reach) < SLACK || (vf[g] != PIR_NO_PAIR) == (near < reach), "case %llu, %s: facet %u of Q",
               (unsigned long long)i, what, g);
    }
    expect(pir_sum_is_valid(s->tracked), "case %llu, %s", (unsigned long long)i, what);
}

static uint64_t signs_asked(const pir_sum *sum) {
    const pir_sum_statistics did = pir_sum_get_statistics(sum);
    return did.by_filter + did.by_exact + did.by_perturbation;
}

static pir_quat turn(pir_quat from, pir_vec3 axis, double angle) {
    double s = sin(angle / 2);
    return test_compose((pir_quat){axis.x * s, axis.y * s, axis.z * s, cos(angle / 2)}, from, 1);
}

/*
 * A walk keeps the cone with the least skin where the axis has moved since the walk before, and alone where it has
 * rested. What it keeps is no ground for an update, however small the step.
 */
static void walks_keep_no_more_than_the_cone(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 40; i++) {
        test_random random = test_random_case("region walks", i);
        struct sums s;
        pir_vec3 about = test_random_direction(&random), axis = test_random_direction(&random);
        pir_quat r = turn((pir_quat){0, 0, 0, 1}, test_random_direction(&random), 1);
        sums_init(&s, test_sphere(&random, 60 + 20 * (i % 5)), test_sphere(&random, 150), r);
        // beyond a quarter turn too
        double half_angle = 0.1 + 0.45 * (double)(i % 4);
        assert_int_equal(pir_sum_set_region(s.tracked, axis, half_angle), PIR_OK);
        for (int round = 0; round < 3; round++) {
            assert_int_equal(pir_sum_rotate(s.tracked, r = turn(r, about, 0.1), PIR_METHOD_WALK), PIR_OK);
            expect_kept(&s, r, axis, half_angle + PIR_LEAST_SKIN, "a walk after a choice", i);
            // within the skin nothing is chosen
            axis = test_turn(turn((pir_quat){0, 0, 0, 1}, about, 0x1p-7), axis, 1);
            assert_int_equal(pir_sum_set_region(s.tracked, axis, half_angle), PIR_OK);
            assert_true(s.tracked->region.cover.stride == PIR_NO_STRIDE);
            assert_int_equal(pir_sum_rotate(s.tracked, r = turn(r, about, 0.1), PIR_METHOD_WALK), PIR_OK);
            expect_kept(&s, r, axis, half_angle + PIR_LEAST_SKIN, "a walk after the axis has moved", i);
            for (int k = 0; k < 2; k++) {
                assert_int_equal(pir_sum_rotate(s.tracked, r = turn(r, about, 0.1), PIR_METHOD_WALK), PIR_OK);
                expect_kept(&s, r, axis, half_angle + PIR_RESTING_SKIN, "a walk after a walk", i);
            }
            r = turn(r, about, round == 0 ? 0 : 0x1p-20 * test_random_unit(&random));
            assert_int_equal(pir_sum_rotate(s.tracked, r, PIR_METHOD_UPDATE), PIR_OK);
            assert_true(s.tracked->region.cover.stride >= PIR_LEAST_STRIDE);
            assert_int_equal(pir_sum_rotate(s.whole, r, PIR_METHOD_WALK), PIR_OK);
            expect(pir_sum_is_valid(s.tracked) && pir_sum_same_pairing(s.tracked, s.whole), "case %llu, round %d",
                   (unsigned long long)i, round);
        }
        sums_clear(&s);
    }
}

static void small_steps_ask_for_less_in_a_cone(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 8; i++) {
        test_random random = test_random_case("region work", i);
        struct sums s;
        pir_quat r = turn((pir_quat){0, 0, 0, 1}, test_random_direction(&random), 1);
        pir_polytope *p = test_sphere(&random, 150), *q = test_sphere(&random, 150);
        sums_init(&s, p, q, r);
        assert_int_equal(pir_sum_set_region(s.tracked, test_random_direction(&random), 0.3), PIR_OK);
        pir_vec3 axis = test_random_direction(&random);
        for (int frame = 0; frame < 200; frame++) {
            if (frame == 10) {
                pir_sum_reset_statistics(s.tracked);
                pir_sum_reset_statistics(s.whole);
            }
            r = turn(r, axis, 1e-3);
            assert_int_equal(pir_sum_rotate(s.tracked, r, PIR_METHOD_UPDATE), PIR_OK);
            assert_int_equal(pir_sum_rotate(s.whole, r, PIR_METHOD_UPDATE), PIR_OK);
        }
        uint64_t part = signs_asked(s.tracked), all = signs_asked(s.whole);
        expect(2 * part < all, "case %llu: %llu signs in the cone, %llu in all", (unsigned long long)i,
               (unsigned long long)part, (unsigned long long)all);
        sums_clear(&s);
    }
}

/* Sweeps have numbers of 32 bits: what an old one marked counts for nothing when they begin again. */
static void numbers_of_sweeps_begin_again(void **state) {
    (void)state;
    static const pir_vec3 axes[7] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0}};
    for (uint32_t before = 0; before < 4; before++) {
        test_random random = test_random_case("sweeps", before);
        struct sums s;
        pir_polytope *p = test_sphere(&random, 60), *q = test_sphere(&random, 60);
        sums_init(&s, p, q, test_general_rotation(&random));
        for (int i = 0; i < 7; i++) {
            if (i == 3)
                s.tracked->region.sweep->number = UINT32_MAX - before;
            assert_int_equal(pir_sum_set_region(s.tracked, axes[i], 0.4), PIR_OK);
            expect(pir_sum_is_valid(s.tracked) && pir_sum_same_pairing(s.tracked, s.whole),
                   "%u before the last: axis %d", before, i);
        }
        assert_true(s.tracked->region.sweep->number < 8);
        sums_clear(&s);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_kept_is_what_comes_near_the_cone),
        cmocka_unit_test(walks_keep_no_more_than_the_cone),
        cmocka_unit_test(numbers_of_sweeps_begin_again),
        cmocka_unit_test(small_steps_ask_for_less_in_a_cone),
    };
    return cmocka_run_group_tests_name("region cost", tests, NULL, NULL);
}
