/* SPDX-License-Identifier: MIT */
/*
 * Points asked about on maps of sums, against oracles that know nothing of maps. A point is outside when it is a vertex
 * of the hull of the sum and itself, and on the boundary when it lies in the plane of a facet, by rationals. Or, for
 * solid sums: a point is outside when it is beyond the plane of a facet, and on the boundary when it is in one and
 * beyond none.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/cgm.h>
#include <pirouette/exact.h>

#include "exact/rotation.h"
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

/* The side of the witness's plane that a point is on: 1 beyond it. */
static int side_of_witness(const pir_cgm *cgm, uint32_t witness, pir_vec3 point) {
    mpq_t plane[4], x[3];
    mpq_inits(plane[0], plane[1], plane[2], plane[3], x[0], x[1], x[2], NULL);
    assert_int_equal(pir_cgm_vertex_plane_exact(cgm, witness, plane), PIR_OK);
    set_point(x, point);
    for (int k = 0; k < 3; k++) {
        mpq_mul(x[k], x[k], plane[k]);
        mpq_sub(plane[3], plane[3], x[k]);
    }
    int side = -mpq_sgn(plane[3]);
    mpq_clears(plane[0], plane[1], plane[2], plane[3], x[0], x[1], x[2], NULL);
    return side;
}

/* A point near the mesh: a vertex, a middle of two or three corners, a grid point, one off by rounding from
   any of these, or far off. */
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

/* Two bodies, the map of their sum with its mesh, and what locates points in it. */
struct located {
    pir_polytope *p, *q;
    pir_cgm *a, *b, *sum;
    pir_mesh *mesh;
    pir_cgm_locator *locator;
};

/* Takes the references to both bodies. P is turned by *rotation, where there is one. */
static struct located located_new(pir_polytope *p, const pir_quat *rotation, pir_polytope *q) {
    struct located l = {.p = p, .q = q};
    assert_int_equal(pir_cgm_create(p, rotation, NULL, &l.a), PIR_OK);
    assert_int_equal(pir_cgm_create(q, NULL, NULL, &l.b), PIR_OK);
    assert_int_equal(pir_cgm_overlay(l.a, l.b, &l.sum), PIR_OK);
    assert_int_equal(pir_cgm_mesh(l.sum, PIR_EXACT, &l.mesh), PIR_OK);
    assert_int_equal(pir_cgm_locator_create(l.sum, &l.locator), PIR_OK);
    return l;
}

static void located_free(struct located *l) {
    pir_cgm_locator_destroy(l->locator);
    pir_mesh_destroy(l->mesh);
    pir_cgm_release(l->sum);
    pir_cgm_release(l->b);
    pir_cgm_release(l->a);
    pir_polytope_release(l->q);
    pir_polytope_release(l->p);
}

/* How often points were outside, on the boundary and inside. */
static void expect_seen(const uint32_t seen[3], uint32_t outside, uint32_t boundary, uint32_t inside) {
    print_message("# %u outside, %u on the boundary, %u inside\n", seen[0], seen[1], seen[2]);
    assert_true(seen[0] > outside && seen[1] > boundary && seen[2] > inside);
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
        struct located l = located_new(test_polytope(&pose.p), &pose.rotation, test_polytope(&pose.q));
        const pir_mesh *mesh = l.mesh;
        mpq_t *points = exact_vertices(mesh);
        uint32_t witness = PIR_CGM_NONE;
        for (int k = 0; k < 12; k++) {
            pir_vec3 point = some_point(&random, mesh);
            if (!isfinite(point.x) || !isfinite(point.y) || !isfinite(point.z))
                continue;
            pir_cgm_location warm, cold;
            assert_int_equal(pir_cgm_locate(l.locator, point, witness, &warm), PIR_OK);
            assert_int_equal(pir_cgm_locate(l.locator, point, PIR_CGM_NONE, &cold), PIR_OK);
            pir_cgm_position expected = oracle(mesh, points, point);
            expect(warm.position == expected && cold.position == expected, "case %llu point %d, %s: %d %d, not %d",
                   (unsigned long long)i, k, pose.situation, (int)warm.position, (int)cold.position, (int)expected);
            seen[expected]++;
            witness = warm.witness;
            int side = expected == PIR_CGM_OUTSIDE ? 1 : expected == PIR_CGM_BOUNDARY ? 0 : -1;
            expect(side_of_witness(l.sum, warm.witness, point) == side &&
                       side_of_witness(l.sum, cold.witness, point) == side,
                   "case %llu point %d, %s: the witness is no witness", (unsigned long long)i, k, pose.situation);
            pir_cgm_location again;
            assert_int_equal(pir_cgm_locate(l.locator, point, witness, &again), PIR_OK);
            // a walk that starts where it must end stays there
            expect(again.witness == witness && again.position == expected, "case %llu point %d", (unsigned long long)i,
                   k);
        }
        for (uint32_t k = 0; k < 3 * (pir_mesh_vertex_count(mesh) + 1); k++)
            mpq_clear(points[k]);
        free(points);
        located_free(&l);
    }
    expect_seen(seen, 300, 300, 300);
}

/* --- points an ulp off facets, edges and vertices --- */

/* The planes of a solid mesh's facets, outwards: n·x − h in at[4f..4f+3], n and then h. */
struct planes {
    uint32_t count;
    mpq_t *at;
};

static struct planes planes_of(const pir_mesh *mesh) {
    mpq_t *points = exact_vertices(mesh), a[3], b[3], part;
    struct planes planes = {pir_mesh_facet_count(mesh), NULL};
    planes.at = malloc(4 * ((size_t)planes.count + 1) * sizeof *planes.at);
    mpq_inits(a[0], a[1], a[2], b[0], b[1], b[2], part, NULL);
    for (uint32_t f = 0; f < planes.count; f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        const mpq_t *x = (const mpq_t *)points + 3 * (size_t)corner[0];
        mpq_t *plane = planes.at + 4 * (size_t)f;
        for (int k = 0; k < 4; k++)
            mpq_init(plane[k]);
        for (int k = 0; k < 3; k++) {
            mpq_sub(a[k], points[3 * (size_t)corner[1] + (size_t)k], x[k]);
            mpq_sub(b[k], points[3 * (size_t)corner[2] + (size_t)k], x[k]);
        }
        for (int k = 0; k < 3; k++) {
            mpq_mul(plane[k], a[(k + 1) % 3], b[(k + 2) % 3]);
            mpq_mul(part, a[(k + 2) % 3], b[(k + 1) % 3]);
            mpq_sub(plane[k], plane[k], part);
            mpq_mul(part, plane[k], x[k]);
            mpq_add(plane[3], plane[3], part);
        }
    }
    mpq_clears(a[0], a[1], a[2], b[0], b[1], b[2], part, NULL);
    for (uint32_t k = 0; k < 3 * (pir_mesh_vertex_count(mesh) + 1); k++)
        mpq_clear(points[k]);
    free(points);
    return planes;
}

static void free_planes(struct planes *planes) {
    for (uint32_t k = 0; k < 4 * planes->count; k++)
        mpq_clear(planes->at[k]);
    free(planes->at);
}

/* Where a point is by the signs of n·x − h. */
static pir_cgm_position by_planes(const struct planes *planes, pir_vec3 point) {
    mpq_t x[3], height, part;
    mpq_inits(x[0], x[1], x[2], height, part, NULL);
    set_point(x, point);
    pir_cgm_position position = PIR_CGM_INSIDE;
    for (uint32_t f = 0; f < planes->count && position != PIR_CGM_OUTSIDE; f++) {
        mpq_neg(height, planes->at[4 * (size_t)f + 3]);
        for (int k = 0; k < 3; k++) {
            mpq_mul(part, planes->at[4 * (size_t)f + (size_t)k], x[k]);
            mpq_add(height, height, part);
        }
        position = mpq_sgn(height) > 0 ? PIR_CGM_OUTSIDE : mpq_sgn(height) == 0 ? PIR_CGM_BOUNDARY : position;
    }
    mpq_clears(x[0], x[1], x[2], height, part, NULL);
    return position;
}

/* As near a point of facet f as doubles come: of its inside, of an edge or a vertex; each coordinate
   perhaps an ulp or two off. */
static pir_vec3 point_beside(test_random *random, const pir_mesh *mesh, uint32_t f) {
    uint32_t n, kind = test_random_below(random, 3);
    const uint32_t *corner = pir_mesh_facet(mesh, f, &n);
    const pir_vec3 *vertex = pir_mesh_vertices(mesh);
    uint32_t i = test_random_below(random, n);
    pir_vec3 a = vertex[corner[i]], b = vertex[corner[(i + 1) % n]], c = vertex[corner[(i + 2) % n]];
    double s = kind > 0 ? fabs(test_random_unit(random)) / 2 : 0, t = kind > 1 ? fabs(test_random_unit(random)) / 2 : 0;
    double x[3] = {a.x + s * (b.x - a.x) + t * (c.x - a.x), a.y + s * (b.y - a.y) + t * (c.y - a.y),
                   a.z + s * (b.z - a.z) + t * (c.z - a.z)};
    for (int k = 0; k < 3; k++)
        for (uint32_t steps = test_random_below(random, 3), up = test_random_below(random, 2); steps > 0; steps--)
            x[k] = nextafter(x[k], up ? HUGE_VAL : -HUGE_VAL);
    return (pir_vec3){x[0], x[1], x[2]};
}

/* Random bodies, as they are, far away, or of mixed size; some on grids, so that ulps cancel. */
static pir_polytope *solid_body(test_random *random) {
    static const test_body kinds[] = {TEST_SPHERE, TEST_BALL,   TEST_GRID,  TEST_PRISM,
                                      TEST_FAR,    TEST_NEEDLE, TEST_SCALED};
    pir_polytope *p = test_random_polytope(random, kinds[test_random_below(random, 7)], 14);
    while (pir_polytope_dimension(p) < 3) {
        pir_polytope_release(p);
        p = test_random_polytope(random, TEST_SPHERE, 14);
    }
    return p;
}

/* Both bodies far from the origin, their sum near it: what is added up is large beside the sum. */
static void move_apart(test_random *random, pir_quat rotation, pir_polytope **p, pir_polytope **q) {
    pir_vec3 points[TEST_POINTS_MAX], far = test_random_direction(random);
    pir_rotation turn;
    assert_int_equal(pir_rotation_set(&turn, rotation), PIR_OK);
    double distance = ldexp(1, test_random_between(random, 10, 40));
    for (int side = 0; side < 2; side++) {
        pir_polytope **body = side ? q : p;
        pir_vec3 by = pir_vec_scale(far, side ? distance : -distance);
        by = side ? by : pir_mat_apply_transposed(&turn.r, by);
        uint32_t n = pir_polytope_vertex_count(*body);
        for (uint32_t v = 0; v < n; v++)
            points[v] = pir_vec_add(pir_polytope_vertex(*body, v), by);
        pir_polytope_release(*body);
        assert_int_equal(pir_polytope_create(points, n, NULL, body), PIR_OK);
    }
}

/* Where doubles end: a grid of the smallest numbers there are, or a few times that. */
static void shrink(test_random *random, pir_polytope **body) {
    pir_vec3 points[TEST_POINTS_MAX];
    uint32_t n = pir_polytope_vertex_count(*body);
    double unit = ldexp(1, test_random_between(random, -1074, -1040));
    for (uint32_t v = 0; v < n; v++) {
        pir_vec3 x = pir_polytope_vertex(*body, v);
        points[v] = (pir_vec3){x.x * unit, x.y * unit, x.z * unit};
    }
    pir_polytope_release(*body);
    assert_int_equal(pir_polytope_create(points, n, NULL, body), PIR_OK);
}

static void points_an_ulp_off_are_placed_exactly(void **state) {
    (void)state;
    uint32_t seen[3] = {0, 0, 0};
    for (uint64_t i = 0; i < 200; i++) {
        test_random random = test_random_case("cgm ulps", i);
        pir_polytope *p = solid_body(&random), *q = solid_body(&random);
        pir_quat rotation = i % 4 ? test_rotation(&random) : (pir_quat){0, 0, 0, 1};
        if (i % 5 == 1)
            move_apart(&random, rotation, &p, &q);
        if (i % 5 == 2) {
            pir_polytope_release(p);
            pir_polytope_release(q);
            p = test_random_polytope(&random, TEST_BOX, 8);
            q = test_random_polytope(&random, TEST_OCTAHEDRON, 8);
            shrink(&random, &p);
            shrink(&random, &q);
        }
        struct located l = located_new(p, i % 4 ? &rotation : NULL, q);
        const pir_mesh *mesh = l.mesh;
        struct planes planes = planes_of(mesh);
        uint32_t witness = PIR_CGM_NONE;
        // small bodies may become flat where doubles are far apart
        bool solid = pir_mesh_facet_count(mesh) > 3;
        for (int k = 0; k < 60 && solid; k++) {
            uint32_t f = test_random_below(&random, pir_mesh_facet_count(mesh));
            pir_vec3 point = point_beside(&random, mesh, f);
            pir_cgm_location location;
            pir_cgm_position expected = by_planes(&planes, point);
            assert_int_equal(pir_cgm_locate(l.locator, point, k % 2 ? witness : PIR_CGM_NONE, &location), PIR_OK);
            expect(location.position == expected, "case %llu point %d: %d, not %d", (unsigned long long)i, k,
                   (int)location.position, (int)expected);
            witness = location.witness;
            seen[expected]++;
        }
        free_planes(&planes);
        located_free(&l);
    }
    expect_seen(seen, 500, 50, 500);
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
        // a walk comes to no facet twice
        assert_true(a.steps < pir_polytope_facet_count(p) && b.steps < pir_polytope_facet_count(p));
        warm += a.steps;
        cold += b.steps;
        witness = a.witness;
    }
    expect(10 * warm < cold, "%llu steps with witnesses, %llu without", (unsigned long long)warm,
           (unsigned long long)cold);
    pir_cgm_locator_destroy(locator);
    pir_cgm_release(cgm);
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
    pir_cgm_release(cgm);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(positions_are_exact),
        cmocka_unit_test(points_an_ulp_off_are_placed_exactly),
        cmocka_unit_test(witnesses_make_walks_short),
        cmocka_unit_test(bad_questions_are_refused),
    };
    return cmocka_run_group_tests_name("cgm locate", tests, NULL, NULL);
}
