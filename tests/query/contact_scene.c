/* SPDX-License-Identifier: MIT */
/* See contact_scene.h. */
#include "query/contact_scene.h"

#include "support/test.h"

#include <math.h>
#include <string.h>

#include "query/query_of.h"
#include "support/vectors.h"

contact_scene contact_scene_make(pir_polytope *p, pir_polytope *q, pir_quat r) {
    contact_scene scene = {.p = p, .q = q, .r = r, .size = 1};
    test_query_make(p, q, r, &scene.sum, &scene.query);
    const pir_polytope *both[2] = {p, q};
    for (int k = 0; k < 2; k++)
        for (uint32_t v = 0; v < pir_polytope_vertex_count(both[k]); v++)
            scene.size = fmax(scene.size, test_length(pir_polytope_vertex(both[k], v)));
    return scene;
}

void contact_scene_clear(contact_scene *scene) {
    test_query_free(scene->query, scene->sum);
    pir_polytope_release(scene->p);
    pir_polytope_release(scene->q);
}

static pir_query_input input_of(const contact_scene *scene) {
    pir_query_input input = pir_query_input_default();
    input.translation = scene->t;
    input.margin = scene->margin;
    return input;
}

void contact_scene_ask(contact_scene *scene) {
    pir_query_input input = input_of(scene);
    assert_int_equal(pir_query_signed_distance(scene->query, &input, NULL, &scene->answer), PIR_OK);
    assert_int_equal(
        pir_query_manifold(scene->query, &input, &scene->answer, SCENE_CONTACTS, scene->contact, &scene->count),
        PIR_OK);
    assert_true(scene->count >= 1 && scene->count <= SCENE_CONTACTS);
}

size_t contact_scene_corners(const contact_scene *scene) {
    return scene->count - (scene->contact[0].id >> 62 == 3);
}

pir_polytope *contact_scene_baked(const pir_vec3 *points, size_t count, pir_quat turned) {
    pir_vec3 at[SCENE_CONTACTS];
    pir_polytope *result;
    assert_true(count <= SCENE_CONTACTS);
    for (size_t i = 0; i < count; i++)
        at[i] = test_turn(turned, points[i], 1);
    assert_int_equal(pir_polytope_create(at, count, NULL, &result), PIR_OK);
    return result;
}

pir_polytope *contact_scene_box(double x, double y, double z) {
    pir_vec3 points[8];
    for (int i = 0; i < 8; i++)
        points[i] = (pir_vec3){i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z};
    return contact_scene_baked(points, 8, (pir_quat){0, 0, 0, 1});
}

/* --- surfaces --- */

static double off_segment(pir_vec3 a, pir_vec3 b, pir_vec3 x) {
    pir_vec3 d = test_add(b, a, -1);
    double along = test_dot(d, d) > 0 ? test_dot(test_add(x, a, -1), d) / test_dot(d, d) : 0;
    return test_length(test_add(x, test_add(a, d, fmin(1, fmax(0, along))), -1));
}

/* The distance of x beyond the sides of a facet, in the facet's plane. */
static double beside(const pir_polytope *p, uint32_t f, pir_vec3 x) {
    uint32_t corner[SCENE_CONTACTS], n = pir_polytope_facet_size(p, f);
    pir_polytope_facet(p, f, corner);
    double most = -HUGE_VAL;
    for (uint32_t i = 0; i < n; i++) {
        pir_vec3 a = pir_polytope_vertex(p, corner[i]), b = pir_polytope_vertex(p, corner[(i + 1) % n]);
        pir_vec3 out = test_cross(test_add(b, a, -1), pir_polytope_normal(p, f));
        most = fmax(most, test_dot(out, test_add(x, a, -1)) / test_length(out));
    }
    return most;
}

double contact_scene_off(const pir_polytope *body, pir_vec3 x) {
    int dimension = pir_polytope_dimension(body);
    if (dimension < 2)
        return off_segment(pir_polytope_vertex(body, 0), pir_polytope_vertex(body, (uint32_t)dimension), x);
    double most = -HUGE_VAL;
    for (uint32_t f = 0; f < pir_polytope_facet_count(body); f++) {
        uint32_t corner[SCENE_CONTACTS];
        assert_true(pir_polytope_facet_size(body, f) <= SCENE_CONTACTS);
        pir_polytope_facet(body, f, corner);
        most =
            fmax(most, test_dot(pir_polytope_normal(body, f), test_add(x, pir_polytope_vertex(body, corner[0]), -1)));
    }
    return dimension == 2 ? fmax(fabs(most), beside(body, 0, x)) : fabs(most);
}

/* --- checks --- */

static bool same(const pir_contact *a, const pir_contact *b) {
    return a->id == b->id && a->distance == b->distance && memcmp(&a->point_p, &b->point_p, sizeof a->point_p) == 0 &&
           memcmp(&a->point_q, &b->point_q, sizeof a->point_q) == 0;
}

static void check_points(const contact_scene *scene, const char *what, unsigned long long number) {
    const pir_query_result *answer = &scene->answer;
    const pir_contact *first = &scene->contact[0];
    double error = 1e-11 * (scene->size + test_length(scene->t));
    for (size_t i = 0; i < scene->count; i++) {
        const pir_contact *c = &scene->contact[i];
        pir_vec3 miss = test_add(c->point_p, test_add(c->point_q, answer->normal, c->distance), -1);
        double way = test_length(test_add(c->point_q, first->point_q, -1)), flush = 0x1p-20 * way + error;
        expect(test_length(miss) <= 0.1 * error, "%s, case %llu: points %.3g off the normal", what, number,
               test_length(miss));
        double of_q = contact_scene_off(scene->q, c->point_q);
        double of_p = contact_scene_off(scene->p, test_turn(scene->r, test_add(c->point_p, scene->t, -1), -1));
        expect(of_q <= error && of_p <= error, "%s, case %llu: contact %zu of %zu is %.3g off P, %.3g off Q", what,
               number, i, scene->count, of_p, of_q);
        expect(c->distance >= answer->distance - error, "%s, case %llu: %.17g deeper than %.17g", what, number,
               c->distance, answer->distance);
        expect(c->distance <= fmax(0, fmax(scene->margin, answer->distance)) + flush,
               "%s, case %llu: contact %zu at %.3g", what, number, i, c->distance);
        for (size_t k = 0; k < i; k++)
            expect(scene->contact[k].id != c->id, "%s, case %llu: contacts %zu and %zu are both %llx", what, number, k,
                   i, (unsigned long long)c->id);
    }
}

static void check_turning(const contact_scene *scene, const char *what, unsigned long long number) {
    // of the corners, no three in a row turn back
    const pir_contact *corner = &scene->contact[scene->contact[0].id >> 62 == 3];
    size_t n = contact_scene_corners(scene);
    double error = 1e-11 * (scene->size + test_length(scene->t)) * scene->size;
    for (size_t i = 0; i < n && n > 2; i++) {
        pir_vec3 a = corner[i].point_q, b = corner[(i + 1) % n].point_q, c = corner[(i + 2) % n].point_q;
        double turn = test_dot(test_cross(test_add(b, a, -1), test_add(c, b, -1)), scene->answer.normal);
        expect(turn >= -error, "%s, case %llu: clockwise at corner %zu of %zu", what, number, i, n);
    }
}

static void check_room(const contact_scene *scene) {
    pir_query_input input = input_of(scene);
    pir_contact fewer[SCENE_CONTACTS];
    for (size_t room = 0; room < scene->count; room += 1 + scene->count / 3) {
        size_t told = 0;
        assert_int_equal(pir_query_manifold(scene->query, &input, &scene->answer, room, fewer, &told), PIR_OK);
        assert_true(told == scene->count);
        for (size_t i = 0; i < room; i++)
            assert_true(same(&fewer[i], &scene->contact[i]));
    }
}

/*
 * Every contact is found again, in the same order, with twice the margin and with any margin, and those within the
 * margin are all there.
 */
static void check_margin(const contact_scene *scene, const char *what, unsigned long long number) {
    pir_query_input input = input_of(scene);
    pir_contact more[SCENE_CONTACTS];
    const double margins[2] = {2 * scene->margin + 0.01, HUGE_VAL};
    for (int k = 0; k < 2; k++) {
        size_t count = 0, found = 0, within = 0;
        input.margin = margins[k];
        assert_int_equal(pir_query_manifold(scene->query, &input, &scene->answer, SCENE_CONTACTS, more, &count),
                         PIR_OK);
        for (size_t i = 0; i < count && found < scene->count; i++)
            found += same(&more[i], &scene->contact[found]);
        expect(found == scene->count, "%s, case %llu: margin %g loses contacts", what, number, margins[k]);
        for (size_t i = 0; i < count; i++)
            within += more[i].distance <= fmax(0, fmax(scene->margin, scene->answer.distance));
        expect(within <= scene->count, "%s, case %llu: %zu of %zu contacts within margin %g", what, number,
               scene->count, within, scene->margin);
    }
}

void contact_scene_check(contact_scene *scene, const char *what, uint64_t number) {
    contact_scene_ask(scene);
    const pir_contact *first = &scene->contact[0];
    const pir_query_result *answer = &scene->answer;
    assert_true(first->distance == answer->distance &&
                memcmp(&first->point_p, &answer->point_p, sizeof first->point_p) == 0 &&
                memcmp(&first->point_q, &answer->point_q, sizeof first->point_q) == 0);
    check_points(scene, what, number);
    check_turning(scene, what, number);
    check_room(scene);
    check_margin(scene, what, number);
}
