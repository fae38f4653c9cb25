/* SPDX-License-Identifier: MIT */
/*
 * Checks that hold of every contact manifold, on random bodies, on bodies whose vertices were rotated in double, and
 * on flat bodies. Its corners are those of the region that the test computes itself, by clipping polygons.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "query/contact_scene.h"
#include "query/polygons.h"
#include "support/bodies.h"
#include "support/vectors.h"

static const pir_quat still = {0, 0, 0, 1};

/* Whether the two manifolds hold the same ids. */
static bool same_ids(const contact_scene *a, const contact_scene *b) {
    for (size_t i = 0; i < a->count; i++) {
        bool found = false;
        for (size_t k = 0; k < b->count; k++)
            found |= a->contact[i].id == b->contact[k].id;
        if (!found)
            return false;
    }
    return a->count == b->count;
}

/* Ids stay under small motions while the same features meet. */
static void check_ids(contact_scene *scene, test_random *random, uint64_t number, int *compared) {
    contact_scene after = *scene;
    after.t = test_add(scene->t, test_random_direction(random), 1e-10 * scene->size);
    contact_scene_ask(scene);
    contact_scene_ask(&after);
    if (memcmp(&scene->answer.witness, &after.answer.witness, sizeof scene->answer.witness) != 0)
        return;
    expect(same_ids(scene, &after), "case %llu: %zu contacts became %zu, or others", (unsigned long long)number,
           scene->count, after.count);
    ++*compared;
}

/* --- regions, by another way --- */

/*
 * Whether an edge of the body leads from a corner of facet f to another vertex within a sixth of a degree of the
 * facet's plane.
 */
static bool is_nearly_flat(const pir_polytope *body, uint32_t f) {
    uint32_t corner[SCENE_CONTACTS], n = pir_polytope_facet_size(body, f);
    pir_polytope_facet(body, f, corner);
    for (uint32_t e = 0; e < pir_polytope_edge_count(body); e++) {
        uint32_t end[2], on = 0;
        pir_polytope_edge(body, e, end);
        for (uint32_t i = 0; i < n; i++)
            on += (corner[i] == end[0]) + (corner[i] == end[1]);
        pir_vec3 d = test_add(pir_polytope_vertex(body, end[0]), pir_polytope_vertex(body, end[1]), -1);
        if (on == 1 && fabs(test_dot(d, pir_polytope_normal(body, f))) < 3e-3 * test_length(d))
            return true;
    }
    return false;
}

/*
 * The facet that is most along n, of those at vertex v, or of all with UINT32_MAX. False where the choice is not
 * clear: steep facets, or others that are nearly coplanar.
 */
static bool facet_most(const pir_polytope *body, uint32_t v, pir_vec3 n, uint32_t *ret_facet) {
    double most = 0.01;
    uint32_t best = UINT32_MAX;
    for (uint32_t f = 0; f < pir_polytope_facet_count(body); f++) {
        uint32_t corner[SCENE_CONTACTS];
        bool has = v == UINT32_MAX;
        pir_polytope_facet(body, f, corner);
        for (uint32_t i = 0; i < pir_polytope_facet_size(body, f); i++)
            has |= corner[i] == v;
        double along = test_dot(pir_polytope_normal(body, f), n);
        if (has && along > most) {
            most = along;
            best = f;
        }
    }
    if (best == UINT32_MAX || is_nearly_flat(body, best))
        return false;
    *ret_facet = best;
    return true;
}

static polygon project(const pir_polytope *body, uint32_t f, pir_quat r, pir_vec3 t, const pir_vec3 axis[2]) {
    polygon flat = {.count = pir_polytope_facet_size(body, f)};
    uint32_t corner[SCENE_CONTACTS];
    pir_polytope_facet(body, f, corner);
    for (size_t i = 0; i < flat.count; i++) {
        pir_vec3 x = test_add(t, test_turn(r, pir_polytope_vertex(body, corner[i]), 1), 1);
        flat.at[i] = (polygon_point){test_dot(axis[0], x), test_dot(axis[1], x)};
    }
    return polygon_turned_left(flat);
}

/* The corners of the last manifold, which must be all its contacts, seen along the normal. */
static polygon seen(const contact_scene *scene, const pir_vec3 axis[2]) {
    polygon flat = {.count = contact_scene_corners(scene)};
    const pir_contact *corner = &scene->contact[scene->count - flat.count];
    assert_true(flat.count <= POLYGON_CORNERS);
    for (size_t i = 0; i < flat.count; i++)
        flat.at[i] = (polygon_point){test_dot(axis[0], corner[i].point_q), test_dot(axis[1], corner[i].point_q)};
    return flat;
}

static void set_axes(pir_vec3 n, pir_vec3 axis[2]) {
    pir_vec3 c = test_cross(n, fabs(n.x) < 0.6 ? (pir_vec3){1, 0, 0} : (pir_vec3){0, 1, 0});
    axis[0] = test_add(test_zero, c, 1 / test_length(c));
    axis[1] = test_cross(n, axis[0]);
}

static void expect_region(const contact_scene *scene, const polygon *expected, const polygon *got, double error,
                          const char *what, unsigned long long number) {
    double area = polygon_area(expected), of_corners = polygon_area(got);
    expect(fabs(area - of_corners) <= error, "%s, case %llu: the corners of %zu contacts hold %.12g, not %.12g", what,
           number, scene->count, of_corners, area);
    for (size_t i = 0; i < got->count && expected->count > 2; i++)
        expect(polygon_beyond(expected, got->at[i]) <= error, "%s, case %llu: corner %zu is %.3g beyond the region",
               what, number, i, polygon_beyond(expected, got->at[i]));
}

/* Checks the overlap of two facets where a facet carries the answer. Returns whether it does. */
static bool check_facets(contact_scene *scene, uint64_t number) {
    pir_feature p = scene->answer.witness.p, q = scene->answer.witness.q;
    pir_vec3 n = scene->answer.normal, axis[2], away = test_turn(scene->r, test_add(test_zero, n, -1), -1);
    bool of_p = p.kind == PIR_FEATURE_FACET && q.kind == PIR_FEATURE_VERTEX;
    bool of_q = q.kind == PIR_FEATURE_FACET && p.kind == PIR_FEATURE_VERTEX;
    uint32_t f, g;
    if (!(of_p || of_q) || !facet_most(scene->p, of_p ? UINT32_MAX : p.index, away, &f) ||
        !facet_most(scene->q, of_q ? UINT32_MAX : q.index, n, &g))
        return false;
    set_axes(n, axis);
    scene->margin = HUGE_VAL;
    contact_scene_ask(scene);
    scene->margin = 0;
    polygon a = project(scene->p, f, scene->r, scene->t, axis), b = project(scene->q, g, still, test_zero, axis);
    polygon expected = polygon_overlap(&a, &b), got = seen(scene, axis);
    expect_region(scene, &expected, &got, 1e-10 * scene->size * scene->size, "facets", number);
    return true;
}

static void manifolds_of_bodies_at_random(void **state) {
    (void)state;
    int compared = 0, facets = 0;
    for (uint64_t number = 0; number < 300; number++) {
        test_random random = test_random_case("manifolds", number);
        pir_polytope *p = test_random_polytope(&random, number % 2 ? TEST_BOX : TEST_SPHERE, 4 + number % 30);
        pir_polytope *q = test_random_polytope(&random, number % 3 ? TEST_SPHERE : TEST_BOX, 4 + number % 17);
        contact_scene scene = contact_scene_make(p, q, test_general_rotation(&random));
        if (pir_polytope_facet_count(p) < 4 || pir_polytope_facet_count(q) < 4) {
            contact_scene_clear(&scene);
            continue;
        }
        pir_query_input input = pir_query_input_default();
        pir_query_result out;
        // from the middle outwards: deep, shallow, and next to each other
        static const double part[4] = {0.3, 0.9, 0.999, 1.0001};
        pir_vec3 low, high, d = test_random_direction(&random);
        pir_polytope_bounds(q, &low, &high);
        input.translation = (pir_vec3){(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2};
        assert_int_equal(pir_query_directional_depth(scene.query, &input, d, &out), PIR_OK);
        for (int i = 0; i < 4 && out.outcome == PIR_OVERLAPPING; i++) {
            scene.t = test_add(input.translation, d, -out.distance * part[i]);
            scene.margin = number % 5 ? 0 : 0.1;
            contact_scene_check(&scene, "at random", number);
            check_ids(&scene, &random, number, &compared);
            facets += check_facets(&scene, number);
        }
        contact_scene_clear(&scene);
    }
    print_message("# %d pairs of manifolds compared, %d regions of two facets\n", compared, facets);
    assert_true(compared > 500 && facets > 300);
}

/* --- bodies that were rotated in double --- */

/* A random convex polygon about the origin: regular, a rectangle, or corners on a circle. */
static polygon random_polygon(test_random *random) {
    polygon flat = {.count = 3 + test_random_below(random, 30)};
    uint32_t kind = test_random_below(random, 3);
    double x = 0.5 + 0.4 * test_random_unit(random), y = 0.5 + 0.4 * test_random_unit(random), pi = acos(-1.0);
    if (kind == 0)
        return (polygon){4, {{-x, -y}, {x, -y}, {x, y}, {-x, y}}};
    for (size_t i = 0; i < flat.count; i++) {
        double angle = 2 * pi * ((double)i + (kind == 1 ? 0 : 0.4 * test_random_unit(random))) / (double)flat.count;
        flat.at[i] = (polygon_point){x * cos(angle), y * sin(angle)};
    }
    return flat;
}

/*
 * A prism over a polygon, rotated in double. Its sides lean outwards by `lean` from the bottom to the top, and the
 * polygon is one of the two.
 */
static pir_polytope *prism(const polygon *base, double low, double high, double lean, pir_quat baked) {
    pir_vec3 at[2 * POLYGON_CORNERS];
    for (size_t i = 0; i < base->count; i++) {
        at[i] = (pir_vec3){base->at[i].u, base->at[i].v, low};
        at[base->count + i] = (pir_vec3){base->at[i].u * (1 + lean), base->at[i].v * (1 + lean), high};
    }
    return contact_scene_baked(at, 2 * base->count, baked);
}

static pir_quat product(pir_quat a, pir_quat b) {
    return (pir_quat){a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

static pir_quat turn_about(double x, double y, double z, double angle) {
    double s = sin(angle / 2) / sqrt(x * x + y * y + z * z);
    return (pir_quat){s * x, s * y, s * z, cos(angle / 2)};
}

/* The overlap of two polygons, one of them turned and moved. */
static polygon region_of(const polygon *a, double yaw, pir_vec3 t, const polygon *b) {
    polygon moved = *a;
    for (size_t i = 0; i < a->count; i++)
        moved.at[i] = (polygon_point){t.x + cos(yaw) * a->at[i].u - sin(yaw) * a->at[i].v,
                                      t.y + sin(yaw) * a->at[i].u + cos(yaw) * a->at[i].v};
    return polygon_overlap(&moved, b);
}

/*
 * A prism stands on a prism, each rotated in double before its hull. They are apart or overlap, level or tilted by
 * less than the angle of flatness. The contacts must be the overlap of the two polygons, though the bodies have no
 * such facets any more.
 */
static void prisms_rotated_in_double_stand_on_each_other(void **state) {
    (void)state;
    int split = 0, regions = 0;
    for (uint64_t number = 0; number < 400; number++) {
        test_random random = test_random_case("manifolds, prisms", number);
        polygon a = random_polygon(&random), b = random_polygon(&random);
        pir_quat of_p = test_general_rotation(&random), of_q = test_general_rotation(&random);
        double yaw = number % 7 ? 3 * test_random_unit(&random) : 0,
               tilt = number % 3 ? 0 : 3e-4 * test_random_unit(&random);
        pir_quat r =
            product(of_q, product(turn_about(test_random_unit(&random), test_random_unit(&random), 0, tilt),
                                  product(turn_about(0, 0, 1, yaw), (pir_quat){-of_p.x, -of_p.y, -of_p.z, of_p.w})));
        contact_scene scene = contact_scene_make(prism(&a, 0, 1, 0.3, of_p), prism(&b, 0, -1, 0.3, of_q), r);
        split += pir_polytope_facet_count(scene.p) > a.count + 2;
        double depth = number % 2 ? 0.01 : -0.01;
        pir_vec3 t = {0.3 * test_random_unit(&random), 0.3 * test_random_unit(&random), -depth}, axis[2];
        scene.t = test_turn(of_q, t, 1);
        scene.margin = 0.05;
        polygon expected = region_of(&a, yaw, t, &b);
        contact_scene_check(&scene, "prisms", number);
        // where the prisms' sides are nearer than their ends, the answer is another
        if (expected.count > 2 && fabs(fabs(scene.answer.distance) - 0.01) < 2e-3 && polygon_area(&expected) > 0.01) {
            axis[0] = test_turn(of_q, (pir_vec3){1, 0, 0}, 1), axis[1] = test_turn(of_q, (pir_vec3){0, 1, 0}, 1);
            polygon got = seen(&scene, axis);
            expect_region(&scene, &expected, &got, tilt == 0 ? 1e-11 : 1e-3, "prisms", number);
            regions++;
        }
        contact_scene_clear(&scene);
    }
    print_message("# %d of 400 prisms have facets that came apart; %d regions of prisms\n", split, regions);
    assert_true(split > 300 && regions > 200);
}

/* In any pose, deep or shallow, all checks hold of bodies whose facets are split. */
static void bodies_rotated_in_double_keep_their_answer(void **state) {
    (void)state;
    const char *text = getenv("PIR_TEST_POSES");
    uint64_t poses = text && *text ? strtoull(text, NULL, 10) : 1500;
    for (uint64_t number = 0; number < poses; number++) {
        test_random random = test_random_case("manifolds, rotated", number);
        polygon a = random_polygon(&random), b = random_polygon(&random);
        pir_quat of_p = test_general_rotation(&random), of_q = test_general_rotation(&random);
        double tilt = ldexp(test_random_unit(&random), -(int)(number % 50));
        pir_quat r = product(of_q, product(turn_about(test_random_unit(&random), test_random_unit(&random), 0.1, tilt),
                                           (pir_quat){-of_p.x, -of_p.y, -of_p.z, of_p.w}));
        contact_scene scene =
            contact_scene_make(prism(&a, 0, 1, number % 2 ? 0 : 0.3, of_p), prism(&b, 0, -1, 0, of_q), r);
        double gap = ldexp(test_random_unit(&random), -(int)(number / 3 % 50));
        scene.t = test_turn(of_q, (pir_vec3){0.7 * test_random_unit(&random), 0.7 * test_random_unit(&random), gap}, 1);
        scene.margin = number % 3 ? 0 : 0.02;
        contact_scene_check(&scene, "rotated", number);
        contact_scene_clear(&scene);
    }
}

/* --- known regions --- */

/*
 * A slab lies on a table, turned about the upright by any angle. There are as many contacts as the overlap of two
 * rectangles has corners.
 */
static void slabs_lie_flat(void **state) {
    (void)state;
    size_t most = 0;
    for (int i = 0; i < 200; i++) {
        test_random random = test_random_case("manifolds, flat", (uint64_t)i);
        double angle = i % 4 == 0 ? 0 : test_random_unit(&random), gap = i % 3 == 0 ? 0 : ldexp(1, -i % 40 - 4);
        contact_scene scene = contact_scene_make(contact_scene_box(1, 1, 0.25), contact_scene_box(1, 1, 0.5),
                                                 (pir_quat){0, 0, sin(angle / 2), cos(angle / 2)});
        scene.t = (pir_vec3){0.4 * test_random_unit(&random), 0.4 * test_random_unit(&random),
                             i % 2 ? 0.75 + gap : 0.75 - gap};
        contact_scene_check(&scene, "flat", (uint64_t)i);
        size_t corners = contact_scene_corners(&scene);
        // where features are parallel the answer is a corner
        expect(corners >= 4 && corners <= 8 && scene.count == corners, "%zu corners, %zu contacts", corners,
               scene.count);
        most = corners > most ? corners : most;
        for (size_t k = 0; k < scene.count; k++)
            assert_true(fabs(scene.contact[k].distance - (scene.t.z - 0.75)) < 1e-12);
        contact_scene_clear(&scene);
    }
    assert_true(most == 8);
}

/* Cubes edge to edge along parallel edges: the contacts are the ends of what the edges share. */
static void parallel_edges_share_a_segment(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("manifolds, edges", i);
        contact_scene scene =
            contact_scene_make(contact_scene_box(1, 1, 1), contact_scene_box(1, 1, 0.5 + 0.75 * (double)(i % 3)),
                               (pir_quat){0, 0, (double)(i % 2), 1});
        double along = 1.2 * test_random_unit(&random), apart = i % 5 ? ldexp(1, -(int)(i % 20)) : 0.5;
        scene.t = (pir_vec3){2 + apart, i % 4 < 2 ? 2 + apart : -2 - apart, along};
        contact_scene_check(&scene, "parallel edges", i);
        size_t corners = contact_scene_corners(&scene);
        expect(corners == 2 && scene.count == 2, "%zu corners, case %llu", corners, (unsigned long long)i);
        double h = 0.5 + 0.75 * (double)(i % 3), low = fmax(along - 1, -h), high = fmin(along + 1, h);
        double a = scene.contact[scene.count - 2].point_q.z, b = scene.contact[scene.count - 1].point_q.z;
        assert_true(fabs(fmin(a, b) - low) < 1e-12 && fabs(fmax(a, b) - high) < 1e-12);
        contact_scene_clear(&scene);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(manifolds_of_bodies_at_random), cmocka_unit_test(prisms_rotated_in_double_stand_on_each_other),
        cmocka_unit_test(bodies_rotated_in_double_keep_their_answer), cmocka_unit_test(slabs_lie_flat),
        cmocka_unit_test(parallel_edges_share_a_segment)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
