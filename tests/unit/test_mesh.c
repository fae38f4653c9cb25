/* SPDX-License-Identifier: MIT */
/* Meshes of sums whose shape is known: merged facets, flat and thin bodies, what each facet came
   from, exact coordinates. */
#include "support/test.h"

#include <math.h>

#include <pirouette/baseline.h>
#include <pirouette/exact.h>

#include "support/bodies.h"
#include "support/meshes.h"

static const pir_quat identity = {0, 0, 0, 1}, turn_about_z = {0, 0, 1, 3};

static pir_polytope *make_cube(void) {
    pir_vec3 points[8];
    for (int i = 0; i < 8; i++)
        points[i] = (pir_vec3){i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1};
    return test_hull(points, 8);
}

/* The mesh of the sum, proven, with these counts; the operands are released. */
static pir_mesh *expect_sum(pir_polytope *p, pir_polytope *q, pir_quat rotation, uint32_t vertices, uint32_t edges,
                            uint32_t facets) {
    pir_sum *sum = NULL;
    pir_mesh *mesh = NULL, *hull = NULL;
    assert_int_equal(pir_sum_create(p, q, rotation, NULL, &sum), PIR_OK);
    assert_int_equal(pir_sum_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
    assert_int_equal(pir_hull_sum(p, q, rotation, NULL, PIR_EXACT, &hull), PIR_OK);
    const char *wrong = test_prove_mesh(sum, mesh);
    expect(!wrong, "%s", wrong);
    assert_true(pir_mesh_equal(mesh, hull) && pir_mesh_is_exact(mesh));
    assert_int_equal(pir_mesh_vertex_count(mesh), vertices);
    assert_int_equal(pir_mesh_edge_count(mesh), edges);
    assert_int_equal(pir_mesh_facet_count(mesh), facets);
    pir_mesh_destroy(hull);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return mesh;
}

static void two_aligned_cubes_make_a_cube(void **state) {
    (void)state;
    pir_mesh *mesh = expect_sum(make_cube(), make_cube(), identity, 8, 12, 6);
    for (uint32_t f = 0; f < 6; f++)
        assert_int_equal(pir_mesh_facet_kind(mesh, f), PIR_FACET_MERGED);
    for (uint32_t v = 0; v < 8; v++) {
        pir_vec3 x = pir_mesh_vertices(mesh)[v];
        assert_true(fabs(x.x) == 2 && fabs(x.y) == 2 && fabs(x.z) == 2);
    }
    pir_mesh_destroy(mesh);
    // a quarter turn, a third of a turn about the diagonal, a half turn: all map the cube to itself
    pir_mesh_destroy(expect_sum(make_cube(), make_cube(), (pir_quat){0, 0, 1, 1}, 8, 12, 6));
    pir_mesh_destroy(expect_sum(make_cube(), make_cube(), (pir_quat){1, 1, 1, 1}, 8, 12, 6));
    pir_mesh_destroy(expect_sum(make_cube(), make_cube(), (pir_quat){0, 5e-324, 0, 0}, 8, 12, 6));
}

static void cube_turned_on_a_table_makes_an_octagonal_prism(void **state) {
    (void)state;
    pir_mesh *mesh = expect_sum(make_cube(), make_cube(), turn_about_z, 16, 24, 10);
    uint32_t quads = 0, octagons = 0, count;
    for (uint32_t f = 0; f < 10; f++) {
        pir_mesh_facet(mesh, f, &count);
        quads += count == 4;
        octagons += count == 8;
    }
    assert_true(quads == 8 && octagons == 2);
    pir_mesh_destroy(mesh);
}

static void cubes_in_general_position_show_every_pair(void **state) {
    (void)state;
    test_random random = test_random_case("mesh cubes", 0);
    for (int i = 0; i < 20; i++) {
        pir_polytope *p = make_cube(), *q = make_cube();
        pir_sum *sum = NULL;
        pir_mesh *mesh = NULL;
        assert_int_equal(pir_sum_create(p, q, test_general_rotation(&random), NULL, &sum), PIR_OK);
        assert_int_equal(pir_sum_mesh(sum, PIR_DOUBLE, &mesh), PIR_OK);
        uint32_t kinds[4] = {0, 0, 0, 0};
        for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++)
            kinds[pir_mesh_facet_kind(mesh, f)]++;
        assert_int_equal(kinds[PIR_FACET_FV], 6);
        assert_int_equal(kinds[PIR_FACET_VF], 6);
        assert_int_equal(kinds[PIR_FACET_EE], pir_sum_ee_count(sum));
        assert_int_equal(kinds[PIR_FACET_MERGED], 0);
        assert_false(pir_mesh_is_exact(mesh));
        mpq_t x[3];
        mpq_inits(x[0], x[1], x[2], NULL);
        assert_int_equal(pir_mesh_vertex_exact(mesh, 0, x), PIR_ERR_ARGUMENT);
        mpq_clears(x[0], x[1], x[2], NULL);
        pir_mesh_destroy(mesh);
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

static void point_moves_a_body_and_leaves_its_facets(void **state) {
    (void)state;
    const pir_vec3 point = {10, 20, -30};
    pir_mesh_destroy(expect_sum(make_cube(), test_hull(&point, 1), turn_about_z, 8, 12, 6));
    pir_mesh_destroy(expect_sum(test_hull(&point, 1), make_cube(), turn_about_z, 8, 12, 6));
    pir_mesh_destroy(expect_sum(test_hull(&point, 1), test_hull(&point, 1), turn_about_z, 1, 0, 0));
}

static void segments_make_a_segment_or_a_parallelogram(void **state) {
    (void)state;
    const pir_vec3 along_x[] = {{0, 0, 0}, {1, 0, 0}}, along_y[] = {{0, 2, 0}, {0, 0, 0}};
    pir_mesh_destroy(expect_sum(test_hull(along_x, 2), test_hull(along_x, 2), identity, 2, 1, 0));
    pir_mesh_destroy(expect_sum(test_hull(along_x, 2), test_hull(along_x, 2), (pir_quat){0, 0, 1, 0}, 2, 1, 0));
    pir_mesh_destroy(expect_sum(test_hull(along_x, 2), test_hull(along_y, 2), identity, 4, 4, 2));
    pir_mesh_destroy(expect_sum(test_hull(along_x, 2), test_hull(along_y, 2), (pir_quat){0, 0, 1, 1}, 2, 1, 0));
}

static void segment_along_an_edge_of_a_cube_stretches_it(void **state) {
    (void)state;
    const pir_vec3 along_x[] = {{0, 0, 0}, {1, 0, 0}}, askew[] = {{0, 0, 0}, {1, 2, 3}};
    pir_mesh_destroy(expect_sum(make_cube(), test_hull(along_x, 2), identity, 8, 12, 6));
    pir_mesh_destroy(expect_sum(test_hull(along_x, 2), make_cube(), (pir_quat){0, 0, 1, 1}, 8, 12, 6));
    // a hexagonal outline swept: two corners of the cube get three edges more
    pir_mesh_destroy(expect_sum(make_cube(), test_hull(askew, 2), identity, 14, 24, 12));
}

static void polygons_of_one_plane_make_a_polygon(void **state) {
    (void)state;
    const pir_vec3 square[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                   triangle[] = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
    pir_mesh_destroy(expect_sum(test_hull(square, 4), test_hull(square, 4), identity, 4, 4, 2));
    pir_mesh_destroy(expect_sum(test_hull(square, 4), test_hull(square, 4), turn_about_z, 8, 8, 2));
    pir_mesh_destroy(expect_sum(test_hull(square, 4), test_hull(triangle, 3), identity, 5, 5, 2));
    // upright on each other they make a prism
    pir_mesh_destroy(expect_sum(test_hull(square, 4), test_hull(square, 4), (pir_quat){1, 0, 0, 1}, 8, 12, 6));
}

static void tetrahedron_and_its_mirror_image_make_a_cuboctahedron(void **state) {
    (void)state;
    const pir_vec3 one[] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    const pir_vec3 other[] = {{-1, -1, -1}, {-1, 1, 1}, {1, -1, 1}, {1, 1, -1}};
    pir_mesh *mesh = expect_sum(test_hull(one, 4), test_hull(other, 4), identity, 12, 24, 14);
    uint32_t triangles = 0, quads = 0, count;
    for (uint32_t f = 0; f < 14; f++) {
        pir_mesh_facet(mesh, f, &count);
        triangles += count == 3;
        quads += count == 4;
    }
    assert_true(triangles == 8 && quads == 6);
    pir_mesh_destroy(mesh);
    // with itself it only grows
    pir_mesh_destroy(expect_sum(test_hull(one, 4), test_hull(one, 4), identity, 4, 6, 4));
}

static void mesh_of_a_polytope_is_the_polytope(void **state) {
    (void)state;
    pir_polytope *cube = make_cube();
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_mesh_from_polytope(cube, &mesh), PIR_OK);
    assert_int_equal(pir_mesh_vertex_count(mesh), 8);
    assert_int_equal(pir_mesh_edge_count(mesh), 12);
    assert_int_equal(pir_mesh_facet_count(mesh), 6);
    assert_true(pir_mesh_is_exact(mesh) && pir_mesh_equal(mesh, mesh));
    uint32_t pair[2];
    for (uint32_t v = 0; v < 8; v++) {
        pir_mesh_pair(mesh, v, pair);
        assert_true(pair[0] == v && pair[1] == 0);
    }
    mpq_t x[3];
    mpq_inits(x[0], x[1], x[2], NULL);
    assert_int_equal(pir_mesh_vertex_exact(mesh, 8, x), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_mesh_vertex_exact(mesh, 0, x), PIR_OK);
    assert_true(mpq_cmp_si(x[0], -1, 1) == 0 && mpq_cmp_si(x[1], -1, 1) == 0 && mpq_cmp_si(x[2], -1, 1) == 0);
    mpq_clears(x[0], x[1], x[2], NULL);
    pir_mesh_destroy(mesh);
    pir_polytope_release(cube);
}

static void equality_sees_a_moved_vertex_and_another_body(void **state) {
    (void)state;
    pir_vec3 points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    pir_polytope *a = test_hull(points, 4), *cube = make_cube();
    points[3].z = nextafter(1, 2);
    pir_polytope *b = test_hull(points, 4);
    pir_mesh *one, *other, *box;
    assert_int_equal(pir_mesh_from_polytope(a, &one), PIR_OK);
    assert_int_equal(pir_mesh_from_polytope(b, &other), PIR_OK);
    assert_int_equal(pir_mesh_from_polytope(cube, &box), PIR_OK);
    assert_false(pir_mesh_equal(one, other));
    assert_false(pir_mesh_equal(one, box));
    pir_mesh_destroy(box);
    pir_mesh_destroy(other);
    pir_mesh_destroy(one);
    pir_polytope_release(b);
    pir_polytope_release(cube);
    pir_polytope_release(a);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_aligned_cubes_make_a_cube),
        cmocka_unit_test(cube_turned_on_a_table_makes_an_octagonal_prism),
        cmocka_unit_test(cubes_in_general_position_show_every_pair),
        cmocka_unit_test(point_moves_a_body_and_leaves_its_facets),
        cmocka_unit_test(segments_make_a_segment_or_a_parallelogram),
        cmocka_unit_test(segment_along_an_edge_of_a_cube_stretches_it),
        cmocka_unit_test(polygons_of_one_plane_make_a_polygon),
        cmocka_unit_test(tetrahedron_and_its_mirror_image_make_a_cuboctahedron),
        cmocka_unit_test(mesh_of_a_polytope_is_the_polytope),
        cmocka_unit_test(equality_sees_a_moved_vertex_and_another_body),
    };
    return cmocka_run_group_tests_name("mesh", tests, NULL, NULL);
}
