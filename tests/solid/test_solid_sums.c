/* SPDX-License-Identifier: MIT */
/*
 * Sums and pieces of random solids, held against what shares nothing with how they are made.
 *
 * Of unions of unit cubes: the sum covers the cells that some pair of cubes covers, counted one by one; its exact
 * volume is their number. Turned by a right angle, in either order, the volume is the same. Of polytopes: the sum as
 * solids has the vertices, edges and facets of the tracked sum, and its volume. Pieces: their exact volumes add up to
 * the solid's.
 *
 * PIR_TEST_CASES sets how many cases there are.
 */
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "support/solid_sums.h"

static const pir_quat no_turn = {0, 0, 0, 1};

/* How many unit cells the cubes of side 2 from i + j cover, over all full cells i of p and j of q. */
static unsigned covered(const cells *p, const cells *q) {
    enum { SIDE = 2 * CELLS };
    bool in[SIDE][SIDE][SIDE];
    memset(in, 0, sizeof in);
    for (int i = 0; i < CELLS * CELLS * CELLS; i++)
        for (int j = 0; j < CELLS * CELLS * CELLS; j++) {
            const int a[3] = {i % CELLS, i / CELLS % CELLS, i / CELLS / CELLS};
            const int b[3] = {j % CELLS, j / CELLS % CELLS, j / CELLS / CELLS};
            if (!p->full[a[0]][a[1]][a[2]] || !q->full[b[0]][b[1]][b[2]])
                continue;
            for (int k = 0; k < 8; k++)
                in[a[0] + b[0] + (k & 1)][a[1] + b[1] + (k >> 1 & 1)][a[2] + b[2] + (k >> 2)] = true;
        }
    unsigned count = 0;
    for (int i = 0; i < SIDE * SIDE * SIDE; i++)
        count += in[i % SIDE][i / SIDE % SIDE][i / SIDE / SIDE];
    return count;
}

static void expect_volume(const pir_solid *p, const pir_solid *q, pir_quat turn, mpq_t expected, uint64_t number) {
    pir_mesh *mesh = NULL;
    pir_solid_sum_info info;
    mpq_t volume;
    mpq_init(volume);
    const pir_status status = solid_sum_mesh(p, q, turn, NULL, &info, &mesh);
    expect(status == PIR_OK, "case %llu: status %d", (unsigned long long)number, (int)status);
    mesh_volume(mesh, volume);
    expect(mpq_equal(volume, expected), "case %llu: volume %g, not %g", (unsigned long long)number, mpq_get_d(volume),
           mpq_get_d(expected));
    expect(info.vertices == pir_mesh_vertex_count(mesh) && info.facets == pir_mesh_facet_count(mesh), "case %llu",
           (unsigned long long)number);
    pir_mesh_destroy(mesh);
    mpq_clear(volume);
}

static void sum_of_cells_covers_what_their_cubes_cover(void **state) {
    (void)state;
    const pir_quat quarter = {0, 0, 1, 1}, back = {0, 0, -1, 1};
    mpq_t expected, turned;
    mpq_inits(expected, turned, NULL);
    for (uint64_t i = 0; i < solid_cases(12); i++) {
        test_random random = test_random_case("cells", i);
        const cells a = cells_random(&random, 2 + test_random_below(&random, 14));
        const cells b = cells_random(&random, 1 + test_random_below(&random, 8));
        pir_solid *p = solid_of_cells(&a), *q = solid_of_cells(&b);
        mpq_set_ui(expected, covered(&a, &b), 1);
        expect_volume(p, q, no_turn, expected, i);
        expect_volume(q, p, no_turn, expected, i);
        // P turned and Q left is Q turned back and P left
        pir_mesh *mesh = NULL;
        assert_int_equal(solid_sum_mesh(p, q, quarter, NULL, NULL, &mesh), PIR_OK);
        mesh_volume(mesh, turned);
        expect_volume(q, p, back, turned, i);
        pir_mesh_destroy(mesh);
        pir_solid_release(q);
        pir_solid_release(p);
    }
    mpq_clears(expected, turned, NULL);
}

static void sum_of_convex_solids_is_the_tracked_sum(void **state) {
    (void)state;
    static const char *const shapes[] = {"cube", "octahedron", "gs4", "dodecahedron"};
    mpq_t volume, other;
    mpq_inits(volume, other, NULL);
    for (uint64_t i = 0; i < solid_cases(12); i++) {
        test_random random = test_random_case("convex", i);
        pir_polytope *p = NULL, *q = NULL;
        pir_solid *of_p = NULL, *of_q = NULL;
        pir_sum *sum = NULL;
        pir_mesh *mesh = NULL, *solid = NULL;
        const int whole = i % 2;
        const pir_quat turn = {whole ? test_random_between(&random, -2, 2) : test_random_unit(&random),
                               whole ? test_random_between(&random, -2, 2) : test_random_unit(&random), 1, 2};
        pir_sum_options tracked = pir_sum_options_default();
        pir_solid_sum_options options = pir_solid_sum_options_default();
        tracked.difference = options.difference = i % 3 == 0;
        assert_int_equal(pir_shape_create(shapes[test_random_below(&random, 4)], NULL, NULL, &p), PIR_OK);
        assert_int_equal(pir_shape_create(shapes[test_random_below(&random, 2)], NULL, NULL, &q), PIR_OK);
        assert_int_equal(pir_sum_create(p, q, turn, &tracked, &sum), PIR_OK);
        assert_int_equal(pir_sum_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
        assert_int_equal(pir_solid_from_polytope(p, NULL, &of_p), PIR_OK);
        assert_int_equal(pir_solid_from_polytope(q, NULL, &of_q), PIR_OK);
        assert_int_equal(solid_sum_mesh(of_p, of_q, turn, &options, NULL, &solid), PIR_OK);
        mesh_volume(mesh, volume);
        mesh_volume(solid, other);
        expect(pir_mesh_vertex_count(mesh) == pir_mesh_vertex_count(solid) &&
                   pir_mesh_edge_count(mesh) == pir_mesh_edge_count(solid) &&
                   pir_mesh_facet_count(mesh) == pir_mesh_facet_count(solid) && mpq_equal(volume, other),
               "case %llu", (unsigned long long)i);
        pir_mesh_destroy(solid);
        pir_mesh_destroy(mesh);
        pir_sum_destroy(sum);
        pir_solid_release(of_q);
        pir_solid_release(of_p);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    mpq_clears(volume, other, NULL);
}

/* A prism over a star-shaped polygon: corners at rising angles and random radii, at multiples of 2^-20. */
static pir_solid *random_star(test_random *random) {
    static const double way[12][2] = {{8, 0},  {7, 4},   {4, 7},   {0, 8},  {-4, 7}, {-7, 4},
                                      {-8, 0}, {-7, -4}, {-4, -7}, {0, -8}, {4, -7}, {7, -4}};
    static solid_facets facets;
    double corner[12][2];
    for (int i = 0; i < 12; i++) {
        const double radius = (1 + test_random_below(random, 1 << 20)) * 0x1p-20;
        corner[i][0] = way[i][0] * radius;
        corner[i][1] = way[i][1] * radius;
    }
    facets = (solid_facets){0};
    solid_add_prism(&facets, (const double(*)[2])corner, 12, 1 + test_random_below(random, 3));
    pir_solid *solid = NULL;
    assert_int_equal(solid_make(&facets, NULL, NULL, &solid), PIR_OK);
    return solid;
}

static void volumes_of_pieces_add_up(void **state) {
    (void)state;
    mpq_t sum, volume;
    mpq_inits(sum, volume, NULL);
    for (uint64_t i = 0; i < solid_cases(12); i++) {
        test_random random = test_random_case("pieces", i);
        const cells of = cells_random(&random, 20);
        pir_solid *solid = i % 2 ? random_star(&random) : solid_of_cells(&of);
        pir_pieces *pieces = NULL;
        pir_solid_info info;
        pir_solid_describe(solid, &info);
        pir_decompose_options options = pir_decompose_options_default();
        options.method = (pir_decompose_method)(i / 2 % 3);
        assert_int_equal(pir_solid_decompose(solid, &options, NULL, &pieces), PIR_OK);
        pieces_volume(pieces, sum);
        assert_int_equal(pir_solid_volume_exact(solid, volume), PIR_OK);
        expect(mpq_equal(sum, volume), "case %llu: the pieces hold %g of %g", (unsigned long long)i, mpq_get_d(sum),
               mpq_get_d(volume));
        expect(i % 2 == 0 || options.method == PIR_DECOMPOSE_WALLS || pir_pieces_count(pieces) <= info.reflex_edges + 1,
               "case %llu: %u pieces, %u reflex edges", (unsigned long long)i, (unsigned)pir_pieces_count(pieces),
               (unsigned)info.reflex_edges);
        pir_pieces_destroy(pieces);
        pir_solid_release(solid);
    }
    mpq_clears(sum, volume, NULL);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sum_of_cells_covers_what_their_cubes_cover),
        cmocka_unit_test(sum_of_convex_solids_is_the_tracked_sum),
        cmocka_unit_test(volumes_of_pieces_add_up),
    };
    return cmocka_run_group_tests_name("sums of solids", tests, NULL, NULL);
}
