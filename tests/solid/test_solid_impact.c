/* SPDX-License-Identifier: MIT */
/*
 * First contacts of solids against exact states. P is a union of unit cubes that turns about an axis through the origin
 * of its frame, so that a quaternion (u, κ) of doubles is exactly its rotation at κ; ways are asked at doubles λ.
 * Where a screw is at κ is rounded. Before the told contact the bodies are apart at many κ, at its ends neither early
 * nor late.
 *
 * PIR_TEST_CASES sets how many pairs of unions there are, each with 10 motions.
 */
#include "support/test.h"

#include <math.h>

#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "support/memory.h"

enum { MOTIONS = 10, SAMPLES = 40 };

typedef struct swing {
    pir_solid_query *query;
    pir_workspace *workspace;
    pir_pair_input input;
    pir_exact_motion motion;
} swing;

static struct { unsigned outcome[8], grazes; } seen;

static pir_solid_query *query_of(const pir_solid *p, const pir_solid *q) {
    pir_pieces *of_p = NULL, *of_q = NULL;
    pir_solid_query *query = NULL;
    assert_int_equal(pir_solid_decompose(p, NULL, NULL, &of_p), PIR_OK);
    assert_int_equal(pir_solid_decompose(q, NULL, NULL, &of_q), PIR_OK);
    assert_int_equal(pir_solid_query_create(of_p, of_q, NULL, &query), PIR_OK);
    pir_pieces_destroy(of_q);
    pir_pieces_destroy(of_p);
    return query;
}

/* κ at a part of the motion. */
static double kappa_at(const swing *s, double part) {
    const pir_vec3 u = s->motion.axis;
    if (s->motion.degrees == 0)
        return 1 / part;
    const double half = part * fabs(s->motion.degrees) * acos(-1) / 360;
    return sqrt(u.x * u.x + u.y * u.y + u.z * u.z) / (part == 1 && fabs(s->motion.degrees) == 90 ? 1 : tan(half));
}

static bool goes(const swing *s) {
    const pir_vec3 way = s->motion.way;
    return way.x != 0 || way.y != 0 || way.z != 0;
}

static pir_pair_input input_at(const swing *s, double kappa) {
    pir_pair_input input = s->input;
    const pir_vec3 u = s->motion.axis, way = s->motion.way;
    const double sign = s->motion.degrees < 0 ? -1 : 1;
    // of small integers and few bits of λ: exact
    const double lambda = (s->motion.degrees == 0 ? 1 : kappa_at(s, 1)) / kappa;
    if (goes(s))
        input.pose_p.translation = (pir_vec3){lambda * way.x, lambda * way.y, lambda * way.z};
    if (s->motion.degrees != 0 && isfinite(kappa))
        input.pose_p.rotation = (pir_quat){sign * u.x, sign * u.y, sign * u.z, kappa};
    return input;
}

static pir_state state_at(const swing *s, double kappa) {
    const pir_pair_input input = input_at(s, kappa);
    pir_state state;
    assert_int_equal(pir_solid_query_overlap(s->query, s->workspace, &input, &state), PIR_OK);
    return state;
}

static void make_motion(swing *s, test_random *random) {
    const bool aligned = test_random_below(random, 2) == 0;
    s->input = pir_pair_input_default();
    s->input.pose_q.translation =
        (pir_vec3){0.5 * test_random_between(random, -10, 10), 0.5 * test_random_between(random, -10, 10),
                   0.5 * test_random_between(random, -10, 10)};
    static const pir_vec3 even[] = {{0, 0, 1}, {1, 0, 0}, {0, -2, 0}, {1, 1, 1}, {1, -1, 0}};
    s->motion =
        (pir_exact_motion){.axis = aligned ? even[test_random_below(random, 5)] : test_random_direction(random)};
    s->motion.degrees = aligned ? 90 * test_random_between(random, -4, 4) : 360 * test_random_unit(random);
    if (!aligned && test_random_below(random, 2) == 0) {
        const pir_vec3 v = test_random_direction(random);
        s->input.pose_q.rotation = (pir_quat){v.x, v.y, v.z, test_random_unit(random)};
    }
    const bool screws = test_random_below(random, 3) == 0;
    if (screws)
        s->motion.degrees = aligned ? 45 * test_random_between(random, 1, 3) : 1 + 175 * test_random_unit(random);
    if (s->motion.degrees == 0 || screws || test_random_below(random, 4) == 0) {
        s->motion.degrees = screws ? s->motion.degrees : 0;
        s->motion.way = (pir_vec3){test_random_between(random, -8, 8), test_random_between(random, -8, 8),
                                   test_random_between(random, -8, 8)};
    }
}

static void expect_apart_before(const swing *s, double last, uint64_t number) {
    for (int i = 1; i <= SAMPLES; i++) {
        const double kappa = kappa_at(s, (double)i / SAMPLES);
        if (!(kappa > last))
            break;
        expect(state_at(s, kappa) == PIR_OUTSIDE, "case %llu: late, κ %.17g", (unsigned long long)number, kappa);
    }
}

static void expect_contact(const swing *s, const pir_exact_impact *hit, uint64_t number) {
    const double low = hit->kappa[0], high = hit->kappa[1];
    expect(low <= high && high - low <= 1e-4 * (1 + fabs(low)), "case %llu: interval", (unsigned long long)number);
    expect(goes(s) || state_at(s, high) != PIR_INSIDE, "case %llu: late", (unsigned long long)number);
    const double hair = 1e-9 * (1 + fabs(high));
    expect(state_at(s, high + hair) == PIR_OUTSIDE, "case %llu: late by a hair", (unsigned long long)number);
    const double behind[3] = {low, low - hair, low - 1e3 * hair};
    for (int k = 0; k < 3; k++)
        if (state_at(s, behind[k]) == PIR_INSIDE)
            return;
    seen.grazes++;
    const pir_pair_input input = input_at(s, 0.5 * (low + high));
    pir_solid_distance distance;
    assert_int_equal(pir_solid_query_distance(s->query, s->workspace, &input, &distance), PIR_OK);
    expect(distance.result.distance < 1e-9, "case %llu: early", (unsigned long long)number);
}

static void check_motion(const swing *s, uint64_t number) {
    pir_exact_impact hit, again;
    assert_int_equal(pir_solid_query_impact(s->query, s->workspace, &s->input, &s->motion, &hit), PIR_OK);
    assert_int_equal(pir_solid_query_impact(s->query, s->workspace, &s->input, &s->motion, &again), PIR_OK);
    assert_true(hit.impact.piece_p == again.impact.piece_p && hit.impact.piece_q == again.impact.piece_q);
    assert_true(hit.kappa[0] == again.kappa[0] && hit.degrees == again.degrees);
    const bool rests = s->motion.degrees == 0 && !goes(s);
    const pir_cast_outcome outcome = hit.impact.outcome;
    // of a screw so late that motions of second order are greater than the rounding
    const double hair = goes(s) && s->motion.degrees != 0 ? 0x1p-16 : 0x1p-30;
    const pir_state start = state_at(s, INFINITY), soon = rests ? start : state_at(s, kappa_at(s, hair));
    seen.outcome[outcome]++;
    expect((start == PIR_INSIDE) == (outcome == PIR_CAST_START_INSIDE), "case %llu: %d", (unsigned long long)number,
           (int)outcome);
    if (start == PIR_BOUNDARY)
        expect(outcome == (soon == PIR_INSIDE ? PIR_CAST_HIT : PIR_CAST_RECEDING), "case %llu: start, %d",
               (unsigned long long)number, (int)outcome);
    else if (rests)
        expect(start == PIR_INSIDE || outcome == PIR_CAST_AT_REST, "case %llu: rests", (unsigned long long)number);
    else if (start == PIR_OUTSIDE) {
        assert_true(outcome == PIR_CAST_HIT || outcome == PIR_CAST_MISS);
        const bool hits = outcome == PIR_CAST_HIT;
        expect_apart_before(s, hits ? hit.kappa[1] : -INFINITY, number);
        if (hits)
            expect_contact(s, &hit, number);
    }
}

static void first_contacts_are_bracketed_by_states(void **state) {
    (void)state;
    swing s;
    assert_int_equal(pir_workspace_create(NULL, &s.workspace), PIR_OK);
    for (uint64_t i = 0; i < solid_cases(20); i++) {
        test_random random = test_random_case("swings", i);
        const cells p = cells_random(&random, 2 + test_random_below(&random, 20));
        const cells q = cells_random(&random, 1 + test_random_below(&random, 8));
        pir_solid *of_p = solid_of_cells(&p), *of_q = solid_of_cells(&q);
        s.query = query_of(of_p, of_q);
        for (int n = 0; n < MOTIONS; n++) {
            make_motion(&s, &random);
            check_motion(&s, i);
        }
        pir_solid_query_destroy(s.query);
        pir_solid_release(of_q);
        pir_solid_release(of_p);
    }
    printf("hits %u (grazes %u), misses %u, receding %u, inside %u, at rest %u\n", seen.outcome[PIR_CAST_HIT],
           seen.grazes, seen.outcome[PIR_CAST_MISS], seen.outcome[PIR_CAST_RECEDING],
           seen.outcome[PIR_CAST_START_INSIDE], seen.outcome[PIR_CAST_AT_REST]);
    pir_workspace_destroy(s.workspace);
}

static void wrong_motions_are_refused(void **state) {
    (void)state;
    cells one = {0};
    one.full[0][0][0] = true;
    pir_solid *cube = solid_of_cells(&one);
    swing s = {.query = query_of(cube, cube), .input = pir_pair_input_default()};
    assert_int_equal(pir_workspace_create(NULL, &s.workspace), PIR_OK);
    pir_exact_impact hit = {.degrees = 7};
    const pir_exact_motion wrong[] = {
        {.degrees = 90}, {.degrees = 361, .axis = {0, 0, 1}}, {.degrees = 180, .axis = {0, 0, 1}, .way = {1, 0, 0}}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
        assert_int_equal(pir_solid_query_impact(s.query, s.workspace, &s.input, &wrong[k], &hit), PIR_ERR_ARGUMENT);
    const pir_exact_motion endless = {.way = {INFINITY, 0, 0}};
    assert_int_equal(pir_solid_query_impact(s.query, s.workspace, &s.input, &endless, &hit), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_solid_query_impact(NULL, s.workspace, &s.input, &wrong[0], &hit), PIR_ERR_ARGUMENT);
    assert_true(hit.degrees == 7);
    pir_workspace_destroy(s.workspace);
    pir_solid_query_destroy(s.query);
    pir_solid_release(cube);
}

/* Two bars of several cells meet side on side: many pairs of pieces have their first contact at one κ. */
static void ties_that_run_out_of_memory_are_told(void **state) {
    (void)state;
    cells bar = {0};
    for (int k = 0; k < 3; k++)
        bar.full[0][0][k] = bar.full[1][0][k] = bar.full[0][k][0] = bar.full[1][k][0] = true;
    pir_solid *solid = solid_of_cells(&bar);
    pir_pieces *pieces = NULL;
    assert_int_equal(pir_solid_decompose(solid, NULL, NULL, &pieces), PIR_OK);
    const pir_exact_motion motions[] = {
        {.axis = {1, 0, 0}, .degrees = 360}, {.axis = {1, 0, 0}, .degrees = 170, .way = {2, 0, 0}}, {.way = {0, 8, 0}}};
    unsigned failed = 0;
    for (int m = 0; m < 3; m++) {
        pir_pair_input input = pir_pair_input_default();
        input.pose_q.translation = (pir_vec3){0, 6, 0};
        if (m < 2)
            input.pose_q.translation = (pir_vec3){0, -3.5, 0.5};
        pir_status status = PIR_ERR_MEMORY;
        for (uint64_t n = 1; status == PIR_ERR_MEMORY; n++) {
            test_memory memory = {0};
            const pir_allocator allocator = test_allocator(&memory);
            pir_solid_query *query = NULL;
            pir_workspace *workspace = NULL;
            assert_int_equal(pir_workspace_create(&allocator, &workspace), PIR_OK);
            assert_int_equal(pir_solid_query_create(pieces, pieces, &allocator, &query), PIR_OK);
            memory.fail_at = memory.requests + n;
            pir_exact_impact hit = {.degrees = 7};
            status = pir_solid_query_impact(query, workspace, &input, &motions[m], &hit);
            assert_true(status == PIR_OK || (status == PIR_ERR_MEMORY && hit.degrees == 7));
            assert_true(status != PIR_OK || hit.impact.outcome == PIR_CAST_HIT);
            failed += status == PIR_ERR_MEMORY;
            pir_solid_query_destroy(query);
            pir_workspace_destroy(workspace);
            assert_true(memory.blocks == 0 && !memory.wrong_size && !memory.overrun);
        }
    }
    printf("%u requests failed\n", failed);
    assert_true(failed > 0);
    pir_pieces_destroy(pieces);
    pir_solid_release(solid);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_contacts_are_bracketed_by_states),
        cmocka_unit_test(ties_that_run_out_of_memory_are_told),
        cmocka_unit_test(wrong_motions_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
