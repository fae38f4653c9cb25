/* SPDX-License-Identifier: MIT */
/*
 * Queries on a sum with a region, against the list of all facets of a whole sum, and against another sum that has
 * come to the same rotation in another way.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/query.h>

#include "base/vec.h"
#include "exact/rotation.h"
#include "support/bodies.h"
#include "support/queries.h"
#include "support/turning.h"
#include "support/vectors.h"

#define MOST_FACETS 20000

/* A normal nearer than this to the rim of the cone counts neither as in nor as out. */
#define RIM 1e-9

struct scene {
    pir_polytope *p, *q;
    pir_sum *region, *fresh, *whole;
    pir_query *ask_region, *ask_fresh, *ask_whole;
    pir_escape *escapes;
    uint32_t answered, apart, nothing, along, edges, beside;
};

static void scene_init(struct scene *s, const test_pose *pose) {
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    s->p = test_polytope(&pose->p);
    s->q = test_polytope(&pose->q);
    pir_sum **sums[] = {&s->region, &s->fresh, &s->whole};
    pir_query **queries[] = {&s->ask_region, &s->ask_fresh, &s->ask_whole};
    for (int k = 0; k < 3; k++) {
        assert_int_equal(pir_sum_create(s->p, s->q, pose->rotation, &options, sums[k]), PIR_OK);
        assert_int_equal(pir_query_create(*sums[k], queries[k]), PIR_OK);
    }
}

static void scene_clear(struct scene *s) {
    pir_query_destroy(s->ask_region);
    pir_query_destroy(s->ask_fresh);
    pir_query_destroy(s->ask_whole);
    pir_sum_destroy(s->region);
    pir_sum_destroy(s->fresh);
    pir_sum_destroy(s->whole);
    pir_polytope_release(s->q);
    pir_polytope_release(s->p);
}

/* A cache that names any piece: one that the sum keeps, a inactive one, or none at all. */
static pir_query_cache any_piece(test_random *random) {
    uint32_t most = test_random_below(random, 4) ? 40 : UINT32_MAX;
    return (pir_query_cache){.pieces = 1,
                             .kind = test_random_below(random, 4),
                             .first = test_random_below(random, most),
                             .second = test_random_below(random, most)};
}

/*
 * The least depth over the whole sum's facets in the cone about unit `axis`, from above and from below where the rim
 * leaves it open.
 */
static void least_in_cone(struct scene *s, const pir_query_input *input, double size, pir_vec3 axis, double half_angle,
                          double *ret_least, double *ret_most) {
    size_t count;
    assert_int_equal(pir_query_escapes(s->ask_whole, input, 1e3 * size, MOST_FACETS, s->escapes, &count), PIR_OK);
    assert_true(count <= MOST_FACETS);
    *ret_least = *ret_most = HUGE_VAL;
    for (size_t i = 0; i < count; i++) {
        double along = test_dot(s->escapes[i].normal, axis) - cos(half_angle);
        if (along >= -RIM)
            *ret_least = fmin(*ret_least, s->escapes[i].depth);
        if (along >= RIM)
            *ret_most = fmin(*ret_most, s->escapes[i].depth);
    }
}

/* The ends of an edge as it is placed. */
static void edge_ends(const pir_polytope *polytope, uint32_t edge, const pir_mat3 *r, pir_vec3 t, pir_vec3 ret[2]) {
    uint32_t v[2];
    pir_polytope_edge(polytope, edge, v);
    for (int k = 0; k < 2; k++) {
        pir_vec3 x = pir_polytope_vertex(polytope, v[k]);
        ret[k] = pir_vec_add(r ? pir_mat_apply(r, x) : x, t);
    }
}

/*
 * That the point on Q of a witness of two edges is that of Q's edge nearest to the line of P's: in a region the foot
 * may be beside the facet, and the ends of P's edge are not asked.
 */
static void expect_edge_point(struct scene *s, const pir_query_result *part, pir_vec3 t, double size,
                              const char *situation) {
    if (part->witness.p.kind != PIR_FEATURE_EDGE || part->witness.q.kind != PIR_FEATURE_EDGE)
        return;
    pir_rotation turn;
    pir_vec3 a[2], b[2];
    assert_int_equal(pir_rotation_set(&turn, pir_sum_rotation(s->region)), PIR_OK);
    edge_ends(s->p, part->witness.p.index, &turn.r, t, a);
    edge_ends(s->q, part->witness.q.index, NULL, (pir_vec3){0, 0, 0}, b);
    pir_vec3 e = pir_vec_sub(a[1], a[0]), d = pir_vec_sub(b[1], b[0]), n = pir_vec_cross(e, d);
    double square = test_dot(n, n);
    double along = test_dot(n, part->normal);
    // edges that doubles tell the directions of, and whose facet it is
    if (!(square > 1e-6 * test_dot(e, e) * test_dot(d, d) &&
          fmin(test_dot(e, e), test_dot(d, d)) > 1e-6 * size * size && along * along > square * (1 - 1e-9)))
        return;
    double at = test_dot(pir_vec_cross(pir_vec_sub(a[0], b[0]), e), pir_vec_cross(d, e)) / square;
    pir_vec3 nearest = pir_vec_add(b[0], pir_vec_scale(d, fmin(1, fmax(0, at))));
    pir_vec3 off = pir_vec_sub(part->point_q, nearest);
    s->edges++;
    s->beside += at < 0 || at > 1;
    expect(sqrt(test_dot(off, off)) <= 1e-11 * size, "%s: the point on Q's edge is %g off", situation,
           sqrt(test_dot(off, off)));
}

static void ask_region(struct scene *s, pir_vec3 t, pir_vec3 axis, double half_angle, pir_query_cache *cache,
                       double size, const char *situation) {
    pir_query_input input = pir_query_input_default();
    pir_query_result part, again, all;
    input.translation = t;
    assert_int_equal(pir_query_penetration(s->ask_region, &input, cache, &part), PIR_OK);
    assert_int_equal(pir_query_penetration(s->ask_fresh, &input, NULL, &again), PIR_OK);
    assert_int_equal(pir_query_penetration(s->ask_whole, &input, NULL, &all), PIR_OK);
    expect(part.state == again.state && part.outcome == again.outcome &&
               memcmp(&part.distance, &again.distance, sizeof part.distance) == 0 &&
               memcmp(&part.normal, &again.normal, sizeof part.normal) == 0 &&
               memcmp(&part.witness, &again.witness, sizeof part.witness) == 0,
           "%s: another answer after another way", situation);
    expect(part.steps == 1 && again.steps == 1, "%s: %u steps to look once", situation, part.steps);
    if (part.outcome == PIR_SEPARATED) {
        s->apart++;
        expect(all.state == PIR_OUTSIDE && part.state == PIR_OUTSIDE, "%s: apart and not", situation);
        return;
    }
    if (all.state == PIR_OUTSIDE) {
        // a facet that shows it, if it is in the cone
        assert_int_equal(pir_query_overlap(s->ask_whole, &input, NULL, &all), PIR_OK);
        expect(test_dot(all.normal, axis) < cos(half_angle) + RIM || test_dot(all.normal, all.normal) < 0.5,
               "%s: a facet of the region separates", situation);
    }
    if (part.outcome == PIR_NO_HIT) {
        s->nothing++;
    } else {
        assert_int_equal(part.outcome, PIR_NOT_SEPARATED);
        expect(test_dot(part.normal, axis) >= cos(half_angle) - RIM, "%s: not in the cone", situation);
        double gap = fmax(fabs(part.point_p.x - part.point_q.x - part.distance * part.normal.x),
                          fabs(part.point_p.y - part.point_q.y - part.distance * part.normal.y));
        gap = fmax(gap, fabs(part.point_p.z - part.point_q.z - part.distance * part.normal.z));
        expect(gap <= 1e-12 * size, "%s: points", situation);
        expect_edge_point(s, &part, t, size, situation);
    }
    if (all.state != PIR_INSIDE)
        return;
    double least, most;
    least_in_cone(s, &input, size, axis, half_angle, &least, &most);
    if (part.outcome == PIR_NO_HIT) {
        expect(most == HUGE_VAL, "%s: facets in the cone", situation);
        return;
    }
    s->answered++;
    expect(-part.distance >= least - 1e-11 * size && -part.distance <= most + 1e-11 * size,
           "%s: depth %g, not %g to %g", situation, -part.distance, least, most);
    // the depth along a direction: that of the whole sum where its facet is in the cone, otherwise no shorter
    pir_query_result out, all_out;
    assert_int_equal(pir_query_directional_depth(s->ask_region, &input, axis, &out), PIR_OK);
    expect(out.steps == (out.state == PIR_INSIDE ? 2 : 1), "%s: %u steps to the state and the exit", situation,
           out.steps);
    assert_int_equal(pir_query_directional_depth(s->ask_whole, &input, axis, &all_out), PIR_OK);
    if (test_dot(all_out.normal, axis) > cos(half_angle) + RIM) {
        s->along++;
        expect(out.outcome == PIR_NOT_SEPARATED && fabs(out.distance - all_out.distance) <= 1e-9 * size,
               "%s: %g along the axis, not %g", situation, out.distance, all_out.distance);
    } else {
        expect(out.outcome == PIR_NO_HIT || out.distance <= all_out.distance + 1e-9 * size, "%s: a shorter way",
               situation);
    }
}

static double reach_of(const pir_polytope *p) {
    pir_vec3 low, high;
    pir_polytope_bounds(p, &low, &high);
    return fmax(high.x - low.x, fmax(high.y - low.y, high.z - low.z)) +
           fmax(fabs(low.x), fmax(fabs(low.y), fabs(low.z)));
}

static void depth_in_a_region_is_the_least_of_its_facets(void **state) {
    (void)state;
    struct scene s = {.escapes = malloc(MOST_FACETS * sizeof *s.escapes)};
    assert_non_null(s.escapes);
    for (uint64_t i = 0; i < 150; i++) {
        test_random random = test_random_case("region queries", i);
        test_pose pose;
        test_random_pose(&random, i % 3 ? 12 : 30, &pose);
        if (pose.rotation.x + pose.rotation.y + pose.rotation.z + pose.rotation.w == 0)
            continue;
        scene_init(&s, &pose);
        double size = reach_of(s.p) + reach_of(s.q);
        // bodies that queries refuse are for other tests
        if (size > 1e100 || size < 1e-100) {
            scene_clear(&s);
            continue;
        }
        pir_query_cache cache = {0};
        pir_quat r = pose.rotation;
        double half_angle = 0.1 + 0.4 * test_random_below(&random, 4);
        pir_vec3 axis = test_random_direction(&random), step = test_random_direction(&random), t = {0, 0, 0};
        for (int frame = 0; frame < 20; frame++) {
            pir_quat next = test_compose((pir_quat){0.01 * step.x, 0.01 * step.y, 0.01 * step.z, 1}, r, 1);
            if (isfinite(next.x + next.y + next.z + next.w) &&
                next.x * next.x + next.w * next.w + next.y * next.y + next.z * next.z > 0.5)
                r = next;
            assert_int_equal(pir_sum_rotate(s.region, r, PIR_METHOD_UPDATE), PIR_OK);
            assert_int_equal(pir_sum_rotate(s.whole, r, PIR_METHOD_UPDATE), PIR_OK);
            assert_int_equal(pir_sum_rotate(s.fresh, r, PIR_METHOD_WALK), PIR_OK);
            axis = (pir_vec3){axis.x + 0.02 * step.y, axis.y + 0.02 * step.z, axis.z + 0.02 * step.x};
            double n = sqrt(test_dot(axis, axis));
            axis = (pir_vec3){axis.x / n, axis.y / n, axis.z / n};
            assert_int_equal(pir_sum_set_region(s.region, axis, half_angle), PIR_OK);
            assert_int_equal(pir_sum_set_region(s.fresh, axis, half_angle), PIR_OK);
            // about the middle of the difference, and out of it towards the axis
            pir_vec3 low[2], high[2];
            pir_polytope_bounds(pir_sum_p(s.whole), &low[0], &high[0]);
            pir_polytope_bounds(pir_sum_q(s.whole), &low[1], &high[1]);
            t = (pir_vec3){(low[1].x + high[1].x) / 2, (low[1].y + high[1].y) / 2, (low[1].z + high[1].z) / 2};
            double along = size * 0.3 * (double)(frame % 5 - 1) / 2;
            t = (pir_vec3){t.x + along * axis.x, t.y + along * axis.y, t.z + along * axis.z};
            if (frame % 4 == 3)
                cache = any_piece(&random);
            ask_region(&s, t, axis, half_angle, &cache, size, pose.situation);
        }
        scene_clear(&s);
    }
    free(s.escapes);
    print_message("# %u depths, %u along, %u apart, %u without a facet, %u on two edges, %u beside them\n", s.answered,
                  s.along, s.apart, s.nothing, s.edges, s.beside);
    assert_true(s.answered > 300 && s.along > 100 && s.apart > 100 && s.nothing > 10);
    assert_true(s.edges > 100 && s.beside > 10);
}

/* A facet's plane passes exactly through the point: the region knows it exactly. */
static void boundary_of_a_region_is_exact(void **state) {
    (void)state;
    test_points box = {.count = 8};
    for (int i = 0; i < 8; i++)
        box.at[i] = (pir_vec3){i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1};
    pir_polytope *p = test_polytope(&box);
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    pir_sum *sum;
    pir_query *query;
    pir_query_result result;
    pir_query_input input = pir_query_input_default();
    assert_int_equal(pir_sum_create(p, p, (pir_quat){0, 0, 0, 1}, &options, &sum), PIR_OK);
    assert_int_equal(pir_query_create(sum, &query), PIR_OK);
    assert_int_equal(pir_sum_set_region(sum, (pir_vec3){0, 0, 1}, 0.3), PIR_OK);
    static const struct {
        double z;
        pir_state state;
        pir_outcome outcome;
    } cases[] = {{2, PIR_BOUNDARY, PIR_NOT_SEPARATED},
                 {2 - 0x1p-52, PIR_INSIDE, PIR_NOT_SEPARATED},
                 {2 + 0x1p-51, PIR_OUTSIDE, PIR_SEPARATED},
                 {-7, PIR_INSIDE, PIR_NOT_SEPARATED}};
    for (int i = 0; i < 4; i++) {
        // far out sideways, where no facet of the region decides
        input.translation = (pir_vec3){9, 0, cases[i].z};
        assert_int_equal(pir_query_penetration(query, &input, NULL, &result), PIR_OK);
        assert_int_equal(result.state, cases[i].state);
        assert_int_equal(result.outcome, cases[i].outcome);
        if (i != 2)
            assert_true(fabs(result.distance - (cases[i].z - 2)) < 1e-12 && result.normal.z == 1);
    }
    // between its facets' normals a box has none
    assert_int_equal(pir_sum_set_region(sum, (pir_vec3){1, 1, 1}, 0.1), PIR_OK);
    assert_int_equal(pir_query_penetration(query, &input, NULL, &result), PIR_OK);
    assert_int_equal(result.outcome, PIR_NO_HIT);
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    pir_polytope_release(p);
}

/* The facets across a segment are none of D's, though its planes bound D: they do not stand before those that are. */
static void hidden_facets_of_a_segment_leave_the_others(void **state) {
    (void)state;
    struct scene s = {.escapes = malloc(MOST_FACETS * sizeof *s.escapes)};
    assert_non_null(s.escapes);
    for (uint64_t i = 0; i < 20; i++) {
        test_random random = test_random_case("hidden facets", i);
        test_pose pose = {.p.count = 2, .rotation = test_general_rotation(&random)};
        for (int k = 0; k < 2; k++)
            pose.p.at[k] = test_random_direction(&random);
        test_body_points(&random, i % 2 ? TEST_GRID : TEST_BOX, 12, &pose.q);
        if (i % 4 < 2) {
            const test_points swapped = pose.p;
            pose.p = pose.q;
            pose.q = swapped;
        }
        scene_init(&s, &pose);
        double size = reach_of(s.p) + reach_of(s.q);
        for (int n = 0; n < 20; n++) {
            pir_vec3 axis = test_random_direction(&random), t = pir_vec_scale(test_random_direction(&random), 0.2);
            double half_angle = 0.9 + 0.4 * (n % 2);
            assert_int_equal(pir_sum_set_region(s.region, axis, half_angle), PIR_OK);
            assert_int_equal(pir_sum_set_region(s.fresh, axis, half_angle), PIR_OK);
            ask_region(&s, t, axis, half_angle, NULL, size, "a segment");
        }
        scene_clear(&s);
    }
    free(s.escapes);
    expect(s.answered > 50, "%u depths", s.answered);
}

static void what_needs_the_whole_sum_says_so(void **state) {
    (void)state;
    test_random random = test_random_case("region refusals", 0);
    pir_polytope *p = test_sphere(&random, 20);
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    pir_sum *sum;
    pir_query *query;
    pir_query_result result;
    pir_impact cast;
    pir_contact contact;
    pir_state place;
    size_t count;
    double depth;
    pir_vec3 x = {1, 0, 0};
    pir_query_input input = pir_query_input_default();
    test_turning motion = {.rotation = {0, 0, 0, 1}, .motion = x, .axis = x, .angle = 1};
    assert_int_equal(pir_sum_create(p, p, (pir_quat){0, 0, 0, 1}, &options, &sum), PIR_OK);
    assert_int_equal(pir_query_create(sum, &query), PIR_OK);
    assert_int_equal(pir_sum_set_region(sum, x, 0.5), PIR_OK);
    for (const test_query_kind *kind = test_query_kinds; kind->name; kind++) {
        test_answer answer;
        const pir_status status = kind->ask(&(test_question){query, &input, NULL, x}, &answer);
        expect(status == (kind->traits & TEST_REGION ? PIR_OK : PIR_ERR_REGION), "%s: status %d", kind->name,
               (int)status);
    }
    assert_int_equal(test_impact(query, sum, &motion, 0.1, &cast), PIR_ERR_REGION);
    assert_int_equal(pir_query_batch_states(query, &x, 1, &place), PIR_ERR_REGION);
    assert_int_equal(pir_query_batch_depths(query, &x, 1, &depth, NULL), PIR_ERR_REGION);
    assert_int_equal(pir_query_batch_distances(query, &x, 1, &depth, NULL), PIR_ERR_REGION);
    assert_int_equal(pir_query_penetration(query, &input, NULL, &result), PIR_OK);
    assert_int_equal(pir_query_manifold(query, &input, &result, 1, &contact, &count), PIR_ERR_REGION);
    input.radius_p = 0.1;
    assert_int_equal(pir_query_penetration(query, &input, NULL, &result), PIR_ERR_REGION);
    // and does it again once the sum is whole
    assert_int_equal(pir_sum_set_region(sum, x, 4), PIR_OK);
    assert_int_equal(pir_query_signed_distance(query, &input, NULL, &result), PIR_OK);
    assert_int_equal(result.outcome, PIR_OVERLAPPING);
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depth_in_a_region_is_the_least_of_its_facets),
        cmocka_unit_test(boundary_of_a_region_is_exact),
        cmocka_unit_test(hidden_facets_of_a_segment_leave_the_others),
        cmocka_unit_test(what_needs_the_whole_sum_says_so),
    };
    return cmocka_run_group_tests_name("region queries", tests, NULL, NULL);
}
