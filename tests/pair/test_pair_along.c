/* SPDX-License-Identifier: MIT */
/*
 * What a pair asks of its whole difference, held against a query on a sum of the same poses: bit for bit where Q is at
 * the identity; where the world is turned by quarters and moved by whole numbers, which no double rounds, with the same
 * outcomes and numbers within 1e-12. Bodies are of all kinds, flat ones too; directions and ways of small whole numbers
 * make them graze and slide. Times of impact are held against distances at many times.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/gradient.h>

#include "support/bodies.h"
#include "support/memory.h"
#include "support/random.h"
#include "support/vectors.h"

#define ROOM 64

static uint64_t cases_of(uint64_t few) {
    const char *text = getenv("PIR_TEST_CASES");
    return text ? strtoull(text, NULL, 10) : few;
}

/* One pose: the query on the sum, the pair, and where the pair's world is. */
struct bench {
    pir_polytope *p, *q;
    pir_sum *sum;
    pir_query *query;
    pir_pair *pair;
    pir_workspace *workspace;
    pir_quat rotation;
    pir_pose world; /* of Q; a whole number of quarter turns */
    bool posed;
};

/* False, with nothing to ask, where two bodies are so far from the origin for their size that queries refuse them. */
static bool make(struct bench *bench, test_random *random, uint64_t number) {
    test_pose pose;
    pir_sum_options options = pir_sum_options_default();
    test_random_pose(random, 12, &pose);
    options.difference = true;
    *bench = (struct bench){.p = test_polytope(&pose.p), .q = test_polytope(&pose.q)};
    bench->posed = number % 2;
    bench->rotation = bench->posed ? test_integer_rotation(random) : pose.rotation;
    bench->world = pir_pose_identity();
    if (bench->posed) {
        static const pir_quat turns[4] = {{0, 0, 1, 1}, {1, 1, 1, 1}, {1, 0, 0, 0}, {0, -1, 0, 1}};
        bench->world.rotation = turns[number / 2 % 4];
        bench->world.translation = (pir_vec3){3, -5, (double)(number % 7)};
    }
    assert_int_equal(pir_sum_create(bench->p, bench->q, bench->rotation, &options, &bench->sum), PIR_OK);
    const pir_status status = pir_query_create(bench->sum, &bench->query);
    if (status == PIR_ERR_LIMIT)
        return false;
    assert_int_equal(status, PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &bench->workspace), PIR_OK);
    assert_int_equal(pir_pair_create(bench->p, bench->q, NULL, &bench->pair), PIR_OK);
    return true;
}

static void clear(struct bench *bench) {
    pir_pair_destroy(bench->pair);
    pir_workspace_destroy(bench->workspace);
    pir_query_destroy(bench->query);
    pir_sum_destroy(bench->sum);
    pir_polytope_release(bench->p);
    pir_polytope_release(bench->q);
}

/* a·b, exact where both are of small whole numbers. */
static pir_quat product(pir_quat a, pir_quat b) {
    return (pir_quat){a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

/* A vector of Q's frame in the world: quarter turns move numbers about and change signs, without a rounding. */
static pir_vec3 to_world(const struct bench *bench, pir_vec3 v) {
    const pir_quat q = bench->world.rotation;
    const double n = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, s = 2 / n;
    const double m[3][3] = {
        {1 - s * (q.y * q.y + q.z * q.z), s * (q.x * q.y - q.z * q.w), s * (q.x * q.z + q.y * q.w)},
        {s * (q.x * q.y + q.z * q.w), 1 - s * (q.x * q.x + q.z * q.z), s * (q.y * q.z - q.x * q.w)},
        {s * (q.x * q.z - q.y * q.w), s * (q.y * q.z + q.x * q.w), 1 - s * (q.x * q.x + q.y * q.y)}};
    return (pir_vec3){m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
                      m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

static pir_pair_input input_of(const struct bench *bench, pir_vec3 t) {
    pir_pair_input input = pir_pair_input_default();
    input.pose_q = bench->world;
    input.pose_p.rotation = bench->posed ? product(bench->world.rotation, bench->rotation) : bench->rotation;
    input.pose_p.translation = bench->posed ? test_add(to_world(bench, t), bench->world.translation, 1) : t;
    return input;
}

/* A place about the bodies on a grid of eighths, whose sums are exact, or anywhere. */
static pir_vec3 place(test_random *random, bool whole, double size) {
    pir_vec3 t = {test_random_between(random, -size, size), test_random_between(random, -size, size),
                  test_random_between(random, -size, size)};
    return whole ? (pir_vec3){rint(8 * t.x) / 8, rint(8 * t.y) / 8, rint(8 * t.z) / 8} : t;
}

static pir_vec3 direction(test_random *random, bool whole) {
    pir_vec3 d = {0, 0, 0};
    if (!whole)
        return test_random_direction(random);
    while (d.x == 0 && d.y == 0 && d.z == 0)
        d = (pir_vec3){rint(test_random_between(random, -2, 2)), rint(test_random_between(random, -2, 2)),
                       rint(test_random_between(random, -2, 2))};
    return d;
}

static double size_of(const struct bench *bench) {
    pir_vec3 low, high;
    double size = 0;
    const pir_polytope *both[2] = {bench->p, bench->q};
    for (int k = 0; k < 2; k++) {
        pir_polytope_bounds(both[k], &low, &high);
        size += fmax(fabs(low.x), fabs(high.x)) + fmax(fabs(low.y), fabs(high.y)) + fmax(fabs(low.z), fabs(high.z));
    }
    return size;
}

static bool near(pir_vec3 a, pir_vec3 b, double error) {
    return fabs(a.x - b.x) <= error && fabs(a.y - b.y) <= error && fabs(a.z - b.z) <= error;
}

/* How far off numbers may be: not at all where Q is at the identity. */
static double error_of(const struct bench *bench, pir_vec3 t) {
    return bench->posed ? 1e-12 * (size_of(bench) + 20 + fabs(t.x) + fabs(t.y) + fabs(t.z)) : 0;
}

static void expect_result(const struct bench *bench, const pir_query_result *right, const pir_query_result *result,
                          double error, const char *call, uint64_t number) {
    expect(result->state == right->state && result->outcome == right->outcome, "%s, case %llu: state %d, outcome %d",
           call, (unsigned long long)number, (int)result->state, (int)result->outcome);
    bool has = right->normal.x != 0 || right->normal.y != 0 || right->normal.z != 0;
    if (!has)
        return;
    expect(fabs(result->distance - right->distance) <= error, "%s, case %llu: %.17g, not %.17g", call,
           (unsigned long long)number, result->distance, right->distance);
    const pir_vec3 normal = to_world(bench, right->normal);
    expect(near(result->normal, normal, bench->posed ? 1e-12 : 0), "%s, case %llu: normal off by %.3g %.3g %.3g", call,
           (unsigned long long)number, result->normal.x - normal.x, result->normal.y - normal.y,
           result->normal.z - normal.z);
    const pir_vec3 point = to_world(bench, right->point_q);
    expect(near(result->point_q, bench->posed ? test_add(point, bench->world.translation, 1) : point, error),
           "%s, case %llu: point", call, (unsigned long long)number);
    expect(memcmp(&result->witness, &right->witness, sizeof right->witness) == 0, "%s, case %llu: witness", call,
           (unsigned long long)number);
}

static void check_along(struct bench *bench, pir_vec3 t, pir_vec3 d, uint64_t number) {
    const pir_pair_input input = input_of(bench, t);
    const pir_vec3 world = to_world(bench, d);
    pir_query_input asked = pir_query_input_default();
    pir_query_result right, result;
    asked.translation = t;
    assert_int_equal(pir_query_directional_depth(bench->query, &asked, d, &right), PIR_OK);
    assert_int_equal(pir_pair_directional_depth(bench->pair, bench->workspace, &input, world, &result), PIR_OK);
    expect_result(bench, &right, &result, error_of(bench, t), "depth", number);
    assert_int_equal(pir_query_directional_distance(bench->query, &asked, d, &right), PIR_OK);
    assert_int_equal(pir_pair_directional_distance(bench->pair, bench->workspace, &input, world, &result), PIR_OK);
    expect_result(bench, &right, &result, error_of(bench, t), "distance", number);
    assert_int_equal(pir_query_largest_distance(bench->query, &asked, &right), PIR_OK);
    assert_int_equal(pir_pair_largest_distance(bench->pair, bench->workspace, &input, &result), PIR_OK);
    expect(result.state == right.state && fabs(result.distance - right.distance) <= error_of(bench, t),
           "largest, case %llu: %.17g, not %.17g", (unsigned long long)number, result.distance, right.distance);
}

static pir_cast_outcome check_cast(struct bench *bench, pir_vec3 t, pir_vec3 way, uint64_t number) {
    const pir_pair_input input = input_of(bench, t);
    const double error = error_of(bench, t);
    pir_query_input asked = pir_query_input_default();
    pir_impact right, impact;
    asked.translation = t;
    assert_int_equal(pir_query_cast(bench->query, &asked, way, &right), PIR_OK);
    assert_int_equal(pir_pair_cast(bench->pair, bench->workspace, &input, to_world(bench, way), &impact), PIR_OK);
    expect(impact.outcome == right.outcome, "cast, case %llu: outcome %d, not %d", (unsigned long long)number,
           (int)impact.outcome, (int)right.outcome);
    expect(fabs(impact.time - right.time) <= error, "cast, case %llu: time %.17g, not %.17g",
           (unsigned long long)number, impact.time, right.time);
    if (right.outcome == PIR_CAST_HIT) {
        const pir_vec3 point = to_world(bench, right.point);
        expect(near(impact.point, bench->posed ? test_add(point, bench->world.translation, 1) : point, error),
               "cast, case %llu: point", (unsigned long long)number);
        expect(near(impact.normal, to_world(bench, right.normal), bench->posed ? 1e-12 : 0), "cast, case %llu: normal",
               (unsigned long long)number);
        expect(memcmp(&impact.witness, &right.witness, sizeof right.witness) == 0, "cast, case %llu: witness",
               (unsigned long long)number);
    }
    return right.outcome;
}

static void check_escapes(struct bench *bench, pir_vec3 t, uint64_t number) {
    const pir_pair_input input = input_of(bench, t);
    pir_query_input asked = pir_query_input_default();
    pir_escape right[ROOM], escapes[ROOM];
    size_t should, count;
    asked.translation = t;
    assert_int_equal(pir_query_escapes(bench->query, &asked, 0.5, ROOM, right, &should), PIR_OK);
    assert_int_equal(pir_pair_escapes(bench->pair, bench->workspace, &input, 0.5, ROOM, escapes, &count), PIR_OK);
    expect(count == should, "escapes, case %llu: %zu, not %zu", (unsigned long long)number, count, should);
    for (size_t i = 0; i < count && i < ROOM; i++)
        expect(fabs(escapes[i].depth - right[i].depth) <= error_of(bench, t) &&
                   near(escapes[i].normal, to_world(bench, right[i].normal), bench->posed ? 1e-12 : 0) &&
                   memcmp(&escapes[i].witness, &right[i].witness, sizeof right[i].witness) == 0,
               "escapes, case %llu: escape %zu", (unsigned long long)number, i);
}

static void answers_are_those_of_a_sum(void **state) {
    (void)state;
    uint64_t met[PIR_CAST_STEP_LIMIT + 1] = {0};
    const uint64_t cases = cases_of(400);
    for (uint64_t i = 0; i < cases; i++) {
        test_random random = test_random_case("along", i);
        struct bench bench;
        if (!make(&bench, &random, i)) {
            clear(&bench);
            continue;
        }
        // doubles as they come are turned by quarters without a rounding, but not multiplied by the length of a turn
        const bool whole = bench.posed || i % 4 == 0;
        const double size = fmin(size_of(&bench), 100);
        for (int k = 0; k < 4; k++) {
            const pir_vec3 t = place(&random, whole, k % 2 ? size : 0.25 * size), d = direction(&random, whole);
            const pir_vec3 way = {size * d.x, size * d.y, size * d.z};
            check_along(&bench, t, d, i);
            met[check_cast(&bench, t, k == 3 ? (pir_vec3){0, 0, 0} : way, i)]++;
            check_escapes(&bench, t, i);
        }
        clear(&bench);
    }
    for (int k = 0; k < PIR_CAST_STEP_LIMIT; k++)
        expect(met[k] > 0 || k == PIR_CAST_RECEDING, "no cast ended with %d", k);
}

/* A cube on a cube: they slide, graze and part as exactly as on a sum, the world turned or not. */
static void cubes_slide_and_graze_in_a_turned_world(void **state) {
    (void)state;
    pir_vec3 corners[8];
    for (int k = 0; k < 8; k++)
        corners[k] = (pir_vec3){k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1};
    static const struct {
        pir_vec3 t, way;
        pir_cast_outcome outcome;
    } cases[] = {{{0, 0, 2}, {1, 0, 0}, PIR_CAST_RECEDING},
                 {{0, 0, 2}, {0, 0, 1}, PIR_CAST_RECEDING},
                 {{0, 0, 2}, {1, 0, -1e-300}, PIR_CAST_HIT},
                 {{4, 0, 2}, {-4, 0, 0}, PIR_CAST_HIT},
                 {{4, 0, 2.0000000000000004}, {-4, 0, 0}, PIR_CAST_MISS},
                 {{4, 2, 2}, {-2, 0, 0}, PIR_CAST_HIT},
                 {{4, 2, 2}, {-1.9999999999999998, 0, 0}, PIR_CAST_MISS},
                 {{3, 0, 0}, {0, 0, 0}, PIR_CAST_AT_REST},
                 {{1, 0, 0}, {0, 0, 0}, PIR_CAST_START_INSIDE}};
    for (uint64_t number = 0; number < 8; number++) {
        struct bench bench = {.rotation = {0, 0, 0, 1}, .world = pir_pose_identity(), .posed = number > 0};
        static const pir_quat turns[4] = {{0, 0, 1, 1}, {1, 1, 1, 1}, {1, 0, 0, 0}, {0, -1, 0, 1}};
        bench.world.rotation = number ? turns[number % 4] : bench.world.rotation;
        assert_int_equal(pir_polytope_create(corners, 8, NULL, &bench.p), PIR_OK);
        bench.q = pir_polytope_retain(bench.p);
        assert_int_equal(pir_workspace_create(NULL, &bench.workspace), PIR_OK);
        assert_int_equal(pir_pair_create(bench.p, bench.q, NULL, &bench.pair), PIR_OK);
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
            const pir_pair_input input = input_of(&bench, cases[i].t);
            pir_impact impact;
            assert_int_equal(
                pir_pair_cast(bench.pair, bench.workspace, &input, to_world(&bench, cases[i].way), &impact), PIR_OK);
            expect(impact.outcome == cases[i].outcome, "turn %u, case %zu: outcome %d", (unsigned)number, i,
                   (int)impact.outcome);
        }
        clear(&bench);
    }
}

/* --- times of impact --- */

static double distance_at(const struct bench *bench, pir_pair *fresh, pir_pair_input input, const pir_motion *motion,
                          double time) {
    pir_query_result result;
    input.pose_p = time > 0 ? pir_pose_integrate(input.pose_p, motion->way, motion->turn, time) : input.pose_p;
    assert_int_equal(pir_pair_signed_distance(fresh, bench->workspace, &input, &result), PIR_OK);
    return result.distance;
}

static void impacts_are_near_and_the_first(void **state) {
    (void)state;
    uint64_t hits = 0, misses = 0, endless = 0;
    const uint64_t cases = cases_of(300);
    for (uint64_t i = 0; i < cases; i++) {
        test_random random = test_random_case("impacts", i);
        struct bench bench;
        pir_impact impact, right;
        if (!make(&bench, &random, 2 * i)) {
            clear(&bench);
            continue;
        }
        const double size = size_of(&bench), tolerance = 1e-6 * (size > 0 ? size : 1); // of two points it is 0
        const pir_vec3 t = place(&random, false, 1.5 * size);
        pir_pair_input input = input_of(&bench, t);
        pir_query_input asked = pir_query_input_default();
        asked.translation = t;
        asked.radius_p = input.radius_p = i % 3 == 0 ? 0.1 * size : 0;
        asked.radius_q = input.radius_q = i % 5 == 0 ? 0.1 * size : 0;
        const pir_vec3 axis = test_random_direction(&random);
        const double turn = i % 4 ? test_random_between(&random, -3, 3) : 0;
        const pir_motion motion = {
            {-1.5 * t.x, -1.5 * t.y, -1.2 * t.z}, {turn * axis.x, turn * axis.y, turn * axis.z}, 0};
        assert_int_equal(pir_pair_time_of_impact(bench.pair, bench.workspace, &input, &motion, tolerance, &impact),
                         PIR_OK);
        assert_int_equal(pir_query_time_of_impact(bench.query, &asked, &motion, tolerance, &right), PIR_OK);
        pir_pair *fresh;
        assert_int_equal(pir_pair_create(bench.p, bench.q, NULL, &fresh), PIR_OK);
        const pir_impact *both[2] = {&impact, &right};
        for (int k = 0; k < 2; k++) {
            const double end = both[k]->time;
            for (int j = 0; j < 20 && both[k]->outcome != PIR_CAST_START_INSIDE; j++)
                expect(distance_at(&bench, fresh, input, &motion, end * j / 20) > 0 || end == 0,
                       "case %llu, way %d: not the first: outcome %d, time %.17g, sample %d", (unsigned long long)i, k,
                       (int)both[k]->outcome, end, j);
            if (both[k]->outcome == PIR_CAST_HIT)
                expect(distance_at(&bench, fresh, input, &motion, end) <= 1.001 * tolerance,
                       "case %llu, way %d: not near", (unsigned long long)i, k);
        }
        const bool ends = impact.outcome != PIR_CAST_STEP_LIMIT && right.outcome != PIR_CAST_STEP_LIMIT;
        // they differ alone where the bodies pass at hardly less than the tolerance
        const pir_impact *met = impact.outcome == PIR_CAST_HIT ? &impact : &right;
        expect(!ends || impact.outcome == right.outcome ||
                   (met->outcome == PIR_CAST_HIT &&
                    distance_at(&bench, fresh, input, &motion, met->time) > 0.4 * tolerance),
               "case %llu: outcomes %d, %d", (unsigned long long)i, (int)impact.outcome, (int)right.outcome);
        endless += !ends;
        hits += impact.outcome == PIR_CAST_HIT;
        misses += impact.outcome == PIR_CAST_MISS;
        pir_pair_destroy(fresh);
        clear(&bench);
    }
    expect(5 * hits > cases && 50 * misses > cases, "%u hits, %u misses", (unsigned)hits, (unsigned)misses);
    // motions that glide along at hardly more than the tolerance
    expect(20 * endless <= cases, "%u of %u do not end", (unsigned)endless, (unsigned)cases);
}

/* --- memory, refusals --- */

static pir_status ask_all(struct bench *bench, const pir_pair_input *input, pir_vec3 d) {
    pir_query_result result;
    pir_impact impact;
    pir_escape escapes[ROOM];
    pir_gradient gradient;
    pir_curvature curvature;
    static pir_active active[ROOM];
    size_t count;
    const pir_motion motion = {d, {0, 0.5, 0}, 0};
    pir_pair *pair = bench->pair;
    pir_workspace *w = bench->workspace;
    pir_status status = pir_pair_directional_depth(pair, w, input, d, &result);
    if (status == PIR_OK)
        status = pir_pair_directional_distance(pair, w, input, d, &result);
    if (status == PIR_OK)
        status = pir_pair_largest_distance(pair, w, input, &result);
    if (status == PIR_OK)
        status = pir_pair_escapes(pair, w, input, 0.1, ROOM, escapes, &count);
    if (status == PIR_OK)
        status = pir_pair_gradient(pair, w, input, &result, &gradient, &curvature);
    if (status == PIR_OK)
        status = pir_pair_active(pair, w, input, 0, ROOM, active, &count);
    if (status == PIR_OK)
        status = pir_pair_cast(pair, w, input, d, &impact);
    return status == PIR_OK ? pir_pair_time_of_impact(pair, w, input, &motion, 1e-3, &impact) : status;
}

static void no_call_allocates_once_warm(void **state) {
    (void)state;
    test_random random = test_random_case("warm", 0);
    test_memory memory = {0};
    const pir_allocator allocator = test_allocator(&memory);
    pir_pair_options options = pir_pair_options_default();
    struct bench bench = {.p = test_sphere(&random, 40), .q = test_sphere(&random, 30), .posed = false};
    options.allocator = &allocator;
    assert_int_equal(pir_workspace_create(&allocator, &bench.workspace), PIR_OK);
    assert_int_equal(pir_pair_create(bench.p, bench.q, &options, &bench.pair), PIR_OK);
    uint64_t before = 0;
    for (int pass = 0; pass < 2; pass++) {
        test_random again = test_random_case("warm", 1);
        before = memory.requests;
        for (int frame = 0; frame < 40; frame++) {
            pir_pair_input input = pir_pair_input_default();
            input.pose_p.rotation = test_rotation(&again);
            input.pose_p.translation = place(&again, false, 2);
            assert_int_equal(ask_all(&bench, &input, test_random_direction(&again)), PIR_OK);
        }
    }
    assert_int_equal(memory.requests - before, 0);
    clear(&bench);
    assert_int_equal(memory.blocks, 0);
}

static void what_is_no_question_is_refused(void **state) {
    (void)state;
    test_random random = test_random_case("refused", 0);
    struct bench bench;
    assert_true(make(&bench, &random, 0));
    const pir_pair_input good = input_of(&bench, (pir_vec3){0, 0, 0});
    pir_query_result result, untouched;
    pir_impact impact, before;
    memset(&result, 0x5a, sizeof result);
    memset(&impact, 0x5a, sizeof impact);
    untouched = result;
    before = impact;
    pir_pair *pair = bench.pair;
    pir_workspace *w = bench.workspace;
    const pir_vec3 none = {0, 0, 0}, wild = {0, NAN, 1};
    assert_int_equal(pir_pair_directional_depth(pair, w, &good, none, &result), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_directional_distance(pair, w, &good, wild, &result), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_pair_directional_depth(pair, w, &good, wild, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_largest_distance(NULL, w, &good, &result), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_cast(pair, w, &good, wild, &impact), PIR_ERR_NOT_FINITE);
    const pir_motion still = {none, none, 0}, whirl = {none, {0, 0, 0x1p21}, 0}, held = {none, none, -1};
    assert_int_equal(pir_pair_time_of_impact(pair, w, &good, &still, 0, &impact), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_time_of_impact(pair, w, &good, &whirl, 1, &impact), PIR_ERR_LIMIT);
    assert_int_equal(pir_pair_time_of_impact(pair, w, &good, &held, 1, &impact), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_time_of_impact(pair, w, NULL, &still, 1, &impact), PIR_ERR_ARGUMENT);
    pir_pair_options options = pir_pair_options_default();
    pir_pair *near_only;
    options.most = PIR_LEVEL_OVERLAPPING;
    assert_int_equal(pir_pair_create(bench.p, bench.q, &options, &near_only), PIR_OK);
    assert_int_equal(pir_pair_cast(near_only, w, &good, (pir_vec3){1, 0, 0}, &impact), PIR_ERR_LIMIT);
    pir_pair_destroy(near_only);
    assert_memory_equal(&result, &untouched, sizeof result);
    assert_memory_equal(&impact, &before, sizeof impact);
    clear(&bench);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(answers_are_those_of_a_sum),     cmocka_unit_test(cubes_slide_and_graze_in_a_turned_world),
        cmocka_unit_test(impacts_are_near_and_the_first), cmocka_unit_test(no_call_allocates_once_warm),
        cmocka_unit_test(what_is_no_question_is_refused),
    };
    return cmocka_run_group_tests_name("pairs along directions", tests, NULL, NULL);
}
