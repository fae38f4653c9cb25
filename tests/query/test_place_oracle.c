/* SPDX-License-Identifier: MIT */
/*
 * The oracle of placements: cases that plain geometry answers, and its two ways to make the difference, half-spaces
 * and the hull of vertices, against each other and against the exact hull of all pairwise sums.
 */
#include "support/test.h"

#include <math.h>

#include <pirouette/baseline.h>

#include "oracle/place.h"
#include "support/bodies.h"

static const pir_vec3 nowhere = {0, 0, 0};
static const pir_quat still = {0, 0, 0, 1};

struct scene {
    pir_polytope *p, *q;
    oracle_solid *solid_p, *solid_q;
    oracle_place *place;
};

static struct scene make_places(const test_points *p, const test_points *q, pir_quat rotation) {
    struct scene s = {.p = test_polytope(p), .q = test_polytope(q)};
    s.solid_p = oracle_solid_make(s.p);
    s.solid_q = oracle_solid_make(s.q);
    s.place = oracle_place_make(s.solid_p, s.solid_q, rotation);
    return s;
}

static void clear_places(struct scene *s) {
    oracle_place_free(s->place);
    oracle_solid_free(s->solid_p);
    oracle_solid_free(s->solid_q);
    pir_polytope_release(s->p);
    pir_polytope_release(s->q);
}

/* The box from the origin. */
static test_points box(double x, double y, double z) {
    test_points points = {.count = 8};
    for (int i = 0; i < 8; i++)
        points.at[i] = (pir_vec3){i & 1 ? x : 0, i & 2 ? y : 0, i & 4 ? z : 0};
    return points;
}

static void boxes_have_the_answers_of_boxes(void **state) {
    (void)state;
    const test_points small = box(1, 1, 1), large = box(4, 4, 4);
    struct scene s = make_places(&small, &large, still);
    oracle_place *o = s.place;
    assert_true(o->dimension == 3 && o->plane_count == 6);
    // inside from −1 to 4 on each axis
    oracle_place_set(o, (pir_vec3){1, 1.5, 3.75}, (pir_vec3){0, 0, -2});
    assert_int_equal(oracle_place_state(o), PIR_INSIDE);
    assert_true(oracle_place_slack(o, oracle_place_deepest(o)) == 0.25);
    assert_true(oracle_place_ray(o).leave == 2.375);
    oracle_place_set(o, (pir_vec3){4, 2, 2}, (pir_vec3){-1, 0, 0});
    assert_int_equal(oracle_place_state(o), PIR_BOUNDARY);
    assert_true(oracle_place_ray(o).inwards);
    assert_false(oracle_place_nearest(o, NULL, NULL).apart);
    oracle_place_set(o, (pir_vec3){4, 2, 2}, (pir_vec3){0, 1, 0});
    assert_false(oracle_place_ray(o).inwards);
    // off a corner
    oracle_place_set(o, (pir_vec3){7, 8, 16}, (pir_vec3){-3, -4, -12});
    assert_int_equal(oracle_place_state(o), PIR_OUTSIDE);
    oracle_nearest nearest = oracle_place_nearest(o, NULL, NULL);
    assert_true(nearest.distance == 13 && nearest.count == 1);
    oracle_ray ray = oracle_place_ray(o);
    assert_true(ray.meets && ray.within && ray.enter == 1);
    assert_true(oracle_place_farthest(o) == sqrt(8 * 8 + 9 * 9 + 17 * 17));
    assert_true(oracle_place_reach(o, (pir_vec3){0, 0, 5}) == -12);
    clear_places(&s);
}

static void a_hair_decides(void **state) {
    (void)state;
    const test_points small = box(1, 1, 1), large = box(4, 4, 4);
    struct scene s = make_places(&small, &large, still);
    oracle_place_set(s.place, (pir_vec3){nextafter(4, 5), 2, 2}, (pir_vec3){0, 1, 0});
    assert_int_equal(oracle_place_state(s.place), PIR_OUTSIDE);
    assert_false(oracle_place_ray(s.place).meets);
    assert_true(oracle_place_nearest(s.place, NULL, NULL).distance == 0x1p-50);
    oracle_place_set(s.place, (pir_vec3){nextafter(4, 3), 2, 2}, nowhere);
    assert_int_equal(oracle_place_state(s.place), PIR_INSIDE);
    // to the end of the motion, and an ulp short of it
    oracle_place_set(s.place, (pir_vec3){5, 2, 2}, (pir_vec3){-1, 0, 0});
    assert_true(oracle_place_ray(s.place).within);
    oracle_place_set(s.place, (pir_vec3){5, 2, 2}, (pir_vec3){-nextafter(1, 0), 0, 0});
    assert_true(oracle_place_ray(s.place).meets && !oracle_place_ray(s.place).within);
    clear_places(&s);
}

static void rotations_are_rational(void **state) {
    (void)state;
    // (0, 0, 1, 2): by the angle of cosine 3/5 about z, so (5, 0, 0) comes to (3, 4, 0)
    const test_points long_box = box(5, 5, 1), large = box(4, 4, 4);
    struct scene s = make_places(&long_box, &large, (pir_quat){0, 0, 1, 2});
    oracle_place_set_point(s.place, PIR_OPERAND_P, (pir_vec3){13, 24, 30}, (pir_vec3){10, 20, 30});
    assert_false(oracle_place_nearest(s.place, NULL, s.place->only_q).apart);
    oracle_place_set_point(s.place, PIR_OPERAND_P, (pir_vec3){13, 24, 29}, (pir_vec3){10, 20, 30});
    assert_true(oracle_place_nearest(s.place, NULL, s.place->only_q).distance == 1);
    oracle_place_set_point(s.place, PIR_OPERAND_Q, (pir_vec3){4, 4, 7}, (pir_vec3){10, 20, 30});
    assert_true(oracle_place_nearest(s.place, s.place->only_p, NULL).distance == 3);
    // from 0 − 4 to 4 + 4 along x
    oracle_place_set(s.place, (pir_vec3){8, 0, 1}, nowhere);
    assert_int_equal(oracle_place_state(s.place), PIR_BOUNDARY);
    clear_places(&s);
}

static void flat_bodies_have_no_inside(void **state) {
    (void)state;
    const test_points segment = {.count = 2, .at = {{0, 0, 0}, {2, 0, 0}}}, point = {.count = 1, .at = {{1, 1, 1}}},
                      square = {.count = 4, .at = {{0, 0, 0}, {0, 3, 0}, {0, 3, 3}, {0, 0, 3}}};
    const test_points *bodies[3] = {&point, &segment, &square};
    static const int dimensions[3][3] = {{0, 1, 2}, {1, 1, 3}, {2, 3, 2}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            struct scene s = make_places(bodies[i], bodies[j], still);
            assert_int_equal(s.place->dimension, dimensions[i][j]);
            // the first vertices together
            pir_vec3 at = oracle_place_vertex(s.place, 0, 0);
            oracle_place_set(s.place, at, nowhere);
            assert_int_equal(oracle_place_state(s.place), PIR_BOUNDARY);
            oracle_place_set(s.place, (pir_vec3){at.x + 9, at.y, at.z}, (pir_vec3){-1, 0, 0});
            assert_int_equal(oracle_place_state(s.place), PIR_OUTSIDE);
            assert_true(oracle_place_ray(s.place).meets);
            double away = oracle_place_nearest(s.place, NULL, NULL).distance;
            assert_true(oracle_place_ray(s.place).enter == away && (away == 9 || away == 7));
            clear_places(&s);
        }
}

static void the_ways_to_make_a_difference_agree(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 200; number++) {
        test_random random = test_random_case("place oracle", number);
        test_pose pose;
        test_random_pose(&random, 8, &pose);
        struct scene s = make_places(&pose.p, &pose.q, pose.rotation);
        assert_null(oracle_solid_compare(s.solid_p, s.p));
        assert_null(oracle_solid_compare(s.solid_q, s.q));
        pir_sum_options options = pir_sum_options_default();
        options.difference = true;
        pir_mesh *mesh;
        assert_int_equal(pir_hull_sum(s.p, s.q, pose.rotation, &options, PIR_EXACT, &mesh), PIR_OK);
        if (s.place->dimension == 3)
            expect(s.place->plane_count == pir_mesh_facet_count(mesh), "%u facets, not %u (%s, case %llu)",
                   s.place->plane_count, pir_mesh_facet_count(mesh), pose.situation, (unsigned long long)number);
        // vertices are in every half-space, and touch some
        for (uint32_t i = 0; i < s.place->plane_count; i++) {
            uint32_t a = 0, b = 0;
            while (!oracle_set_has(s.place->plane[i].p, a))
                a++;
            while (!oracle_set_has(s.place->plane[i].q, b))
                b++;
            pir_vec3 t = oracle_place_vertex(s.place, a, b);
            t.x += i % 3 ? 0 : s.place->plane[i].near[0];
            oracle_place_set(s.place, t, nowhere);
            assert_int_equal(oracle_place_nearest(s.place, NULL, NULL).apart,
                             oracle_place_state(s.place) == PIR_OUTSIDE);
        }
        pir_mesh_destroy(mesh);
        clear_places(&s);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_have_the_answers_of_boxes),
        cmocka_unit_test(a_hair_decides),
        cmocka_unit_test(rotations_are_rational),
        cmocka_unit_test(flat_bodies_have_no_inside),
        cmocka_unit_test(the_ways_to_make_a_difference_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
