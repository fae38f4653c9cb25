/* SPDX-License-Identifier: MIT */
/*
 * Boxes of integers along the axes, many of them flat: rectangles, segments, points. Their difference is such a box
 * too, so every query has an answer that a few comparisons of integers give. Most poses have ties, and many touch.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/ccd.h>
#include <pirouette/query.h>

#include "query/query_of.h"
#include "support/random.h"

#define PAIRS 250
#define POSES 24

typedef struct box {
    int low[3], high[3];
} box;

struct scene {
    box p, q, d; /* P turned, Q, and the translations at which they meet */
    double unit; /* a power of two */
    pir_query *query;
    const pir_polytope *body_p, *body_q;
    pir_quat rotation;
    uint64_t number;
};

struct ray {
    bool meets;
    int enter[2], leave[2]; /* fractions of the motion, with denominators above 0 */
    bool inwards;           /* from the boundary */
};

static double component(pir_vec3 v, int k) {
    return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

static pir_vec3 vector(const int c[3], double unit) {
    return (pir_vec3){c[0] * unit, c[1] * unit, c[2] * unit};
}

static double length_of(pir_vec3 v) {
    return sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

/* --- scenes --- */

static box draw_box(test_random *random) {
    box b;
    for (int k = 0; k < 3; k++) {
        b.low[k] = test_random_between(random, -3, 3);
        b.high[k] = b.low[k] + (test_random_below(random, 2) ? test_random_between(random, 1, 3) : 0);
    }
    return b;
}

static pir_polytope *polytope_of(const box *b, double unit) {
    pir_vec3 points[8];
    pir_polytope *p = NULL;
    for (int i = 0; i < 8; i++) {
        const int c[3] = {i & 1 ? b->high[0] : b->low[0], i & 2 ? b->high[1] : b->low[1],
                          i & 4 ? b->high[2] : b->low[2]};
        points[i] = vector(c, unit);
    }
    assert_int_equal(pir_polytope_create(points, 8, NULL, &p), PIR_OK);
    return p;
}

/* A quarter turn from axis i to axis i + 1, or none for i = 3. */
static box turned(const box *b, int i) {
    box to = *b;
    if (i == 3)
        return to;
    int j = (i + 1) % 3;
    to.low[j] = b->low[i];
    to.high[j] = b->high[i];
    to.low[i] = -b->high[j];
    to.high[i] = -b->low[j];
    return to;
}

static pir_quat quarter_turn(int i) {
    return (pir_quat){i == 1 ? 1 : 0, i == 2 ? 1 : 0, i == 0 ? 1 : 0, 1};
}

/* --- what geometry says --- */

static pir_state state_at(const box *d, const int t[3]) {
    pir_state state = PIR_INSIDE;
    for (int k = 0; k < 3; k++) {
        if (t[k] < d->low[k] || t[k] > d->high[k])
            return PIR_OUTSIDE;
        if (t[k] == d->low[k] || t[k] == d->high[k])
            state = PIR_BOUNDARY;
    }
    return state;
}

static bool is_flat(const box *b) {
    return b->low[0] == b->high[0] || b->low[1] == b->high[1] || b->low[2] == b->high[2];
}

/* The slack of side `i` of six. */
static int slack_at(const box *d, const int t[3], int i) {
    return i % 2 ? d->high[i / 2] - t[i / 2] : t[i / 2] - d->low[i / 2];
}

static int depth_at(const box *d, const int t[3]) {
    int least = slack_at(d, t, 0);
    for (int i = 1; i < 6; i++)
        least = slack_at(d, t, i) < least ? slack_at(d, t, i) : least;
    return least;
}

static double distance_at(const box *d, const int t[3]) {
    int square = 0;
    for (int k = 0; k < 3; k++) {
        int gap = t[k] < d->low[k] ? d->low[k] - t[k] : t[k] > d->high[k] ? t[k] - d->high[k] : 0;
        square += gap * gap;
    }
    return sqrt(square);
}

static double farthest_at(const box *d, const int t[3]) {
    int square = 0;
    for (int k = 0; k < 3; k++) {
        int a = t[k] - d->low[k], b = d->high[k] - t[k], far = a > b ? a : b;
        square += far * far;
    }
    return sqrt(square);
}

static bool before(const int a[2], const int b[2]) {
    return a[0] * b[1] < b[0] * a[1];
}

static struct ray ray_from(const box *d, const int t[3], const int m[3]) {
    struct ray ray = {.meets = true, .enter = {-1000, 1}, .leave = {1000, 1}, .inwards = true};
    for (int k = 0; k < 3; k++) {
        bool on_low = t[k] == d->low[k], on_high = t[k] == d->high[k];
        if ((on_low && m[k] <= 0) || (on_high && m[k] >= 0))
            ray.inwards = false;
        if (m[k] == 0) {
            ray.meets &= t[k] >= d->low[k] && t[k] <= d->high[k];
            continue;
        }
        int to_low = d->low[k] - t[k], to_high = d->high[k] - t[k];
        int near[2] = {m[k] > 0 ? to_low : -to_high, abs(m[k])}, far[2] = {m[k] > 0 ? to_high : -to_low, abs(m[k])};
        if (before(ray.enter, near))
            memcpy(ray.enter, near, sizeof near);
        if (before(far, ray.leave))
            memcpy(ray.leave, far, sizeof far);
    }
    ray.meets = ray.meets && !before(ray.leave, ray.enter) && ray.enter[0] > 0;
    return ray;
}

/* --- what answers must be --- */

static bool is_in(const box *b, double unit, pir_vec3 at, pir_vec3 point) {
    for (int k = 0; k < 3; k++) {
        double x = component(point, k) - component(at, k), error = 1e-14 * unit;
        if (x < b->low[k] * unit - error || x > b->high[k] * unit + error)
            return false;
    }
    return true;
}

/* The difference has nothing beyond `there` along the normal. */
static bool supports(const struct scene *s, pir_vec3 there, pir_vec3 n) {
    double most = 0;
    for (int k = 0; k < 3; k++) {
        double along = component(n, k), x = component(there, k);
        most += fmax(along * (s->d.low[k] * s->unit - x), along * (s->d.high[k] * s->unit - x));
    }
    return fabs(length_of(n) - 1) < 1e-14 && fabs(most) < 1e-13 * s->unit;
}

static bool is_near(const struct scene *s, double number, double units) {
    return fabs(number - units * s->unit) <= 1e-13 * s->unit;
}

static bool same_bits(const pir_query_result *a, const pir_query_result *b) {
    return a->state == b->state && a->outcome == b->outcome &&
           memcmp(&a->distance, &b->distance, sizeof a->distance) == 0 &&
           memcmp(&a->normal, &b->normal, sizeof a->normal) == 0 &&
           memcmp(&a->point_p, &b->point_p, sizeof a->point_p) == 0 &&
           memcmp(&a->point_q, &b->point_q, sizeof a->point_q) == 0 &&
           memcmp(&a->witness, &b->witness, sizeof a->witness) == 0;
}

/* A cache that no query has written: indices in range, next to the ends of ranges, and far beyond. */
static pir_query_cache wild_cache(test_random *random) {
    static const uint32_t numbers[] = {0, 1, 2, 3, 4, 5, 7, 8, 11, 12, 24, 25, 1u << 20, UINT32_MAX - 1, UINT32_MAX};
    pir_query_cache cache;
    uint32_t *at[] = {&cache.points, &cache.p[0], &cache.p[1],  &cache.p[2],   &cache.q[0],  &cache.q[1],
                      &cache.q[2],   &cache.kind, &cache.first, &cache.second, &cache.pieces};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++)
        *at[i] = numbers[test_random_below(random, i == 0 || i == 7 ? 4 : sizeof numbers / sizeof *numbers)];
    cache.pieces = test_random_below(random, 8) ? 1 : cache.pieces;
    return cache;
}

static void check_pose(const struct scene *s, test_random *random, const int t[3]) {
    pir_query_input input = pir_query_input_default();
    input.translation = vector(t, s->unit);
    pir_state state = state_at(&s->d, t);
    double distance = state == PIR_INSIDE ? -depth_at(&s->d, t) : distance_at(&s->d, t);
    pir_query_result r, other;
    assert_int_equal(pir_query_signed_distance(s->query, &input, NULL, &r), PIR_OK);
    expect(r.state == state && is_near(s, r.distance, distance), "pair %llu: state %d, not %d, distance %g, not %g",
           (unsigned long long)s->number, (int)r.state, (int)state, r.distance / s->unit, distance);
    pir_vec3 n = r.normal, there = {input.translation.x - r.distance * n.x, input.translation.y - r.distance * n.y,
                                    input.translation.z - r.distance * n.z};
    expect(supports(s, there, n), "pair %llu: normal %g, %g, %g", (unsigned long long)s->number, n.x, n.y, n.z);
    expect(is_in(&s->p, s->unit, input.translation, r.point_p) && is_in(&s->q, s->unit, (pir_vec3){0, 0, 0}, r.point_q),
           "pair %llu: points off the bodies", (unsigned long long)s->number);
    expect(r.steps < 1000, "pair %llu: %u steps", (unsigned long long)s->number, r.steps);
    // with any cache, each call gives the same
    pir_status (*const calls[4])(pir_query *, const pir_query_input *, pir_query_cache *, pir_query_result *) = {
        pir_query_signed_distance, pir_query_overlap, pir_query_penetration, pir_query_distance};
    for (int i = 0; i < 4; i++) {
        pir_query_cache cache = wild_cache(random);
        assert_int_equal(calls[i](s->query, &input, NULL, &r), PIR_OK);
        assert_int_equal(calls[i](s->query, &input, &cache, &other), PIR_OK);
        expect(r.state == state && same_bits(&r, &other) && other.steps < 1000, "pair %llu: call %d with a cache",
               (unsigned long long)s->number, i);
        bool none = (i == 2 && state == PIR_OUTSIDE) || (i == 3 && state == PIR_INSIDE) || i == 1;
        expect(is_near(s, r.distance, none ? 0 : distance), "pair %llu: call %d, distance %g",
               (unsigned long long)s->number, i, r.distance / s->unit);
    }
    pir_state states[2];
    double numbers[2];
    assert_int_equal(pir_query_batch_states(s->query, &input.translation, 1, &states[0]), PIR_OK);
    assert_int_equal(pir_query_batch_depths(s->query, &input.translation, 1, &numbers[0], &states[1]), PIR_OK);
    assert_int_equal(pir_query_batch_distances(s->query, &input.translation, 1, &numbers[1], NULL), PIR_OK);
    expect(states[0] == state && states[1] == state && is_near(s, numbers[1], distance) &&
               is_near(s, numbers[0], state == PIR_INSIDE ? -distance : 0),
           "pair %llu: in a batch", (unsigned long long)s->number);
}

/* What supports alone tell. */
static void check_pair(const struct scene *s, const int t[3]) {
    pir_ccd_pair pair = {s->body_p, s->body_q, s->rotation, vector(t, s->unit)};
    pir_ccd_outcome outcome;
    double distance;
    pir_status status = pir_ccd_distance(&pair, &outcome, &distance);
    if (status == PIR_ERR_NOT_BUILT)
        return;
    bool apart = state_at(&s->d, t) == PIR_OUTSIDE;
    expect(status == PIR_OK && outcome == (apart ? PIR_CCD_SEPARATED : PIR_CCD_OVERLAPPING) &&
               fabs(distance - (apart ? distance_at(&s->d, t) * s->unit : 0)) <= 1e-8 * s->unit,
           "pair %llu: by supports, outcome %d, distance %g", (unsigned long long)s->number, (int)outcome,
           distance / s->unit);
}

/* Balls around the bodies: the distance less the radii, and the largest distance with them. */
static void check_radii(const struct scene *s, test_random *random, const int t[3]) {
    pir_query_input input = pir_query_input_default();
    pir_query_result r, other;
    int radius_p = test_random_between(random, 0, 2), radius_q = test_random_between(random, 0, 2);
    double radii = radius_p + radius_q, distance = -radii;
    input.translation = vector(t, s->unit);
    input.radius_p = radius_p * s->unit;
    input.radius_q = radius_q * s->unit;
    distance += state_at(&s->d, t) == PIR_INSIDE ? -depth_at(&s->d, t) : distance_at(&s->d, t);
    assert_int_equal(pir_query_signed_distance(s->query, &input, NULL, &r), PIR_OK);
    assert_int_equal(pir_query_overlap(s->query, &input, NULL, &other), PIR_OK);
    expect(is_near(s, r.distance, distance) && r.state == other.state, "pair %llu: radii %d, %d: %g, not %g",
           (unsigned long long)s->number, radius_p, radius_q, r.distance / s->unit, distance);
    if (fabs(distance) > 1e-9)
        expect(r.state == (distance > 0 ? PIR_OUTSIDE : PIR_INSIDE), "pair %llu: state with radii",
               (unsigned long long)s->number);
    assert_int_equal(pir_query_largest_distance(s->query, &input, &r), PIR_OK);
    pir_vec3 n = r.normal, p = {r.point_p.x - input.radius_p * n.x, r.point_p.y - input.radius_p * n.y,
                                r.point_p.z - input.radius_p * n.z};
    pir_vec3 q = {r.point_q.x + input.radius_q * n.x, r.point_q.y + input.radius_q * n.y,
                  r.point_q.z + input.radius_q * n.z};
    expect(is_near(s, r.distance, farthest_at(&s->d, t) + radii) && is_in(&s->p, s->unit, input.translation, p) &&
               is_in(&s->q, s->unit, (pir_vec3){0, 0, 0}, q),
           "pair %llu: largest distance %g", (unsigned long long)s->number, r.distance / s->unit);
}

/* Sides are ways out, each by its slack; no more is written than there is room for. */
static void check_escapes(const struct scene *s, test_random *random, const int t[3]) {
    pir_query_input input = pir_query_input_default();
    input.translation = vector(t, s->unit);
    input.radius_q = test_random_between(random, 0, 1) * s->unit;
    int more = test_random_between(random, 0, 3), right = 0;
    // bodies with radii overlap where they would touch without
    pir_state state = state_at(&s->d, t);
    bool overlap = state == PIR_INSIDE || (state == PIR_BOUNDARY && input.radius_q > 0);
    if (state == PIR_BOUNDARY && is_flat(&s->d))
        return;
    for (int i = 0; i < 6 && overlap; i++)
        right += slack_at(&s->d, t, i) <= depth_at(&s->d, t) + more;
    size_t room = test_random_below(random, 8), count = 99;
    pir_escape escapes[8], untouched;
    memset(escapes, 0x5a, sizeof escapes);
    memset(&untouched, 0x5a, sizeof untouched);
    assert_int_equal(pir_query_escapes(s->query, &input, more * s->unit, room, room ? escapes : NULL, &count), PIR_OK);
    expect(count == (size_t)right, "pair %llu: %zu escapes, not %d", (unsigned long long)s->number, count, right);
    for (size_t i = 0; i < 8; i++) {
        if (i >= room || i >= count) {
            assert_memory_equal(&escapes[i], &untouched, sizeof untouched);
            continue;
        }
        pir_vec3 n = escapes[i].normal;
        int side = n.x != 0 ? n.x > 0 : n.y != 0 ? 2 + (n.y > 0) : 4 + (n.z > 0);
        double depth = slack_at(&s->d, t, side) + input.radius_q / s->unit;
        expect(length_of(n) == 1 && is_near(s, escapes[i].depth, depth), "pair %llu: escape %zu",
               (unsigned long long)s->number, i);
    }
}

static void check_contact(const struct scene *s, pir_vec3 t, pir_vec3 m, double time, pir_vec3 normal, pir_vec3 point) {
    pir_vec3 there = {t.x + time * m.x, t.y + time * m.y, t.z + time * m.z};
    expect(supports(s, there, normal) && is_in(&s->p, s->unit, there, point) &&
               is_in(&s->q, s->unit, (pir_vec3){0, 0, 0}, point),
           "pair %llu: contact at %g", (unsigned long long)s->number, time);
}

static void check_motion(const struct scene *s, const int t[3], const int m[3]) {
    struct ray ray = ray_from(&s->d, t, m);
    pir_query_input input = pir_query_input_default();
    pir_vec3 motion = vector(m, s->unit);
    input.translation = vector(t, s->unit);
    pir_state state = state_at(&s->d, t);
    double enter = (double)ray.enter[0] / ray.enter[1], leave = (double)ray.leave[0] / ray.leave[1];
    double length = length_of(motion) / s->unit;
    bool still = length == 0;
    pir_impact cast;
    pir_query_result r;
    assert_int_equal(pir_query_cast(s->query, &input, motion, &cast), PIR_OK);
    pir_cast_outcome right = state == PIR_INSIDE                         ? PIR_CAST_START_INSIDE
                             : state == PIR_BOUNDARY && ray.inwards      ? PIR_CAST_HIT
                             : state == PIR_BOUNDARY                     ? PIR_CAST_RECEDING
                             : still                                     ? PIR_CAST_AT_REST
                             : ray.meets && ray.enter[0] <= ray.enter[1] ? PIR_CAST_HIT
                                                                         : PIR_CAST_MISS;
    double time = state != PIR_OUTSIDE ? 0 : right == PIR_CAST_HIT ? enter : 1;
    expect(cast.outcome == right && fabs(cast.time - time) < 1e-14 && cast.steps < 1000,
           "pair %llu: cast %d, not %d, time %g, not %g, %u steps", (unsigned long long)s->number, (int)cast.outcome,
           (int)right, cast.time, time, cast.steps);
    if (right == PIR_CAST_HIT)
        check_contact(s, input.translation, motion, time, cast.normal, cast.point);
    pir_status status = pir_query_directional_distance(s->query, &input, motion, &r);
    assert_int_equal(status, still ? PIR_ERR_ARGUMENT : PIR_OK);
    assert_int_equal(pir_query_directional_depth(s->query, &input, motion, &r), status);
    if (still)
        return;
    pir_outcome out = state == PIR_INSIDE ? PIR_OVERLAPPING : PIR_NO_HIT;
    expect(r.state == state && r.outcome == out && is_near(s, r.distance, state == PIR_INSIDE ? -leave * length : 0),
           "pair %llu: directional depth %g", (unsigned long long)s->number, r.distance / s->unit);
    if (state == PIR_INSIDE)
        check_contact(s, input.translation, motion, leave, r.normal, r.point_p);
    assert_int_equal(pir_query_directional_distance(s->query, &input, motion, &r), PIR_OK);
    out = state == PIR_INSIDE     ? PIR_OVERLAPPING
          : state == PIR_BOUNDARY ? PIR_TOUCHING
          : ray.meets             ? PIR_SEPARATED
                                  : PIR_NO_HIT;
    expect(r.state == state && r.outcome == out && is_near(s, r.distance, out == PIR_SEPARATED ? enter * length : 0),
           "pair %llu: directional distance %g, outcome %d, not %d", (unsigned long long)s->number,
           r.distance / s->unit, (int)r.outcome, (int)out);
    if (out == PIR_SEPARATED)
        check_contact(s, input.translation, motion, enter, r.normal, r.point_q);
}

static void boxes_of_any_dimension(void **state) {
    (void)state;
    for (uint64_t number = 0; number < PAIRS; number++) {
        test_random random = test_random_case("boxes", number);
        box body = draw_box(&random);
        int turn = test_random_between(&random, 0, 3);
        struct scene s = {.p = turned(&body, turn), .q = draw_box(&random), .number = number};
        s.unit = ldexp(1, 250 * test_random_between(&random, -1, 1));
        for (int k = 0; k < 3; k++) {
            s.d.low[k] = s.q.low[k] - s.p.high[k];
            s.d.high[k] = s.q.high[k] - s.p.low[k];
        }
        pir_polytope *p = polytope_of(&body, s.unit), *q = polytope_of(&s.q, s.unit);
        pir_sum *sum;
        s.rotation = turn == 3 ? (pir_quat){0, 0, 0, 2} : quarter_turn(turn);
        s.body_p = p;
        s.body_q = q;
        test_query_make(p, q, s.rotation, &sum, &s.query);
        for (int i = 0; i < POSES; i++) {
            int t[3], m[3];
            for (int k = 0; k < 3; k++) {
                t[k] = test_random_between(&random, s.d.low[k] - 2, s.d.high[k] + 2);
                m[k] = test_random_below(&random, 3) ? test_random_between(&random, -4, 4) : 0;
            }
            // half of the translations in the difference, where there is more to tell
            for (int k = 0; k < 3 && i % 2; k++)
                t[k] = test_random_between(&random, s.d.low[k], s.d.high[k]);
            check_pose(&s, &random, t);
            check_pair(&s, t);
            check_radii(&s, &random, t);
            check_escapes(&s, &random, t);
            check_motion(&s, t, m);
        }
        test_query_free(s.query, sum);
        pir_polytope_release(p);
        pir_polytope_release(q);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_of_any_dimension),
    };
    return cmocka_run_group_tests_name("boxes", tests, NULL, NULL);
}
