/* SPDX-License-Identifier: MIT */
/*
 * Gradients, Hessians and active sets of pairs and queries, held against differences of the signed distance that the
 * oracle of tests/oracle/signed_distance.h gives at moved poses: along random motions of both bodies at once, central
 * ones where one pair of features decides, one-sided ones at ties. A third of the poses is aligned on grids, where
 * bodies tie, touch and are flat.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/gradient.h>

#include "oracle/signed_distance.h"
#include "support/bodies.h"
#include "support/random.h"
#include "support/vectors.h"

#define ROOM 256
/* Steps of differences: 2^-60, whose square is far above the oracle's rounding. */
#define STEP (-60)

static uint64_t cases_of(uint64_t few) {
    const char *text = getenv("PIR_TEST_CASES");
    return text ? strtoull(text, NULL, 10) : few;
}

static uint64_t current; /* case */

#define FAULT(...)                                                                                                     \
    do {                                                                                                               \
        print_error("case %llu: ", (unsigned long long)current);                                                       \
        print_error(__VA_ARGS__);                                                                                      \
        fail_msg(" ");                                                                                                 \
    } while (0)

/* --- what was compared, for the summary --- */

static struct {
    uint64_t gradients, hessians, ties, along, outwards, between, unknown;
    double gradient, hessian, tie; /* the greatest errors, relative */
} seen;

/* --- scenes --- */

struct scene {
    pir_polytope *p, *q;
    pir_pair *pair;
    pir_workspace *workspace;
    oracle_signed *oracle;
    mpf_t at, before, after;
};

static void open_scene(struct scene *s, pir_polytope *p, pir_polytope *q) {
    *s = (struct scene){.p = p, .q = q, .oracle = oracle_signed_make(p, q)};
    assert_int_equal(pir_workspace_create(NULL, &s->workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, q, NULL, &s->pair), PIR_OK);
    oracle_signed_init(s->at);
    oracle_signed_init(s->before);
    oracle_signed_init(s->after);
}

static void close_scene(struct scene *s) {
    mpf_clear(s->at);
    mpf_clear(s->before);
    mpf_clear(s->after);
    oracle_signed_free(s->oracle);
    pir_pair_destroy(s->pair);
    pir_workspace_destroy(s->workspace);
    pir_polytope_release(s->p);
    pir_polytope_release(s->q);
}

/* A body of few points: of general position, or on a grid. */
static pir_polytope *small_body(test_random *random, bool aligned) {
    static const test_body general[] = {TEST_SPHERE, TEST_BALL, TEST_SPHERE, TEST_POLYGON, TEST_SEGMENT, TEST_POINT};
    static const test_body grid[] = {TEST_GRID, TEST_BOX, TEST_OCTAHEDRON, TEST_PRISM, TEST_POLYGON, TEST_SEGMENT};
    const test_body body = (aligned ? grid : general)[test_random_below(random, 6)];
    return test_random_polytope(random, body, 5);
}

static double size_of(const struct scene *s) {
    double most = 0;
    for (int k = 0; k < 2; k++) {
        const pir_polytope *p = k ? s->q : s->p;
        for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++)
            most = fmax(most, test_length(pir_polytope_vertex(p, v)));
    }
    return most;
}

static pir_pose random_pose(test_random *random, bool aligned, double size) {
    pir_pose pose = {aligned ? test_integer_rotation(random) : test_general_rotation(random), {0, 0, 0}};
    double *t[3] = {&pose.translation.x, &pose.translation.y, &pose.translation.z};
    for (int k = 0; k < 3; k++) {
        const double x = size * test_random_unit(random);
        *t[k] = aligned ? rint(2 * x) / 2 : x;
    }
    return pose;
}

/* --- differences --- */

static void random_motion(test_random *random, double motion[12]) {
    for (int k = 0; k < 12; k += 3) {
        const pir_vec3 v = test_random_direction(random);
        motion[k] = v.x;
        motion[k + 1] = v.y;
        motion[k + 2] = v.z;
    }
}

static double distance_less(struct scene *s, const pir_pair_input *input, const double motion[12], double sign,
                            mpf_t ret_difference) {
    double moved[12];
    for (int k = 0; k < 12; k++)
        moved[k] = sign * motion[k];
    oracle_signed_distance(s->oracle, &input->pose_p, &input->pose_q, moved, STEP, ret_difference);
    mpf_sub(ret_difference, ret_difference, s->at);
    return ldexp(mpf_get_d(ret_difference), -STEP);
}

static double dot12(const double a[12], const double b[12]) {
    double sum = 0;
    for (int k = 0; k < 12; k++)
        sum += a[k] * b[k];
    return sum;
}

static double along(const pir_wrench *p, const pir_wrench *q, const double m[12]) {
    return pir_wrench_along(*p, (pir_vec3){m[0], m[1], m[2]}, (pir_vec3){m[3], m[4], m[5]}) +
           pir_wrench_along(*q, (pir_vec3){m[6], m[7], m[8]}, (pir_vec3){m[9], m[10], m[11]});
}

static double keep_greatest(double *most, double error) {
    *most = fmax(*most, error);
    return error;
}

/* The second difference, over the square of the step. */
static double second_difference(struct scene *s) {
    mpf_add(s->before, s->before, s->after);
    return ldexp(mpf_get_d(s->before), -2 * STEP);
}

static void check_smooth(struct scene *s, const pir_pair_input *input, const pir_gradient *gradient,
                         const pir_curvature *curvature, const double motion[12], double scale, bool aligned) {
    const double after = distance_less(s, input, motion, 1, s->after);
    const double before = distance_less(s, input, motion, -1, s->before);
    const double first = along(&gradient->p, &gradient->q, motion),
                 error = fabs(first - 0.5 * (after - before)) / scale;
    seen.gradients++;
    if (keep_greatest(&seen.gradient, error) > 1e-9)
        FAULT("the gradient is off by %g of scale: %g, %g", error, first, 0.5 * (after - before));
    // aligned bodies may be where second derivatives jump
    if (aligned || !curvature->is_known)
        return;
    double most = scale, twice[12];
    for (int i = 0; i < 12; i++) {
        twice[i] = dot12(curvature->hessian[i], motion);
        for (int j = 0; j < 12; j++)
            most = fmax(most, fabs(curvature->hessian[i][j]));
    }
    const double second = dot12(twice, motion), should = second_difference(s), off = fabs(second - should) / most;
    seen.hessians++;
    if (keep_greatest(&seen.hessian, off) > 1e-7)
        FAULT("the Hessian is off by %g: %g, %g", off, second, should);
}

/* The derivative along a motion from the active set: the greatest over facets of the least over corners. */
static double along_active(const pir_active *active, size_t count, const double motion[12]) {
    double most = -HUGE_VAL;
    for (size_t i = 0; i < count;) {
        double least = HUGE_VAL;
        const uint32_t facet = active[i].facet;
        for (; i < count && active[i].facet == facet; i++)
            least = fmin(least, along(&active[i].p, &active[i].q, motion));
        most = fmax(most, least);
    }
    return most;
}

/* Whether some facet of several has more corners than one. */
static bool has_long_facets(const pir_active *active, size_t count) {
    return active[count - 1].facet > 0 && count > active[count - 1].facet + (size_t)1;
}

/*
 * Edges of both that lie along each other cross as they turn, in facets between those told. The derivative along a
 * motion is no less than that of these, and no greater than that of any corner.
 */
static void check_between(const pir_active *active, size_t count, const double motion[12], double after, double scale) {
    double most = -HUGE_VAL;
    for (size_t i = 0; i < count; i++)
        most = fmax(most, along(&active[i].p, &active[i].q, motion));
    const double told = along_active(active, count, motion);
    seen.between++;
    if (after < told - 1e-9 * scale || after > most + 1e-9 * scale)
        FAULT("the active set of %zu has %g to %g, should be %g", count, told, most, after);
}

static void check_tie(struct scene *s, const pir_pair_input *input, const pir_active *active, size_t count,
                      const double motion[12], double scale) {
    const double after = distance_less(s, input, motion, 1, s->after);
    // from a touch at a corner or an edge outwards, the distance is not that to one facet's plane
    const bool touches = fabs(mpf_get_d(s->at)) < 1e-60, outwards = touches && after > 0;
    seen.ties += count > 1;
    seen.outwards += outwards;
    if (outwards && active[count - 1].facet > 0)
        return;
    if (touches && has_long_facets(active, count)) {
        check_between(active, count, motion, after, scale);
        return;
    }
    seen.along++;
    const double told = along_active(active, count, motion), error = fabs(told - after) / scale;
    if (keep_greatest(&seen.tie, error) > 1e-9)
        FAULT("the active set of %zu is off by %g of scale: %g, %g", count, error, told, after);
}

/* --- what holds of every answer --- */

static void check_curvature(const pir_curvature *curvature) {
    double most = 1;
    for (int i = 0; i < 12; i++)
        for (int j = 0; j < 12; j++) {
            if (curvature->hessian[i][j] != curvature->hessian[j][i])
                FAULT("the Hessian is not symmetric");
            most = fmax(most, fabs(curvature->hessian[i][j]));
        }
    // the derivative to P's translation is the normal
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 12; j++)
            if (fabs(curvature->hessian[i][j] - curvature->normal[i][j]) > 1e-11 * most)
                FAULT("the normal turns otherwise: %g, %g", curvature->hessian[i][j], curvature->normal[i][j]);
}

static void check_first(const pir_query_result *result, const pir_gradient *gradient, const pir_active *active) {
    if (memcmp(&active->normal, &result->normal, sizeof active->normal) != 0 || active->distance != result->distance)
        FAULT("the first of the active set is another");
    if (memcmp(&gradient->features, &active->features, sizeof active->features) != 0)
        FAULT("features %d %u, %d %u or %d %u, %d %u", gradient->features.p.kind, gradient->features.p.index,
              gradient->features.q.kind, gradient->features.q.index, active->features.p.kind, active->features.p.index,
              active->features.q.kind, active->features.q.index);
}

/* The features that may decide, and one motion by these and by all. */
static void settle(struct scene *s, const pir_pair_input *input) {
    static const double motion[12] = {0.5, -0.25, 0.75, 0.25, 1, -0.5, -1, 0.5, 0.125, -0.75, 0.25, 1};
    oracle_signed_distance(s->oracle, &input->pose_p, &input->pose_q, motion, STEP, s->before);
    oracle_signed_settle(s->oracle, &input->pose_p, &input->pose_q);
    oracle_signed_distance(s->oracle, &input->pose_p, &input->pose_q, motion, STEP, s->after);
    if (mpf_cmp(s->before, s->after) != 0)
        FAULT("the oracle's candidates tell %g where all features tell %g", mpf_get_d(s->after), mpf_get_d(s->before));
}

static void check_pose(struct scene *s, const pir_pair_input *input, test_random *random, bool aligned, int motions) {
    static const double still[12];
    static pir_active active[ROOM];
    pir_query_result result;
    pir_gradient gradient;
    pir_curvature curvature;
    size_t count;
    assert_int_equal(pir_pair_gradient(s->pair, s->workspace, input, &result, &gradient, &curvature), PIR_OK);
    assert_int_equal(pir_pair_active(s->pair, s->workspace, input, 0, ROOM, active, &count), PIR_OK);
    assert_true(count > 0 && count <= ROOM);
    check_curvature(&curvature);
    check_first(&result, &gradient, active);
    oracle_signed_distance(s->oracle, &input->pose_p, &input->pose_q, still, STEP, s->at);
    settle(s, input);
    const double scale =
        1 + size_of(s) + test_length(input->pose_p.translation) + test_length(input->pose_q.translation);
    const double radii = input->radius_p + input->radius_q, polytopes = mpf_get_d(s->at);
    if (fabs(polytopes - radii - result.distance) > 1e-12 * scale)
        FAULT("distance %g, should be %g", result.distance, polytopes - radii);
    seen.unknown += !curvature.is_known;
    for (int k = 0; k < motions; k++) {
        double motion[12];
        random_motion(random, motion);
        check_tie(s, input, active, count, motion, scale);
        // at a touch of flat bodies both sides are outside
        if (count == 1 && fabs(polytopes) > 1e-60)
            check_smooth(s, input, &gradient, &curvature, motion, scale, aligned);
    }
}

/* A query on a sum, where Q is at the identity, gives the same bits as the pair. */
static void check_query(struct scene *s, const pir_pair_input *input, double slack) {
    static pir_active active[2][ROOM];
    pir_sum *sum;
    pir_query *query;
    pir_sum_options options = pir_sum_options_default();
    pir_query_result result[2];
    pir_gradient gradient[2];
    pir_curvature curvature[2];
    pir_query_cache cache = {0};
    size_t count[2];
    options.difference = true;
    pir_query_input asked = pir_query_input_default();
    asked.translation = input->pose_p.translation;
    asked.radius_p = input->radius_p;
    asked.radius_q = input->radius_q;
    assert_int_equal(pir_sum_create(s->p, s->q, input->pose_p.rotation, &options, &sum), PIR_OK);
    assert_int_equal(pir_query_create(sum, &query), PIR_OK);
    memset(curvature, 0, sizeof curvature);
    memset(result, 0, sizeof result);
    for (int again = 0; again < 2; again++) {
        assert_int_equal(pir_pair_gradient(s->pair, s->workspace, input, &result[0], &gradient[0], &curvature[0]),
                         PIR_OK);
        assert_int_equal(pir_query_gradient(query, &asked, &cache, &result[1], &gradient[1], &curvature[1]), PIR_OK);
        result[0].steps = result[1].steps;
        if (memcmp(&result[0], &result[1], sizeof result[0]) != 0 ||
            memcmp(&gradient[0], &gradient[1], sizeof gradient[0]) != 0 ||
            memcmp(&curvature[0], &curvature[1], sizeof curvature[0]) != 0)
            FAULT("a query on the sum tells otherwise");
        assert_int_equal(pir_pair_active(s->pair, s->workspace, input, slack, ROOM, active[0], &count[0]), PIR_OK);
        assert_int_equal(pir_query_active(query, &asked, slack, ROOM, active[1], &count[1]), PIR_OK);
        if (count[0] != count[1] || memcmp(active[0], active[1], count[0] * sizeof **active) != 0)
            FAULT("a query on the sum has %zu active, not %zu", count[1], count[0]);
    }
    pir_query_destroy(query);
    pir_sum_destroy(sum);
}

static void summarise(void) {
    printf("%llu gradients off by %.1e at most, %llu Hessians by %.1e, %llu one-sided by %.1e, of which %llu at ties; "
           "%llu outwards from a touch, %llu between facets, %llu curvatures unknown\n",
           (unsigned long long)seen.gradients, seen.gradient, (unsigned long long)seen.hessians, seen.hessian,
           (unsigned long long)seen.along, seen.tie, (unsigned long long)seen.ties, (unsigned long long)seen.outwards,
           (unsigned long long)seen.between, (unsigned long long)seen.unknown);
}

static void test_differences(void **state) {
    (void)state;
    const uint64_t cases = cases_of(1500);
    memset(&seen, 0, sizeof seen);
    for (current = 0; current < cases; current++) {
        test_random random = test_random_case("gradients", current / 5);
        test_random of_pose = test_random_case("gradients, poses", current);
        const bool aligned = current / 5 % 3 == 0;
        struct scene s;
        open_scene(&s, small_body(&random, aligned), small_body(&random, aligned));
        pir_pair_input input = pir_pair_input_default();
        const double size = size_of(&s) + 0.5;
        input.pose_p = random_pose(&of_pose, aligned, 1.2 * size);
        if (current % 4 != 0)
            input.pose_q = random_pose(&of_pose, aligned, size);
        if (current % 7 == 0) {
            input.radius_p = 0.25;
            input.radius_q = 0.125 * (double)(current % 3);
        }
        check_pose(&s, &input, &of_pose, aligned, 3);
        close_scene(&s);
    }
    summarise();
}

/* a·b, exact where both are of small whole numbers. */
static pir_quat product(pir_quat a, pir_quat b) {
    return (pir_quat){a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

/* Grid bodies a few quarter turns apart: parallel faces, edges over edges, equal depths, touches. */
static void test_ties(void **state) {
    (void)state;
    static const pir_quat turns[] = {{0, 0, 0, 1}, {0, 0, 1, 1}, {1, 0, 0, 1},
                                     {1, 1, 1, 1}, {0, 1, 0, 0}, {0, 0, 1, 2}};
    // in the long run 1000 motions each
    const uint64_t asked = cases_of(1500) / 5, cases = asked < 2000 ? asked : 2000;
    memset(&seen, 0, sizeof seen);
    for (current = 0; current < cases; current++) {
        test_random random = test_random_case("ties of gradients", current);
        struct scene s;
        open_scene(&s, small_body(&random, true), small_body(&random, true));
        pir_pair_input input = pir_pair_input_default();
        input.pose_p = random_pose(&random, true, 0.8 * size_of(&s));
        input.pose_p.rotation = turns[test_random_below(&random, 6)];
        if (current % 2) {
            // whole turns of the world by a third, which no double rounds
            const pir_quat third = {1, 1, 1, 1};
            const pir_vec3 t = input.pose_p.translation;
            input.pose_q.rotation = third;
            input.pose_p.rotation = product(third, input.pose_p.rotation);
            input.pose_p.translation = (pir_vec3){t.z + 1, t.x - 2, t.y};
            input.pose_q.translation = (pir_vec3){1, -2, 0};
        }
        check_pose(&s, &input, &random, true, cases > 1000 ? 1000 : 10);
        if (current % 2 == 0)
            check_query(&s, &input, 0.25 * (double)(current % 8));
        close_scene(&s);
    }
    summarise();
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_differences), cmocka_unit_test(test_ties)};
    test_print_seed();
    return cmocka_run_group_tests_name("gradients", tests, NULL, NULL);
}
