/* SPDX-License-Identifier: MIT */
/*
 * Sweeps of solids against sweeps of all pairs of their pieces, and against exact states of the unions at poses on the
 * way, in doubles. Solids are unions of unit cubes.
 *
 * PIR_TEST_CASES sets how many pairs of unions there are, each with MOTIONS motions.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "support/bodies.h"

enum { MOTIONS = 10, SAMPLES = 24, PIECES = 64 };

typedef struct two {
    pir_solid_query *query;
    pir_workspace *workspace;
    pir_polytope *piece[2][PIECES];
    uint32_t pieces[2];
    pir_pair_input first, second;
    bool screws; /* along `screw`, in place of to `second` */
    pir_exact_motion screw;
} two;

static struct { unsigned outcome[3], fewer, samples; } seen;

static void make_two(two *t, test_random *random) {
    pir_pieces *pieces[2];
    for (int k = 0; k < 2; k++) {
        const cells of = cells_random(random, 2 + test_random_below(random, 10));
        pir_solid *solid = solid_of_cells(&of);
        assert_int_equal(pir_solid_decompose(solid, NULL, NULL, &pieces[k]), PIR_OK);
        t->pieces[k] = pir_pieces_count(pieces[k]);
        assert_true(t->pieces[k] <= PIECES);
        for (uint32_t i = 0; i < t->pieces[k]; i++)
            assert_int_equal(pir_pieces_polytope(pieces[k], i, &t->piece[k][i]), PIR_OK);
        pir_solid_release(solid);
    }
    assert_int_equal(pir_solid_query_create(pieces[0], pieces[1], NULL, &t->query), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &t->workspace), PIR_OK);
    for (int k = 0; k < 2; k++)
        pir_pieces_destroy(pieces[k]);
}

static void free_two(two *t) {
    pir_solid_query_destroy(t->query);
    pir_workspace_destroy(t->workspace);
    for (int k = 0; k < 2; k++)
        for (uint32_t i = 0; i < t->pieces[k]; i++)
            pir_polytope_release(t->piece[k][i]);
}

static pir_pose random_pose(test_random *random, bool aligned, double size) {
    static const pir_quat even[] = {{0, 0, 0, 1}, {0, 0, 1, 1}, {1, 0, 0, -1}, {0, 1, 0, 0}, {1, 1, 1, 1}};
    const pir_vec3 v = test_random_direction(random);
    pir_pose pose = {test_general_rotation(random), {size * v.x, size * v.y, size * v.z}};
    if (aligned) {
        pose.rotation = even[test_random_below(random, 5)];
        pose.translation = (pir_vec3){rint(pose.translation.x), rint(pose.translation.y), rint(pose.translation.z)};
    }
    return pose;
}

static void make_motion(two *t, test_random *random) {
    const bool aligned = test_random_below(random, 2) == 0, q_rests = test_random_below(random, 2) == 0;
    t->first = t->second = pir_pair_input_default();
    t->first.pose_p = random_pose(random, aligned, 7);
    t->second.pose_p = random_pose(random, aligned, 7);
    if (test_random_below(random, 3) == 0)
        t->second.pose_p.rotation = t->first.pose_p.rotation;
    t->first.pose_q = random_pose(random, aligned, 2);
    t->second.pose_q = q_rests ? t->first.pose_q : random_pose(random, aligned, 2);
    if (test_random_below(random, 5) == 0)
        t->first.radius_p = t->second.radius_p = 0.125;
}

/* Likewise a screw of P. */
static void make_screw(two *t, test_random *random) {
    const bool aligned = test_random_below(random, 2) == 0;
    make_motion(t, random);
    t->second.pose_q = t->first.pose_q;
    t->screws = true;
    const pir_pose pivot = random_pose(random, aligned, 3), way = random_pose(random, aligned, 5);
    t->screw = (pir_exact_motion){.pivot = pivot.translation,
                                  .axis = aligned ? (pir_vec3){0, 0, 2} : test_random_direction(random),
                                  .degrees = 90 * test_random_between(random, -5, 5),
                                  .way = way.translation};
}

/* --- the loop --- */

static pir_status sweep_of(const two *t, pir_sweep_result *ret_sweep) {
    return t->screws ? pir_solid_query_sweep_screw(t->query, t->workspace, &t->first, &t->screw, 0, ret_sweep)
                     : pir_solid_query_sweep(t->query, t->workspace, &t->first, &t->second, 0, ret_sweep);
}

static pir_status sweep_of_pair(const two *t, pir_pair *pair, pir_sweep_result *ret_sweep) {
    return t->screws ? pir_pair_sweep_screw(pair, t->workspace, &t->first, &t->screw, 0, ret_sweep)
                     : pir_pair_sweep(pair, t->workspace, &t->first, &t->second, 0, ret_sweep);
}

static pir_sweep_result loop(const two *t) {
    pir_sweep_result all = {PIR_SWEEP_FREE, 1, 1, 0};
    double meets = HUGE_VAL, last = 0;
    for (uint32_t i = 0; i < t->pieces[0]; i++)
        for (uint32_t j = 0; j < t->pieces[1]; j++) {
            pir_pair *pair;
            pir_sweep_result sweep;
            assert_int_equal(pir_pair_create(t->piece[0][i], t->piece[1][j], NULL, &pair), PIR_OK);
            assert_int_equal(sweep_of_pair(t, pair, &sweep), PIR_OK);
            pir_pair_destroy(pair);
            all.queries += sweep.queries;
            if (sweep.outcome == PIR_SWEEP_FREE)
                continue;
            all.from = fmin(all.from, sweep.from);
            if (sweep.outcome == PIR_SWEEP_MEETS)
                meets = fmin(meets, sweep.to);
            else
                last = fmax(last, sweep.to);
            all.outcome = PIR_SWEEP_UNDECIDED;
        }
    if (all.outcome == PIR_SWEEP_FREE)
        return all;
    all.outcome = meets <= 1 ? PIR_SWEEP_MEETS : PIR_SWEEP_UNDECIDED;
    all.to = meets <= 1 ? meets : last;
    return all;
}

/* --- states on the way --- */

static pir_pose between(pir_pose a, pir_pose b, double time) {
    const pir_quat p = a.rotation, q = b.rotation;
    const double n =
        sqrt((p.x * p.x + p.y * p.y + p.z * p.z + p.w * p.w) * (q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w));
    const double cosine = (p.x * q.x + p.y * q.y + p.z * q.z + p.w * q.w) / n, side = cosine < 0 ? -1 : 1;
    const double half = acos(fmin(1, side * cosine)), sine = sin(half);
    const double lp = sqrt(p.x * p.x + p.y * p.y + p.z * p.z + p.w * p.w), lq = n / lp;
    const double s = sine > 1e-9 ? sin((1 - time) * half) / sine / lp : (1 - time) / lp;
    const double e = side * (sine > 1e-9 ? sin(time * half) / sine / lq : time / lq);
    return (pir_pose){{s * p.x + e * q.x, s * p.y + e * q.y, s * p.z + e * q.z, s * p.w + e * q.w},
                      {a.translation.x + time * (b.translation.x - a.translation.x),
                       a.translation.y + time * (b.translation.y - a.translation.y),
                       a.translation.z + time * (b.translation.z - a.translation.z)}};
}

/* P's pose on a screw: R(t - pivot) + pivot + time·way, R by the formula of Rodrigues. */
static pir_pose screwed(const two *t, double time) {
    const pir_exact_motion *s = &t->screw;
    const double n = sqrt(s->axis.x * s->axis.x + s->axis.y * s->axis.y + s->axis.z * s->axis.z);
    const double angle = time * s->degrees * 0.017453292519943295, sine = sin(angle / 2), cosine = cos(angle / 2);
    const pir_vec3 u = {s->axis.x / n, s->axis.y / n, s->axis.z / n}, p = t->first.pose_p.translation;
    const pir_vec3 x = {p.x - s->pivot.x, p.y - s->pivot.y, p.z - s->pivot.z};
    const pir_vec3 across = {u.y * x.z - u.z * x.y, u.z * x.x - u.x * x.z, u.x * x.y - u.y * x.x};
    const double along = (u.x * x.x + u.y * x.y + u.z * x.z) * (1 - cos(angle)), c = cos(angle), w = sin(angle);
    const pir_quat q = t->first.pose_p.rotation;
    const double a = sine * u.x, b = sine * u.y, d = sine * u.z;
    return (pir_pose){{cosine * q.x + a * q.w + b * q.z - d * q.y, cosine * q.y + b * q.w + d * q.x - a * q.z,
                       cosine * q.z + d * q.w + a * q.y - b * q.x, cosine * q.w - a * q.x - b * q.y - d * q.z},
                      {c * x.x + w * across.x + along * u.x + s->pivot.x + time * s->way.x,
                       c * x.y + w * across.y + along * u.y + s->pivot.y + time * s->way.y,
                       c * x.z + w * across.z + along * u.z + s->pivot.z + time * s->way.z}};
}

static pir_state state_at(const two *t, double time) {
    pir_pair_input input = t->first;
    input.pose_p = t->screws ? screwed(t, time) : between(t->first.pose_p, t->second.pose_p, time);
    input.pose_q = between(t->first.pose_q, t->second.pose_q, time);
    pir_state state;
    assert_int_equal(pir_solid_query_overlap(t->query, t->workspace, &input, &state), PIR_OK);
    return state;
}

/* Half a turn has two ways, which the function above does not tell apart. */
static bool is_half_turn(pir_quat p, pir_quat q) {
    return fabs(p.x * q.x + p.y * q.y + p.z * q.z + p.w * q.w) <
           1e-9 *
               sqrt((p.x * p.x + p.y * p.y + p.z * p.z + p.w * p.w) * (q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w));
}

static void check_states(const two *t, const pir_sweep_result *sweep, uint64_t number) {
    if (!t->screws && (is_half_turn(t->first.pose_p.rotation, t->second.pose_p.rotation) ||
                       is_half_turn(t->first.pose_q.rotation, t->second.pose_q.rotation)))
        return;
    for (int i = 0; i <= SAMPLES; i++) {
        const double time = sweep->from * i / SAMPLES;
        // at `from` itself, unless the motion is free, the gap may be what poses in doubles are off by
        if (time < sweep->from || sweep->outcome == PIR_SWEEP_FREE)
            expect(state_at(t, time) == PIR_OUTSIDE, "case %llu: outcome %d, %.17g to %.17g, not apart at %.17g",
                   (unsigned long long)number, sweep->outcome, sweep->from, sweep->to, time);
        seen.samples++;
    }
    if (sweep->outcome == PIR_SWEEP_MEETS && sweep->to > 0 && sweep->to < 1)
        assert_int_equal(state_at(t, sweep->to), PIR_INSIDE);
}

static void check_motion(const two *t, uint64_t number) {
    pir_sweep_result sweep;
    assert_int_equal(sweep_of(t, &sweep), PIR_OK);
    const pir_sweep_result all = loop(t);
    seen.outcome[sweep.outcome]++;
    seen.fewer += sweep.queries < all.queries;
    expect(sweep.outcome == all.outcome && sweep.to == all.to && sweep.from >= all.from && sweep.from <= sweep.to &&
               (sweep.outcome == PIR_SWEEP_MEETS || sweep.from == all.from) && sweep.queries <= all.queries,
           "case %llu: %d, %.17g to %.17g; all pairs %d, %.17g to %.17g", (unsigned long long)number, sweep.outcome,
           sweep.from, sweep.to, all.outcome, all.from, all.to);
    check_states(t, &sweep, number);
}

static void sweeps_are_those_of_all_pairs(void **state) {
    (void)state;
    const char *text = getenv("PIR_TEST_CASES");
    const uint64_t count = text ? strtoull(text, NULL, 10) : 30;
    for (uint64_t i = 0; i < count; i++) {
        test_random random = test_random_case("solid sweep", i);
        two t;
        make_two(&t, &random);
        for (uint32_t k = 0; k < MOTIONS; k++) {
            t.screws = false;
            if (k % 2 == 0)
                make_motion(&t, &random);
            else
                make_screw(&t, &random);
            check_motion(&t, MOTIONS * i + k);
        }
        free_two(&t);
    }
    print_message("%u free, %u meet, %u undecided; %u asked fewer pairs; %u states\n", seen.outcome[PIR_SWEEP_FREE],
                  seen.outcome[PIR_SWEEP_MEETS], seen.outcome[PIR_SWEEP_UNDECIDED], seen.fewer, seen.samples);
    assert_true(seen.outcome[PIR_SWEEP_FREE] > 0 && seen.outcome[PIR_SWEEP_MEETS] > 0 && seen.fewer > 0);
}

static void bad_input_is_refused(void **state) {
    (void)state;
    test_random random = test_random_case("solid sweep", 0);
    two t;
    make_two(&t, &random);
    pir_pair_input first = pir_pair_input_default(), second = first;
    // so far apart that no pair is asked
    first.pose_p.translation.x = second.pose_p.translation.x = 1000;
    pir_sweep_result sweep = {.from = -1};
    second.pose_q.rotation.w = 0;
    assert_int_equal(pir_solid_query_sweep(t.query, t.workspace, &first, &second, 0, &sweep), PIR_ERR_ZERO_QUATERNION);
    second.pose_q.rotation.w = NAN;
    assert_int_equal(pir_solid_query_sweep(t.query, t.workspace, &first, &second, 0, &sweep), PIR_ERR_NOT_FINITE);
    second.pose_q.rotation.w = 1;
    second.pose_q.translation.y = INFINITY;
    assert_int_equal(pir_solid_query_sweep(t.query, t.workspace, &first, &second, 0, &sweep), PIR_ERR_NOT_FINITE);
    second.pose_q.translation.y = 1e308;
    assert_int_equal(pir_solid_query_sweep(t.query, t.workspace, &first, &second, 0, &sweep), PIR_ERR_LIMIT);
    second.pose_q.translation.y = 0;
    first.radius_q = -1;
    assert_int_equal(pir_solid_query_sweep(t.query, t.workspace, &first, &second, 0, &sweep), PIR_ERR_ARGUMENT);
    first.radius_q = 0;
    assert_int_equal(pir_solid_query_sweep(NULL, t.workspace, &first, &second, 0, &sweep), PIR_ERR_ARGUMENT);
    pir_exact_motion screw = {.degrees = 90};
    assert_int_equal(pir_solid_query_sweep_screw(t.query, t.workspace, &first, &screw, 0, &sweep), PIR_ERR_ARGUMENT);
    screw = (pir_exact_motion){.axis = {0, 0, 1}, .pivot = {0, NAN, 0}};
    assert_int_equal(pir_solid_query_sweep_screw(t.query, t.workspace, &first, &screw, 0, &sweep), PIR_ERR_NOT_FINITE);
    screw = (pir_exact_motion){.axis = {0, 0, 1}, .pivot = {0, 1e308, 0}, .degrees = 1, .way = {1e308, 0, 0}};
    assert_int_equal(pir_solid_query_sweep_screw(t.query, t.workspace, &first, &screw, 0, &sweep), PIR_ERR_LIMIT);
    assert_true(sweep.from == -1);
    assert_int_equal(pir_solid_query_sweep(t.query, t.workspace, &first, &second, 0, &sweep), PIR_OK);
    assert_true(sweep.outcome == PIR_SWEEP_FREE && sweep.queries == 0);
    free_two(&t);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sweeps_are_those_of_all_pairs),
        cmocka_unit_test(bad_input_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
