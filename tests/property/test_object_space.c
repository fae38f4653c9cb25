/* SPDX-License-Identifier: MIT */
/*
 * The object-space method against the walk, facet for facet, in poses most of which are degenerate; and that a sum at
 * one rotation is the same pairs of vertices whatever sizes its operands have.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/baseline.h>
#include <pirouette/exact.h>
#include <pirouette/shape.h>

#include "dymsum/mesh/object_sum.h"
#include "support/bodies.h"
#include "support/meshes.h"

/* The mesh that the walk's pairing has. */
static pir_mesh *mesh_by_walk(pir_polytope *p, pir_polytope *q, pir_quat rotation, const pir_sum_options *options) {
    pir_sum *sum = NULL;
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_sum_create(p, q, rotation, options, &sum), PIR_OK);
    assert_int_equal(pir_sum_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
    pir_sum_destroy(sum);
    return mesh;
}

static void expect_same(const pir_mesh *object, const pir_mesh *walk, uint64_t index, const char *situation) {
    expect(pir_mesh_equal(object, walk), "case %llu, %s", (unsigned long long)index, situation);
    expect(test_hash_mesh(TEST_HASH_START, object) == test_hash_mesh(TEST_HASH_START, walk), "case %llu, %s",
           (unsigned long long)index, situation);
    mpq_t x[3], y[3];
    for (int k = 0; k < 3; k++)
        mpq_inits(x[k], y[k], NULL);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(walk); v++) {
        assert_int_equal(pir_mesh_vertex_exact(object, v, x), PIR_OK);
        assert_int_equal(pir_mesh_vertex_exact(walk, v, y), PIR_OK);
        for (int k = 0; k < 3; k++)
            expect(mpq_equal(x[k], y[k]), "case %llu, %s, vertex %u", (unsigned long long)index, situation, v);
    }
    for (int k = 0; k < 3; k++)
        mpq_clears(x[k], y[k], NULL);
}

static void every_facet_is_that_of_the_walk(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 1500; i++) {
        test_random random = test_random_case("object space", i);
        test_pose pose;
        test_random_pose(&random, i % 10 ? 10 : 40, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        pir_sum_options options = pir_sum_options_default();
        options.difference = i % 2;
        pir_mesh *walk = mesh_by_walk(p, q, pose.rotation, &options), *object = NULL;
        assert_int_equal(pir_object_sum(p, q, pose.rotation, &options, PIR_EXACT, &object), PIR_OK);
        expect_same(object, walk, i, pose.situation);
        pir_mesh_destroy(object);
        pir_mesh_destroy(walk);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

static pir_polytope *shape(const char *name) {
    pir_polytope *made = NULL;
    assert_int_equal(pir_shape_create(name, NULL, NULL, &made), PIR_OK);
    return made;
}

/* The pairs of the method's own table, aligned and by hard rotations: the poses that lose facets to rounding. */
static void platonic_solids_lose_no_facet(void **state) {
    (void)state;
    static const char *const names[] = {"tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron"};
    for (uint32_t i = 0; i < 25; i++) {
        pir_polytope *p = shape(names[i / 5]), *q = shape(names[i % 5]);
        for (uint32_t k = 0; k < TEST_HARD_ROTATIONS + 8; k++) {
            test_random random = test_random_case("platonic", 100 * i + k);
            pir_quat r = k < TEST_HARD_ROTATIONS ? test_hard_rotation(k) : test_integer_rotation(&random);
            pir_mesh *walk = mesh_by_walk(p, q, r, NULL), *object = NULL;
            assert_int_equal(pir_object_sum(p, q, r, NULL, PIR_EXACT, &object), PIR_OK);
            expect_same(object, walk, 100 * i + k, names[i % 5]);
            pir_mesh_destroy(object);
            pir_mesh_destroy(walk);
        }
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

/* --- a prototype, scaled by index --- */

/* Facets and pairs of both, one for one. */
static void expect_same_topology(const pir_mesh *prototype, const pir_mesh *fresh, uint64_t index) {
    assert_int_equal(pir_mesh_vertex_count(prototype), pir_mesh_vertex_count(fresh));
    assert_int_equal(pir_mesh_facet_count(prototype), pir_mesh_facet_count(fresh));
    for (uint32_t v = 0; v < pir_mesh_vertex_count(fresh); v++) {
        uint32_t a[2], b[2];
        pir_mesh_pair(prototype, v, a);
        pir_mesh_pair(fresh, v, b);
        expect(a[0] == b[0] && a[1] == b[1], "scale %llu, vertex %u", (unsigned long long)index, v);
    }
    for (uint32_t f = 0; f < pir_mesh_facet_count(fresh); f++) {
        uint32_t a_count, b_count;
        const uint32_t *a = pir_mesh_facet(prototype, f, &a_count), *b = pir_mesh_facet(fresh, f, &b_count);
        expect(a_count == b_count && memcmp(a, b, a_count * sizeof *a) == 0, "scale %llu, facet %u",
               (unsigned long long)index, f);
        assert_int_equal(pir_mesh_facet_kind(prototype, f), pir_mesh_facet_kind(fresh, f));
    }
}

/* R·x for the exact rotation of q. */
static void rotate_exactly(pir_quat q, mpq_t x[3]) {
    mpq_t c[4], m, n, out[3];
    const double value[4] = {q.x, q.y, q.z, q.w};
    mpq_inits(m, n, out[0], out[1], out[2], NULL);
    for (int i = 0; i < 4; i++) {
        mpq_init(c[i]);
        mpq_set_d(c[i], value[i]);
        mpq_mul(m, c[i], c[i]);
        mpq_add(n, n, m);
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            // an entry of the matrix: 2 (cᵢcⱼ ± w·cₖ), and w² − x² − y² − z² besides on the diagonal
            mpq_t entry;
            mpq_init(entry);
            mpq_mul(entry, c[i], c[j]);
            if (i != j) {
                mpq_mul(m, c[3], c[3 - i - j]);
                if ((j - i + 3) % 3 == 1)
                    mpq_sub(entry, entry, m);
                else
                    mpq_add(entry, entry, m);
            } else {
                mpq_mul(m, c[3], c[3]);
                mpq_add(entry, entry, m);
            }
            mpq_add(entry, entry, entry);
            if (i == j)
                mpq_sub(entry, entry, n);
            mpq_mul(m, entry, x[j]);
            mpq_add(out[i], out[i], m);
            mpq_clear(entry);
        }
    for (int i = 0; i < 3; i++)
        mpq_div(x[i], out[i], n);
    for (int i = 0; i < 4; i++)
        mpq_clear(c[i]);
    mpq_clears(m, n, out[0], out[1], out[2], NULL);
}

/* That each vertex of the fresh sum is R·s·p + t·q, in rationals, for the pair that the prototype names. */
static void expect_scaled_by_index(const pir_mesh *prototype, const pir_mesh *fresh, pir_polytope *const of[2],
                                   pir_quat r, const double scale[2]) {
    mpq_t x[3], y[3], by;
    mpq_inits(x[0], x[1], x[2], y[0], y[1], y[2], by, NULL);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(fresh); v++) {
        uint32_t pair[2];
        pir_mesh_pair(prototype, v, pair);
        mpq_t at[2][3];
        for (int o = 0; o < 2; o++) {
            mpq_inits(at[o][0], at[o][1], at[o][2], NULL);
            pir_polytope_vertex_exact(of[o], pair[o], at[o]);
            mpq_set_d(by, scale[o]);
            for (int k = 0; k < 3; k++)
                mpq_mul(at[o][k], at[o][k], by);
        }
        rotate_exactly(r, at[0]);
        assert_int_equal(pir_mesh_vertex_exact(fresh, v, y), PIR_OK);
        for (int k = 0; k < 3; k++) {
            mpq_add(x[k], at[0][k], at[1][k]);
            expect(mpq_equal(x[k], y[k]), "scales %.17g and %.17g, vertex %u", scale[0], scale[1], v);
        }
        for (int o = 0; o < 2; o++)
            mpq_clears(at[o][0], at[o][1], at[o][2], NULL);
    }
    mpq_clears(x[0], x[1], x[2], y[0], y[1], y[2], by, NULL);
}

/* Fresh sums at 100 random sizes of both operands against a prototype at size 1. */
static void expect_invariance(const char *p_name, const char *q_name, pir_quat r, uint64_t from) {
    pir_polytope *const of[2] = {shape(p_name), shape(q_name)};
    pir_mesh *prototype = NULL;
    assert_int_equal(pir_object_sum(of[0], of[1], r, NULL, PIR_DOUBLE, &prototype), PIR_OK);
    for (uint64_t i = from; i < from + 100; i++) {
        test_random random = test_random_case("object scale", i);
        double scale[2];
        pir_polytope *scaled[2];
        for (int o = 0; o < 2; o++) {
            // from 2^-30 to 2^30, with all bits in use
            scale[o] = ldexp(1 + test_random_unit(&random), (int)test_random_between(&random, -30, 29));
            assert_int_equal(pir_polytope_scale(of[o], scale[o], &scaled[o]), PIR_OK);
        }
        pir_mesh *fresh = NULL;
        assert_int_equal(pir_object_sum(scaled[0], scaled[1], r, NULL, PIR_EXACT, &fresh), PIR_OK);
        expect_same_topology(prototype, fresh, i);
        expect_scaled_by_index(prototype, fresh, of, r, scale);
        pir_mesh_destroy(fresh);
        pir_polytope_release(scaled[1]);
        pir_polytope_release(scaled[0]);
    }
    pir_mesh_destroy(prototype);
    pir_polytope_release(of[1]);
    pir_polytope_release(of[0]);
}

static void prototype_scaled_by_index_is_the_fresh_sum(void **state) {
    (void)state;
    const pir_quat turned = {0.1, 0.2, 0.3, 0.9}, on_a_table = {0, 0, 0.3, 0.9}, aligned = {0, 0, 0, 1};
    expect_invariance("cube", "cube", turned, 0);
    expect_invariance("cube", "cube", on_a_table, 100);
    expect_invariance("cube", "cube", aligned, 200);
    expect_invariance("tetrahedron", "cube", turned, 300);
    expect_invariance("tetrahedron", "cube", aligned, 400);
    expect_invariance("cube", "icosahedron", turned, 500);
    expect_invariance("icosahedron", "icosahedron", turned, 600);
    expect_invariance("cube", "dodecahedron", aligned, 700);
    expect_invariance("dodecahedron", "dodecahedron", turned, 800);
    expect_invariance("icosahedron", "dodecahedron", turned, 900);
}

static void bodies_that_are_not_simple_are_refused(void **state) {
    (void)state;
    pir_polytope *large = shape("geodesic?level=9"), *cube = shape("cube");
    pir_mesh *mesh = NULL;
    const pir_quat r = {0, 0, 0, 1};
    assert_int_equal(pir_object_sum(large, large, r, NULL, PIR_DOUBLE, &mesh), PIR_ERR_LIMIT);
    assert_null(mesh);
    assert_int_equal(pir_object_sum(NULL, cube, r, NULL, PIR_DOUBLE, &mesh), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_object_sum(cube, NULL, r, NULL, PIR_DOUBLE, &mesh), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_object_sum(cube, cube, r, NULL, PIR_DOUBLE, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_object_sum(cube, cube, (pir_quat){0}, NULL, PIR_DOUBLE, &mesh), PIR_ERR_ZERO_QUATERNION);
    assert_int_equal(pir_object_sum(cube, cube, (pir_quat){NAN, 0, 0, 1}, NULL, PIR_DOUBLE, &mesh), PIR_ERR_NOT_FINITE);
    assert_null(mesh);
    // one operand may be large
    assert_int_equal(pir_object_sum(large, cube, r, NULL, PIR_DOUBLE, &mesh), PIR_OK);
    pir_mesh_destroy(mesh);
    pir_polytope_release(cube);
    pir_polytope_release(large);
}

static void euler_tells_a_sum_without_a_facet_or_an_edge(void **state) {
    (void)state;
    pir_polytope *cube = shape("cube");
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_object_sum(cube, cube, (pir_quat){1, 2, 3, 4}, NULL, PIR_DOUBLE, &mesh), PIR_OK);
    assert_true(pir_mesh_is_whole(mesh));
    const uint32_t facets = mesh->facets.count;
    mesh->facets.count--;
    assert_false(pir_mesh_is_whole(mesh));
    mesh->facets.count = facets;
    mesh->facets.start[facets]--;
    assert_false(pir_mesh_is_whole(mesh));
    mesh->facets.start[facets]++;
    mesh->vertex_count--;
    assert_false(pir_mesh_is_whole(mesh));
    mesh->vertex_count++;
    pir_mesh_destroy(mesh);
    pir_polytope_release(cube);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_facet_is_that_of_the_walk),
        cmocka_unit_test(platonic_solids_lose_no_facet),
        cmocka_unit_test(prototype_scaled_by_index_is_the_fresh_sum),
        cmocka_unit_test(bodies_that_are_not_simple_are_refused),
        cmocka_unit_test(euler_tells_a_sum_without_a_facet_or_an_edge),
    };
    return cmocka_run_group_tests_name("object space", tests, NULL, NULL);
}
