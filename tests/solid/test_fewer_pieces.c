/* SPDX-License-Identifier: MIT */
/*
 * Fewer pieces than exact ones need: each exact piece is in one of them, exactly, and no point of theirs is farther
 * from the exact ones than they say.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/exact.h>
#include <pirouette/pair.h>
#include <pirouette/solid.h>

#include "solid/bodies.h"
#include "support/memory.h"

/* The exact volume of the hull of two polytopes. */
static void joint_volume(const pir_polytope *a, const pir_polytope *b, mpq_t ret_volume) {
    const uint32_t of_a = pir_polytope_vertex_count(a), of_b = pir_polytope_vertex_count(b);
    mpq_t *x = malloc(3 * (size_t)(of_a + of_b) * sizeof *x), middle[3], inertia[6];
    pir_polytope *hull = NULL;
    assert_non_null(x);
    for (uint32_t i = 0; i < of_a + of_b; i++) {
        for (int k = 0; k < 3; k++)
            mpq_init(x[3 * (size_t)i + (size_t)k]);
        pir_polytope_vertex_exact(i < of_a ? a : b, i < of_a ? i : i - of_a, x + 3 * (size_t)i);
    }
    for (int k = 0; k < 6; k++)
        mpq_init(inertia[k]);
    for (int k = 0; k < 3; k++)
        mpq_init(middle[k]);
    assert_int_equal(pir_polytope_create_exact((const mpq_t *)x, of_a + of_b, NULL, &hull), PIR_OK);
    assert_int_equal(pir_polytope_mass_exact(hull, ret_volume, middle, inertia), PIR_OK);
    pir_polytope_release(hull);
    for (size_t i = 0; i < 3 * (size_t)(of_a + of_b); i++)
        mpq_clear(x[i]);
    free(x);
    for (int k = 0; k < 6; k++)
        mpq_clear(inertia[k]);
    for (int k = 0; k < 3; k++)
        mpq_clear(middle[k]);
}

static bool contains(const pir_polytope *outer, const pir_polytope *inner) {
    mpq_t alone, both;
    mpq_inits(alone, both, NULL);
    joint_volume(outer, outer, alone);
    joint_volume(outer, inner, both);
    const bool same = mpq_equal(alone, both);
    mpq_clears(alone, both, NULL);
    return same;
}

struct bodies {
    uint32_t count;
    pir_polytope **body;
};

static struct bodies bodies_of(const pir_pieces *pieces) {
    struct bodies bodies = {pir_pieces_count(pieces), calloc(pir_pieces_count(pieces), sizeof(pir_polytope *))};
    assert_non_null(bodies.body);
    for (uint32_t i = 0; i < bodies.count; i++)
        assert_int_equal(pir_pieces_polytope(pieces, i, &bodies.body[i]), PIR_OK);
    return bodies;
}

static void bodies_free(struct bodies *bodies) {
    for (uint32_t i = 0; i < bodies->count; i++)
        pir_polytope_release(bodies->body[i]);
    free(bodies->body);
}

/* A point of a body: a mean of its vertices by chance. */
static pir_vec3 point_in(test_random *random, const pir_polytope *body) {
    const uint32_t count = pir_polytope_vertex_count(body);
    pir_vec3 sum = {0, 0, 0};
    double weights = 0;
    for (uint32_t v = 0; v < count; v++) {
        const double weight = pow(fabs(test_random_unit(random)), 4);
        const pir_vec3 x = pir_polytope_vertex(body, v);
        sum = (pir_vec3){sum.x + weight * x.x, sum.y + weight * x.y, sum.z + weight * x.z};
        weights += weight;
    }
    return (pir_vec3){sum.x / weights, sum.y / weights, sum.z / weights};
}

/* How far a point is from the nearest of the bodies. */
static double distance_from(const struct bodies *bodies, pir_workspace *workspace, pir_polytope *origin,
                            pir_vec3 point) {
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < bodies->count; i++) {
        pir_pair *pair;
        pir_query_result result;
        pir_pair_input input = pir_pair_input_default();
        input.pose_p.translation = point;
        assert_int_equal(pir_pair_create(origin, bodies->body[i], NULL, &pair), PIR_OK);
        assert_int_equal(pir_pair_distance(pair, workspace, &input, &result), PIR_OK);
        least = fmin(least, result.distance);
        pir_pair_destroy(pair);
    }
    return least;
}

/* Returns the greatest distance that was met, as a part of the bound. */
static double check_bodies(test_random *random, uint64_t number, const struct bodies *exact, const struct bodies *fewer,
                           double error) {
    pir_workspace *workspace;
    pir_polytope *origin;
    double greatest = 0;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_polytope_create(&(pir_vec3){0, 0, 0}, 1, NULL, &origin), PIR_OK);
    for (uint32_t i = 0; i < exact->count; i++) {
        bool held = false;
        for (uint32_t k = 0; k < fewer->count && !held; k++)
            held = contains(fewer->body[k], exact->body[i]);
        expect(held, "case %llu: piece %u is in none", (unsigned long long)number, i);
    }
    for (uint32_t k = 0; k < fewer->count; k++)
        for (int n = 0; n < 20; n++)
            greatest = fmax(greatest, distance_from(exact, workspace, origin, point_in(random, fewer->body[k])));
    expect(greatest <= error + 1e-12, "case %llu: %g out, not %g", (unsigned long long)number, greatest, error);
    pir_polytope_release(origin);
    pir_workspace_destroy(workspace);
    return error > 0 ? greatest / error : 0;
}

static void fewer_pieces_contain_the_solid_within_their_error(void **state) {
    (void)state;
    double sum = 0;
    const uint64_t cases = solid_cases(12);
    for (uint64_t i = 0; i < cases; i++) {
        test_random random = test_random_case("fewer pieces", i);
        const cells of = cells_random(&random, 12);
        pir_solid *solid = solid_of_cells(&of);
        pir_pieces *pieces = NULL, *fewer = NULL;
        pir_decompose_options options = pir_decompose_options_default();
        pir_decompose_info info;
        options.method = PIR_DECOMPOSE_FACETS;
        assert_int_equal(pir_solid_decompose(solid, &options, &info, &pieces), PIR_OK);
        expect(info.error == 0 && info.exact_pieces == pir_pieces_count(pieces), "case %llu", (unsigned long long)i);
        options.tolerance = i % 2 ? 0.1 * (1 + test_random_below(&random, 10)) : 0;
        options.pieces = i % 2 ? 0 : 1 + test_random_below(&random, 3);
        assert_int_equal(pir_solid_decompose(solid, &options, &info, &fewer), PIR_OK);
        expect(info.exact_pieces == pir_pieces_count(pieces) && pir_pieces_count(fewer) <= info.exact_pieces,
               "case %llu", (unsigned long long)i);
        expect(i % 2 ? info.error <= options.tolerance : pir_pieces_count(fewer) <= options.pieces,
               "case %llu: %u pieces, error %g", (unsigned long long)i, pir_pieces_count(fewer), info.error);
        struct bodies exact = bodies_of(pieces), less = bodies_of(fewer);
        sum += check_bodies(&random, i, &exact, &less, info.error);
        bodies_free(&less);
        bodies_free(&exact);
        pir_pieces_destroy(fewer);
        pir_pieces_destroy(pieces);
        pir_solid_release(solid);
    }
    print_message("# points reach %.2f of the bound in the mean\n", sum / (double)cases);
    assert_true(sum > 0.1 * (double)cases);
}

/* An L: the middle of its hull's slanted side is as far from one leg as from the other. */
static const double l_shape[6][2] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};

static pir_solid *l_of(const pir_solid_options *options, double scale, pir_status *ret_status) {
    static solid_facets facets;
    double corner[6][2];
    pir_solid *solid = NULL;
    facets = (solid_facets){0};
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 2; k++)
            corner[i][k] = scale * l_shape[i][k];
    solid_add_prism(&facets, (const double(*)[2])corner, 6, scale);
    *ret_status = solid_make(&facets, options, NULL, &solid);
    return solid;
}

static void expect_hull_of_an_l(double scale) {
    pir_status status;
    pir_solid *solid = l_of(NULL, scale, &status);
    pir_pieces *pieces;
    pir_decompose_options options = pir_decompose_options_default();
    pir_decompose_info info;
    assert_int_equal(status, PIR_OK);
    options.pieces = 1;
    assert_int_equal(pir_solid_decompose(solid, &options, &info, &pieces), PIR_OK);
    assert_int_equal(pir_pieces_count(pieces), 1);
    assert_int_equal(info.exact_pieces, 2);
    expect(info.error >= scale && info.error <= fmax(1.000001 * scale, scale + 0x1p-1073), "%g at %g", info.error,
           scale);
    pir_pieces_destroy(pieces);
    options.pieces = 0;
    options.tolerance = 0.99 * scale;
    assert_int_equal(pir_solid_decompose(solid, &options, &info, &pieces), PIR_OK);
    expect(pir_pieces_count(pieces) == 2 && info.error == 0, "%u pieces at %g", pir_pieces_count(pieces), scale);
    pir_pieces_destroy(pieces);
    pir_solid_release(solid);
}

static void one_piece_of_an_l_is_its_hull_at_any_scale(void **state) {
    (void)state;
    static const double scale[] = {1, 1e-150, 1e150, 1e-300, 1e300, 0x1p-1070};
    for (size_t i = 0; i < sizeof scale / sizeof *scale; i++)
        expect_hull_of_an_l(scale[i]);
}

static void bad_options_are_refused(void **state) {
    (void)state;
    pir_status status;
    pir_solid *solid = l_of(NULL, 1, &status);
    pir_pieces *pieces = NULL;
    pir_decompose_options options = pir_decompose_options_default();
    assert_int_equal(pir_solid_decompose(NULL, &options, NULL, &pieces), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_decompose(solid, &options, NULL, NULL), PIR_ERR_ARGUMENT);
    options.tolerance = -1;
    assert_int_equal(pir_solid_decompose(solid, &options, NULL, &pieces), PIR_ERR_ARGUMENT);
    options.tolerance = NAN;
    assert_int_equal(pir_solid_decompose(solid, &options, NULL, &pieces), PIR_ERR_NOT_FINITE);
    options.tolerance = 0;
    options.method = (pir_decompose_method)7;
    assert_int_equal(pir_solid_decompose(solid, &options, NULL, &pieces), PIR_ERR_ARGUMENT);
    assert_null(pieces);
    pir_solid_release(solid);
}

static void every_failing_request_is_survived(void **state) {
    (void)state;
    for (uint64_t fail_at = 1, done = 0; !done; fail_at++) {
        test_memory memory = {.fail_at = fail_at};
        pir_allocator allocator = test_allocator(&memory);
        pir_decompose_options options = pir_decompose_options_default();
        pir_pieces *pieces = NULL;
        pir_status status;
        options.allocator = &allocator;
        options.pieces = 1;
        pir_solid_options of_solid = pir_solid_options_default();
        of_solid.allocator = &allocator;
        pir_solid *solid = l_of(&of_solid, 1, &status);
        if (status == PIR_OK)
            status = pir_solid_decompose(solid, &options, NULL, &pieces);
        done = status == PIR_OK;
        expect(done || status == PIR_ERR_MEMORY, "request %llu: status %d", (unsigned long long)fail_at, (int)status);
        pir_pieces_destroy(pieces);
        pir_solid_release(solid);
        expect(memory.blocks == 0 && !memory.wrong_size, "request %llu: %zu blocks left", (unsigned long long)fail_at,
               memory.blocks);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fewer_pieces_contain_the_solid_within_their_error),
        cmocka_unit_test(one_piece_of_an_l_is_its_hull_at_any_scale),
        cmocka_unit_test(bad_options_are_refused),
        cmocka_unit_test(every_failing_request_is_survived),
    };
    return cmocka_run_group_tests_name("fewer pieces", tests, NULL, NULL);
}
