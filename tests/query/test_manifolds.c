/* SPDX-License-Identifier: MIT */
/*
 * What holds of every contact manifold: its points are of the bodies, on their surfaces, apart by the distance along the normal, none deeper
 * than the bodies are; it turns counter-clockwise, fits what the caller has room for or says that it does not, and names each point by what
 * meets there, the same as long as that does.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include <pirouette/query.h>

#include "query/query_of.h"
#include "support/bodies.h"

#define MOST 256

static pir_vec3 add(pir_vec3 a, pir_vec3 b, double s) {
    return (pir_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static double dot(pir_vec3 a, pir_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double length(pir_vec3 a) {
    return sqrt(dot(a, a));
}

static pir_vec3 cross(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* R v, or its inverse, by the quaternion alone. */
static pir_vec3 turn(pir_quat q, pir_vec3 v, double sign) {
    pir_vec3 u = {sign * q.x, sign * q.y, sign * q.z};
    double n = dot(u, u) + q.w * q.w;
    pir_vec3 c = add(cross(u, v), v, q.w);
    return add(v, cross(u, c), 2 / n);
}

/* How far x is beyond the facet that it is farthest beyond: 0 on the surface, negative inside. */
static double beyond(const pir_polytope *p, pir_vec3 x) {
    double most = -HUGE_VAL;
    for (uint32_t f = 0; f < pir_polytope_facet_count(p); f++) {
        uint32_t corners[MOST];
        pir_polytope_facet(p, f, corners);
        double s = dot(pir_polytope_normal(p, f), add(x, pir_polytope_vertex(p, corners[0]), -1));
        most = s > most ? s : most;
    }
    return most;
}

struct scene {
    pir_polytope *p, *q;
    pir_sum *sum;
    pir_query *query;
    pir_quat r;
    pir_vec3 t;
    double size;
};

static struct scene make(pir_polytope *p, pir_polytope *q, pir_quat r) {
    struct scene scene = {.p = p, .q = q, .r = r, .size = 1};
    test_query_make(p, q, r, &scene.sum, &scene.query);
    const pir_polytope *both[2] = {p, q};
    for (int k = 0; k < 2; k++)
        for (uint32_t v = 0; v < pir_polytope_vertex_count(both[k]); v++)
            scene.size = fmax(scene.size, length(pir_polytope_vertex(both[k], v)));
    return scene;
}

static void clear(struct scene *scene) {
    test_query_free(scene->query, scene->sum);
    pir_polytope_release(scene->p);
    pir_polytope_release(scene->q);
}

static size_t manifold(struct scene *scene, pir_query_result *answer, pir_contact contacts[MOST]) {
    pir_query_input input = pir_query_input_default();
    input.translation = scene->t;
    size_t count = 0;
    assert_int_equal(pir_query_signed_distance(scene->query, &input, NULL, answer), PIR_OK);
    assert_int_equal(pir_query_manifold(scene->query, &input, answer, MOST, contacts, &count), PIR_OK);
    assert_true(count >= 1 && count <= MOST);
    return count;
}

static void check(struct scene *scene, const char *what, uint64_t number) {
    pir_query_result answer;
    pir_contact contacts[MOST], fewer[MOST];
    size_t count = manifold(scene, &answer, contacts);
    double hair = 1e-11 * (scene->size + length(scene->t));
    pir_vec3 turning = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        const pir_contact *c = &contacts[i];
        pir_vec3 miss = add(c->point_p, add(c->point_q, answer.normal, c->distance), -1);
        expect(length(miss) <= hair + 2e-6 * fabs(c->distance), "%s, case %llu: points %.3g off the normal", what,
               (unsigned long long)number, length(miss));
        // each point is of its body's surface
        double of_q = beyond(scene->q, c->point_q);
        double of_p = beyond(scene->p, turn(scene->r, add(c->point_p, scene->t, -1), -1));
        expect(fabs(of_q) <= hair && fabs(of_p) <= hair, "%s, case %llu: contact %zu is %.3g off P, %.3g off Q", what,
               (unsigned long long)number, i, of_p, of_q);
        expect(c->distance >= answer.distance - hair, "%s, case %llu: %.17g deeper than %.17g", what,
               (unsigned long long)number, c->distance, answer.distance);
        for (size_t k = 0; k < i; k++)
            expect(contacts[k].id != c->id, "%s, case %llu: contacts %zu and %zu of %zu are both %llx", what,
                   (unsigned long long)number, k, i, count, (unsigned long long)c->id);
        const pir_contact *next = &contacts[(i + 1) % count];
        turning = add(turning, cross(add(c->point_q, contacts[0].point_q, -1), add(next->point_q, c->point_q, -1)), 1);
    }
    expect(dot(turning, answer.normal) >= -hair * scene->size, "%s, case %llu: clockwise", what,
           (unsigned long long)number);
    // less room
    pir_query_input input = pir_query_input_default();
    input.translation = scene->t;
    for (size_t room = 0; room < count; room += 1 + count / 3) {
        size_t told = 0;
        assert_int_equal(pir_query_manifold(scene->query, &input, &answer, room, fewer, &told), PIR_ERR_LIMIT);
        assert_true(told == count);
        for (size_t i = 0; i < room; i++)
            assert_true(fewer[i].id == contacts[i].id && fewer[i].distance == contacts[i].distance);
    }
}

/* Whether the two manifolds hold the same ids. */
static bool same_ids(const pir_contact *a, const pir_contact *b, size_t count) {
    for (size_t i = 0; i < count; i++) {
        bool found = false;
        for (size_t k = 0; k < count; k++)
            found |= a[i].id == b[k].id;
        if (!found)
            return false;
    }
    return true;
}

/* A hair along keeps the ids while the same features meet. */
static void check_ids(struct scene *scene, test_random *random, uint64_t number, int *compared) {
    pir_query_result before, after;
    pir_contact old[MOST], now[MOST];
    size_t count = manifold(scene, &before, old);
    pir_vec3 t = scene->t;
    scene->t = add(t, test_random_direction(random), 1e-10 * scene->size);
    size_t next = manifold(scene, &after, now);
    scene->t = t;
    if (memcmp(&before.witness, &after.witness, sizeof before.witness) != 0)
        return;
    expect(next == count && same_ids(old, now, count), "case %llu: %zu contacts became %zu, or others",
           (unsigned long long)number, count, next);
    ++*compared;
}

static void manifolds_of_bodies_at_random(void **state) {
    (void)state;
    int compared = 0;
    for (uint64_t number = 0; number < 300; number++) {
        test_random random = test_random_case("manifolds", number);
        pir_polytope *p = test_random_polytope(&random, number % 2 ? TEST_BOX : TEST_SPHERE, 4 + number % 30);
        pir_polytope *q = test_random_polytope(&random, number % 3 ? TEST_SPHERE : TEST_BOX, 4 + number % 17);
        struct scene scene = make(p, q, test_general_rotation(&random));
        if (pir_polytope_facet_count(p) < 4 || pir_polytope_facet_count(q) < 4) {
            clear(&scene);
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
            scene.t = add(input.translation, d, -out.distance * part[i]);
            check(&scene, "at random", number);
            check_ids(&scene, &random, number, &compared);
        }
        clear(&scene);
    }
    assert_true(compared > 500);
}

static pir_polytope *box(double x, double y, double z) {
    pir_vec3 points[8];
    pir_polytope *p;
    for (int i = 0; i < 8; i++)
        points[i] = (pir_vec3){i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z};
    assert_int_equal(pir_polytope_create(points, 8, NULL, &p), PIR_OK);
    return p;
}

/* A slab that lies on a table, turned about the upright by any angle: as many contacts as the overlap of two rectangles has corners. */
static void slabs_lie_flat(void **state) {
    (void)state;
    size_t most = 0;
    for (int i = 0; i < 200; i++) {
        test_random random = test_random_case("manifolds, flat", (uint64_t)i);
        double angle = i % 4 == 0 ? 0 : test_random_unit(&random), gap = i % 3 == 0 ? 0 : ldexp(1, -i % 40 - 4);
        struct scene scene = make(box(1, 1, 0.25), box(1, 1, 0.5), (pir_quat){0, 0, sin(angle / 2), cos(angle / 2)});
        scene.t = (pir_vec3){0.4 * test_random_unit(&random), 0.4 * test_random_unit(&random),
                             i % 2 ? 0.75 + gap : 0.75 - gap};
        check(&scene, "flat", (uint64_t)i);
        pir_query_result answer;
        pir_contact contacts[MOST];
        size_t count = manifold(&scene, &answer, contacts);
        expect(count >= 4 && count <= 8, "%zu contacts", count);
        most = count > most ? count : most;
        for (size_t k = 0; k < count; k++)
            assert_true(fabs(contacts[k].distance - (scene.t.z - 0.75)) < 1e-12);
        clear(&scene);
    }
    assert_true(most == 8);
}

/* Cubes edge to edge along parallel edges: the ends of what the edges share. */
static void parallel_edges_share_a_segment(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("manifolds, edges", i);
        struct scene scene = make(box(1, 1, 1), box(1, 1, 0.5 + 0.75 * (i % 3)), (pir_quat){0, 0, i % 2, 1});
        double along = 1.2 * test_random_unit(&random), apart = i % 5 ? ldexp(1, -(int)(i % 20)) : 0.5;
        scene.t = (pir_vec3){2 + apart, i % 4 < 2 ? 2 + apart : -2 - apart, along};
        check(&scene, "parallel edges", i);
        pir_query_result answer;
        pir_contact contacts[MOST];
        size_t count = manifold(&scene, &answer, contacts);
        expect(count == 2, "%zu contacts, case %llu", count, (unsigned long long)i);
        double h = 0.5 + 0.75 * (double)(i % 3), low = fmax(along - 1, -h), high = fmin(along + 1, h);
        double a = contacts[0].point_q.z, b = contacts[1].point_q.z;
        assert_true(fabs(fmin(a, b) - low) < 1e-12 && fabs(fmax(a, b) - high) < 1e-12);
        clear(&scene);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(manifolds_of_bodies_at_random),
                                       cmocka_unit_test(slabs_lie_flat),
                                       cmocka_unit_test(parallel_edges_share_a_segment)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
