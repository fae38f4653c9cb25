/* SPDX-License-Identifier: MIT */
/*
 * Queries of solids in pieces, against what shares nothing with pieces.
 *
 * Unions of unit cubes at half-integer places: the state by counting cubes, ties and tight passages included. Prisms,
 * and bodies of many pieces, at any rotations: state and distance by the exact difference of the two, whose boundary is
 * looked at facet by facet. Casts: apart until the time of impact, near at it.
 *
 * PIR_TEST_CASES sets how many rotations, or pairs of unions, there are. Two models as arguments take the place of the
 * prisms.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "solid/models.h"
#include "support/solid_sums.h"
#include "support/vectors.h"

enum { PLACES = 200 };

static pir_solid_query *query_of(const pir_solid *p, const pir_solid *q) {
    pir_pieces *of_p = NULL, *of_q = NULL;
    pir_solid_query *query = NULL;
    assert_int_equal(pir_solid_decompose(p, NULL, NULL, &of_p), PIR_OK);
    assert_int_equal(pir_solid_decompose(q, NULL, NULL, &of_q), PIR_OK);
    assert_int_equal(pir_solid_query_create(of_p, of_q, NULL, &query), PIR_OK);
    pir_pieces_destroy(of_q);
    pir_pieces_destroy(of_p);
    return query;
}

/* --- cubes --- */

/* The state of unit cubes p + t/2 and q, by counting. */
static pir_state state_of_cubes(const cells *p, const cells *q, const int t[3]) {
    pir_state state = PIR_OUTSIDE;
    for (int i = 0; i < CELLS * CELLS * CELLS; i++)
        for (int j = 0; j < CELLS * CELLS * CELLS; j++) {
            const int a[3] = {i % CELLS, i / CELLS % CELLS, i / CELLS / CELLS};
            const int b[3] = {j % CELLS, j / CELLS % CELLS, j / CELLS / CELLS};
            if (!p->full[a[0]][a[1]][a[2]] || !q->full[b[0]][b[1]][b[2]])
                continue;
            int most = 0;
            for (int k = 0; k < 3; k++)
                most = abs(2 * a[k] + t[k] - 2 * b[k]) > most ? abs(2 * a[k] + t[k] - 2 * b[k]) : most;
            const pir_state own = most < 2 ? PIR_INSIDE : most == 2 ? PIR_BOUNDARY : PIR_OUTSIDE;
            state = own > state ? own : state;
        }
    return state;
}

static void states_of_cubes_are_those_that_are_counted(void **state) {
    (void)state;
    pir_workspace *workspace = NULL;
    unsigned seen[3] = {0};
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t i = 0; i < solid_cases(10); i++) {
        test_random random = test_random_case("cubes", i);
        const cells p = cells_random(&random, 2 + test_random_below(&random, 30));
        const cells q = cells_random(&random, 1 + test_random_below(&random, 8));
        pir_solid *of_p = solid_of_cells(&p), *of_q = solid_of_cells(&q);
        pir_solid_query *query = query_of(of_p, of_q);
        for (int n = 0; n < PLACES; n++) {
            const int t[3] = {test_random_between(&random, -10, 10), test_random_between(&random, -10, 10),
                              test_random_between(&random, -10, 10)};
            pir_pair_input input = pir_pair_input_default();
            pir_solid_distance distance;
            pir_state found;
            input.pose_p.translation = (pir_vec3){t[0] / 2.0, t[1] / 2.0, t[2] / 2.0};
            assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &found), PIR_OK);
            assert_int_equal(pir_solid_query_distance(query, workspace, &input, &distance), PIR_OK);
            const pir_state expected = state_of_cubes(&p, &q, t);
            expect(found == expected && distance.result.state == expected, "case %llu, place %d: %d and %d, not %d",
                   (unsigned long long)i, n, (int)found, (int)distance.result.state, (int)expected);
            seen[expected]++;
        }
        pir_solid_query_destroy(query);
        pir_solid_release(of_q);
        pir_solid_release(of_p);
    }
    printf("%u outside, %u boundary, %u inside\n", seen[0], seen[1], seen[2]);
    pir_workspace_destroy(workspace);
}

/* --- the exact difference --- */

static pir_vec3 minus(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

/* The normal of a facet, twice as long as its area. */
static pir_vec3 normal_of(const pir_vec3 *x, const uint32_t *corner, uint32_t count) {
    pir_vec3 sum = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < count; i++) {
        const pir_vec3 c = test_cross(minus(x[corner[i]], x[corner[0]]), minus(x[corner[i + 1]], x[corner[0]]));
        sum = (pir_vec3){sum.x + c.x, sum.y + c.y, sum.z + c.z};
    }
    return sum;
}

static double square_to_segment(pir_vec3 a, pir_vec3 b, pir_vec3 t) {
    const pir_vec3 way = minus(b, a), to = minus(t, a);
    const double s = fmin(1, fmax(0, test_dot(to, way) / test_dot(way, way)));
    const pir_vec3 rest = {to.x - s * way.x, to.y - s * way.y, to.z - s * way.z};
    return test_dot(rest, rest);
}

/* The solid angle over 4π of a triangle from t (Van Oosterom, Strackee 1983). */
static double angle_of(pir_vec3 a, pir_vec3 b, pir_vec3 c) {
    const double la = sqrt(test_dot(a, a)), lb = sqrt(test_dot(b, b)), lc = sqrt(test_dot(c, c));
    const double up = test_dot(a, test_cross(b, c));
    const double down = la * lb * lc + test_dot(a, b) * lc + test_dot(b, c) * la + test_dot(c, a) * lb;
    return atan2(up, down) / (2 * acos(-1));
}

/* The distance from t to the boundary of the difference, and how often that winds round t. */
static double look(const pir_mesh *mesh, pir_vec3 t, double *ret_winding) {
    const pir_vec3 *x = pir_mesh_vertices(mesh);
    double least = HUGE_VAL, winding = 0;
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        const pir_vec3 n = normal_of(x, corner, count);
        const double away = test_dot(n, minus(t, x[corner[0]])), size = test_dot(n, n);
        const pir_vec3 foot = {t.x - away / size * n.x, t.y - away / size * n.y, t.z - away / size * n.z};
        double turns = 0;
        for (uint32_t i = 0; i < count; i++) {
            const pir_vec3 a = x[corner[i]], b = x[corner[i + 1 < count ? i + 1 : 0]];
            least = fmin(least, square_to_segment(a, b, t));
            turns += atan2(test_dot(n, test_cross(minus(a, foot), minus(b, foot))) / sqrt(size),
                           test_dot(minus(a, foot), minus(b, foot)));
            winding += angle_of(minus(x[corner[0]], t), minus(a, t), minus(b, t));
        }
        if (turns > acos(-1))
            least = fmin(least, away * away / size);
    }
    *ret_winding = winding;
    return sqrt(least);
}

static double size_of(const pir_mesh *mesh) {
    double most = 0;
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++)
        most = fmax(most, sqrt(test_dot(pir_mesh_vertices(mesh)[v], pir_mesh_vertices(mesh)[v])));
    return most;
}

struct tally {
    uint64_t places, inside;
    double worst;
};

/* Looks at random places of P in one rotation, Q turned as well. */
static void compare(pir_solid_query *query, pir_workspace *workspace, const pir_mesh *mesh, pir_quat rotation,
                    test_random *random, struct tally *tally) {
    const double size = size_of(mesh);
    for (int n = 0; n < PLACES; n++) {
        pir_pair_input input = pir_pair_input_default();
        pir_solid_distance distance;
        pir_state state;
        double winding;
        const pir_vec3 t = {size * test_random_unit(random), size * test_random_unit(random),
                            size * test_random_unit(random)};
        input.pose_p = (pir_pose){rotation, t};
        if (n % 2) {
            // the same place, seen from a world in which Q is turned by a right angle
            const pir_pose world = {{0, 0, 1, 1}, {0, 0, 0}};
            input.pose_p = pir_pose_compose(world, input.pose_p);
            input.pose_q = world;
        }
        const double away = look(mesh, t, &winding);
        assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &state), PIR_OK);
        assert_int_equal(pir_solid_query_distance(query, workspace, &input, &distance), PIR_OK);
        const bool inside = winding > 0.5;
        expect(state == (inside ? PIR_INSIDE : PIR_OUTSIDE) && distance.result.state == state,
               "place %d: state %d, winding %g, distance %g", n, (int)state, winding, away);
        const double off = inside ? 0 : fabs(distance.result.distance - away) / size;
        expect(off <= 1e-12, "place %d: distance %.17g, not %.17g", n, distance.result.distance, away);
        tally->worst = fmax(tally->worst, off);
        tally->places++;
        tally->inside += inside;
    }
}

static void compare_all(const pir_solid *p, const pir_solid *q, const char *name, uint64_t rotations) {
    pir_workspace *workspace = NULL;
    pir_solid_query *query = query_of(p, q);
    struct tally tally = {0};
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t i = 0; i < rotations; i++) {
        test_random random = test_random_case(name, i);
        pir_solid_sum_options options = pir_solid_sum_options_default();
        pir_mesh *mesh = NULL;
        const pir_vec3 axis = test_random_direction(&random);
        const pir_quat rotation = {axis.x, axis.y, axis.z, test_random_unit(&random)};
        options.difference = true;
        assert_int_equal(solid_sum_mesh(p, q, rotation, &options, NULL, &mesh), PIR_OK);
        compare(query, workspace, mesh, rotation, &random, &tally);
        pir_mesh_destroy(mesh);
    }
    printf("%s: %llu places, %llu inside, distances off by %.2g of the size at most\n", name,
           (unsigned long long)tally.places, (unsigned long long)tally.inside, tally.worst);
    pir_solid_query_destroy(query);
    pir_workspace_destroy(workspace);
}

/* A prism over a polygon whose corners are at one radius and another in turn. */
static pir_solid *star_of(uint32_t corners, double radius, double other) {
    static solid_facets facets;
    double corner[32][2];
    for (uint32_t i = 0; i < corners; i++) {
        const double angle = 2 * acos(-1) * i / corners, r = i % 2 ? other : radius;
        corner[i][0] = ldexp(rint(ldexp(r * cos(angle), 20)), -20);
        corner[i][1] = ldexp(rint(ldexp(r * sin(angle), 20)), -20);
    }
    facets = (solid_facets){0};
    solid_add_prism(&facets, (const double(*)[2])corner, corners, 1);
    return solid_of_facets(&facets);
}

static void answers_are_those_of_the_exact_difference(void **state) {
    (void)state;
    cells frame = {0}, clamp = {0};
    for (int i = 0; i < 9; i++)
        frame.full[i % 3][i / 3][0] = i != 4;
    for (int i = 0; i < 12; i++)
        clamp.full[i % 3][i / 3][0] = i % 3 == 0 || i / 3 == 0 || i / 3 == 3;
    pir_solid *solids[] = {star_of(16, 2, 1.25), star_of(10, 2, 0.75), solid_of_cells(&frame), solid_of_cells(&clamp)};
    compare_all(solids[0], solids[1], "stars", solid_cases(10));
    compare_all(solids[3], solids[2], "clamp and frame", solid_cases(10));
    compare_all(solids[2], solids[0], "frame and star", solid_cases(10));
    for (int i = 0; i < 4; i++)
        pir_solid_release(solids[i]);
}

static void answers_for_bodies_of_many_pieces_are_those_of_the_exact_difference(void **state) {
    (void)state;
    static const char *const names[][2] = {{"gear8", "star5"}, {"mushroom", "cup"}, {"spoon", "cup"}};
    for (int i = 0; i < 3; i++) {
        pir_solid *p = solid_model_new(names[i][0], 1), *q = solid_model_new(names[i][1], 1);
        assert_true(p && q);
        compare_all(p, q, names[i][0], solid_cases(1));
        pir_solid_release(q);
        pir_solid_release(p);
    }
}

/* --- casts --- */

static void impacts_are_the_first(void **state) {
    (void)state;
    pir_workspace *workspace = NULL;
    pir_solid *p = star_of(10, 2, 0.75), *q = star_of(16, 2, 1.25);
    pir_solid_query *query = query_of(p, q);
    unsigned met = 0;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t i = 0; i < 5 * solid_cases(10); i++) {
        test_random random = test_random_case("casts", i);
        pir_pair_input input = pir_pair_input_default();
        const pir_vec3 from = test_random_direction(&random), axis = test_random_direction(&random);
        const double speed = test_random_between(&random, 2, 12), turn = i % 2 ? test_random_unit(&random) * 3 : 0;
        const pir_motion motion = {
            {-speed * from.x, -speed * from.y, -speed * from.z}, {turn * axis.x, turn * axis.y, turn * axis.z}, 0};
        pir_impact impact;
        pir_solid_distance distance;
        input.pose_p = (pir_pose){{axis.y, axis.z, axis.x, 1}, {5 * from.x, 5 * from.y, 5 * from.z}};
        input.pose_q.translation = (pir_vec3){0.25, 0, 0.5};
        assert_int_equal(pir_solid_query_cast(query, workspace, &input, &motion, 1e-6, &impact), PIR_OK);
        const pir_pose start = input.pose_p;
        const double end = impact.time;
        for (int k = 0; k <= 50; k++) {
            input.pose_p = pir_pose_integrate(start, motion.way, motion.turn, end * k / 50);
            assert_int_equal(pir_solid_query_distance(query, workspace, &input, &distance), PIR_OK);
            expect(distance.result.state == PIR_OUTSIDE, "case %llu: they meet at %d/50 of the way to %g",
                   (unsigned long long)i, k, end);
        }
        expect(impact.outcome == PIR_CAST_MISS || distance.result.distance <= 1.001e-6, "case %llu: %g apart at impact",
               (unsigned long long)i, distance.result.distance);
        met += impact.outcome != PIR_CAST_MISS;
    }
    printf("%u casts met\n", met);
    assert_true(met > 0);
    pir_solid_query_destroy(query);
    pir_solid_release(q);
    pir_solid_release(p);
    pir_workspace_destroy(workspace);
}

static void a_cast_that_begins_inside_has_the_normal_of_its_depth(void **state) {
    (void)state;
    cells cube = {0};
    cube.full[0][0][0] = true;
    pir_workspace *workspace = NULL;
    pir_solid *p = solid_of_cells(&cube);
    pir_solid_query *query = query_of(p, p);
    pir_pair_input input = pir_pair_input_default();
    const pir_motion motion = {{1, 0, 0}, {0, 0, 1}, 0};
    pir_impact impact;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    input.pose_p.translation = (pir_vec3){0.125, 0.25, 0.75};
    assert_int_equal(pir_solid_query_cast(query, workspace, &input, &motion, 1e-6, &impact), PIR_OK);
    assert_true(impact.outcome == PIR_CAST_START_INSIDE && impact.time == 0);
    assert_true(impact.normal.x == 0 && impact.normal.y == 0 && impact.normal.z == 1);
    // one that spins over it, and never nears it, is no hit
    input.pose_p.translation = (pir_vec3){0, 0, 1 + 1e-5};
    assert_int_equal(pir_solid_query_cast(query, workspace, &input, &motion, 1e-6, &impact), PIR_OK);
    assert_true(impact.outcome == PIR_CAST_MISS && impact.time == 1);
    pir_solid_query_destroy(query);
    pir_solid_release(p);
    pir_workspace_destroy(workspace);
}

/* A quaternion of any length, whichever of its numbers is the greatest, is the rotation of one of length 1. It takes no
 * more pairs either. */
static void quaternions_of_any_length_are_one_rotation(void **state) {
    (void)state;
    static const pir_quat turns[] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0},  {0, 0, 0, 1}, {1, 0, 0.25, 0.5},
                                     {0, 1, 2, 0}, {0, 3, 0, 4}, {1, 2, 0, -1}, {2, 1, 0, 3}, {0.5, -1, 2, 0.25}};
    const cells p = {.full = {{{true}}, {{true, true}}}}, q = {.full = {{{true, true, true}}, {{true}}}};
    pir_workspace *workspace = NULL;
    pir_solid *of_p = solid_of_cells(&p), *of_q = solid_of_cells(&q);
    pir_solid_query *query = query_of(of_p, of_q);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (size_t i = 0; i < 2 * sizeof turns / sizeof *turns; i++)
        for (int exponent = -900; exponent <= 900; exponent += 300)
            for (int n = 0; n < 3; n++) {
                const pir_quat turn = turns[i / 2];
                pir_pair_input input = pir_pair_input_default();
                pir_pose *pose = i % 2 ? &input.pose_q : &input.pose_p;
                pir_solid_distance expected, found;
                pir_state state_found;
                input.pose_p.translation = (pir_vec3){2.5 * n, 0.25 - n, 0.5};
                pose->rotation = turn;
                // the second time the pair of the last answer comes first, as it does from then on
                for (int twice = 0; twice < 2; twice++)
                    assert_int_equal(pir_solid_query_distance(query, workspace, &input, &expected), PIR_OK);
                pose->rotation = (pir_quat){ldexp(turn.x, exponent), ldexp(turn.y, exponent), ldexp(turn.z, exponent),
                                            ldexp(turn.w, exponent)};
                assert_int_equal(pir_solid_query_distance(query, workspace, &input, &found), PIR_OK);
                assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &state_found), PIR_OK);
                expect(found.result.state == expected.result.state &&
                           fabs(found.result.distance - expected.result.distance) < 1e-12 &&
                           state_found == expected.result.state && found.pairs == expected.pairs,
                       "turn %zu by 2^%d, place %d: %d, %g of %u pairs, not %d, %g of %u", i, exponent, n,
                       (int)state_found, found.result.distance, found.pairs, (int)expected.result.state,
                       expected.result.distance, expected.pairs);
            }
    pir_solid_query_destroy(query);
    pir_solid_release(of_q);
    pir_solid_release(of_p);
    pir_workspace_destroy(workspace);
}

/* Every query of solids refuses what a pair refuses, with its status. */
static void placements_that_are_none_are_refused_as_by_pairs(void **state) {
    (void)state;
    const cells cube = {.full = {{{true}}}};
    const double bad[] = {NAN, HUGE_VAL, 0, -1};
    const pir_motion motion = {{1, 0, 0}, {0, 0, 0}, 0};
    pir_workspace *workspace = NULL;
    pir_polytope *box = NULL;
    pir_pair *pair = NULL;
    pir_solid *p = solid_of_cells(&cube);
    pir_solid_query *query = query_of(p, p);
    int refused = 0;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_shape_create("cube", NULL, NULL, &box), PIR_OK);
    assert_int_equal(pir_pair_create(box, box, NULL, &pair), PIR_OK);
    for (int k = 0; k < 6; k++)
        for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
            pir_pair_input input = pir_pair_input_default();
            pir_query_result answer;
            pir_state found;
            pir_solid_distance distance;
            pir_impact impact;
            pir_solid_depth depth;
            input.pose_p.translation.x = 4;
            double *const numbers[6] = {&input.pose_p.translation.y,
                                        &input.pose_q.translation.z,
                                        &input.pose_p.rotation.w,
                                        &input.pose_q.rotation.w,
                                        &input.radius_p,
                                        &input.radius_q};
            *numbers[k] = bad[i];
            const pir_status status = pir_pair_distance(pair, workspace, &input, &answer);
            assert_int_equal(pir_solid_query_distance(query, workspace, &input, &distance), status);
            assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &found), status);
            assert_int_equal(pir_solid_query_cast(query, workspace, &input, &motion, 1e-6, &impact), status);
            assert_int_equal(pir_solid_query_depth(query, workspace, &input, &depth), status);
            assert_int_equal(pir_solid_query_directional_depth(query, workspace, &input, (pir_vec3){0, 0, 1}, &depth),
                             status);
            refused += status != PIR_OK;
        }
    // all but the numbers that a translation may be, a quaternion of one sign or the other, and no radius
    assert_int_equal(refused, 24 - 4 - 2 - 2);
    pir_pair_destroy(pair);
    pir_polytope_release(box);
    pir_solid_query_destroy(query);
    pir_solid_release(p);
    pir_workspace_destroy(workspace);
}

static void body_in_a_cavity_is_outside_and_one_that_is_swallowed_inside(void **state) {
    (void)state;
    cells block = {0}, cube = {0};
    for (int i = 0; i < 27; i++)
        block.full[i % 3][i / 3 % 3][i / 9] = i != 13;
    cube.full[0][0][0] = true;
    pir_workspace *workspace = NULL;
    pir_solid *p = solid_of_cells(&cube), *q = solid_of_cells(&block);
    pir_solid_query *query = query_of(p, q);
    pir_pair_input input = pir_pair_input_default();
    pir_state found;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    input.pose_p.translation = (pir_vec3){1, 1, 1};
    assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &found), PIR_OK);
    assert_int_equal(found, PIR_BOUNDARY);
    input.pose_p.translation = (pir_vec3){0x1p-40, 1, 1};
    assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &found), PIR_OK);
    assert_int_equal(found, PIR_INSIDE);
    assert_int_equal(pir_solid_query_overlap(NULL, workspace, &input, &found), PIR_ERR_ARGUMENT);
    input.pose_p.translation.x = HUGE_VAL;
    assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &found), PIR_ERR_NOT_FINITE);
    // rotations whose squares are beyond doubles, and none at all
    input.pose_p = (pir_pose){{0, 0, 3e-200, 3e-200}, {4, 1, 1}};
    input.pose_q.rotation.w = 2e180;
    assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &found), PIR_OK);
    assert_int_equal(found, PIR_BOUNDARY);
    input.pose_p.translation.x = 2;
    assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &found), PIR_OK);
    assert_int_equal(found, PIR_BOUNDARY);
    input.pose_p.translation.x = 1.5;
    assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &found), PIR_OK);
    assert_int_equal(found, PIR_INSIDE);
    input.pose_q.rotation = (pir_quat){0, 0, 0, 0};
    assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &found), PIR_ERR_ZERO_QUATERNION);
    // radii close the gap between far bodies
    input = pir_pair_input_default();
    input.pose_p.translation = (pir_vec3){-3, 1, 1};
    input.radius_p = 1.5;
    assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &found), PIR_OK);
    assert_int_equal(found, PIR_OUTSIDE);
    input.radius_q = 0.5;
    assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &found), PIR_OK);
    assert_int_equal(found, PIR_BOUNDARY);
    input.radius_q = 0.75;
    assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &found), PIR_OK);
    assert_int_equal(found, PIR_INSIDE);
    pir_solid_query_destroy(query);
    pir_solid_release(q);
    pir_solid_release(p);
    pir_workspace_destroy(workspace);
}

static int compare_files(char **path) {
    pir_solid *solid[2] = {NULL, NULL};
    for (int k = 0; k < 2; k++)
        if (pir_solid_read(path[k], NULL, NULL, &solid[k]) != PIR_OK)
            return 2;
    compare_all(solid[0], solid[1], "files", solid_cases(10));
    pir_solid_release(solid[1]);
    pir_solid_release(solid[0]);
    return 0;
}

int main(int argc, char **argv) {
    test_print_seed();
    if (argc == 3)
        return compare_files(argv + 1);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(states_of_cubes_are_those_that_are_counted),
        cmocka_unit_test(answers_are_those_of_the_exact_difference),
        cmocka_unit_test(answers_for_bodies_of_many_pieces_are_those_of_the_exact_difference),
        cmocka_unit_test(impacts_are_the_first),
        cmocka_unit_test(a_cast_that_begins_inside_has_the_normal_of_its_depth),
        cmocka_unit_test(placements_that_are_none_are_refused_as_by_pairs),
        cmocka_unit_test(quaternions_of_any_length_are_one_rotation),
        cmocka_unit_test(body_in_a_cavity_is_outside_and_one_that_is_swallowed_inside),
    };
    return cmocka_run_group_tests_name("queries of solids", tests, NULL, NULL);
}
