/* SPDX-License-Identifier: MIT */
/*
 * Queries on scenes against pairs made for each piece: overlaps, nearest pieces, closest pairs, rays with exact hits,
 * moving shapes, what is refused, memory.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/mass.h>
#include <pirouette/scene_query.h>

#include "scene/crowd.h"
#include "scene/scene_bodies.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/vectors.h"

#define MOST 256

/* The answer of a pair made for a polytope in a pose and a piece. */
static pir_query_result ask_alone(pir_polytope *p, pir_pose pose, double radius, const crowd_body *body,
                                  uint32_t piece) {
    pir_pair *pair;
    pir_workspace *workspace;
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    input.pose_p = pose;
    input.radius_p = radius;
    input.pose_q = body->options.pose;
    input.radius_q = body->options.radius;
    assert_int_equal(pir_pair_create(p, body->piece[piece], NULL, &pair), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_signed_distance(pair, workspace, &input, &result), PIR_OK);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    return result;
}

static bool sees(const pir_scene_shape *shape, const crowd_body *body) {
    return body && !body->options.sensor && (body->options.category & shape->mask) && body->id != shape->except;
}

static pir_scene_shape random_shape(crowd *c) {
    static const test_body kinds[4] = {TEST_SPHERE, TEST_BOX, TEST_SEGMENT, TEST_POINT};
    test_points points;
    test_body_points(&c->random, kinds[test_random_below(&c->random, 4)], 10, &points);
    for (size_t i = 0; i < points.count; i++)
        points.at[i] = test_add(test_zero, points.at[i], 0.25);
    pir_scene_shape shape = pir_scene_shape_default(test_polytope(&points));
    shape.pose = (pir_pose){test_integer_rotation(&c->random), test_random_direction(&c->random)};
    shape.radius = test_random_below(&c->random, 3) ? 0 : 0.125;
    shape.mask = test_random_below(&c->random, 3) ? UINT32_MAX : 1 + test_random_below(&c->random, 6);
    shape.except = test_random_below(&c->random, 2) ? PIR_SCENE_NONE : test_random_below(&c->random, 10);
    return shape;
}

static void new_crowd(crowd *c, uint64_t number) {
    pir_scene_options options = pir_scene_options_default();
    options.margin = number % 2 ? 0.125 : 0;
    crowd_init(c, 1000 + number, 10 + (uint32_t)number % 20, &options);
    if (number % 3)
        assert_int_equal(pir_scene_update(c->scene, NULL, 0), PIR_OK);
}

static void overlaps_are_those_of_all_pieces(void **state) {
    (void)state;
    static crowd c;
    size_t hits = 0;
    for (uint64_t n = 0; n < 60; n++) {
        new_crowd(&c, n);
        pir_scene_shape shape = random_shape(&c);
        pir_scene_hit hit[MOST], few[2];
        size_t count, next = 0, again;
        assert_int_equal(pir_scene_overlap(c.scene, &shape, MOST, hit, &count), PIR_OK);
        for (uint32_t id = 0; id < CROWD_BODIES; id++) {
            const crowd_body *body = crowd_body_of(&c, id);
            for (uint32_t k = 0; sees(&shape, body) && k < body->options.piece_count; k++) {
                pir_state is = ask_alone(shape.polytope, shape.pose, shape.radius, body, k).state;
                if (is == PIR_OUTSIDE)
                    continue;
                expect(next < count && hit[next].body == id && hit[next].piece == k && hit[next].state == is,
                       "case %llu, body %u, piece %u", (unsigned long long)n, id, k);
                next++;
            }
        }
        expect(next == count, "case %llu", (unsigned long long)n);
        // the first ones of them
        assert_int_equal(pir_scene_overlap(c.scene, &shape, 2, few, &again), PIR_OK);
        assert_int_equal(again, count);
        assert_memory_equal(few, hit, (count < 2 ? count : 2) * sizeof *hit);
        hits += count;
        pir_polytope_release(shape.polytope);
        crowd_finish(&c);
    }
    assert_true(hits > 20);
}

/* --- what is nearest --- */

static bool nearer(const pir_scene_near *a, const pir_scene_near *b) {
    const uint32_t x[4] = {a->body_p, a->body_q, a->piece_p, a->piece_q};
    const uint32_t y[4] = {b->body_p, b->body_q, b->piece_p, b->piece_q};
    if (a->result.distance != b->result.distance)
        return a->result.distance < b->result.distance;
    for (int k = 0; k < 4; k++)
        if (x[k] != y[k])
            return x[k] < y[k];
    return false;
}

static void insert(pir_scene_near *list, size_t *count, const pir_scene_near *near) {
    size_t at = (*count)++;
    for (; at > 0 && nearer(near, &list[at - 1]); at--)
        list[at] = list[at - 1];
    list[at] = *near;
}

static void expect_same_near(const pir_scene_near *a, size_t count_a, const pir_scene_near *b, size_t count_b,
                             unsigned long long number) {
    expect(count_a == count_b, "case %llu: %zu, expected %zu", number, count_a, count_b);
    for (size_t i = 0; i < count_a; i++)
        expect(a[i].body_p == b[i].body_p && a[i].body_q == b[i].body_q && a[i].piece_p == b[i].piece_p &&
                   a[i].piece_q == b[i].piece_q && a[i].result.state == b[i].result.state &&
                   memcmp(&a[i].result.distance, &b[i].result.distance, sizeof(double)) == 0 &&
                   memcmp(&a[i].result.point_p, &b[i].result.point_p, sizeof(pir_vec3)) == 0,
               "case %llu, number %zu", number, i);
}

static void the_nearest_are_those_of_all_pieces(void **state) {
    (void)state;
    static crowd c;
    static pir_scene_near all[MOST], near[MOST];
    for (uint64_t n = 0; n < 60; n++) {
        new_crowd(&c, n);
        pir_scene_shape shape = random_shape(&c);
        double cutoff = n % 3 == 0 ? HUGE_VAL : n % 3 == 1 ? 0.75 : 0;
        size_t expected = 0, count, capacity = n % 2 ? MOST : 3;
        for (uint32_t id = 0; id < CROWD_BODIES; id++) {
            const crowd_body *body = crowd_body_of(&c, id);
            for (uint32_t k = 0; sees(&shape, body) && k < body->options.piece_count; k++) {
                pir_scene_near one = {.body_p = PIR_SCENE_NONE,
                                      .body_q = id,
                                      .piece_q = k,
                                      .result = ask_alone(shape.polytope, shape.pose, shape.radius, body, k),
                                      .user_q = body->options.user,
                                      .piece_user_q = 100 + k};
                if (one.result.distance <= cutoff)
                    insert(all, &expected, &one);
            }
        }
        assert_int_equal(pir_scene_nearest(c.scene, &shape, cutoff, capacity, near, &count), PIR_OK);
        expect_same_near(near, count, all, expected < capacity ? expected : capacity, n);
        pir_polytope_release(shape.polytope);
        crowd_finish(&c);
    }
}

static bool may_meet(const crowd_body *a, const crowd_body *b) {
    const pir_body_options *p = &a->options, *q = &b->options;
    return (p->kind == PIR_BODY_MOVING || q->kind == PIR_BODY_MOVING) && (p->category & q->mask) &&
           (q->category & p->mask) && !p->sensor && !q->sensor;
}

static void the_closest_pairs_are_those_of_all(void **state) {
    (void)state;
    static crowd c;
    static pir_scene_near all[4096], near[MOST];
    for (uint64_t n = 0; n < 12; n++) {
        new_crowd(&c, n);
        double cutoff = n % 2 ? HUGE_VAL : 0.5;
        size_t expected = 0, count, capacity = n % 3 ? 20 : 1;
        for (uint32_t a = 0; a < CROWD_BODIES; a++)
            for (uint32_t b = a + 1; b < CROWD_BODIES; b++) {
                const crowd_body *p = crowd_body_of(&c, a), *q = crowd_body_of(&c, b);
                for (uint32_t i = 0; p && q && may_meet(p, q) && i < p->options.piece_count; i++)
                    for (uint32_t k = 0; k < q->options.piece_count; k++) {
                        pir_scene_near one = {.body_p = a,
                                              .body_q = b,
                                              .piece_p = i,
                                              .piece_q = k,
                                              .result =
                                                  ask_alone(p->piece[i], p->options.pose, p->options.radius, q, k),
                                              .user_p = p->options.user,
                                              .user_q = q->options.user,
                                              .piece_user_p = 100 + i,
                                              .piece_user_q = 100 + k};
                        if (one.result.distance <= cutoff)
                            insert(all, &expected, &one);
                    }
            }
        assert_true(expected < 4096);
        assert_int_equal(pir_scene_closest_pairs(c.scene, cutoff, capacity, near, &count), PIR_OK);
        expect_same_near(near, count, all, expected < capacity ? expected : capacity, n);
        crowd_finish(&c);
    }
}

/* --- rays --- */

/*
 * Whether a segment meets a piece, by pairs: 1 it does, 0 it does not, −1 where doubles cannot tell whether it
 * touches a rounded body.
 */
static int segment_hits(const crowd *c, pir_vec3 origin, pir_vec3 way, uint32_t mask) {
    test_points ends = {2, {test_zero, way}};
    pir_polytope *segment = test_polytope(&ends);
    int hits = 0;
    for (uint32_t i = 0; i < CROWD_BODIES && hits < 1; i++) {
        const crowd_body *body = &c->body[i];
        for (uint32_t k = 0; body->used && !body->options.sensor && (body->options.category & mask) &&
                             k < body->options.piece_count && hits < 1;
             k++) {
            pir_query_result answer = ask_alone(segment, (pir_pose){{0, 0, 0, 1}, origin}, 0, body, k);
            bool unsure = body->options.radius > 0 && fabs(answer.distance) < 1e-9;
            hits = unsure ? -1 : answer.state != PIR_OUTSIDE ? 1 : hits;
        }
    }
    pir_polytope_release(segment);
    return hits;
}

static void rays_hit_exactly_what_segments_do(void **state) {
    (void)state;
    static crowd c;
    uint32_t hit = 0, missed = 0;
    for (uint64_t n = 0; n < 40; n++) {
        new_crowd(&c, n);
        for (int i = 0; i < 8; i++) {
            // every other one on a grid, where segments graze
            pir_vec3 origin = test_add(test_zero, test_random_direction(&c.random), 2 * c.size), way = {0, 0, 0};
            if (i % 2 == 0) {
                origin = (pir_vec3){rint(2 * origin.x) / 2, rint(2 * origin.y) / 2, rint(2 * origin.z) / 2};
                way = (pir_vec3){-2 * origin.x, i % 4 ? -origin.y : 0, i % 4 ? -origin.z : 0};
            } else {
                way = test_add(test_random_direction(&c.random), origin, -1.5);
            }
            uint32_t mask = i < 6 ? UINT32_MAX : 1;
            pir_impact impact;
            assert_int_equal(pir_scene_ray(c.scene, origin, way, mask, &impact), PIR_OK);
            unsigned long long number = n * 8 + (uint64_t)i;
            int by_pairs = segment_hits(&c, origin, way, mask);
            bool hits = impact.body != PIR_SCENE_NONE;
            expect(by_pairs < 0 || hits == by_pairs, "ray %llu", number);
            hit += hits;
            missed += !hits;
            if (!hits) {
                assert_true(impact.time == 1 && impact.piece_q == PIR_SCENE_NONE && impact.outcome == PIR_CAST_MISS);
                continue;
            }
            // the point is on the piece, and nothing is met before it
            test_points at = {1, {impact.point}};
            pir_polytope *point = test_polytope(&at);
            double distance =
                ask_alone(point, pir_pose_identity(), 0, crowd_body_of(&c, impact.body), impact.piece_q).distance;
            pir_polytope_release(point);
            expect(distance < 1e-9 && distance > -2, "ray %llu: %g from the piece", number, distance);
            expect(impact.time == 0 || segment_hits(&c, origin, test_add(test_zero, way, impact.time - 1e-9), mask) < 1,
                   "ray %llu is met before", number);
            expect(impact.time == 0 || test_dot(impact.normal, way) < 0, "ray %llu", number);
            expect((impact.outcome == PIR_CAST_START_INSIDE) <= (impact.time == 0), "ray %llu", number);
        }
        crowd_finish(&c);
    }
    assert_true(hit > 30 && missed > 30);
}

static void a_ray_in_the_plane_of_a_flat_piece_enters_by_its_side(void **state) {
    (void)state;
    static const pir_vec3 square[4] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    pir_polytope *flat = NULL;
    pir_scene *scene = NULL;
    pir_body_options body = pir_body_options_default();
    pir_impact impact;
    uint32_t id;
    assert_int_equal(pir_polytope_create(square, 4, NULL, &flat), PIR_OK);
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    body.pieces = &flat;
    body.piece_count = 1;
    assert_int_equal(pir_scene_add(scene, &body, &id), PIR_OK);
    const pir_vec3 origin = {-5, 0.5, 0}, beside = {-5, 0.5, 1e-9}, way = {10, 0, 0}, none = {0, 0, 0};
    assert_int_equal(pir_scene_ray(scene, origin, way, UINT32_MAX, &impact), PIR_OK);
    assert_true(impact.body == id && impact.time == 0.4);
    assert_true(impact.point.x == -1 && impact.point.y == 0.5 && impact.point.z == 0);
    assert_true(impact.normal.x == -1 && impact.normal.y == 0 && impact.normal.z == 0);
    // a body that stands in it, before its middle, is met later
    pir_polytope *cube = scene_cube(0.05);
    uint32_t later = scene_add(scene, cube, scene_at(-0.8, 0.5, 0), PIR_BODY_STATIC);
    assert_int_equal(pir_scene_ray(scene, origin, way, UINT32_MAX, &impact), PIR_OK);
    assert_true(impact.body == id && impact.time == 0.4);
    assert_int_equal(pir_scene_remove(scene, later), PIR_OK);
    pir_polytope_release(cube);
    assert_int_equal(pir_scene_ray(scene, beside, way, UINT32_MAX, &impact), PIR_OK);
    assert_true(impact.body == PIR_SCENE_NONE);
    // and a point in it
    assert_int_equal(pir_scene_ray(scene, none, none, UINT32_MAX, &impact), PIR_OK);
    assert_true(impact.body == id && impact.time == 0);
    pir_scene_destroy(scene);
    pir_polytope_release(flat);
}

/* A long chain of nodes: each cube holds those before it. */
static void boxes_in_boxes_are_all_met(void **state) {
    (void)state;
    enum { CUBES = 200 };
    static pir_impact hit[CUBES];
    pir_scene *scene;
    size_t count;
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    for (int k = 0; k < CUBES; k++) {
        pir_polytope *cube = scene_cube(1 + k);
        scene_add(scene, cube, scene_at(0, 0, 0), PIR_BODY_STATIC);
        pir_polytope_release(cube);
    }
    const pir_vec3 from = {-500, 0.25, 0.125}, way = {1000, 0, 0};
    assert_int_equal(pir_scene_ray_all(scene, from, way, NULL, CUBES, hit, &count), PIR_OK);
    assert_int_equal(count, CUBES);
    for (int k = 0; k < CUBES; k++)
        expect(hit[k].body == (uint32_t)(CUBES - 1 - k) && fabs(hit[k].time - (300 + k) / 1000.0) < 1e-12,
               "hit %d: body %u at %g", k, hit[k].body, hit[k].time);
    assert_int_equal(pir_scene_ray(scene, from, way, UINT32_MAX, hit), PIR_OK);
    assert_int_equal(hit[0].body, CUBES - 1);
    // from within all of them
    assert_int_equal(pir_scene_ray_all(scene, (pir_vec3){0, 0.25, 0.125}, way, NULL, CUBES, hit, &count), PIR_OK);
    assert_int_equal(count, CUBES);
    for (int k = 0; k < CUBES; k++)
        expect(hit[k].body == (uint32_t)k && hit[k].outcome == PIR_CAST_START_INSIDE, "hit %d from within", k);
    pir_scene_destroy(scene);
}

/* --- moving shapes --- */

static pir_pose pose_at(pir_pose begin, const pir_motion *motion, double time) {
    return pir_pose_integrate(begin, motion->way, motion->turn, time);
}

/* The least distance of the shape to anything, at a time. */
static double least_distance(const crowd *c, const pir_scene_shape *shape, const pir_motion *motion, double time) {
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < CROWD_BODIES; i++)
        for (uint32_t k = 0; c->body[i].used && sees(shape, &c->body[i]) && k < c->body[i].options.piece_count; k++)
            least = fmin(
                least,
                ask_alone(shape->polytope, pose_at(shape->pose, motion, time), shape->radius, &c->body[i], k).distance);
    return least;
}

static void a_cast_ends_at_the_first_contact(void **state) {
    (void)state;
    static crowd c;
    uint32_t met = 0;
    const double tolerance = 1e-6;
    const char *casts = getenv("PIR_TEST_CASTS");
    const uint64_t most = casts ? strtoull(casts, NULL, 10) : 36;
    for (uint64_t n = 0; n < most; n++) {
        new_crowd(&c, n);
        pir_scene_shape shape = random_shape(&c);
        shape.pose.translation = test_add(test_zero, shape.pose.translation, 1.5 * c.size);
        const double turns[4] = {0, 2, 20, 300};
        pir_motion motion = {test_add(test_random_direction(&c.random), shape.pose.translation, -1.75),
                             test_add(test_zero, test_random_direction(&c.random), turns[n % 4]), 0};
        pir_impact impact;
        assert_int_equal(pir_scene_cast(c.scene, &shape, &motion, tolerance, &impact), PIR_OK);
        unsigned long long number = n;
        bool meets = impact.body != PIR_SCENE_NONE;
        expect(meets || impact.time == 1, "cast %llu", number);
        expect(impact.outcome != PIR_CAST_STEP_LIMIT, "cast %llu does not converge", number);
        for (int i = 0; i <= 20 && impact.time > 0; i++) {
            double time = impact.time * i / 20 * (1 - 1e-9);
            expect(least_distance(&c, &shape, &motion, time) > 0, "cast %llu touches at %g", number, time);
        }
        if (meets) {
            double left = ask_alone(shape.polytope, pose_at(shape.pose, &motion, impact.time), shape.radius,
                                    crowd_body_of(&c, impact.body), impact.piece_q)
                              .distance;
            expect(left <= tolerance * 1.001, "cast %llu ends %g away", number, left);
        }
        met += meets && impact.time > 0;
        pir_polytope_release(shape.polytope);
        crowd_finish(&c);
    }
    assert_true(met >= 4);
}

/* A cube over a floor, turned about the vertical: the floor's number, and its distance. */
static pir_scene *floor_new(double gap, pir_scene_shape *ret_shape) {
    pir_scene *scene;
    pir_polytope *cube = scene_cube(10);
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    scene_add(scene, cube, scene_at(0, 0, -10), PIR_BODY_STATIC);
    pir_polytope_release(cube);
    *ret_shape = pir_scene_shape_default(scene_cube(0.5));
    ret_shape->pose.translation.z = 0.5 + gap;
    return scene;
}

static void a_spinning_cube_that_glides_by_is_no_hit(void **state) {
    (void)state;
    for (int exponent = 2; exponent <= 5; exponent++)
        for (int turn = 0; turn < 8; turn++) {
            const double gap = pow(10, -exponent), turns[8] = {0, 0.1, 1, 3, 10, 100, 1e4, 1e6};
            pir_scene_shape shape;
            pir_scene *scene = floor_new(gap, &shape);
            pir_motion motion = {{2, 0, 0}, {0, 0, turns[turn]}, 0};
            pir_impact impact;
            assert_int_equal(pir_scene_cast(scene, &shape, &motion, 1e-6, &impact), PIR_OK);
            expect(impact.outcome == PIR_CAST_MISS && impact.time == 1, "gap %g, turn %g", gap, turns[turn]);
            // and one that sinks meets it in time, however it spins
            motion.way.z = -2 * gap;
            assert_int_equal(pir_scene_cast(scene, &shape, &motion, 1e-6, &impact), PIR_OK);
            expect(impact.outcome == PIR_CAST_HIT && fabs(impact.time - 0.5) <= 0.5e-6 / gap && impact.normal.z == 1,
                   "gap %g, turn %g: %g", gap, turns[turn], impact.time);
            pir_polytope_release(shape.polytope);
            pir_scene_destroy(scene);
        }
}

/* The distance of a pole at so much along x from a square of side 1 whose middle is 2 from the axis of its turn. */
static double pole_from_square(double pole, double angle) {
    const double x = pole * cos(angle), y = -pole * sin(angle);
    const double beyond = fmax(0, fmax(1.5 - x, x - 2.5)), beside = fmax(0, fabs(y) - 0.5);
    return sqrt(beyond * beyond + beside * beside);
}

/* A cube swings round a pole, so that no plane parts them for a whole turn, each time a little nearer. */
static void a_cube_that_swings_by_in_each_turn_is_followed_to_its_hit(void **state) {
    (void)state;
    const double tolerance = 1e-6, from = 1.485, drifts = 0.03, turns[] = {30, 300, 1500};
    const pir_vec3 ends[2] = {{from, 0, -1}, {from, 0, 1}};
    pir_vec3 corners[8];
    pir_polytope *pole = NULL, *cube = NULL;
    pir_scene *scene = NULL;
    for (int i = 0; i < 8; i++)
        corners[i] = (pir_vec3){i & 1 ? 2.5 : 1.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5};
    assert_int_equal(pir_polytope_create(ends, 2, NULL, &pole), PIR_OK);
    assert_int_equal(pir_polytope_create(corners, 8, NULL, &cube), PIR_OK);
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    scene_add(scene, pole, scene_at(0, 0, 0), PIR_BODY_STATIC);
    pir_scene_shape shape = pir_scene_shape_default(cube);
    for (size_t k = 0; k < sizeof turns / sizeof *turns; k++) {
        const pir_motion motion = {.way = {-drifts, 0, 0}, .turn = {0, 0, turns[k]}};
        pir_impact impact;
        // it begins a quarter of a turn away
        const double begins = -1.5707963267948966;
        shape.pose.rotation = (pir_quat){0, 0, sin(begins / 2), cos(begins / 2)};
        assert_int_equal(pir_scene_cast(scene, &shape, &motion, tolerance, &impact), PIR_OK);
        expect(impact.outcome == PIR_CAST_HIT, "turn %g: outcome %d at %g", turns[k], (int)impact.outcome, impact.time);
        const double end = pole_from_square(from + drifts * impact.time, begins + turns[k] * impact.time);
        expect(end > 0 && end <= 1.001 * tolerance, "turn %g: it ends %g away", turns[k], end);
        const int samples = (int)(400 * turns[k]);
        for (int i = 0; i < samples; i++) {
            const double time = impact.time * i / samples;
            const double apart = pole_from_square(from + drifts * time, begins + turns[k] * time);
            expect(apart > 0.49 * tolerance, "turn %g: %g away at %g before %g", turns[k], apart, time, impact.time);
        }
    }
    pir_scene_destroy(scene);
    pir_polytope_release(cube);
    pir_polytope_release(pole);
}

static void a_cast_that_begins_inside_tells_the_normal_of_the_depth(void **state) {
    (void)state;
    pir_scene_shape shape;
    pir_scene *scene = floor_new(-0.25, &shape);
    pir_motion motion = {{2, 0, 0}, {0, 0, 1}, 0};
    pir_impact impact;
    assert_int_equal(pir_scene_cast(scene, &shape, &motion, 1e-6, &impact), PIR_OK);
    assert_true(impact.outcome == PIR_CAST_START_INSIDE && impact.time == 0 && impact.body == 0);
    assert_true(impact.normal.x == 0 && impact.normal.y == 0 && impact.normal.z == 1 && impact.point.z == 0);
    // a ray that begins there likewise
    assert_int_equal(pir_scene_ray(scene, (pir_vec3){1, 2, -0.5}, motion.way, UINT32_MAX, &impact), PIR_OK);
    assert_true(impact.outcome == PIR_CAST_START_INSIDE && impact.time == 0 && impact.normal.z == 1);
    // what is left at once is not met
    motion.held = 1e-6;
    assert_int_equal(pir_scene_cast(scene, &shape, &motion, 1e-6, &impact), PIR_OK);
    assert_int_equal(impact.outcome, PIR_CAST_MISS);
    pir_polytope_release(shape.polytope);
    pir_scene_destroy(scene);
}

/* A cube that begins within the tolerance of a floor, level or on an edge. */
/* A cube that begins on a floor, in a wall, and deeper in another: the floor hides no wall. */
static void a_cast_that_begins_in_several_tells_the_deepest(void **state) {
    (void)state;
    pir_polytope *cube = scene_cube(1);
    pir_scene *scene;
    uint32_t id[3];
    pir_impact impact;
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    const pir_vec3 at[3] = {{0, 0, -2}, {1.75, 0, 0.5}, {0, 1.5, 0.5}};
    for (int k = 0; k < 3; k++) {
        pir_body_options body = pir_body_options_default();
        body.pieces = &cube;
        body.piece_count = 1;
        body.pose.translation = at[k];
        body.category = 1u << k;
        assert_int_equal(pir_scene_add(scene, &body, &id[k]), PIR_OK);
    }
    pir_scene_shape shape = pir_scene_shape_default(cube);
    const pir_motion motion = {.way = {0, 0, -1}};
    // of the floor alone it is a touch, of the first wall .25 deep, of the second .5
    const uint32_t mask[4] = {1, 3, 5, 7}, first[4] = {0, 1, 2, 2};
    for (int k = 0; k < 4; k++) {
        shape.mask = mask[k];
        assert_int_equal(pir_scene_cast(scene, &shape, &motion, 1e-6, &impact), PIR_OK);
        expect(impact.body == id[first[k]] && impact.time == 0, "mask %u: body %u", mask[k], impact.body);
        assert_int_equal(impact.outcome, k == 0 ? PIR_CAST_HIT : PIR_CAST_START_INSIDE);
    }
    pir_scene_destroy(scene);
    pir_polytope_release(cube);
}

static void what_is_held_is_met_at_half_its_distance(void **state) {
    (void)state;
    pir_scene_shape shape;
    pir_scene *scene = floor_new(1e-3, &shape);
    pir_motion motion = {{5, 0, 1e-3}, {0, 0, 0}, 1e-6};
    pir_impact impact;
    assert_int_equal(pir_scene_cast(scene, &shape, &motion, 1e-2, &impact), PIR_OK);
    assert_int_equal(impact.outcome, PIR_CAST_MISS);
    motion.way.z = -2e-3;
    assert_int_equal(pir_scene_cast(scene, &shape, &motion, 1e-2, &impact), PIR_OK);
    expect(impact.outcome == PIR_CAST_HIT && impact.time >= 0.25 && impact.time < 0.4, "time %g", impact.time);
    // one side rises as fast as the other comes down
    motion = (pir_motion){{0, 0, 1e-4}, {0, 0.5, 0}, 1e-6};
    assert_int_equal(pir_scene_cast(scene, &shape, &motion, 1e-2, &impact), PIR_OK);
    expect(impact.outcome == PIR_CAST_HIT && impact.time > 0 && impact.time < 0.01, "time %g", impact.time);
    motion.held = 2e-3;
    assert_int_equal(pir_scene_cast(scene, &shape, &motion, 1e-2, &impact), PIR_OK);
    assert_int_equal(impact.outcome, PIR_CAST_MISS);
    motion.held = 0;
    assert_int_equal(pir_scene_cast(scene, &shape, &motion, 1e-2, &impact), PIR_OK);
    assert_true(impact.outcome == PIR_CAST_HIT && impact.time == 0);
    motion.held = -1;
    assert_int_equal(pir_scene_cast(scene, &shape, &motion, 1e-2, &impact), PIR_ERR_ARGUMENT);
    motion.held = NAN;
    assert_int_equal(pir_scene_cast(scene, &shape, &motion, 1e-2, &impact), PIR_ERR_NOT_FINITE);
    pir_polytope_release(shape.polytope);
    pir_scene_destroy(scene);
}

static uint32_t add(pir_scene *scene, pir_polytope *const *pieces, uint32_t count, pir_vec3 at, int sensor) {
    pir_body_options body = pir_body_options_default();
    uint32_t id;
    body.pieces = pieces;
    body.piece_count = count;
    body.pose.translation = at;
    body.sensor = sensor;
    assert_int_equal(pir_scene_add(scene, &body, &id), PIR_OK);
    return id;
}

static void a_fast_body_meets_a_wall_in_time(void **state) {
    (void)state;
    pir_polytope *pieces[2] = {scene_cube(0.5), NULL};
    assert_int_equal(pir_polytope_translate(pieces[0], (pir_vec3){1, 0, 0}, &pieces[1]), PIR_OK);
    pir_scene *scene;
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    uint32_t bullet = add(scene, pieces, 2, (pir_vec3){0, 0, 0}, 0);
    add(scene, pieces, 1, (pir_vec3){5, 0, 0}, 1);
    uint32_t wall = add(scene, pieces, 1, (pir_vec3){10, 0.25, 0}, 0);
    pir_motion motion = {{100, 0, 0}, {0, 0, 0}, 0};
    pir_impact impact;
    assert_int_equal(pir_scene_time_of_impact(scene, bullet, &motion, 1e-9, &impact), PIR_OK);
    assert_int_equal(impact.body, wall);
    assert_int_equal(impact.piece_p, 1);
    assert_true(fabs(impact.time - 0.08) < 1e-9 && impact.normal.x == -1 && fabs(impact.point.x - 9.5) < 1e-9);
    motion.way = (pir_vec3){-100, 0, 0};
    assert_int_equal(pir_scene_time_of_impact(scene, bullet, &motion, 1e-9, &impact), PIR_OK);
    assert_true(impact.body == PIR_SCENE_NONE && impact.time == 1);
    // by a turn alone: the second piece swings into a wall beside it
    uint32_t side = add(scene, pieces, 1, (pir_vec3){0, 1.5, 0}, 0);
    motion = (pir_motion){{0, 0, 0}, {0, 0, 3}, 0};
    assert_int_equal(pir_scene_time_of_impact(scene, bullet, &motion, 1e-6, &impact), PIR_OK);
    assert_true(impact.body == side && impact.time > 0 && impact.time < 0.3);
    pir_scene_destroy(scene);
    pir_polytope_release(pieces[0]);
    pir_polytope_release(pieces[1]);
}

/* --- refusals and memory --- */

static void what_cannot_be_asked_is_refused(void **state) {
    (void)state;
    pir_polytope *p = scene_cube(1);
    pir_scene *scene;
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    uint32_t ghost = add(scene, &p, 1, (pir_vec3){0, 0, 0}, 1);
    pir_scene_shape good = pir_scene_shape_default(p), shape = good;
    pir_motion motion = {{1, 0, 0}, {0, 0, 0}, 0}, wild = {{1, NAN, 0}, {0, 0, 0}, 0},
               whirl = {{1, 0, 0}, {0, 1e7, 0}, 0};
    pir_scene_hit hit;
    pir_scene_near near;
    pir_impact impact;
    size_t count = 42;
    struct {
        pir_scene_shape shape;
        pir_status status;
    } cases[5] = {{good, PIR_ERR_ARGUMENT},
                  {good, PIR_ERR_NOT_FINITE},
                  {good, PIR_ERR_ARGUMENT},
                  {good, PIR_ERR_ZERO_QUATERNION},
                  {good, PIR_ERR_LIMIT}};
    cases[0].shape.polytope = NULL;
    cases[1].shape.radius = NAN;
    cases[2].shape.radius = -1;
    cases[3].shape.pose.rotation.w = 0;
    cases[4].shape.pose.translation.z = 0x1p70;
    for (int i = 0; i < 5; i++) {
        shape = cases[i].shape;
        assert_int_equal(pir_scene_overlap(scene, &shape, 1, &hit, &count), cases[i].status);
        assert_int_equal(pir_scene_nearest(scene, &shape, 1, 1, &near, &count), cases[i].status);
        assert_int_equal(pir_scene_cast(scene, &shape, &motion, 1e-6, &impact), cases[i].status);
    }
    assert_int_equal(pir_scene_overlap(NULL, &good, 1, &hit, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_overlap(scene, NULL, 1, &hit, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_overlap(scene, &good, 1, NULL, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_overlap(scene, &good, 1, &hit, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_nearest(scene, &good, NAN, 1, &near, &count), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_scene_nearest(scene, &good, -1, 1, &near, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_nearest(scene, &good, 1, 0, &near, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_nearest(NULL, &good, 1, 1, &near, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_closest_pairs(NULL, 1, 1, &near, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_closest_pairs(scene, 1, 1, NULL, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_ray(NULL, test_zero, test_zero, 1, &impact), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_ray(scene, wild.way, test_zero, 1, &impact), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_scene_ray(scene, (pir_vec3){0x1p70, 0, 0}, test_zero, 1, &impact), PIR_ERR_LIMIT);
    assert_int_equal(pir_scene_cast(scene, &good, &wild, 1e-6, &impact), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_scene_cast(scene, &good, &whirl, 1e-6, &impact), PIR_ERR_LIMIT);
    assert_int_equal(pir_scene_cast(scene, &good, &motion, 0, &impact), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_cast(scene, &good, NULL, 1, &impact), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_time_of_impact(scene, ghost, &motion, 1, &impact), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_time_of_impact(scene, 7, &motion, 1, &impact), PIR_ERR_ARGUMENT);
    assert_int_equal(count, 42);
    // a scene in which there is nothing to see
    assert_int_equal(pir_scene_overlap(scene, &good, 1, &hit, &count), PIR_OK);
    assert_int_equal(count, 0);
    assert_int_equal(pir_scene_ray(scene, test_zero, test_zero, UINT32_MAX, &impact), PIR_OK);
    assert_int_equal(impact.body, PIR_SCENE_NONE);
    pir_scene_destroy(scene);
    pir_polytope_release(p);
}

static void memory_that_fails_fails_the_query_alone(void **state) {
    (void)state;
    pir_polytope *p = scene_cube(1), *shape_of = scene_cube(0.75);
    pir_status status = PIR_ERR_MEMORY;
    uint64_t failures = 0;
    for (uint64_t request = 1; status == PIR_ERR_MEMORY; request++) {
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        pir_scene_options options = pir_scene_options_default();
        pir_scene *scene;
        options.allocator = &allocator;
        assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
        uint32_t id = add(scene, &p, 1, (pir_vec3){2, 0, 0}, 0);
        pir_scene_shape shape = pir_scene_shape_default(shape_of);
        pir_scene_near near;
        pir_impact impact = {.body = 42};
        size_t count = 0;
        memory.fail_at = memory.requests + request;
        status = pir_scene_nearest(scene, &shape, 5, 1, &near, &count);
        if (status == PIR_OK) // along a face: integers are made
            status = pir_scene_ray(scene, (pir_vec3){0, 1, 0}, (pir_vec3){8, 0, 0}, 1, &impact);
        failures += status == PIR_ERR_MEMORY;
        assert_true(pir_scene_is_valid(scene));
        // again, with memory
        assert_int_equal(pir_scene_nearest(scene, &shape, 5, 1, &near, &count), PIR_OK);
        assert_true(count == 1 && near.body_q == id && near.result.distance == 0.25);
        assert_int_equal(pir_scene_ray(scene, (pir_vec3){0, 1, 0}, (pir_vec3){8, 0, 0}, 1, &impact), PIR_OK);
        assert_true(impact.body == id && impact.time == 0.125);
        pir_scene_destroy(scene);
        expect(memory.blocks == 0 && !memory.wrong_size, "request %llu", (unsigned long long)request);
    }
    assert_int_equal(status, PIR_OK);
    assert_true(failures > 3);
    pir_polytope_release(p);
    pir_polytope_release(shape_of);
}

/* Casts of a ball as a point with a radius, by conservative advancement, and rays of that radius, in closed form. */
static void rays_with_a_radius_are_casts_of_balls(void **state) {
    (void)state;
    static crowd c;
    uint32_t hit = 0, missed = 0;
    test_points centre = {1, {{0, 0, 0}}};
    pir_polytope *point = test_polytope(&centre);
    for (uint64_t n = 0; n < 40; n++) {
        new_crowd(&c, n);
        for (int i = 0; i < 8; i++) {
            const double tolerance = 1e-7;
            pir_scene_ray_options options = pir_scene_ray_options_default();
            pir_scene_shape ball = pir_scene_shape_default(point);
            const pir_vec3 origin = test_add(test_zero, test_random_direction(&c.random), 2 * c.size);
            const pir_motion motion = {test_add(test_random_direction(&c.random), origin, -1.5), {0, 0, 0}, 0};
            pir_impact impact, right;
            options.radius = ball.radius = 0.0625 * (1 + i);
            options.mask = ball.mask = i % 2 ? UINT32_MAX : 1;
            ball.pose.translation = origin;
            assert_int_equal(pir_scene_ray_first(c.scene, origin, motion.way, &options, &impact), PIR_OK);
            assert_int_equal(pir_scene_cast(c.scene, &ball, &motion, tolerance, &right), PIR_OK);
            const unsigned long long number = n * 8 + (uint64_t)i;
            // a ball that hardly touches something on its way may pass it by its tolerance
            const double room = 1e-3;
            expect(impact.time >= right.time - 1e-9 && impact.time >= 0 && impact.time <= 1, "ray %llu", number);
            const bool hits = impact.outcome != PIR_CAST_MISS;
            expect(impact.time <= right.time + room || right.outcome == PIR_CAST_MISS || !hits, "ray %llu: %g, %g",
                   number, impact.time, right.time);
            hit += hits;
            missed += !hits;
            if (impact.outcome != PIR_CAST_HIT)
                continue;
            const crowd_body *body = crowd_body_of(&c, impact.body);
            const pir_query_result there =
                ask_alone(point, (pir_pose){{0, 0, 0, 1}, impact.point}, 0, body, impact.piece_q);
            expect(fabs(there.distance) < 1e-9, "ray %llu: its point is %g off", number, there.distance);
            expect(impact.user == body->options.user && impact.piece_user == 100 + impact.piece_q, "ray %llu", number);
        }
        crowd_finish(&c);
    }
    pir_polytope_release(point);
    expect(hit > 100 && missed > 2, "%u hits, %u misses", hit, missed);
}

static bool counts_even(void *context, uint32_t body, uint64_t user) {
    ++*(uint32_t *)context;
    return body % 2 == 0 && user > 0;
}

/* What a filter leaves out, each by a scene without it; many rays at once are as one after the other. */
static bool are_same_hits(const pir_scene_hit *a, const pir_scene_hit *b) {
    return a->body == b->body && a->piece == b->piece && a->state == b->state && a->user == b->user &&
           a->piece_user == b->piece_user;
}

static void filters_leave_out_what_they_name(void **state) {
    (void)state;
    static crowd c;
    for (uint64_t n = 0; n < 20; n++) {
        new_crowd(&c, n);
        const uint32_t ignored[3] = {1, 4, 1u << 20 | 2};
        uint32_t asked = 0, seen = 0;
        const pir_query_filter by_id = {.ignored = ignored, .ignored_count = 3},
                               by_call = {.counts = counts_even, .context = &asked};
        pir_scene_ray_options options = pir_scene_ray_options_default();
        pir_scene_shape shape = random_shape(&c);
        pir_scene_hit all[MOST], few[MOST];
        size_t of_all, of_few;
        for (int k = 0; k < 2; k++) {
            shape.mask = UINT32_MAX;
            shape.except = PIR_SCENE_NONE;
            shape.filter = NULL;
            assert_int_equal(pir_scene_overlap(c.scene, &shape, MOST, all, &of_all), PIR_OK);
            shape.filter = k == 0 ? &by_id : &by_call;
            assert_int_equal(pir_scene_overlap(c.scene, &shape, MOST, few, &of_few), PIR_OK);
            size_t next = 0;
            for (size_t i = 0; i < of_all; i++)
                if (k == 0 ? all[i].body != 1 && all[i].body != 4 : all[i].body % 2 == 0)
                    assert_true(are_same_hits(&few[next++], &all[i]));
            assert_int_equal(next, of_few);
        }
        assert_true(asked > 0 || of_all == 0);
        pir_scene_segment segment[16];
        pir_impact impact[16];
        for (int i = 0; i < 16; i++) {
            segment[i].origin = test_add(test_zero, test_random_direction(&c.random), 2 * c.size);
            segment[i].way = test_add(test_random_direction(&c.random), segment[i].origin, -1.5);
        }
        options.filter = &by_call;
        options.radius = n % 2 ? 0.125 : 0;
        assert_int_equal(pir_scene_ray_batch(c.scene, segment, 16, &options, impact), PIR_OK);
        for (int i = 0; i < 16; i++) {
            pir_impact one;
            assert_int_equal(pir_scene_ray_first(c.scene, segment[i].origin, segment[i].way, &options, &one), PIR_OK);
            assert_true(one.body == impact[i].body && one.time == impact[i].time && one.piece_q == impact[i].piece_q);
            assert_true(one.body == PIR_SCENE_NONE || one.body % 2 == 0);
            seen += one.body != PIR_SCENE_NONE;
        }
        assert_int_equal(pir_scene_ray_batch(c.scene, NULL, 0, NULL, NULL), PIR_OK);
        assert_int_equal(pir_scene_ray_batch(c.scene, NULL, 1, NULL, impact), PIR_ERR_ARGUMENT);
        const pir_impact before = impact[0];
        segment[15].way.x = NAN;
        assert_int_equal(pir_scene_ray_batch(c.scene, segment, 16, &options, impact), PIR_ERR_NOT_FINITE);
        assert_memory_equal(&before, &impact[0], sizeof before);
        options.radius = -1;
        assert_int_equal(pir_scene_ray_first(c.scene, test_zero, test_zero, &options, impact), PIR_ERR_ARGUMENT);
        options.radius = NAN;
        assert_int_equal(pir_scene_ray_first(c.scene, test_zero, test_zero, &options, impact), PIR_ERR_NOT_FINITE);
        assert_true(seen > 0);
        pir_polytope_release(shape.polytope);
        crowd_finish(&c);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(overlaps_are_those_of_all_pieces),
        cmocka_unit_test(the_nearest_are_those_of_all_pieces),
        cmocka_unit_test(the_closest_pairs_are_those_of_all),
        cmocka_unit_test(rays_hit_exactly_what_segments_do),
        cmocka_unit_test(a_ray_in_the_plane_of_a_flat_piece_enters_by_its_side),
        cmocka_unit_test(boxes_in_boxes_are_all_met),
        cmocka_unit_test(a_cast_ends_at_the_first_contact),
        cmocka_unit_test(a_spinning_cube_that_glides_by_is_no_hit),
        cmocka_unit_test(a_cube_that_swings_by_in_each_turn_is_followed_to_its_hit),
        cmocka_unit_test(a_cast_that_begins_inside_tells_the_normal_of_the_depth),
        cmocka_unit_test(a_cast_that_begins_in_several_tells_the_deepest),
        cmocka_unit_test(what_is_held_is_met_at_half_its_distance),
        cmocka_unit_test(a_fast_body_meets_a_wall_in_time),
        cmocka_unit_test(what_cannot_be_asked_is_refused),
        cmocka_unit_test(memory_that_fails_fails_the_query_alone),
        cmocka_unit_test(rays_with_a_radius_are_casts_of_balls),
        cmocka_unit_test(filters_leave_out_what_they_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
