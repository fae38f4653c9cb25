/* SPDX-License-Identifier: MIT */
/*
 * Which way serves: situations that once took the whole difference in every frame, and must not. Each answer is that of
 * the whole difference, bit for bit, where that is not too large to be made in a test.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include <pirouette/pair.h>

#include "support/answers.h"
#include "support/bodies.h"
#include "support/vectors.h"

/* A prism about z, of radius 1 and half height 0.5. */
static pir_polytope *prism(uint32_t sides) {
    pir_polytope *p = NULL;
    pir_vec3 *at = malloc(2 * sides * sizeof *at);
    assert_non_null(at);
    for (uint32_t i = 0; i < sides; i++) {
        double angle = 2 * acos(-1.0) * i / sides;
        at[i] = (pir_vec3){cos(angle), sin(angle), -0.5};
        at[sides + i] = (pir_vec3){cos(angle), sin(angle), 0.5};
    }
    assert_int_equal(pir_polytope_create(at, 2 * sides, NULL, &p), PIR_OK);
    free(at);
    return p;
}

/* A pair, and one that answers by the whole difference. */
struct bench {
    pir_polytope *p, *q;
    pir_workspace *workspace;
    pir_pair *pair, *whole;
    pir_pair_input input;
};

static struct bench bench_make(pir_polytope *p, pir_polytope *q) {
    struct bench bench = {.p = p, .q = q, .input = pir_pair_input_default()};
    pir_pair_options options = pir_pair_options_default();
    options.least = PIR_LEVEL_WHOLE;
    assert_int_equal(pir_workspace_create(NULL, &bench.workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, q, NULL, &bench.pair), PIR_OK);
    assert_int_equal(pir_pair_create(p, q, &options, &bench.whole), PIR_OK);
    return bench;
}

static void bench_clear(struct bench *bench) {
    pir_pair_destroy(bench->pair);
    pir_pair_destroy(bench->whole);
    pir_workspace_destroy(bench->workspace);
    pir_polytope_release(bench->p);
    if (bench->q != bench->p)
        pir_polytope_release(bench->q);
}

static pir_query_result ask_ways(struct bench *bench, bool compare, const char *what, int frame) {
    pir_query_result result, expected;
    assert_int_equal(pir_pair_signed_distance(bench->pair, bench->workspace, &bench->input, &result), PIR_OK);
    if (compare) {
        assert_int_equal(pir_pair_signed_distance(bench->whole, bench->workspace, &bench->input, &expected), PIR_OK);
        expect(test_same_result(&result, &expected), "%s, frame %d: level %d, distance %.17g, not %.17g", what, frame,
               (int)pir_pair_level(bench->pair), result.distance, expected.distance);
    }
    return result;
}

/* --- bodies that are laid flush --- */

/* Its difference is symmetric about x, so that no descent ended with a tetrahedron about a point inside. */
static void a_cold_box_laid_flush_on_a_box_is_told_by_a_facet(void **state) {
    (void)state;
    struct bench bench = bench_make(test_box(1, 1, 1), test_box(1, 1, 1));
    for (int i = 0; i < 200; i++) {
        assert_int_equal(pir_pair_reset(bench.pair, bench.p, bench.q), PIR_OK);
        bench.input.pose_p.translation = (pir_vec3){-1.5 + i / 64.0, (i % 7 - 3) / 4.0, i % 2 ? 2 : -2};
        pir_query_result result = ask_ways(&bench, true, "box on box", i);
        pir_pair_statistics statistics = pir_pair_get_statistics(bench.pair);
        expect(statistics.by_nearest + statistics.by_depth == 1 && statistics.begun < 3 && result.state == PIR_BOUNDARY,
               "frame %d: level %d, state %d", i, (int)pir_pair_level(bench.pair), (int)result.state);
    }
    bench_clear(&bench);
}

/* Rests, turns, slides, or both: the facet of the last frame is proven by the disc about the foot of x. */
static void a_cylinder_that_stands_on_a_box_is_told_by_its_facet(void **state) {
    (void)state;
    static const uint32_t sides[3] = {36, 64, 200};
    for (int i = 0; i < 3 * 4 * 2; i++) {
        bool turns = i / 3 % 4 & 1, slides = i / 3 % 4 & 2, wide = i / 12;
        struct bench bench = bench_make(prism(sides[i % 3]), wide ? test_box(10, 10, 1) : test_box(1, 1, 1));
        for (int k = 0; k < 60; k++) {
            double angle = turns ? k * 0.01 : 0;
            bench.input.pose_p.rotation = (pir_quat){0, 0, sin(angle / 2), cos(angle / 2)};
            bench.input.pose_p.translation = (pir_vec3){slides ? 0.005 * k : 0.125, 0.0625, 1.5};
            pir_query_result result = ask_ways(&bench, k % 20 == 0, "cylinder on box", k);
            assert_int_equal(result.state, PIR_BOUNDARY);
        }
        pir_pair_statistics statistics = pir_pair_get_statistics(bench.pair);
        // the first frame has nothing to walk from
        expect(statistics.by_walk >= 59 && statistics.by_whole == 0,
               "%u sides%s%s%s: %llu of 60 by a walk, %llu by the whole difference", sides[i % 3],
               turns ? ", turning" : "", slides ? ", sliding" : "", wide ? ", on a slab" : "",
               (unsigned long long)statistics.by_walk, (unsigned long long)statistics.by_whole);
        bench_clear(&bench);
    }
}

/* --- poses that are far from those before --- */

/* Both bodies turned by any rotation, P a little above or below contact with Q, each time in another direction. */
static void a_walk_serves_after_many_jumps(void **state) {
    (void)state;
    test_random random = test_random_case("jumps", 0);
    struct bench bench = bench_make(test_sphere(&random, 200), test_sphere(&random, 150));
    enum { JUMPS = 300 };
    for (int k = 0; k < JUMPS; k++) {
        const pir_vec3 a = test_random_direction(&random), b = test_random_direction(&random),
                       d = test_random_direction(&random);
        const double at = 2 + 0.1 * (k % 11 - 6);
        bench.input.pose_p = (pir_pose){{a.x, a.y, a.z, 0.7}, {at * d.x + b.x, at * d.y + b.y, at * d.z + b.z}};
        bench.input.pose_q = (pir_pose){{b.x, b.y, b.z, 0.3}, {b.x, b.y, b.z}};
        ask_ways(&bench, k % 4 == 0, "jumps", k);
    }
    pir_pair_statistics statistics = pir_pair_get_statistics(bench.pair);
    expect(statistics.by_walk > JUMPS / 3 && statistics.by_whole == 0,
           "%llu of %d by a walk, %llu by a descent, %llu by a depth, %llu by the whole difference",
           (unsigned long long)statistics.by_walk, JUMPS, (unsigned long long)statistics.by_nearest,
           (unsigned long long)statistics.by_depth, (unsigned long long)statistics.by_whole);
    bench_clear(&bench);
}

/* --- facets that doubles cannot tell apart --- */

static const double turns[7] = {0, 1e-16, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3};

static void turn_bench(struct bench *bench, int i, bool about_one_middle) {
    double e = turns[i];
    bench->input.pose_p.rotation = (pir_quat){e, 2 * e, -e, 1};
    bench->input.pose_p.translation = about_one_middle ? (pir_vec3){0, 0, 0} : (pir_vec3){0.1, 0.2, 0.3};
}

/* Two equal prisms, turned by next to nothing: their difference has some millions of facets at 1,451 sides. */
static void equal_prisms_nearly_parallel_need_no_whole_difference(void **state) {
    (void)state;
    static const uint32_t sides[10] = {3, 4, 8, 9, 15, 36, 64, 101, 400, 1451};
    int by_whole = 0;
    for (int m = 0; m < 10; m++) {
        pir_polytope *p = prism(sides[m]);
        struct bench bench = bench_make(p, p);
        for (int i = 0; i < 14; i++) {
            turn_bench(&bench, i / 2, i % 2);
            assert_int_equal(pir_pair_reset(bench.pair, p, p), PIR_OK);
            pir_query_result result = ask_ways(&bench, sides[m] <= 101, "prisms", i);
            pir_pair_statistics statistics = pir_pair_get_statistics(bench.pair);
            assert_int_equal(result.state, PIR_INSIDE);
            expect(sides[m] < 400 || statistics.by_whole == 0, "%u sides, turned by %g: the whole difference", sides[m],
                   turns[i / 2]);
            // a vertex takes a microsecond, and a search has no more than these
            assert_true(statistics.supports < 256);
            by_whole += statistics.by_whole > 0;
        }
        bench_clear(&bench);
    }
    print_message("# %d of 140 by the whole difference\n", by_whole);
    assert_true(by_whole <= 7);
}

/* Prisms of other numbers of sides, sizes and places, resting, sunk or apart by little. */
static void prisms_at_random_nearly_parallel_answer_as_their_difference(void **state) {
    (void)state;
    const char *scenes = getenv("PIR_TEST_SCENES");
    uint64_t count = scenes ? strtoull(scenes, NULL, 10) : 150, asked = 0, by_whole = 0;
    for (uint64_t number = 0; number < count; number++) {
        test_random random = test_random_case("prisms nearly parallel", number);
        pir_polytope *p = prism(3 + test_random_below(&random, 60)), *q = prism(3 + test_random_below(&random, 60));
        struct bench bench = bench_make(p, q);
        double e = ldexp(test_random_unit(&random), -test_random_between(&random, 0, 54));
        for (int k = 0; k < 8; k++) {
            pir_vec3 d = test_random_direction(&random);
            bench.input.pose_p.rotation = (pir_quat){e * d.x, e * d.y, k % 2 ? e * d.z : 0.25 * d.z, 1};
            double gap = k % 3 ? ldexp(test_random_unit(&random), -test_random_between(&random, 1, 50)) : 0;
            pir_vec3 t = {0.5 * test_random_unit(&random), k % 4 ? 0 : 0.5 * test_random_unit(&random), 1 + gap};
            bench.input.pose_p.translation = k % 5 == 4 ? (pir_vec3){0, 0, t.z - 1} : t;
            ask_ways(&bench, true, "prisms at random", (int)number);
            asked++;
        }
        by_whole += pir_pair_get_statistics(bench.pair).by_whole;
        bench_clear(&bench);
    }
    print_message("# %llu answers, %llu by the whole difference\n", (unsigned long long)asked,
                  (unsigned long long)by_whole);
    // a t on an edge of D but for rounding is left to that
    assert_true(5 * by_whole < asked);
}

/* Of two facets that are nearly as deep the one beyond a facet a rounding wide was passed over. */
static void the_facet_beyond_one_a_rounding_wide_is_compared(void **state) {
    (void)state;
    pir_polytope *p = test_box(1, 0x1.32a559e403192p-1, 0x1.2be0ba2d59a16p-1);
    struct bench bench = bench_make(p, p);
    bench.input.pose_p =
        (pir_pose){{-0x1.19799812dea0fp-42, 0x1.bb67ae8584cabp-1, -0x1.e78769f84a62bp-42, -0x1.ffffffffffffcp-2},
                   {-0x1.06f9ffae42a95p+2, -0x1.460f8898610dcp+1, -0x1.832ac4a941493p+1}};
    bench.input.pose_q = (pir_pose){{0, 0x1.bb67ae8584cabp-1, 0, -0x1.ffffffffffffcp-2},
                                    {-0x1.9f1a13bb242p+1, -0x1.460f8898610dcp+1, -0x1.432ac4a941492p+1}};
    const pir_vec3 t = bench.input.pose_p.translation;
    // about one middle first, so that there is a surface
    bench.input.pose_p.translation = bench.input.pose_q.translation;
    ask_ways(&bench, true, "one middle", 0);
    bench.input.pose_p.translation = t;
    ask_ways(&bench, true, "moved along an axis", 1);
    bench_clear(&bench);
}

static double ulps_from(test_random *random, double x) {
    for (int k = test_random_between(random, -2, 2); k != 0; k += k < 0 ? 1 : -1)
        x = nextafter(x, k < 0 ? -HUGE_VAL : HUGE_VAL);
    return x;
}

/* A plate as thin as 2^-10 to 2^-40 whose corners are some ulps off. */
static pir_polytope *rough_plate(test_random *random) {
    const double u = test_random_unit(random) + 0.1, thin = ldexp(1 + test_random_unit(random), -10);
    const double half = ldexp(thin, -test_random_between(random, 0, 30));
    test_points points = {.count = 8};
    for (int i = 0; i < 8; i++)
        points.at[i] = (pir_vec3){i & 1 ? 1 : -1, i & 2 ? u : -u, i & 4 ? half : -half};
    for (int k = 0; k < 2; k++) {
        pir_vec3 *at = &points.at[test_random_below(random, 8)];
        double *const number[3] = {&at->x, &at->y, &at->z};
        const uint32_t which = test_random_below(random, 3);
        *number[which] = ulps_from(random, *number[which]);
    }
    return test_polytope(&points);
}

/*
 * A thin plate on its narrow side over a triangle, a corner an ulp off: facets that are slivers, coplanar but for
 * rounding. A foot beyond the tip of one is near to the lines of its sides, and far from it.
 */
static void thin_plates_over_a_triangle_answer_as_their_difference(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 3000; number++) {
        test_random random = test_random_case("thin plates", number);
        const pir_vec3 corners[3] = {{1, 0, 0}, {-0.5, sqrt(0.75), 0}, {-0.5, -sqrt(0.75), 0}};
        pir_polytope *triangle = NULL;
        assert_int_equal(pir_polytope_create(corners, 3, NULL, &triangle), PIR_OK);
        struct bench bench = bench_make(rough_plate(&random), triangle);
        // one of the axes up, its end in the triangle by next to nothing
        const double s[4] = {1, test_random_below(&random, 2) ? 1 : -1, test_random_below(&random, 2) ? 1 : -1,
                             test_random_below(&random, 2) ? 1 : -1};
        const bool thirds = test_random_below(&random, 4) > 0;
        bench.input.pose_p.rotation = thirds ? (pir_quat){s[0], s[1], s[2], s[3]} : (pir_quat){s[0], 0, 0, s[3]};
        double low = HUGE_VAL;
        for (uint32_t v = 0; v < pir_polytope_vertex_count(bench.p); v++)
            low = fmin(low, test_turn(bench.input.pose_p.rotation, pir_polytope_vertex(bench.p, v), 1).z);
        bench.input.pose_p.translation.z = -low - pow(10, -4 - 12 * test_random_unit(&random));
        if (test_random_below(&random, 2))
            bench.input.pose_p.translation.y = 0.25 * (test_random_unit(&random) - 0.5);
        ask_ways(&bench, true, "plate", (int)number);
        bench_clear(&bench);
    }
}

/* The sliver of such a plate was taken for the facet under it: its depth is 2^-53 more. */
static void the_facet_beyond_the_tip_of_a_sliver_is_compared(void **state) {
    (void)state;
    const double u = 0x1.1f426dcc56d35p-1, half = 0x1.0c6f7a0b5ed8dp-20;
    const pir_vec3 corners[3] = {{0x1.fffffffffffffp-1, 0, 0},
                                 {-0x1.ffffffffffffcp-2, 0x1.bb67ae8584cadp-1, 0},
                                 {-0x1.0000000000004p-1, -0x1.bb67ae8584ca8p-1, 0}};
    test_points points = {.count = 8};
    pir_polytope *triangle = NULL;
    for (int i = 0; i < 8; i++)
        points.at[i] = (pir_vec3){i & 1 ? 1 : -1, i & 2 ? u : -u, i & 4 ? half : -half};
    points.at[5].x = 0x1.0000000000002p+0;
    points.at[7].y = 0x1.1f426dcc56d37p-1;
    assert_int_equal(pir_polytope_create(corners, 3, NULL, &triangle), PIR_OK);
    struct bench bench = bench_make(test_polytope(&points), triangle);
    bench.input.pose_p = (pir_pose){{1, -1, -1, -1}, {0, 0, 0x1.ffffffaaa30ccp-1}};
    // exactly: the lowest corner is at a height of 2^-51 below -1, and the triangle's plane is the facet
    const pir_query_result result = ask_ways(&bench, true, "sliver", 0);
    assert_true(result.distance == 0x1.ffffffaaa30ccp-1 - 0x1.0000000000002p+0);
    bench_clear(&bench);
}

/* Any equal boxes, turned by next to nothing and moved along an axis. */
static void equal_boxes_nearly_parallel_answer_as_their_difference(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 3000; number++) {
        test_random random = test_random_case("boxes nearly parallel", number);
        pir_polytope *p = test_box(1, 0.6 + 0.3 * test_random_unit(&random), 0.6 + 0.3 * test_random_unit(&random));
        struct bench bench = bench_make(p, p);
        double e = number % 2 ? 5e-13 : ldexp(test_random_unit(&random), -test_random_between(&random, 20, 54));
        for (int k = 0; k < 4; k++) {
            double along = k == 0 ? 0 : ldexp(1 + test_random_unit(&random), -test_random_between(&random, 0, 50));
            double t[3] = {0, 0, 0}, v[3] = {0, 0, 0};
            t[test_random_below(&random, 3)] = number % 3 ? along : (k > 0);
            v[test_random_below(&random, 3)] = e;
            if (number % 5 == 0)
                v[test_random_below(&random, 3)] = 2 * e;
            bench.input.pose_p.rotation = (pir_quat){v[0], v[1], v[2], 1};
            bench.input.pose_p.translation = (pir_vec3){t[0], t[1], t[2]};
            ask_ways(&bench, true, "equal boxes", (int)number);
        }
        bench_clear(&bench);
    }
}

/* --- each way where it is there for --- */

#define FRAMES 200

/* Counts the answers of a way. */
enum way { PROOF, WALK, NEAREST, DEPTH, WHOLE, WAYS };

static const char *const way_names[WAYS] = {"proof", "walk", "nearest", "depth", "whole"};

static uint64_t count_of(const pir_pair *pair, enum way way) {
    const pir_pair_statistics s = pir_pair_get_statistics(pair);
    const uint64_t counts[WAYS] = {s.by_proof, s.by_walk, s.by_nearest, s.by_depth, s.by_whole};
    assert_int_equal(s.by_proof + s.by_walk + s.by_nearest + s.by_depth + s.by_whole, s.queries);
    return counts[way];
}

/* Moves both bodies to their poses of a frame. */
typedef void mover(int frame, pir_pair_input *input);

static pir_quat turned_about(double x, double y, double z, double angle) {
    double s = sin(angle / 2) / sqrt(x * x + y * y + z * z);
    return (pir_quat){s * x, s * y, s * z, cos(angle / 2)};
}

static void glides_apart(int frame, pir_pair_input *input) {
    input->cutoff = 0.1;
    input->pose_p.translation = (pir_vec3){0.01 * frame - 1, 0.2, 2.5};
}

static void both_glide_apart_and_turn(int frame, pir_pair_input *input) {
    input->cutoff = 0.1;
    input->pose_p = (pir_pose){turned_about(1, 2, 3, 0.001 * frame), {0.01 * frame - 1, 0.2, 4}};
    input->pose_q = (pir_pose){turned_about(3, 1, 1, -0.001 * frame), {0.01 * frame, 0.1, -0.001 * frame}};
}

static void stands_over_a_face(int frame, pir_pair_input *input) {
    input->pose_p = (pir_pose){turned_about(1, 0.3, 0.1, 0.0002 * frame), {0.002 * frame - 0.2, 0.1, 11.125}};
}

static void rests(int frame, pir_pair_input *input) {
    input->pose_p.translation = (pir_vec3){0.25 + 0.001 * frame, 0.125, 2};
}

static void sinks_deep(int frame, pir_pair_input *input) {
    input->pose_p = (pir_pose){turned_about(1, 2, 3, 0.3 + 0.02 * frame), {0.001 * frame, 0.1, 0.2}};
}

static void jumps_about(int frame, pir_pair_input *input) {
    input->pose_p = (pir_pose){turned_about(1, frame % 7, 3, frame), {3 * cos(2.0 * frame), 3 * sin(2.0 * frame), 4}};
}

static void stands_corner_to_corner(int frame, pir_pair_input *input) {
    input->pose_p.translation = (pir_vec3){2, 2, frame % 2 ? 2 : -2};
}

static void each_way_serves_where_it_is_there_for(void **state) {
    (void)state;
    const struct {
        const char *name;
        pir_polytope *p, *q;
        mover *move;
        enum way way;
        int least; /* of FRAMES */
    } situations[] = {
        {"a box that glides by", test_box(1, 1, 1), test_box(1, 1, 1), glides_apart, PROOF, FRAMES - 2},
        {"boxes that both glide and turn", test_box(1, 1, 1), test_box(1, 1, 1), both_glide_apart_and_turn, PROOF,
         FRAMES - 2},
        {"a needle over a face", test_box(0.01, 0.01, 10), test_box(1, 1, 1), stands_over_a_face, WALK, FRAMES - 4},
        {"a box at rest", test_box(1, 1, 1), test_box(1, 1, 1), rests, WALK, FRAMES - 2},
        {"a small box on a slab", test_box(1, 1, 1), test_box(20, 20, 1), rests, WALK, FRAMES - 2},
        {"a cylinder of 36 sides deep in a box", prism(36), test_box(1, 1, 1), sinks_deep, DEPTH, FRAMES * 9 / 10},
        {"boxes deep in each other", test_box(1, 0.8, 0.6), test_box(1, 1, 1), sinks_deep, DEPTH, FRAMES / 2},
        {"cylinders that jump about", prism(36), prism(36), jumps_about, NEAREST, FRAMES * 9 / 10},
        {"boxes corner to corner", test_box(1, 1, 1), test_box(1, 1, 1), stands_corner_to_corner, WHOLE, FRAMES - 2},
    };
    for (size_t i = 0; i < sizeof situations / sizeof *situations; i++) {
        struct bench bench = bench_make(situations[i].p, situations[i].q);
        for (int frame = 0; frame < FRAMES; frame++) {
            situations[i].move(frame, &bench.input);
            ask_ways(&bench, frame % 20 == 0, situations[i].name, frame);
        }
        uint64_t served = count_of(bench.pair, situations[i].way);
        print_message("# %s: %llu of %d by %s\n", situations[i].name, (unsigned long long)served, FRAMES,
                      way_names[situations[i].way]);
        expect(served >= (uint64_t)situations[i].least, "%s: %llu of %d by %s", situations[i].name,
               (unsigned long long)served, FRAMES, way_names[situations[i].way]);
        bench_clear(&bench);
    }
}

/* Counts manifolds that have a contact, and no others. */
static void manifolds_are_counted(void **state) {
    (void)state;
    struct bench bench = bench_make(test_box(1, 1, 1), test_box(1, 1, 1));
    pir_contact contacts[16];
    size_t count;
    for (int frame = 0; frame < 6; frame++) {
        bench.input.cutoff = bench.input.margin = 0.1;
        bench.input.pose_p.translation = (pir_vec3){0.25, 0.125, frame < 4 ? 2 : 3};
        pir_query_result answer = ask_ways(&bench, false, "manifold", frame);
        assert_int_equal(pir_pair_manifold(bench.pair, bench.workspace, &bench.input, &answer, 16, contacts, &count),
                         PIR_OK);
        assert_int_equal(count, frame < 4 ? 4 : 0);
    }
    assert_int_equal(pir_pair_get_statistics(bench.pair).manifolds, 4);
    bench_clear(&bench);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cold_box_laid_flush_on_a_box_is_told_by_a_facet),
        cmocka_unit_test(a_cylinder_that_stands_on_a_box_is_told_by_its_facet),
        cmocka_unit_test(a_walk_serves_after_many_jumps),
        cmocka_unit_test(equal_prisms_nearly_parallel_need_no_whole_difference),
        cmocka_unit_test(the_facet_beyond_one_a_rounding_wide_is_compared),
        cmocka_unit_test(the_facet_beyond_the_tip_of_a_sliver_is_compared),
        cmocka_unit_test(thin_plates_over_a_triangle_answer_as_their_difference),
        cmocka_unit_test(equal_boxes_nearly_parallel_answer_as_their_difference),
        cmocka_unit_test(prisms_at_random_nearly_parallel_answer_as_their_difference),
        cmocka_unit_test(each_way_serves_where_it_is_there_for),
        cmocka_unit_test(manifolds_are_counted),
    };
    return cmocka_run_group_tests_name("ways of pairs", tests, NULL, NULL);
}
