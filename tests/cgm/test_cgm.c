/* SPDX-License-Identifier: MIT */
/* Cubical Gaussian maps whose shape is known: counts, normals on cube edges and corners, flat bodies, the
   public traversal, bad calls. */
#include "support/test.h"

#include <math.h>

#include <pirouette/cgm.h>
#include <pirouette/shape.h>
#include <pirouette/sum.h>

#include "cgm/build.h"
#include "support/bodies.h"
#include "support/memory.h"

static const pir_quat identity = {0, 0, 0, 1};

#define BODY(...) test_hull((pir_vec3[]){__VA_ARGS__}, sizeof((pir_vec3[]){__VA_ARGS__}) / sizeof(pir_vec3))

static pir_polytope *octahedron(void) {
    return BODY({1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1});
}

static pir_polytope *cube(void) {
    return BODY({-1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {-1, 1, 1}, {1, -1, -1}, {1, -1, 1}, {1, 1, -1}, {1, 1, 1});
}

static pir_cgm *map_of(pir_polytope *p, pir_quat rotation) {
    pir_cgm *cgm = NULL;
    assert_int_equal(pir_cgm_create(p, &rotation, NULL, &cgm), PIR_OK);
    assert_true(pir_cgm_is_valid(cgm));
    return cgm;
}

static void expect_counts(const pir_cgm *cgm, uint32_t vertices, uint32_t halfedges, uint32_t faces) {
    pir_cgm_counts total = pir_cgm_total_counts(cgm);
    expect(total.vertices == vertices && total.halfedges == halfedges && total.faces == faces, "%u %u %u",
           total.vertices, total.halfedges, total.faces);
}

static uint32_t count_real(const pir_cgm *cgm) {
    uint32_t count = 0;
    for (uint32_t v = 0; v < pir_cgm_total_counts(cgm).vertices; v++)
        count += (uint32_t)pir_cgm_vertex_at(cgm, v).real;
    return count;
}

/* The octahedron's eight normals are the corners of the cube, its arcs the cube's edges: every map is a bare
   square, and all of it real. */
static void octahedron_is_the_cube_itself(void **state) {
    (void)state;
    pir_polytope *p = octahedron();
    pir_cgm *cgm = map_of(p, identity);
    expect_counts(cgm, 24, 48, 12);
    assert_int_equal(count_real(cgm), 24);
    for (uint32_t h = 0; h < 48; h++)
        assert_true(pir_cgm_halfedge_at(cgm, h).real);
    for (uint32_t map = 0; map < 6; map++)
        for (uint32_t k = 0; k < 4; k++)
            assert_int_not_equal(pir_cgm_vertex_facet(cgm, pir_cgm_corner(cgm, map, k), 0), PIR_CGM_NONE);
    pir_cgm_release(cgm);
    pir_polytope_release(p);
}

/* The cube's six normals are the middles of the maps; each arc crosses one cube edge in its middle. */
static void cube_has_a_cross_in_every_map(void **state) {
    (void)state;
    pir_polytope *p = cube();
    pir_cgm *cgm = map_of(p, identity);
    expect_counts(cgm, 54, 144, 30);
    assert_int_equal(count_real(cgm), 6);
    for (uint32_t map = 0; map < 6; map++) {
        pir_cgm_counts counts = pir_cgm_map_counts(cgm, map);
        assert_true(counts.vertices == 9 && counts.halfedges == 24 && counts.faces == 5);
    }
    // a third of a turn about the diagonal takes it to itself
    pir_cgm *turned = map_of(p, (pir_quat){1, 1, 1, 1});
    expect_counts(turned, 54, 144, 30);
    pir_cgm_release(turned);
    pir_cgm_release(cgm);
    pir_polytope_release(p);
}

/* A square prism whose four upright sides face cube edges, exactly: normals (±1, ±1, 0) in two maps each. */
static void normals_on_cube_edges_are_in_two_maps(void **state) {
    (void)state;
    pir_polytope *p =
        BODY({2, 0, -1}, {-2, 0, -1}, {0, 2, -1}, {0, -2, -1}, {2, 0, 1}, {-2, 0, 1}, {0, 2, 1}, {0, -2, 1});
    pir_cgm *cgm = map_of(p, identity);
    uint32_t on_edges = 0;
    for (uint32_t v = 0; v < pir_cgm_total_counts(cgm).vertices; v++) {
        pir_cgm_vertex_info info = pir_cgm_vertex_at(cgm, v);
        if (info.real && info.place == PIR_CGM_EDGE) {
            on_edges++;
            assert_int_equal(pir_cgm_vertex_at(cgm, info.copy).copy, v);
            assert_int_equal(pir_cgm_vertex_facet(cgm, v, 0), pir_cgm_vertex_facet(cgm, info.copy, 0));
            assert_float_equal(fabs(info.direction.x), sqrt(0.5), 1e-15);
        }
    }
    assert_int_equal(on_edges, 8);
    pir_cgm_release(cgm);
    pir_polytope_release(p);
}

/* A body and itself, which is its own reflection, and two bodies whose maps share nothing but the
   cube: the sum is 26-sided. */
static void equal_bodies_and_dual_bodies_sum(void **state) {
    (void)state;
    pir_polytope *p = octahedron(), *c = cube();
    pir_cgm *a = map_of(p, identity), *b = map_of(c, identity), *twice, *both;
    // a body and itself: the same map; the octahedron is its own reflection
    assert_int_equal(pir_cgm_overlay(a, a, &twice), PIR_OK);
    assert_true(pir_cgm_is_valid(twice));
    expect_counts(twice, 24, 48, 12);
    // octahedron and cube: their maps have nothing in common but the cube's edges, which cross arcs in their middles
    assert_int_equal(pir_cgm_overlay(a, b, &both), PIR_OK);
    assert_true(pir_cgm_is_valid(both));
    expect_counts(both, 54, 144, 30);
    pir_mesh *mesh;
    assert_int_equal(pir_cgm_mesh(both, PIR_DOUBLE, &mesh), PIR_OK);
    assert_int_equal(pir_mesh_vertex_count(mesh), 24);
    assert_int_equal(pir_mesh_edge_count(mesh), 48);
    assert_int_equal(pir_mesh_facet_count(mesh), 26);
    pir_mesh_destroy(mesh);
    pir_cgm_release(both);
    pir_cgm_release(twice);
    pir_cgm_release(b);
    pir_cgm_release(a);
    pir_polytope_release(c);
    pir_polytope_release(p);
}

/* What the sum of the bodies must have. */
static void expect_sum(pir_polytope *p, pir_polytope *q, uint32_t vertices, uint32_t edges, uint32_t facets) {
    pir_cgm *a = map_of(p, identity), *b = map_of(q, identity), *sum;
    pir_mesh *mesh;
    assert_int_equal(pir_cgm_overlay(a, b, &sum), PIR_OK);
    assert_true(pir_cgm_is_valid(sum));
    assert_int_equal(pir_cgm_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
    expect(pir_mesh_vertex_count(mesh) == vertices && pir_mesh_edge_count(mesh) == edges &&
               pir_mesh_facet_count(mesh) == facets,
           "%u %u %u", pir_mesh_vertex_count(mesh), pir_mesh_edge_count(mesh), pir_mesh_facet_count(mesh));
    pir_mesh_destroy(mesh);
    pir_cgm_release(sum);
    pir_cgm_release(b);
    pir_cgm_release(a);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void flat_bodies_sum(void **state) {
    (void)state;
    // a cube and a triangle across it; two triangles in one plane; a triangle and a segment out of its plane
    expect_sum(cube(), BODY({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 10, 15, 7);
    expect_sum(BODY({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), BODY({0, 0, 0}, {-1, 0, 0}, {0, -1, 0}), 6, 6, 2);
    expect_sum(BODY({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), BODY({0, 0, 0}, {0, 0, 2}), 6, 9, 5);
    // segments: across each other, along each other
    expect_sum(BODY({0, 0, 0}, {1, 0, 0}), BODY({0, 0, 0}, {0, 1, 0}), 4, 4, 2);
    expect_sum(BODY({0, 0, 0}, {1, 1, 1}), BODY({0, 0, 0}, {3, 3, 3}), 2, 1, 0);
    expect_sum(BODY({0, 0, 0}, {1, -1, 0}), BODY({5, 5, 5}), 2, 1, 0);
    expect_sum(BODY({1, 2, 3}), BODY({5, 5, 5}), 1, 0, 0);
    // three segments along the axes make a cube
    pir_polytope *square = BODY({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0});
    expect_sum(square, BODY({0, 0, 0}, {0, 0, 1}), 8, 12, 6);
}

/* The map of a point is six bare squares; of a segment, one great circle without a vertex of its own. */
static void maps_of_points_and_segments(void **state) {
    (void)state;
    pir_polytope *point = BODY({1, 2, 3}), *segment = BODY({0, 0, 0}, {0, 0, 1});
    pir_cgm *a = map_of(point, identity), *b = map_of(segment, identity);
    expect_counts(a, 24, 48, 12);
    // across the middles of the four maps around z, two new vertices in each
    expect_counts(b, 32, 72, 16);
    assert_int_equal(count_real(a) + count_real(b), 0);
    for (uint32_t h = 0; h < 72; h++)
        assert_true(pir_cgm_halfedge_edge(b, h, 0) == 0 || pir_cgm_halfedge_edge(b, h, 0) == PIR_CGM_NONE);
    pir_cgm_release(b);
    pir_cgm_release(a);
    pir_polytope_release(segment);
    pir_polytope_release(point);
}

/* Everything a map holds can be reached by the public calls, and they agree with each other. */
static void traversal_is_consistent(void **state) {
    (void)state;
    test_random random = test_random_case("cgm traversal", 0);
    pir_polytope *p = test_sphere(&random, 40), *q = test_sphere(&random, 30);
    pir_quat rotation = test_general_rotation(&random);
    pir_cgm *a = map_of(p, rotation), *b = map_of(q, identity), *cgm;
    assert_int_equal(pir_cgm_overlay(a, b, &cgm), PIR_OK);
    assert_int_equal(pir_cgm_source_count(cgm), 2);
    assert_ptr_equal(pir_cgm_source(cgm, 0), p);
    assert_ptr_equal(pir_cgm_source(cgm, 1), q);
    const pir_quat kept[2] = {pir_cgm_source_rotation(cgm, 0), pir_cgm_source_rotation(cgm, 1)};
    assert_memory_equal(kept, ((pir_quat[2]){rotation, identity}), sizeof kept);
    pir_cgm_counts total = pir_cgm_total_counts(cgm);
    uint32_t corners = 0, beyond = 0, facets_of_p = 0;
    for (uint32_t v = 0; v < total.vertices; v++) {
        pir_cgm_vertex_info info = pir_cgm_vertex_at(cgm, v);
        assert_int_equal(pir_cgm_halfedge_at(cgm, info.half).origin, v);
        assert_true(fabs(info.x) <= 1 + 1e-12 && fabs(info.y) <= 1 + 1e-12);
        // once around its copies
        uint32_t copy = info.copy, length = 1;
        for (; copy != v; copy = pir_cgm_vertex_at(cgm, copy).copy)
            length++;
        assert_int_equal(length, info.place == PIR_CGM_INTERIOR ? 1 : info.place == PIR_CGM_EDGE ? 2 : 3);
        corners += info.place == PIR_CGM_CORNER;
        facets_of_p += info.place == PIR_CGM_INTERIOR && pir_cgm_vertex_facet(cgm, v, 0) != PIR_CGM_NONE;
    }
    assert_int_equal(corners, 24);
    assert_int_equal(facets_of_p, pir_polytope_facet_count(p));
    for (uint32_t h = 0; h < total.halfedges; h++) {
        pir_cgm_halfedge_info info = pir_cgm_halfedge_at(cgm, h);
        assert_int_equal(pir_cgm_halfedge_at(cgm, info.twin).origin, info.target);
        assert_int_equal(pir_cgm_halfedge_at(cgm, info.next).origin, info.target);
        assert_int_equal(pir_cgm_clockwise_after(cgm, h), pir_cgm_halfedge_at(cgm, info.twin).next);
        if (info.beyond != PIR_CGM_NONE) {
            beyond++;
            assert_int_equal(pir_cgm_halfedge_at(cgm, info.beyond).beyond, h);
            assert_int_not_equal(pir_cgm_face_at(cgm, pir_cgm_halfedge_at(cgm, info.beyond).face).map,
                                 pir_cgm_face_at(cgm, info.face).map);
        }
    }
    assert_true(beyond >= 24 && beyond % 2 == 0);
    uint32_t outer = 0;
    for (uint32_t f = 0; f < total.faces; f++) {
        pir_cgm_face_info info = pir_cgm_face_at(cgm, f);
        outer += (uint32_t)info.outer;
        assert_int_equal(pir_cgm_halfedge_at(cgm, info.half).face, f);
        assert_int_equal(pir_cgm_face_vertex(cgm, f, 1) == PIR_CGM_NONE, info.outer);
        if (info.outer)
            assert_int_equal(pir_cgm_map_first(cgm, info.map).faces, f);
    }
    assert_int_equal(outer, 6);
    pir_cgm_statistics statistics = pir_cgm_get_statistics(cgm);
    assert_true(statistics.by_filter > 1000 && statistics.by_exact < statistics.by_filter / 100);
    pir_cgm_release(cgm);
    pir_cgm_release(b);
    pir_cgm_release(a);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

/* The check sees what is broken: here a face that carries a wrong vertex, a link, a copy, a line. */
static void check_sees_damage(void **state) {
    (void)state;
    pir_polytope *p = cube();
    pir_cgm *cgm = map_of(p, (pir_quat){0.1, 0.2, 0.3, 1});
    uint32_t *const places[] = {&cgm->face_vertex[1], &cgm->half[5].next,  &cgm->half[7].face,     &cgm->vertex[2].copy,
                                &cgm->edge_line[30],  &cgm->vertex[3].out, &cgm->vertex_facet[13], &cgm->edge_half[40]};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        uint32_t was = *places[i];
        *places[i] = was == 0 || was == PIR_CGM_NONE ? 3 : was ^ 1;
        expect(!pir_cgm_is_valid(cgm), "damage %zu", i);
        *places[i] = was;
        assert_true(pir_cgm_is_valid(cgm));
    }
    pir_cgm_release(cgm);
    pir_polytope_release(p);
}

static void bad_calls_are_refused(void **state) {
    (void)state;
    pir_polytope *p = cube();
    pir_cgm *cgm = map_of(p, identity), *other = NULL;
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_cgm_create(NULL, NULL, NULL, &other), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cgm_create(p, NULL, NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cgm_create(p, &(pir_quat){0, 0, 0, 0}, NULL, &other), PIR_ERR_ZERO_QUATERNION);
    assert_int_equal(pir_cgm_create(p, &(pir_quat){0, NAN, 0, 1}, NULL, &other), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_cgm_overlay(cgm, NULL, &other), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cgm_overlay(NULL, cgm, &other), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cgm_overlay(cgm, cgm, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cgm_mesh(cgm, (pir_precision)7, &mesh), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cgm_mesh(NULL, PIR_EXACT, &mesh), PIR_ERR_ARGUMENT);
    assert_null(other);
    assert_null(mesh);
    pir_cgm_release(NULL);
    pir_cgm_release(cgm);
    pir_polytope_release(p);
}

/* Whatever request for memory fails, the call says so and nothing is lost. */
static void memory_may_run_out_anywhere(void **state) {
    (void)state;
    test_random random = test_random_case("cgm memory", 0);
    pir_polytope *p = test_sphere(&random, 12), *q = cube();
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_quat rotation = {0.3, 0.1, 0.4, 0.8};
    uint64_t failures = 0;
    for (uint64_t fail_at = 1;; fail_at++) {
        memory.requests = 0;
        memory.fail_at = fail_at;
        pir_cgm *a = NULL, *b = NULL, *sum = NULL;
        pir_mesh *mesh = NULL;
        pir_status status = pir_cgm_create(p, &rotation, &allocator, &a);
        if (status == PIR_OK)
            status = pir_cgm_create(q, NULL, &allocator, &b);
        if (status == PIR_OK)
            status = pir_cgm_overlay(a, b, &sum);
        if (status == PIR_OK)
            status = pir_cgm_mesh(sum, PIR_EXACT, &mesh);
        bool asked = memory.requests >= fail_at;
        // room that cannot be given back is kept: not every refusal is a failure
        expect(status == PIR_OK || (status == PIR_ERR_MEMORY && asked), "request %llu", (unsigned long long)fail_at);
        failures += status != PIR_OK;
        if (sum)
            assert_true(pir_cgm_is_valid(sum) || memory.requests >= fail_at);
        pir_mesh_destroy(mesh);
        pir_cgm_release(sum);
        pir_cgm_release(b);
        pir_cgm_release(a);
        expect(memory.blocks == 0 && memory.bytes == 0 && !memory.wrong_size, "request %llu",
               (unsigned long long)fail_at);
        if (!asked)
            break;
    }
    assert_true(failures > 50);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

/* A rebuild by CGM that runs out of memory leaves the sum at the rotation before, whole. */
static void a_failed_rebuild_leaves_the_sum_as_it_was(void **state) {
    (void)state;
    test_random random = test_random_case("cgm rebuild memory", 0);
    pir_polytope *p = test_sphere(&random, 12), *q = cube();
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_sum_options options = {.size = sizeof options, .allocator = &allocator};
    const pir_quat before = {0.1, 0.2, 0.3, 0.9}, after = {0, 0, 1, 1};
    pir_sum *reference[2];
    assert_int_equal(pir_sum_create(p, q, before, NULL, &reference[0]), PIR_OK);
    assert_int_equal(pir_sum_create(p, q, after, NULL, &reference[1]), PIR_OK);
    uint32_t failures = 0;
    for (uint64_t fail_at = 1;; fail_at++) {
        pir_sum *sum = NULL;
        memory.fail_at = 0;
        assert_int_equal(pir_sum_create(p, q, before, &options, &sum), PIR_OK);
        memory.requests = 0;
        memory.fail_at = fail_at;
        pir_status status = pir_sum_rotate(sum, after, PIR_METHOD_CGM);
        expect(status == PIR_OK || status == PIR_ERR_MEMORY, "request %llu", (unsigned long long)fail_at);
        failures += status != PIR_OK;
        expect(pir_sum_is_valid(sum) && pir_sum_same_pairing(sum, reference[status == PIR_OK]), "request %llu",
               (unsigned long long)fail_at);
        pir_sum_destroy(sum);
        expect(memory.blocks == 0 && !memory.wrong_size, "request %llu", (unsigned long long)fail_at);
        if (memory.requests < fail_at)
            break;
    }
    assert_true(failures > 50);
    pir_sum_destroy(reference[1]);
    pir_sum_destroy(reference[0]);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void a_locator_may_lack_memory(void **state) {
    (void)state;
    pir_polytope *p = cube();
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_cgm *cgm = NULL;
    assert_int_equal(pir_cgm_create(p, NULL, &allocator, &cgm), PIR_OK);
    size_t blocks = memory.blocks;
    for (uint64_t fail_at = 1; fail_at <= 4; fail_at++) {
        pir_cgm_locator *locator = NULL;
        memory.requests = 0;
        memory.fail_at = fail_at;
        assert_int_equal(pir_cgm_locator_create(cgm, &locator), PIR_ERR_MEMORY);
        assert_null(locator);
        assert_int_equal(memory.blocks, blocks);
    }
    pir_cgm_release(cgm);
    assert_int_equal(memory.blocks, 0);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(octahedron_is_the_cube_itself),
        cmocka_unit_test(cube_has_a_cross_in_every_map),
        cmocka_unit_test(normals_on_cube_edges_are_in_two_maps),
        cmocka_unit_test(equal_bodies_and_dual_bodies_sum),
        cmocka_unit_test(flat_bodies_sum),
        cmocka_unit_test(maps_of_points_and_segments),
        cmocka_unit_test(traversal_is_consistent),
        cmocka_unit_test(check_sees_damage),
        cmocka_unit_test(bad_calls_are_refused),
        cmocka_unit_test(memory_may_run_out_anywhere),
        cmocka_unit_test(a_failed_rebuild_leaves_the_sum_as_it_was),
        cmocka_unit_test(a_locator_may_lack_memory),
    };
    return cmocka_run_group_tests_name("cgm", tests, NULL, NULL);
}
