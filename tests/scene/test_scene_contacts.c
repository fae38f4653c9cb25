/* SPDX-License-Identifier: MIT */
/*
 * First contacts in scenes against a loop over all pairs of pieces, each asked by a pair made for it. Which of two
 * contacts comes first is told by their polynomials in 1000 bits. Half of the scenes are on a grid, where many contacts
 * come at once; a third has a floor of triangles.
 *
 * PIR_TEST_SCENES sets how many scenes there are, each with MOTIONS motions.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/exact.h>
#include <pirouette/scene_query.h>
#include <pirouette/trimesh.h>

#include "scene/scene_bodies.h"
#include "support/bodies.h"
#include "support/memory.h"

enum { BODIES = 14, PIECES = 3, MOTIONS = 6, BITS = 1000, TRIANGLES = 8 };

typedef struct thing {
    pir_body_options options;
    pir_polytope *piece[TRIANGLES]; /* of the floor its triangles */
    uint32_t pieces, id;
} thing;

typedef struct crowd {
    pir_scene *scene;
    thing thing[BODIES + 1];
    uint32_t count;
    pir_trimesh *floor;
    bool aligned;
} crowd;

/* An answer of the loop. */
typedef struct candidate {
    pir_exact_impact impact;
    uint32_t body; /* its place in the list */
    mpz_t c[4];
    bool is_cubic;
} candidate;

static struct { unsigned outcome[8], at_start, ties, triangles, refused; } seen;

/* --- scenes --- */

static pir_vec3 place_of(test_random *random, bool aligned) {
    if (aligned)
        return (pir_vec3){0.5 * test_random_between(random, -10, 10), 0.5 * test_random_between(random, -10, 10),
                          0.5 * test_random_between(random, 1, 6)};
    const pir_vec3 v = test_random_direction(random);
    return (pir_vec3){5 * v.x, 5 * v.y, 3 + 2 * v.z};
}

static pir_quat turn_of(test_random *random, bool aligned) {
    static const pir_quat even[] = {{0, 0, 0, 1}, {0, 0, 1, 1}, {1, 0, 0, -1}, {0, 1, 0, 0}, {1, 1, 1, 1}};
    return aligned ? even[test_random_below(random, 5)] : test_general_rotation(random);
}

static void add(crowd *c, thing *t) {
    assert_int_equal(pir_scene_add(c->scene, &t->options, &t->id), PIR_OK);
}

static void add_body(crowd *c, test_random *random) {
    thing *t = &c->thing[c->count++];
    t->options = pir_body_options_default();
    t->pieces = 1 + test_random_below(random, PIECES);
    for (uint32_t i = 0; i < t->pieces; i++) {
        const pir_vec3 at = {0.5 * test_random_between(random, -2, 2), 0.5 * test_random_between(random, -2, 2), 0};
        t->piece[i] = test_random_below(random, 4) == 0 ? test_sphere(random, 6) : test_box_at(0.25, 0.25, 0.5, at);
    }
    t->options.pieces = t->piece;
    t->options.piece_count = t->pieces;
    t->options.kind = test_random_below(random, 3) == 0 ? PIR_BODY_STATIC : PIR_BODY_MOVING;
    t->options.pose = (pir_pose){turn_of(random, c->aligned), place_of(random, c->aligned)};
    t->options.sensor = test_random_below(random, 10) == 0;
    t->options.mask = test_random_below(random, 10) == 0 ? 2 : UINT32_MAX;
    t->options.user = 100 + c->count;
    add(c, t);
}

/* Two by two squares in the plane z = 0, cut in triangles. */
static void add_floor(crowd *c) {
    pir_vec3 vertex[9];
    uint32_t triangle[TRIANGLES][3];
    for (uint32_t i = 0; i < 9; i++)
        vertex[i] = (pir_vec3){5.0 * (i % 3) - 5, 5.0 * (i / 3) - 5, 0};
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t corner = i % 2 + 3 * (i / 2);
        const uint32_t loops[2][3] = {{corner, corner + 1, corner + 4}, {corner, corner + 4, corner + 3}};
        memcpy(triangle[2 * i], loops, sizeof loops);
    }
    thing *t = &c->thing[c->count++];
    const pir_trimesh_arrays arrays = {
        .vertices = vertex, .vertex_count = 9, .triangles = triangle[0], .triangle_count = TRIANGLES};
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &c->floor), PIR_OK);
    t->options = pir_body_options_default();
    t->options.kind = PIR_BODY_STATIC;
    t->options.mesh = c->floor;
    t->pieces = TRIANGLES;
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        const pir_vec3 corner[3] = {vertex[triangle[i][0]], vertex[triangle[i][1]], vertex[triangle[i][2]]};
        t->piece[i] = test_hull(corner, 3);
    }
    add(c, t);
}

static void make(crowd *c, test_random *random) {
    *c = (crowd){.aligned = test_random_below(random, 2) == 0};
    assert_int_equal(pir_scene_create(NULL, &c->scene), PIR_OK);
    const uint32_t floor = test_random_below(random, 3 * BODIES);
    for (uint32_t i = 0; i < BODIES; i++) {
        if (i == floor)
            add_floor(c);
        add_body(c, random);
    }
    if (test_random_below(random, 2) == 0)
        assert_int_equal(pir_scene_update(c->scene, NULL, 0), PIR_OK);
}

static void clear(crowd *c) {
    pir_scene_destroy(c->scene);
    for (uint32_t i = 0; i < c->count; i++)
        for (uint32_t k = 0; k < c->thing[i].pieces; k++)
            pir_polytope_release(c->thing[i].piece[k]);
    pir_trimesh_release(c->floor);
}

/* --- the loop --- */

static bool meet(const thing *a, const thing *b) {
    const pir_body_options *p = &a->options, *q = &b->options;
    return (p->category & q->mask) != 0 && (q->category & p->mask) != 0 &&
           (p->kind == PIR_BODY_MOVING || q->kind == PIR_BODY_MOVING);
}

static int rank_of(const pir_impact *impact) {
    const pir_cast_outcome outcome = impact->outcome;
    return outcome == PIR_CAST_START_INSIDE ? 4
           : outcome == PIR_CAST_HIT        ? 2 + (impact->steps == 0)
                                            : outcome == PIR_CAST_RECEDING;
}

/* The root of a cubic that is in the interval: by Newton's steps, of which each halves the error at a double root. */
static void cubic_root_of(mpf_t root, const candidate *c) {
    mpf_t value, slope, term;
    mpf_inits(value, slope, term, NULL);
    mpf_set_d(root, 0.5 * (c->impact.kappa[0] + c->impact.kappa[1]));
    for (int step = 0; step < BITS; step++) {
        mpf_set_ui(value, 0);
        mpf_set_ui(slope, 0);
        for (int i = 0; i < 4; i++) {
            mpf_mul(slope, slope, root);
            mpf_add(slope, slope, value);
            mpf_mul(value, value, root);
            mpf_set_z(term, c->c[i]);
            mpf_add(value, value, term);
        }
        if (mpf_sgn(value) == 0 || mpf_sgn(slope) == 0)
            break;
        mpf_div(term, value, slope);
        mpf_sub(root, root, term);
    }
    mpf_clears(value, slope, term, NULL);
}

/* The root of the quadratic that is in the interval. */
static void root_of(mpf_t root, candidate *c) {
    if (c->is_cubic) {
        cubic_root_of(root, c);
        return;
    }
    mpf_t d, a, other;
    mpf_inits(d, a, other, NULL);
    mpf_set_z(a, c->c[1]);
    if (mpz_sgn(c->c[0]) == 0) {
        mpf_set_z(d, c->c[2]);
        mpf_div(root, d, a);
        mpf_neg(root, root);
    } else {
        mpz_t s;
        mpz_init(s);
        mpz_mul(s, c->c[0], c->c[2]);
        mpz_mul_2exp(s, s, 2);
        mpz_neg(s, s);
        mpz_addmul(s, c->c[1], c->c[1]);
        mpf_set_z(d, s);
        mpz_clear(s);
        mpf_sqrt(d, d);
        mpf_neg(a, a);
        mpf_add(root, a, d);
        mpf_sub(other, a, d);
        mpf_set_z(a, c->c[0]);
        mpf_mul_2exp(a, a, 1);
        mpf_div(root, root, a);
        mpf_div(other, other, a);
        const double middle = 0.5 * (c->impact.kappa[0] + c->impact.kappa[1]);
        if (fabs(mpf_get_d(other) - middle) < fabs(mpf_get_d(root) - middle))
            mpf_set(root, other);
    }
    mpf_clears(d, a, other, NULL);
}

/* The sign of a's κ less b's: 0 where they agree in 250 bits. */
static int compare_kappa(candidate *a, candidate *b) {
    mpf_t x, y, size;
    mpf_inits(x, y, size, NULL);
    root_of(x, a);
    root_of(y, b);
    mpf_abs(size, x);
    mpf_add_ui(size, size, 1);
    mpf_div_2exp(size, size, 250);
    mpf_sub(x, x, y);
    const int sign = mpf_sgn(x);
    mpf_abs(x, x);
    const int order = mpf_cmp(x, size) < 0 ? 0 : sign;
    mpf_clears(x, y, size, NULL);
    return order;
}

static bool is_lower(const candidate *a, const candidate *b) {
    if (a->body != b->body)
        return a->body < b->body;
    const pir_impact *x = &a->impact.impact, *y = &b->impact.impact;
    return x->piece_p != y->piece_p ? x->piece_p < y->piece_p : x->piece_q < y->piece_q;
}

static bool comes_before(candidate *a, candidate *b) {
    const int x = rank_of(&a->impact.impact), y = rank_of(&b->impact.impact);
    if (x != y)
        return x > y;
    const int order = x == 2 ? compare_kappa(a, b) : 0;
    seen.ties += x == 2 && order == 0;
    return order != 0 ? order > 0 : is_lower(a, b);
}

static void ask_pair(const thing *own, uint32_t i, const thing *other, uint32_t j, const pir_exact_motion *motion,
                     candidate *ret) {
    pir_pair *pair;
    pir_workspace *workspace;
    assert_int_equal(pir_pair_create(own->piece[i], other->piece[j], NULL, &pair), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    pir_pair_input input = pir_pair_input_default();
    input.pose_p = own->options.pose;
    input.pose_q = other->options.pose;
    assert_int_equal(pir_pair_impact_exact(pair, workspace, &input, motion, &ret->impact, ret->c), PIR_OK);
    ret->is_cubic = motion->degrees != 0 && (motion->way.x != 0 || motion->way.y != 0 || motion->way.z != 0);
    ret->impact.impact.piece_p = i;
    ret->impact.impact.piece_q = j;
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
}

/* The first of all pairs, in best[0]; false where there is none. best[1] is scratch. */
static bool loop(const crowd *c, uint32_t own, const pir_exact_motion *motion, candidate best[2]) {
    bool any = false;
    for (uint32_t b = 0; b < c->count; b++) {
        const thing *p = &c->thing[own], *q = &c->thing[b];
        if (b == own || q->options.sensor || !meet(p, q))
            continue;
        for (uint32_t i = 0; i < p->pieces; i++)
            for (uint32_t j = 0; j < q->pieces; j++) {
                candidate *next = &best[any];
                ask_pair(p, i, q, j, motion, next);
                next->body = b;
                if (rank_of(&next->impact.impact) == 0)
                    continue;
                if (!any || comes_before(next, &best[0])) {
                    const candidate swapped = best[0];
                    best[0] = *next;
                    *next = any ? swapped : *next;
                }
                any = true;
            }
    }
    return any;
}

/* --- the check --- */

static pir_exact_motion motion_of(test_random *random, bool aligned) {
    static const pir_vec3 even[] = {{0, 0, 1}, {1, 0, 0}, {0, -2, 0}, {1, 1, 1}, {1, -1, 0}};
    pir_exact_motion motion = {.axis = aligned ? even[test_random_below(random, 5)] : test_random_direction(random),
                               .pivot = place_of(random, aligned)};
    motion.degrees = aligned ? 90 * test_random_between(random, -4, 4) : 360 * test_random_unit(random);
    const bool screws = test_random_below(random, 3) == 0;
    if (screws)
        motion.degrees = aligned ? 45 * test_random_between(random, 1, 3) : 1 + 175 * test_random_unit(random);
    if (motion.degrees == 0 || screws || test_random_below(random, 3) == 0) {
        motion.degrees = screws ? motion.degrees : 0;
        motion.way = (pir_vec3){test_random_between(random, -8, 8), test_random_between(random, -8, 8),
                                test_random_between(random, -6, 6)};
    }
    return motion;
}

static void check_motion(const crowd *c, uint32_t own, const pir_exact_motion *motion, candidate best[2],
                         uint64_t number) {
    pir_exact_impact told, again;
    const thing *p = &c->thing[own];
    const pir_status status = pir_scene_first_contact(c->scene, p->id, motion, &told);
    if (p->options.sensor || p->options.mesh) {
        assert_int_equal(status, PIR_ERR_ARGUMENT);
        seen.refused++;
        return;
    }
    assert_int_equal(status, PIR_OK);
    assert_int_equal(pir_scene_first_contact(c->scene, p->id, motion, &again), PIR_OK);
    const pir_impact *impact = &told.impact;
    assert_true(again.impact.time == impact->time && again.impact.body == impact->body &&
                again.impact.piece_q == impact->piece_q && again.kappa[0] == told.kappa[0]);
    seen.outcome[impact->outcome]++;
    if (!loop(c, own, motion, best)) {
        const bool rests = motion->degrees == 0 && motion->way.x == 0 && motion->way.y == 0 && motion->way.z == 0;
        expect(impact->outcome == (rests ? PIR_CAST_AT_REST : PIR_CAST_MISS) && impact->body == PIR_SCENE_NONE &&
                   impact->time == (rests ? 0 : 1),
               "motion %llu: outcome %d", (unsigned long long)number, (int)impact->outcome);
        return;
    }
    const pir_exact_impact *first = &best[0].impact;
    const thing *q = &c->thing[best[0].body];
    seen.at_start += first->impact.outcome == PIR_CAST_HIT && first->impact.steps == 0;
    seen.triangles += q->options.mesh != NULL;
    expect(impact->outcome == first->impact.outcome && impact->body == q->id &&
               impact->piece_p == first->impact.piece_p && impact->piece_q == first->impact.piece_q,
           "motion %llu: outcome %d, body %u, pieces %u %u; all pairs: %d, %u, %u %u", (unsigned long long)number,
           (int)impact->outcome, impact->body, impact->piece_p, impact->piece_q, (int)first->impact.outcome, q->id,
           first->impact.piece_p, first->impact.piece_q);
    assert_true(impact->time == first->impact.time && told.degrees == first->degrees &&
                told.kappa[0] == first->kappa[0] && told.kappa[1] == first->kappa[1]);
    assert_true(impact->witness.p.index == first->impact.witness.p.index &&
                impact->witness.q.index == first->impact.witness.q.index && impact->user == q->options.user);
}

static void contacts_are_the_first_of_all_pairs(void **state) {
    (void)state;
    const char *text = getenv("PIR_TEST_SCENES");
    const uint64_t count = text ? strtoull(text, NULL, 10) : 60;
    candidate best[2];
    mpf_set_default_prec(BITS);
    for (int k = 0; k < 2; k++)
        mpz_inits(best[k].c[0], best[k].c[1], best[k].c[2], best[k].c[3], NULL);
    for (uint64_t i = 0; i < count; i++) {
        test_random random = test_random_case("scene contacts", i);
        crowd c;
        make(&c, &random);
        for (uint32_t k = 0; k < MOTIONS; k++) {
            const pir_exact_motion motion = motion_of(&random, c.aligned);
            check_motion(&c, test_random_below(&random, c.count), &motion, best, MOTIONS * i + k);
        }
        clear(&c);
    }
    for (int k = 0; k < 2; k++)
        mpz_clears(best[k].c[0], best[k].c[1], best[k].c[2], best[k].c[3], NULL);
    print_message("%u hits, %u of them at the start, %u misses, %u receding, %u inside; %u ties, %u with triangles, "
                  "%u refused\n",
                  seen.outcome[PIR_CAST_HIT], seen.at_start, seen.outcome[PIR_CAST_MISS],
                  seen.outcome[PIR_CAST_RECEDING], seen.outcome[PIR_CAST_START_INSIDE], seen.ties, seen.triangles,
                  seen.refused);
    assert_true(seen.outcome[PIR_CAST_HIT] > 0 && seen.outcome[PIR_CAST_MISS] > 0 && seen.ties > 0);
}

/* --- by hand --- */

/* A door on a floor, which it slides on, is opened until it meets the wall behind it. */
static void a_door_meets_the_wall_and_not_the_floor(void **state) {
    (void)state;
    pir_scene *scene;
    pir_polytope *leaf = test_box_at(0.5, 0.0625, 1, (pir_vec3){0.5, 0, 1}), *slab = test_box(8, 8, 1),
                 *wall = test_box(0.5, 4, 1);
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    const uint32_t floor = scene_add(scene, slab, scene_at(0, 0, -1), PIR_BODY_STATIC);
    const uint32_t door = scene_add(scene, leaf, scene_at(0, 0, 0), PIR_BODY_MOVING);
    const pir_exact_motion opening = {.axis = {0, 0, 1}, .degrees = 180};
    pir_exact_impact impact;
    assert_int_equal(pir_scene_first_contact(scene, door, &opening, &impact), PIR_OK);
    assert_true(impact.impact.outcome == PIR_CAST_RECEDING && impact.impact.body == floor);
    // behind x = -0.5, which the leaf's far edge comes to at 120 degrees, less what half its thickness adds
    const uint32_t behind = scene_add(scene, wall, scene_at(-1, 0, 1), PIR_BODY_STATIC);
    assert_int_equal(pir_scene_first_contact(scene, door, &opening, &impact), PIR_OK);
    assert_true(impact.impact.outcome == PIR_CAST_HIT && impact.impact.body == behind);
    const double turned = (acos(-0.5 / hypot(1, 0.0625)) - atan(0.0625)) * 180 / acos(-1);
    expect(impact.degrees <= turned && impact.degrees > turned - 1e-9, "%.17g, expected %.17g", impact.degrees, turned);
    assert_true(impact.impact.normal.x == 1);
    pir_scene_destroy(scene);
    pir_polytope_release(leaf);
    pir_polytope_release(slab);
    pir_polytope_release(wall);
}

static void refusals_are_told(void **state) {
    (void)state;
    pir_report report = {0};
    pir_scene_options options = pir_scene_options_default();
    pir_scene *scene;
    pir_polytope *cube = scene_cube(1);
    options.report = &report;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
    const uint32_t body = scene_add(scene, cube, scene_at(0, 0, 0), PIR_BODY_MOVING);
    pir_body_options round = pir_body_options_default();
    round.pieces = &cube;
    round.piece_count = 1;
    round.radius = 0.25;
    round.pose = scene_at(5, 0, 0);
    uint32_t ball;
    assert_int_equal(pir_scene_add(scene, &round, &ball), PIR_OK);
    pir_exact_motion motion = {.way = {0, 9, 0}};
    pir_exact_impact impact = {.degrees = -1};
    // a body with a radius matters where it is in the way
    assert_int_equal(pir_scene_first_contact(scene, body, &motion, &impact), PIR_OK);
    assert_int_equal(impact.impact.outcome, PIR_CAST_MISS);
    impact.degrees = -1;
    motion.way = (pir_vec3){9, 0, 0};
    assert_int_equal(pir_scene_first_contact(scene, body, &motion, &impact), PIR_ERR_ARGUMENT);
    assert_string_equal(report.text, "first contact: body 1 in the way has a radius");
    assert_int_equal(pir_scene_first_contact(scene, ball, &motion, &impact), PIR_ERR_ARGUMENT);
    assert_string_equal(report.text, "first contact: body 1 has a radius");
    motion.degrees = 90;
    assert_int_equal(pir_scene_first_contact(scene, body, &motion, &impact), PIR_ERR_ARGUMENT);
    motion.way.x = NAN;
    assert_int_equal(pir_scene_first_contact(scene, body, &motion, &impact), PIR_ERR_NOT_FINITE);
    motion = (pir_exact_motion){.way = {1e300, 0, 0}};
    assert_int_equal(pir_scene_first_contact(scene, body, &motion, &impact), PIR_ERR_LIMIT);
    motion = (pir_exact_motion){.pivot = {1e300, 0, 0}, .axis = {0, 0, 1}, .degrees = 5};
    assert_int_equal(pir_scene_first_contact(scene, body, &motion, &impact), PIR_ERR_LIMIT);
    assert_int_equal(pir_scene_first_contact(scene, 17, &motion, &impact), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_first_contact(scene, body, NULL, &impact), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_first_contact(scene, body, &motion, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_first_contact(NULL, body, &motion, &impact), PIR_ERR_ARGUMENT);
    assert_true(impact.degrees == -1);
    pir_scene_destroy(scene);
    pir_polytope_release(cube);
}

static void memory_that_fails_at_any_request_is_told(void **state) {
    (void)state;
    pir_polytope *cube = scene_cube(1);
    // on both sides at once: a tie
    const pir_exact_motion motion = {.axis = {0, 0, 1}, .degrees = 90};
    for (uint64_t at = 1, done = 0; !done; at++) {
        test_memory memory = {.fail_at = at};
        const pir_allocator allocator = test_allocator(&memory);
        pir_scene_options options = pir_scene_options_default();
        options.allocator = &allocator;
        pir_scene *scene = NULL;
        pir_exact_impact impact = {.degrees = -1};
        static const double side[] = {0, 2.25, -2.25};
        uint32_t id[3];
        pir_status status = pir_scene_create(&options, &scene);
        for (int k = 0; k < 3 && status == PIR_OK; k++) {
            pir_body_options body = pir_body_options_default();
            body.pieces = &cube;
            body.piece_count = 1;
            body.pose = scene_at(side[k], 0, 0);
            status = pir_scene_add(scene, &body, &id[k]);
        }
        if (status == PIR_OK)
            status = pir_scene_first_contact(scene, id[0], &motion, &impact);
        done = memory.requests < at;
        assert_true(status == PIR_OK || (status == PIR_ERR_MEMORY && !done && impact.degrees == -1));
        if (status == PIR_OK)
            assert_true(impact.impact.outcome == PIR_CAST_HIT && impact.impact.body == id[1]);
        pir_scene_destroy(scene);
        expect(memory.blocks == 0 && !memory.wrong_size && !memory.overrun, "request %llu", (unsigned long long)at);
    }
    pir_polytope_release(cube);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contacts_are_the_first_of_all_pairs),
        cmocka_unit_test(a_door_meets_the_wall_and_not_the_floor),
        cmocka_unit_test(refusals_are_told),
        cmocka_unit_test(memory_that_fails_at_any_request_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
