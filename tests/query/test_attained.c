/* SPDX-License-Identifier: MIT */
/*
 * Where answers are attained: points on the bodies where features are parallel, casts that slide or recede next to a
 * face, lines nearly along the facet that decides, and the same bits whatever was asked before. Small cases, with the
 * answers that plain geometry gives; the same at random, and against exact arithmetic, is in test_exact_answers.c.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/query.h>

#include "query/box_scene.h"
#include "support/bodies.h"
#include "support/turning.h"

static const pir_quat eighth = {0, 0.3826834323650898, 0, 0.9238795325112867}; /* of a turn, about y */

static pir_query_result ask_anew(struct scene *pair, double x, double y, double z) {
    pir_query_input input = at(x, y, z);
    pir_query_result result;
    assert_int_equal(pir_query_signed_distance(pair->query, &input, NULL, &result), PIR_OK);
    return result;
}

static int in_box(pir_vec3 point, pir_vec3 low, pir_vec3 high) {
    const double error = 4e-16;
    return point.x >= low.x - error && point.x <= high.x + error && point.y >= low.y - error &&
           point.y <= high.y + error && point.z >= low.z - error && point.z <= high.z + error;
}

/* --- points on the bodies --- */

static void cubes_face_on_face_touch_where_both_are(void **state) {
    (void)state;
    struct scene pair = make_scene(test_box(0.5, 0.5, 0.5), test_box(0.5, 0.5, 0.5), still);
    const double heights[3] = {0.9, 1, 1.25};
    for (int i = 0; i < 3; i++) {
        pir_query_result r = ask_anew(&pair, 0.3, 0.2, heights[i]);
        assert_true(fabs(r.distance - (heights[i] - 1)) <= 1e-15 && r.normal.z == 1);
        pir_vec3 low = {-0.2, -0.3, heights[i] - 0.5}, high = {0.8, 0.7, heights[i] + 0.5};
        assert_true(in_box(r.point_p, low, high));
        assert_true(in_box(r.point_q, (pir_vec3){-0.5, -0.5, -0.5}, (pir_vec3){0.5, 0.5, 0.5}));
    }
    clear_scene(&pair);
}

static void a_cube_on_its_edge_touches_where_both_are(void **state) {
    (void)state;
    struct scene pair = make_scene(test_box(0.5, 0.5, 0.5), test_box(0.5, 0.5, 0.5), eighth);
    double half = sqrt(0.5);
    for (double along = -0.9; along < 1; along += 0.45)
        for (double height = -0.1; height <= 0.1; height += 0.1) {
            pir_query_result r = ask_anew(&pair, 0.2, along, 0.5 + half + height);
            assert_true(fabs(r.distance - height) <= 1e-15);
            assert_true(in_box(r.point_q, (pir_vec3){-0.5, -0.5, -0.5}, (pir_vec3){0.5, 0.5, 0.5}));
            assert_true(fabs(r.point_p.x - 0.2) <= 1e-15 && fabs(r.point_p.y - along) <= 0.5 + 1e-15);
            assert_true(r.witness.p.kind != PIR_FEATURE_FACET && r.witness.q.kind != PIR_FEATURE_NONE);
        }
    clear_scene(&pair);
}

static void the_least_faces_are_named(void **state) {
    (void)state;
    struct scene pair = make_scene(test_box(0.5, 0.5, 0.5), test_box(0.5, 0.5, 0.5), still);
    // corners of Q under the inside, an edge and a corner of P's face
    const struct {
        double x, y;
        pir_feature_kind p;
    } cases[3] = {{0.25, 0.125, PIR_FEATURE_FACET}, {0, 0.125, PIR_FEATURE_EDGE}, {0, 0, PIR_FEATURE_VERTEX}};
    for (int i = 0; i < 3; i++) {
        pir_query_result r = ask_anew(&pair, cases[i].x, cases[i].y, 0.75);
        assert_int_equal(r.witness.p.kind, cases[i].p);
        assert_int_equal(r.witness.q.kind, PIR_FEATURE_VERTEX);
    }
    clear_scene(&pair);
}

/* Far from the origin a gap may be too small for coordinates to tell: the two points are apart all the same. */
static void points_over_any_gap_are_apart_along_the_normal(void **state) {
    (void)state;
    for (int axis = 0; axis < 3; axis++)
        for (int side = -1; side <= 1; side += 2) {
            pir_vec3 points[2][8];
            pir_polytope *body[2];
            for (int k = 0; k < 2; k++) {
                for (int i = 0; i < 8; i++) {
                    double c[3] = {i & 1, (i & 2) / 2, (i & 4) / 4};
                    c[axis] += k == 0 ? 1024 + side : 1024;
                    points[k][i] = (pir_vec3){c[0], c[1], c[2]};
                }
                assert_int_equal(pir_polytope_create(points[k], 8, NULL, &body[k]), PIR_OK);
            }
            struct scene pair = make_scene(body[0], body[1], still);
            for (int i = 20; i <= 200; i += 20) {
                double gap = side * ldexp(1, -i);
                pir_query_result r = ask_anew(&pair, axis == 0 ? gap : 0, axis == 1 ? gap : 0, axis == 2 ? gap : 0);
                double normal[3] = {r.normal.x, r.normal.y, r.normal.z};
                double apart = (r.point_p.x - r.point_q.x) * normal[0] + (r.point_p.y - r.point_q.y) * normal[1] +
                               (r.point_p.z - r.point_q.z) * normal[2];
                assert_true(r.state == PIR_OUTSIDE && r.distance == fabs(gap) && normal[axis] == side);
                expect(apart > 0 && apart <= fabs(gap) + 0x1p-42, "axis %d, side %d, gap 2^-%d: %g", axis, side, i,
                       apart);
            }
            clear_scene(&pair);
        }
}

/* --- casts and directions --- */

static void casts_slide_along_a_face_at_any_gap(void **state) {
    (void)state;
    struct scene pair = make_scene(test_box(0.5, 0.5, 0.5), test_box(0.5, 0.5, 0.5), still);
    for (int i = 1; i <= 52; i++) {
        double gap = ldexp(1, -i);
        pir_query_input input = at(0.25, 0, 1 + gap);
        const pir_vec3 ways[3] = {{1, 0, 0}, {-0.5, 2, 0}, {1, 1, ldexp(1, -1000)}};
        for (int k = 0; k < 3; k++) {
            pir_impact cast;
            pir_query_result r;
            assert_int_equal(pir_query_cast(pair.query, &input, ways[k], &cast), PIR_OK);
            assert_int_equal(cast.outcome, PIR_CAST_MISS);
            assert_int_equal(pir_query_directional_distance(pair.query, &input, ways[k], &r), PIR_OK);
            assert_int_equal(r.outcome, PIR_NO_HIT);
        }
        // and the least descent arrives, at the very time
        pir_impact cast;
        assert_int_equal(pir_query_cast(pair.query, &input, (pir_vec3){0.125, 0, -2 * gap}, &cast), PIR_OK);
        assert_int_equal(cast.outcome, PIR_CAST_HIT);
        assert_true(cast.time == 0.5);
    }
    clear_scene(&pair);
}

/* A motion that ends on the face hits it, and one that is shorter by the last bit does not. */
static void casts_end_where_they_end(void **state) {
    (void)state;
    struct scene pair = make_scene(test_box(0.5, 0.5, 0.5), test_box(0.5, 0.5, 0.5), still);
    for (int i = 0; i <= 40; i++) {
        double gap = ldexp(1, -i);
        pir_query_input input = at(0.125, 0.25, 1 + gap);
        const double lengths[3] = {nextafter(gap, 0), gap, nextafter(gap, 2)};
        for (int k = 0; k < 3; k++) {
            pir_impact cast;
            assert_int_equal(pir_query_cast(pair.query, &input, (pir_vec3){0, 0, -lengths[k]}, &cast), PIR_OK);
            assert_int_equal(cast.outcome, k > 0 ? PIR_CAST_HIT : PIR_CAST_MISS);
            assert_true(k == 2 ? cast.time > 1 - 1e-15 && cast.time <= 1 : cast.time == 1);
        }
    }
    clear_scene(&pair);
}

/* A motion of a box that is turned on the way, its rotation given by quaternions of all sizes. */
static void advances_take_rotations_of_any_size(void **state) {
    (void)state;
    const double sizes[4] = {1, 3, 0x1p-1060, 0x1.8p1023}, half[3] = {0.5, 0.25, 1};
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < 4; i++) {
            struct scene pair = make_scene(test_box(half[0], half[1], half[2]), test_box(1, 1, 1), still);
            double part[3] = {0, 0, 0}, s = sizes[i];
            part[axis] = s;
            test_turning motion = {.rotation = {part[0], part[1], part[2], s},
                                   .axis = {axis == 0, axis == 1, axis == 2}};
            // a quarter turn about the axis brings the one after next to the next
            int next = (axis + 1) % 3, other = (axis + 2) % 3;
            double start[3] = {0, 0, 0};
            start[next] = 5;
            motion.start = (pir_vec3){start[0], start[1], start[2]};
            motion.motion = (pir_vec3){-start[0], -start[1], -start[2]};
            pir_impact cast;
            assert_int_equal(test_impact(pair.query, pair.sum, &motion, 1e-9, &cast), PIR_OK);
            expect(cast.outcome == PIR_CAST_HIT && fabs(5 - 5 * cast.time - 1 - half[other]) < 1e-8,
                   "axis %d, size %g: time %.17g", axis, s, cast.time);
            // turning on, either way, the box reaches as far
            motion.angle = -0.25;
            assert_int_equal(test_impact(pair.query, pair.sum, &motion, 1e-9, &cast), PIR_OK);
            double angle = 0.25 * cast.time;
            expect(cast.outcome == PIR_CAST_HIT &&
                       fabs(5 - 5 * cast.time - 1 - half[other] * cos(angle) - half[next] * sin(angle)) < 1e-8,
                   "axis %d, size %g, turning: time %.17g", axis, s, cast.time);
            assert_true(cast.steps < 10000);
            clear_scene(&pair);
        }
}

static void lines_leave_by_facets_that_they_are_nearly_along(void **state) {
    (void)state;
    struct scene pair = make_scene(test_box(0.5, 0.5, 0.5), test_box(0.5, 0.5, 0.5), still);
    for (int i = 10; i <= 50; i++) {
        // half way to the next face when it passes this one
        double slope = ldexp(1, -i);
        pir_query_input input = at(0, 1 - slope / 2, 0);
        pir_query_result r;
        assert_int_equal(pir_query_directional_depth(pair.query, &input, (pir_vec3){1, slope, 0}, &r), PIR_OK);
        assert_true(fabs(r.distance + 0.5 * sqrt(1 + slope * slope)) <= 1e-15 && r.normal.y == 1);
        input = at(-2, 1 + slope / 2 + slope, 0);
        assert_int_equal(pir_query_directional_distance(pair.query, &input, (pir_vec3){1, -slope, 0}, &r), PIR_OK);
        assert_int_equal(r.outcome, PIR_SEPARATED);
        assert_true(fabs(r.distance - 1.5 * sqrt(1 + slope * slope)) <= 2e-15 && r.normal.y == 1);
    }
    clear_scene(&pair);
}

/* --- one query through many rotations --- */

static double along(pir_vec3 n, pir_vec3 v) {
    return n.x * v.x + n.y * v.y + n.z * v.z;
}

/* v turned by a quaternion of integers whose square is 1, 2 or 4: exact. */
static pir_vec3 turn(pir_quat q, pir_vec3 v) {
    double x = q.x, y = q.y, z = q.z, w = q.w, n = x * x + y * y + z * z + w * w;
    pir_vec3 m[3] = {{(w * w + x * x - y * y - z * z) / n, 2 * (x * y - w * z) / n, 2 * (x * z + w * y) / n},
                     {2 * (x * y + w * z) / n, (w * w - x * x + y * y - z * z) / n, 2 * (y * z - w * x) / n},
                     {2 * (x * z - w * y) / n, 2 * (y * z + w * x) / n, (w * w - x * x - y * y + z * z) / n}};
    return (pir_vec3){along(m[0], v), along(m[1], v), along(m[2], v)};
}

/* The point of a body, turned, that is farthest along n. */
static pir_vec3 farthest(const test_points *points, pir_quat rotation, pir_vec3 n) {
    pir_vec3 best = turn(rotation, points->at[0]);
    for (size_t i = 1; i < points->count; i++) {
        pir_vec3 v = turn(rotation, points->at[i]);
        best = along(n, v) > along(n, best) ? v : best;
    }
    return best;
}

/* Where the farthest points of two bodies meet they touch, whatever rotations the query has seen before. */
static void farthest_points_touch_at_every_rotation(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 12; number++) {
        test_random random = test_random_case("farthest points", number);
        test_points p, q;
        test_body_points(&random, TEST_GRID, 60, &p);
        test_body_points(&random, number % 2 ? TEST_GRID : TEST_BOX, 60, &q);
        struct scene pair = make_scene(test_polytope(&p), test_polytope(&q), still);
        const pir_quat none = {0, 0, 0, 1};
        for (int i = 0; i < 60; i++) {
            // a quarter, third or half turn; those between leave other facets behind
            pir_quat r = {(double)test_random_below(&random, 2), (double)test_random_below(&random, 2),
                          (double)test_random_below(&random, 2), (double)test_random_below(&random, 2)};
            double square = r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w;
            if (square == 0 || square == 3)
                continue;
            pir_query_result result;
            pir_query_input input = at(0, 0, 0);
            assert_int_equal(pir_sum_rotate(pair.sum, test_general_rotation(&random), PIR_METHOD_AUTO), PIR_OK);
            assert_int_equal(pir_query_penetration(pair.query, &input, NULL, &result), PIR_OK);
            assert_int_equal(pir_sum_rotate(pair.sum, r, PIR_METHOD_AUTO), PIR_OK);
            for (int k = 0; k < 12; k++) {
                pir_vec3 n = test_random_direction(&random), back = {-n.x, -n.y, -n.z};
                pir_vec3 a = farthest(&p, r, back), b = farthest(&q, none, n);
                input = at(b.x - a.x, b.y - a.y, b.z - a.z);
                assert_int_equal(pir_query_overlap(pair.query, &input, NULL, &result), PIR_OK);
                expect(result.state == PIR_BOUNDARY, "bodies %llu, rotation %d: state %d", (unsigned long long)number,
                       i, (int)result.state);
                input = at(input.translation.x + n.x * 0x1p-20, input.translation.y + n.y * 0x1p-20,
                           input.translation.z + n.z * 0x1p-20);
                assert_int_equal(pir_query_overlap(pair.query, &input, NULL, &result), PIR_OK);
                assert_int_equal(result.state, PIR_OUTSIDE);
            }
        }
        clear_scene(&pair);
    }
}

/* --- the same bits --- */

static int same(const pir_query_result *a, const pir_query_result *b) {
    return a->state == b->state && a->outcome == b->outcome && a->distance == b->distance &&
           memcmp(&a->normal, &b->normal, sizeof a->normal) == 0 &&
           memcmp(&a->point_p, &b->point_p, sizeof a->point_p) == 0 &&
           memcmp(&a->point_q, &b->point_q, sizeof a->point_q) == 0 &&
           memcmp(&a->witness, &b->witness, sizeof a->witness) == 0;
}

/* Points at the ends of the doubles: the largest distance is a number or an error, never infinite. */
static void farthest_points_beyond_the_doubles_are_refused(void **state) {
    (void)state;
    const double far[] = {1e300, 1.2e308, 1.3e308, 1.7e308};
    for (int i = 0; i < 4; i++) {
        pir_polytope *p, *q;
        assert_int_equal(pir_polytope_create(&(pir_vec3){far[i], 0, 0}, 1, NULL, &p), PIR_OK);
        assert_int_equal(pir_polytope_create(&(pir_vec3){0, far[i], 0}, 1, NULL, &q), PIR_OK);
        struct scene pair = make_scene(p, q, still);
        pir_query_input input = at(0, 0, 0);
        pir_query_result result = {.steps = 7};
        assert_int_equal(pir_query_largest_distance(pair.query, &input, &result), i < 2 ? PIR_OK : PIR_ERR_LIMIT);
        if (i < 2)
            assert_true(fabs(result.distance / far[i] - sqrt(2)) < 1e-15 && isfinite(result.point_p.y));
        else
            assert_int_equal(result.steps, 7);
        clear_scene(&pair);
    }
}

static void any_cache_gives_the_same_bits(void **state) {
    (void)state;
    const pir_quat rotations[3] = {still, eighth, {0.1, -0.2, 0.3, 0.9}};
    for (int k = 0; k < 3; k++) {
        struct scene pair = make_scene(test_box(0.5, 0.25, 0.75), test_box(0.5, 0.5, 0.5), rotations[k]);
        pir_query_cache last = {0};
        for (uint32_t i = 0; i < 400; i++) {
            pir_query_input input = at((i % 7) * 0.25 - 0.75, (i % 5) * 0.375 - 0.75, (i % 13) * 0.125);
            pir_query_cache any = {
                1 + i % 3, {i % 8, (i / 8) % 8, (i / 64) % 8}, {i % 5, i % 3, i % 8}, i % 2, i % 3, i % 6, i % 11};
            pir_query_result cold, warm, strange;
            assert_int_equal(pir_query_signed_distance(pair.query, &input, NULL, &cold), PIR_OK);
            assert_int_equal(pir_query_signed_distance(pair.query, &input, &last, &warm), PIR_OK);
            assert_int_equal(pir_query_signed_distance(pair.query, &input, &any, &strange), PIR_OK);
            double number;
            assert_int_equal(pir_query_batch_distances(pair.query, &input.translation, 1, &number, NULL), PIR_OK);
            assert_true(same(&cold, &warm) && same(&cold, &strange) && number == cold.distance);
        }
        clear_scene(&pair);
    }
}

/*
 * A box moves along an edge of its own, turned by quaternions of integers, one of its facets through a corner of the
 * other box: parallel to it exactly, so that it grazes the corner for the length of the box. One query follows all
 * rotations.
 */
static void casts_along_turned_facets_graze_what_is_in_their_plane(void **state) {
    (void)state;
    const pir_vec3 half = {0.5, 0.25, 0.5};
    for (uint64_t i = 0; i < 20; i++) {
        test_random random = test_random_case("casts along facets", i);
        double q[4], n = 0;
        for (int k = 0; k < 4; k++) {
            q[k] = test_random_between(&random, 1, 9) * (test_random_below(&random, 2) ? 1 : -1);
            n += q[k] * q[k];
        }
        // of a size that makes all coordinates of the turned box integers
        struct scene pair = make_scene(test_box(n, n, n), test_box(half.x, half.y, half.z), still);
        for (int step = 0; step < 20; step++) {
            // the same numbers in another order and with other signs have the same length
            for (int k = 3; k > 0; k--) {
                uint32_t j = test_random_below(&random, (uint32_t)k + 1);
                double swapped = q[k];
                q[k] = q[j], q[j] = test_random_below(&random, 2) ? swapped : -swapped;
            }
            assert_int_equal(pir_sum_rotate(pair.sum, (pir_quat){q[0], q[1], q[2], q[3]}, PIR_METHOD_AUTO), PIR_OK);
            // two columns of M(q)
            pir_vec3 e = {n - 2 * (q[1] * q[1] + q[2] * q[2]), 2 * (q[0] * q[1] + q[2] * q[3]),
                          2 * (q[0] * q[2] - q[1] * q[3])};
            pir_vec3 d = {2 * (q[0] * q[1] - q[2] * q[3]), n - 2 * (q[0] * q[0] + q[2] * q[2]),
                          2 * (q[1] * q[2] + q[0] * q[3])};
            if (e.x * e.y * e.z == 0)
                continue;
            pir_query_input input = at(e.x + copysign(half.x, e.x) - 3 * d.x, e.y + copysign(half.y, e.y) - 3 * d.y,
                                       e.z + copysign(half.z, e.z) - 3 * d.z);
            pir_impact cast;
            assert_int_equal(pir_query_cast(pair.query, &input, (pir_vec3){6 * d.x, 6 * d.y, 6 * d.z}, &cast), PIR_OK);
            expect(cast.outcome == PIR_CAST_HIT && fabs(cast.time - 1.0 / 3) <= 1e-15,
                   "case %llu, step %d: outcome %d at %.17g", (unsigned long long)i, step, (int)cast.outcome,
                   cast.time);
        }
        clear_scene(&pair);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubes_face_on_face_touch_where_both_are),
        cmocka_unit_test(a_cube_on_its_edge_touches_where_both_are),
        cmocka_unit_test(the_least_faces_are_named),
        cmocka_unit_test(points_over_any_gap_are_apart_along_the_normal),
        cmocka_unit_test(casts_slide_along_a_face_at_any_gap),
        cmocka_unit_test(casts_end_where_they_end),
        cmocka_unit_test(advances_take_rotations_of_any_size),
        cmocka_unit_test(lines_leave_by_facets_that_they_are_nearly_along),
        cmocka_unit_test(farthest_points_touch_at_every_rotation),
        cmocka_unit_test(casts_along_turned_facets_graze_what_is_in_their_plane),
        cmocka_unit_test(farthest_points_beyond_the_doubles_are_refused),
        cmocka_unit_test(any_cache_gives_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
