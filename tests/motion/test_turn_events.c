/* SPDX-License-Identifier: MIT */
/*
 * The events of a turn held against brute force in integers of any length: their number and order, κ, the quadratic,
 * the facets that end and begin, and how many there are. Bodies are small and of all kinds with facets, flat ones among
 * them; axes and poses are aligned in more than half of the cases, so that ties last and changes come together.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>

#include "brute_turn.h"
#include "support/bodies.h"

struct scene {
    pir_polytope *p, *q;
    pir_quat start;
    pir_vec3 axis;
    bool difference;
    pir_events *events;
};

/* --- cases --- */

static pir_polytope *random_body(test_random *random) {
    static const test_body kinds[] = {TEST_BOX,   TEST_OCTAHEDRON, TEST_GRID,    TEST_GRID,
                                      TEST_PRISM, TEST_SPHERE,     TEST_POLYGON, TEST_BOX};
    for (;;) {
        const test_body kind = kinds[test_random_below(random, sizeof kinds / sizeof *kinds)];
        pir_polytope *body = test_random_polytope(random, kind, 4 + test_random_below(random, 4));
        if (pir_polytope_dimension(body) >= 2 && pir_polytope_facet_count(body) <= 12)
            return body;
        pir_polytope_release(body);
    }
}

static pir_vec3 random_axis(test_random *random) {
    static const pir_vec3 aligned[] = {{0, 0, 1}, {1, 0, 0}, {0, -2, 0}, {1, 1, 1}, {1, -1, 0}, {0.75, 0, 1}};
    const uint32_t i = test_random_below(random, 9);
    if (i < sizeof aligned / sizeof *aligned)
        return aligned[i];
    return (pir_vec3){test_random_between(random, -4, 4) + 0.5, test_random_between(random, -4, 4), 1};
}

static pir_quat random_start(test_random *random) {
    switch (test_random_below(random, 4)) {
    case 0:
        return (pir_quat){0, 0, 0, 1};
    case 1:
        return test_integer_rotation(random);
    case 2:
        return (pir_quat){0, 0, 1, 1};
    default:
        return (pir_quat){test_random_between(random, -8, 8), test_random_between(random, -8, 8), 3, 0.5};
    }
}

static void make_case(uint64_t number, struct scene *scene) {
    test_random random = test_random_case("turn events", number);
    *scene = (struct scene){.p = random_body(&random), .q = random_body(&random)};
    if (test_random_below(&random, 5) == 0) {
        pir_polytope_release(scene->q);
        scene->q = pir_polytope_retain(scene->p);
    }
    scene->start = random_start(&random);
    scene->axis = random_axis(&random);
    scene->difference = test_random_below(&random, 3) == 0;
    pir_events_options options = pir_events_options_default();
    options.difference = scene->difference;
    assert_int_equal(pir_events_create(scene->p, scene->q, scene->start, scene->axis, &options, &scene->events),
                     PIR_OK);
}

static void clear_case(struct scene *scene) {
    pir_events_destroy(scene->events);
    pir_polytope_release(scene->p);
    pir_polytope_release(scene->q);
}

/* --- one event --- */

static uint64_t bits_of(const pir_polytope *p, pir_feature face) {
    uint32_t corner[BRUTE_VERTICES] = {face.index}, count = 1;
    uint64_t bits = 0;
    if (face.kind == PIR_FEATURE_EDGE) {
        pir_polytope_edge(p, face.index, corner);
        count = 2;
    } else if (face.kind == PIR_FEATURE_FACET) {
        pir_polytope_facet(p, face.index, corner);
        count = pir_polytope_facet_size(p, face.index);
        bits = pir_polytope_facet_count(p) == 2 ? (uint64_t)1 << (62 + face.index) : 0;
    }
    for (uint32_t i = 0; i < count; i++)
        bits |= (uint64_t)1 << corner[i];
    return bits;
}

static bool has(const brute_facets *facets, brute_facet facet) {
    for (size_t i = 0; i < facets->count; i++)
        if (facets->at[i].p == facet.p && facets->at[i].q == facet.q)
            return true;
    return false;
}

/* The faces are in `in`, and not in `out`; returns how many. */
static size_t check_faces(const struct scene *scene, const pir_witness *faces, uint32_t count, const brute_facets *in,
                          const brute_facets *out) {
    for (uint32_t i = 0; i < count; i++) {
        const brute_facet facet = {bits_of(scene->p, faces[i].p), bits_of(scene->q, faces[i].q)};
        assert_true(has(in, facet) && !has(out, facet));
        for (uint32_t k = 0; k < i; k++)
            assert_true(faces[k].p.kind != faces[i].p.kind || faces[k].p.index != faces[i].p.index ||
                        faces[k].q.kind != faces[i].q.kind || faces[k].q.index != faces[i].q.index);
    }
    return count;
}

static size_t count_of(const brute_facets *in, const brute_facets *out) {
    size_t count = 0;
    for (size_t i = 0; i < in->count; i++)
        count += !has(out, in->at[i]);
    return count;
}

/* The sign of the quadratic at a double. */
static int sign_at(mpz_t c[3], double kappa) {
    mpq_t x, s, t;
    mpq_inits(x, s, t, NULL);
    mpq_set_d(x, kappa);
    mpq_set_z(s, c[0]);
    for (int i = 1; i < 3; i++) {
        mpq_mul(s, s, x);
        mpq_set_z(t, c[i]);
        mpq_add(s, s, t);
    }
    const int sign = mpq_sgn(s);
    mpq_clears(x, s, t, NULL);
    return sign;
}

/* κ between the doubles told is that of brute force, and a root of the quadratic lies there. */
static void check_kappa(const struct scene *scene, const brute_event *truth) {
    double kappa[2], angle[2];
    mpz_t c[3], low;
    mpq_t at, told;
    mpz_inits(c[0], c[1], c[2], low, NULL);
    mpq_inits(at, told, NULL);
    pir_events_kappa(scene->events, kappa);
    pir_events_angle(scene->events, angle);
    assert_true(kappa[0] <= kappa[1] && nextafter(kappa[0], INFINITY) >= kappa[1]);
    mpz_set(mpq_numref(at), truth->low);
    mpz_mul_2exp(mpq_denref(at), mpq_denref(at), BRUTE_BITS);
    mpq_canonicalize(at);
    for (int k = 0; k < 2; k++) {
        // truth is off by a unit of its root and one of its quotient
        mpq_set_d(told, kappa[k]);
        mpq_sub(told, told, at);
        mpq_mul_2exp(told, told, BRUTE_BITS);
        assert_true(k == 0 ? mpq_cmp_ui(told, 4, 1) < 0 : mpq_cmp_si(told, -4, 1) > 0);
    }
    assert_int_equal(pir_events_polynomial_exact(scene->events, c), PIR_OK);
    const int ends[2] = {sign_at(c, kappa[0]), sign_at(c, kappa[1])};
    mpz_mul(low, c[1], c[1]);
    mpz_mul(c[1], c[0], c[2]);
    mpz_submul_ui(low, c[1], 4);
    // a root with a change of sign, or a double one
    assert_true(kappa[0] == kappa[1] ? ends[0] == 0 : ends[0] * ends[1] < 0 || mpz_sgn(low) == 0);
    const pir_vec3 u = scene->axis;
    const double length = sqrt(u.x * u.x + u.y * u.y + u.z * u.z), middle = kappa[0] / 2 + kappa[1] / 2;
    const double degrees = 2 * atan2(length, middle) * (180 / 3.14159265358979323846);
    assert_true(angle[0] < angle[1] && angle[1] - angle[0] < 2e-12);
    assert_true(angle[0] >= 0 && angle[1] <= 360 && fabs(angle[0] - degrees) < 2e-12);
    mpq_clears(at, told, NULL);
    mpz_clears(c[0], c[1], c[2], low, NULL);
}

/* --- tests --- */

static void events_are_those_of_brute_force(void **state) {
    (void)state;
    const char *told = getenv("PIR_TEST_CASES");
    const uint64_t cases = told ? strtoull(told, NULL, 10) : 60;
    size_t all = 0, together = 0;
    for (uint64_t i = 0; i < cases; i++) {
        struct scene scene;
        brute_turn truth;
        pir_event event;
        bool found;
        make_case(i, &scene);
        brute_turn_make(scene.p, scene.q, scene.start, scene.axis, scene.difference, &truth);
        // the count may be asked for first, or at some event
        if (i % 2 == 0 && truth.count > 0)
            assert_int_equal(pir_events_facet_count(scene.events), truth.event[0].before.count);
        for (size_t k = 0; k < truth.count; k++) {
            const brute_event *real = &truth.event[k];
            assert_int_equal(pir_events_next(scene.events, &event, &found), PIR_OK);
            expect(found, "case %d: %zu events, not %zu", (int)i, k, truth.count);
            check_kappa(&scene, real);
            const size_t lost = check_faces(&scene, event.lost, event.lost_count, &real->before, &real->after);
            const size_t gained = check_faces(&scene, event.gained, event.gained_count, &real->after, &real->before);
            expect(lost == count_of(&real->before, &real->after) && gained == count_of(&real->after, &real->before),
                   "case %d, event %zu: %zu lost, %zu gained", (int)i, k, lost, gained);
            if (i % 2 == 0 || k >= 2)
                assert_int_equal(pir_events_facet_count(scene.events), real->after.count);
            together += lost > 6;
        }
        all += truth.count;
        assert_int_equal(pir_events_next(scene.events, &event, &found), PIR_OK);
        expect(!found, "case %d: more than %zu events", (int)i, truth.count);
        brute_turn_clear(&truth);
        clear_case(&scene);
    }
    printf("# %zu events, %zu of several facets\n", all, together);
    assert_true(all > 5 * cases && together > cases / 10);
}

/* Facets and κ of the events from here to the end. */
static uint32_t hash_rest(pir_events *events, uint32_t *ret_hash) {
    uint32_t count = 0, hash = 1;
    for (;; count++) {
        pir_event event;
        double kappa[2];
        bool found;
        assert_int_equal(pir_events_next(events, &event, &found), PIR_OK);
        if (!found)
            break;
        pir_events_kappa(events, kappa);
        hash = hash * 31 + (uint32_t)(int32_t)(kappa[0] * 1000) + pir_events_facet_count(events);
        for (uint32_t i = 0; i < event.lost_count; i++)
            hash = hash * 31 + event.lost[i].p.index + 7 * event.lost[i].q.index;
    }
    *ret_hash = hash;
    return count;
}

/* From any κ on, events are those that follow it from the beginning. */
static void seeking_is_going_on(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 60; i++) {
        struct scene scene;
        make_case(1000 + i, &scene);
        pir_event event;
        bool found;
        double between;
        const uint32_t skipped = (uint32_t)(i % 7);
        for (uint32_t k = 0; k < skipped; k++)
            assert_int_equal(pir_events_next(scene.events, &event, &found), PIR_OK);
        assert_int_equal(pir_events_between(scene.events, &between), PIR_OK);
        uint32_t straight, sought;
        const uint32_t rest = hash_rest(scene.events, &straight);
        assert_int_equal(pir_events_seek(scene.events, between), PIR_OK);
        expect(hash_rest(scene.events, &sought) == rest, "case %d from %g", (int)i, between);
        assert_int_equal(straight, sought);
        clear_case(&scene);
    }
}

/* A double that is an event's κ: what follows is behind it. */
static void seeking_an_event_leaves_it_behind(void **state) {
    (void)state;
    pir_polytope *cube = test_box(1, 1, 1);
    pir_events *events;
    pir_event event;
    bool found;
    double kappa[2];
    assert_int_equal(pir_events_create(cube, cube, (pir_quat){0, 0, 0, 1}, (pir_vec3){0, 0, 1}, NULL, &events), PIR_OK);
    // a box that turns on a table: its sides are parallel to the other one's at three angles in between
    const double expected[3] = {1, 0, -1};
    for (int k = 0; k < 3; k++) {
        assert_int_equal(pir_events_next(events, &event, &found), PIR_OK);
        assert_true(found);
        assert_int_equal(event.lost_count, 8);
        assert_int_equal(event.gained_count, 8);
        pir_events_kappa(events, kappa);
        assert_true(kappa[0] == expected[k] && kappa[1] == expected[k]);
        assert_int_equal(pir_events_facet_count(events), 10);
        // behind 0 the least double below it is not rounded to 0
        double between;
        assert_int_equal(pir_events_between(events, &between), PIR_OK);
        assert_true(between < expected[k] && (k == 2 || between > expected[k + 1]));
    }
    assert_int_equal(pir_events_next(events, &event, &found), PIR_OK);
    assert_false(found);
    assert_int_equal(pir_events_seek(events, 1), PIR_OK);
    assert_int_equal(pir_events_next(events, &event, &found), PIR_OK);
    pir_events_kappa(events, kappa);
    assert_true(found && kappa[0] == 0);
    assert_int_equal(pir_events_seek(events, INFINITY), PIR_OK);
    pir_events_kappa(events, kappa);
    assert_true(kappa[0] == INFINITY && kappa[1] == INFINITY);
    assert_int_equal(pir_events_next(events, &event, &found), PIR_OK);
    pir_events_kappa(events, kappa);
    assert_true(found && kappa[0] == 1);
    pir_events_destroy(events);
    pir_polytope_release(cube);
}

static void bad_input_is_refused(void **state) {
    (void)state;
    pir_polytope *cube = test_box(1, 1, 1), *segment = test_hull((const pir_vec3[2]){{0, 0, 0}, {1, 0, 0}}, 2);
    const pir_quat one = {0, 0, 0, 1};
    const pir_vec3 z = {0, 0, 1};
    pir_events *const before = (pir_events *)&before, *events = before;
    assert_int_equal(pir_events_create(NULL, cube, one, z, NULL, &events), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_events_create(cube, NULL, one, z, NULL, &events), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_events_create(cube, cube, one, z, NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_events_create(segment, cube, one, z, NULL, &events), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_events_create(cube, cube, one, (pir_vec3){0, 0, 0}, NULL, &events), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_events_create(cube, cube, one, (pir_vec3){0, NAN, 0}, NULL, &events), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_events_create(cube, cube, (pir_quat){0, 0, 0, 0}, z, NULL, &events), PIR_ERR_ZERO_QUATERNION);
    assert_int_equal(pir_events_create(cube, cube, (pir_quat){0, 0, 0, INFINITY}, z, NULL, &events),
                     PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_sum_events(NULL, z, NULL, &events), PIR_ERR_ARGUMENT);
    assert_ptr_equal(events, before);
    assert_int_equal(pir_events_create(cube, cube, one, z, NULL, &events), PIR_OK);
    mpz_t c[3];
    mpz_inits(c[0], c[1], c[2], NULL);
    pir_event event;
    bool found;
    double kappa;
    assert_int_equal(pir_events_polynomial_exact(events, c), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_events_next(NULL, &event, &found), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_events_next(events, NULL, &found), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_events_next(events, &event, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_events_seek(NULL, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_events_seek(events, NAN), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_events_seek(events, -INFINITY), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_events_between(NULL, &kappa), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_events_between(events, NULL), PIR_ERR_ARGUMENT);
    mpz_clears(c[0], c[1], c[2], NULL);
    pir_events_destroy(events);
    pir_events_destroy(NULL);
    pir_polytope_release(segment);
    pir_polytope_release(cube);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(events_are_those_of_brute_force),
        cmocka_unit_test(seeking_is_going_on),
        cmocka_unit_test(seeking_an_event_leaves_it_behind),
        cmocka_unit_test(bad_input_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
