/* SPDX-License-Identifier: MIT */
/*
 * Points asked about on maps of sums, against an oracle that knows nothing of maps: a point is outside when it is a vertex of the hull of the
 * sum and itself, and on the boundary when it lies in the plane of a facet, by rationals.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/cgm.h>
#include <pirouette/exact.h>

#include "support/bodies.h"

static void set_point(mpq_t x[3], pir_vec3 p) {
    mpq_set_d(x[0], p.x);
    mpq_set_d(x[1], p.y);
    mpq_set_d(x[2], p.z);
}

/* The sign of det(b − a, c − a, d − a). */
static int orientation(const mpq_t *a, const mpq_t *b, const mpq_t *c, const mpq_t *d) {
    mpq_t m[3][3], sum, part;
    mpq_inits(sum, part, NULL);
    const mpq_t *rows[3] = {b, c, d};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            mpq_init(m[i][j]);
            mpq_sub(m[i][j], rows[i][j], a[j]);
        }
    for (int i = 0; i < 3; i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            mpq_mul(part, m[1][(i + (sign > 0 ? 1 : 2)) % 3], m[2][(i + (sign > 0 ? 2 : 1)) % 3]);
            mpq_mul(part, part, m[0][i]);
            sign > 0 ? mpq_add(sum, sum, part) : mpq_sub(sum, sum, part);
        }
    int sign = mpq_sgn(sum);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            mpq_clear(m[i][j]);
    mpq_clears(sum, part, NULL);
    return sign;
}

/* The exact vertices of a mesh, with room for one point more. */
static mpq_t *exact_vertices(const pir_mesh *mesh) {
    uint32_t n = pir_mesh_vertex_count(mesh);
    mpq_t *points = malloc(3 * ((size_t)n + 1) * sizeof *points);
    for (uint32_t k = 0; k < 3 * (n + 1); k++)
        mpq_init(points[k]);
    for (uint32_t v = 0; v < n; v++)
        assert_int_equal(pir_mesh_vertex_exact(mesh, v, points + 3 * (size_t)v), PIR_OK);
    return points;
}

static pir_cgm_position oracle(const pir_mesh *mesh, mpq_t *points, pir_vec3 point) {
    uint32_t n = pir_mesh_vertex_count(mesh);
    set_point(points + 3 * (size_t)n, point);
    pir_polytope *hull = NULL;
    assert_int_equal(pir_polytope_create_exact((const mpq_t *)points, (size_t)n + 1, NULL, &hull), PIR_OK);
    pir_cgm_position position = pir_polytope_dimension(hull) < 3 ? PIR_CGM_BOUNDARY : PIR_CGM_INSIDE;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(hull); v++)
        if (pir_polytope_source(hull, v) == n)
            position = PIR_CGM_OUTSIDE;
    pir_polytope_release(hull);
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh) && position == PIR_CGM_INSIDE; f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        if (orientation((const mpq_t *)points + 3 * (size_t)corner[0], (const mpq_t *)points + 3 * (size_t)corner[1],
                        (const mpq_t *)points + 3 * (size_t)corner[2], (const mpq_t *)points + 3 * (size_t)n) == 0)
            position = PIR_CGM_BOUNDARY;
    }
    return position;
}

/* A point near the mesh: a vertex, a middle of two or three corners, a grid point, one a hair away from any of these, or far off. */
static pir_vec3 some_point(test_random *random, const pir_mesh *mesh) {
    const pir_vec3 *vertex = pir_mesh_vertices(mesh);
    uint32_t n = pir_mesh_vertex_count(mesh), kind = test_random_below(random, 6);
    pir_vec3 a = vertex[test_random_below(random, n)], b = vertex[test_random_below(random, n)];
    if (kind > 0)
        a = (pir_vec3){(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
    if (kind == 2)
        a = (pir_vec3){rint(a.x), rint(a.y), rint(a.z)};
    if (kind == 3)
        a.x += a.x * 0x1p-52;
    if (kind == 4)
        a = (pir_vec3){2 * a.x - b.x, 3 * a.y, a.z};
    if (kind == 5)
        a.z *= 1 + 1e-3 * test_random_unit(random);
    return a;
}

static void positions_are_exact(void **state) {
    (void)state;
    uint32_t seen[3] = {0, 0, 0};
    for (uint64_t i = 0; i < 300; i++) {
        test_random random = test_random_case("cgm locate", i);
        test_pose pose;
        test_random_pose(&random, 4 + test_random_below(&random, 8), &pose);
        if (i % 2)
            pose.rotation = (pir_quat){0, 0, (double)(i % 3), 1};
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        pir_cgm *a, *b, *sum;
        pir_mesh *mesh;
        pir_cgm_locator *locator;
        assert_int_equal(pir_cgm_create(p, &pose.rotation, NULL, &a), PIR_OK);
        assert_int_equal(pir_cgm_create(q, NULL, NULL, &b), PIR_OK);
        assert_int_equal(pir_cgm_overlay(a, b, &sum), PIR_OK);
        assert_int_equal(pir_cgm_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
        assert_int_equal(pir_cgm_locator_create(sum, &locator), PIR_OK);
        mpq_t *points = exact_vertices(mesh);
        uint32_t witness = PIR_CGM_NONE;
        for (int k = 0; k < 12; k++) {
            pir_vec3 point = some_point(&random, mesh);
            if (!isfinite(point.x) || !isfinite(point.y) || !isfinite(point.z))
                continue;
            pir_cgm_location warm, cold;
            assert_int_equal(pir_cgm_locate(locator, point, witness, &warm), PIR_OK);
            assert_int_equal(pir_cgm_locate(locator, point, PIR_CGM_NONE, &cold), PIR_OK);
            pir_cgm_position expected = oracle(mesh, points, point);
            expect(warm.position == expected && cold.position == expected, "case %llu point %d, %s: %d %d, not %d",
                   (unsigned long long)i, k, pose.situation, (int)warm.position, (int)cold.position, (int)expected);
            seen[expected]++;
            witness = warm.witness;
            pir_cgm_location again;
            assert_int_equal(pir_cgm_locate(locator, point, witness, &again), PIR_OK);
            // a walk that starts where it must end stays there
            expect(again.witness == witness && again.position == expected, "case %llu point %d", (unsigned long long)i,
                   k);
        }
        for (uint32_t k = 0; k < 3 * (pir_mesh_vertex_count(mesh) + 1); k++)
            mpq_clear(points[k]);
        free(points);
        pir_cgm_locator_destroy(locator);
        pir_mesh_destroy(mesh);
        pir_cgm_destroy(sum);
        pir_cgm_destroy(b);
        pir_cgm_destroy(a);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    print_message("# %u outside, %u on the boundary, %u inside\n", seen[0], seen[1], seen[2]);
    assert_true(seen[0] > 300 && seen[1] > 300 && seen[2] > 300);
}

static void witnesses_make_walks_short(void **state) {
    (void)state;
    test_random random = test_random_case("cgm witness", 0);
    pir_polytope *p = test_sphere(&random, 300);
    pir_cgm *cgm;
    pir_cgm_locator *locator;
    assert_int_equal(pir_cgm_create(p, NULL, NULL, &cgm), PIR_OK);
    assert_int_equal(pir_cgm_locator_create(cgm, &locator), PIR_OK);
    uint64_t warm = 0, cold = 0;
    uint32_t witness = PIR_CGM_NONE;
    for (int i = 0; i < 1000; i++) {
        // round and round, a little off the circle
        double t = i * 0.002;
        pir_vec3 point = {(1 - t * t) / (1 + t * t), 2 * t / (1 + t * t), 0.3};
        pir_cgm_location a, b;
        assert_int_equal(pir_cgm_locate(locator, point, witness, &a), PIR_OK);
        assert_int_equal(pir_cgm_locate(locator, point, PIR_CGM_NONE, &b), PIR_OK);
        assert_int_equal(a.position, b.position);
        warm += a.steps;
        cold += b.steps;
        witness = a.witness;
    }
    expect(10 * warm < cold, "%llu steps with witnesses, %llu without", (unsigned long long)warm,
           (unsigned long long)cold);
    pir_cgm_locator_destroy(locator);
    pir_cgm_destroy(cgm);
    pir_polytope_release(p);
}

static void bad_questions_are_refused(void **state) {
    (void)state;
    test_random random = test_random_case("cgm questions", 0);
    pir_polytope *p = test_sphere(&random, 10);
    pir_cgm *cgm;
    pir_cgm_locator *locator;
    pir_cgm_location location = {PIR_CGM_INSIDE, 77, 77};
    assert_int_equal(pir_cgm_create(p, NULL, NULL, &cgm), PIR_OK);
    assert_int_equal(pir_cgm_locator_create(NULL, &locator), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cgm_locator_create(cgm, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cgm_locator_create(cgm, &locator), PIR_OK);
    assert_int_equal(pir_cgm_locate(locator, (pir_vec3){NAN, 0, 0}, PIR_CGM_NONE, &location), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_cgm_locate(locator, (pir_vec3){0, 0, 0}, 1u << 30, &location), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cgm_locate(NULL, (pir_vec3){0, 0, 0}, PIR_CGM_NONE, &location), PIR_ERR_ARGUMENT);
    assert_int_equal(location.witness, 77);
    pir_cgm_locator_destroy(locator);
    pir_cgm_locator_destroy(NULL);
    pir_cgm_destroy(cgm);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(positions_are_exact),
        cmocka_unit_test(witnesses_make_walks_short),
        cmocka_unit_test(bad_questions_are_refused),
    };
    return cmocka_run_group_tests_name("cgm locate", tests, NULL, NULL);
}
