/* SPDX-License-Identifier: MIT */
/*
 * Sums of solids as operands of the next: what is written is read again as the same solid. Facets of sums have holes,
 * and sums touch themselves along edges and at vertices.
 *
 * Of random cells, which touch each other in all ways: the volume is their number, and (P ⊕ Q) ⊕ C, whose first sum
 * is written and read, has the volume of P ⊕ (Q ⊕ C).
 *
 * PIR_TEST_CASES sets how many cases there are.
 */
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "solid/models.h"
#include "support/solid_sums.h"

static const pir_quat no_turn = {0, 0, 0, 1};

/* P ⊕ Q as a solid, whose volume is that of its mesh, and of its pieces. */
static pir_solid *sum_of(const pir_solid *p, const pir_solid *q, pir_quat turn, pir_solid_sum_info *ret_info) {
    pir_mesh *mesh = NULL;
    pir_pieces *pieces = NULL;
    mpq_t within, volume;
    mpq_inits(within, volume, NULL);
    assert_int_equal(solid_sum_mesh(p, q, turn, NULL, ret_info, &mesh), PIR_OK);
    pir_solid *solid = solid_read_again(mesh);
    mesh_volume(mesh, within);
    assert_int_equal(pir_solid_volume_exact(solid, volume), PIR_OK);
    expect(mpq_equal(within, volume), "the volume is %g, not %g", mpq_get_d(volume), mpq_get_d(within));
    assert_int_equal(pir_solid_decompose(solid, NULL, NULL, &pieces), PIR_OK);
    pieces_volume(pieces, volume);
    pir_pieces_destroy(pieces);
    expect(mpq_equal(within, volume), "pieces have the volume %g, not %g", mpq_get_d(volume), mpq_get_d(within));
    mpq_clears(within, volume, NULL);
    pir_mesh_destroy(mesh);
    return solid;
}

static void facets_with_holes_are_read_again(void **state) {
    (void)state;
    pir_solid *frame = solid_model_new("frame", 1), *cube = solid_model_new("cube", 4);
    pir_solid_sum_info made;
    pir_solid_info info;
    pir_solid *sum = sum_of(frame, cube, no_turn, &made);
    pir_solid_describe(sum, &info);
    assert_int_equal(made.holes, 2);
    assert_int_equal(info.merged_edges, made.edges);
    assert_int_equal(info.merged_facets, made.facets);
    assert_int_equal(info.edges, made.edges + made.holes); // the slits
    assert_int_equal(info.genus, 1);
    // a hole within a hole's facet, and facets that a turn makes rational
    pir_solid *turned = sum_of(sum, frame, (pir_quat){1, 2, 3, 4}, &made);
    pir_solid *more = sum_of(turned, cube, no_turn, &made);
    pir_solid_release(more);
    pir_solid_release(turned);
    pir_solid_release(sum);
    pir_solid_release(cube);
    pir_solid_release(frame);
}

static void facet_that_leads_to_no_hole_is_refused(void **state) {
    (void)state;
    static const pir_vec3 tips[3] = {{2, 2, 1}, {5, 5, 1}, {6, 0, 1}}; // from a corner of the top, within it and beyond
    for (int i = 0; i < 3; i++) {
        static solid_facets facets;
        pir_report report = {0};
        pir_solid *solid = NULL;
        facets = (solid_facets){0};
        const pir_vec3 low[4] = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
        const pir_vec3 top[4] = {{0, 0, 1}, {4, 0, 1}, {4, 4, 1}, {0, 4, 1}};
        solid_add_facet(&facets, (const pir_vec3[]){low[3], low[2], low[1], low[0]}, 4);
        solid_add_facet(&facets, (const pir_vec3[]){top[0], top[1], tips[i], top[1], top[2], top[3]}, 6);
        for (int k = 0; k < 4; k++)
            solid_add_facet(&facets, (const pir_vec3[]){low[k], low[(k + 1) % 4], top[(k + 1) % 4], top[k]}, 4);
        assert_int_equal(solid_make(&facets, NULL, &report, &solid), PIR_ERR_NOT_CLOSED);
        expect(strstr(report.text, "no hole is there"), "'%s'", report.text);
    }
}

/* --- solids that touch themselves --- */

static void cells_that_touch_along_an_edge_are_shells_of_their_own(void **state) {
    (void)state;
    cells two = {0};
    two.full[0][0][0] = two.full[1][1][0] = true;
    const pir_solid_info info = solid_info_of(solid_of_cells(&two));
    assert_int_equal(info.shells, 2);
    assert_int_equal(info.edges, 24);
    assert_int_equal(info.reflex_edges, 0);
    assert_int_equal(info.genus, 0);
    assert_true(info.volume == 2);
}

static void cell_that_touches_others_at_every_corner_is_a_shell(void **state) {
    (void)state;
    cells corners = {0};
    for (int i = 0; i < 8; i++)
        corners.full[2 * (i & 1)][i & 2][2 * (i >> 2)] = true;
    corners.full[1][1][1] = true;
    pir_solid_info info = solid_info_of(solid_of_cells(&corners));
    assert_int_equal(info.shells, 9);
    assert_true(info.volume == 9);
    // and a cavity that touches the outside at every corner
    cells block = {0};
    for (int i = 0; i < 27; i++)
        block.full[i % 3][i / 3 % 3][i / 9] = !corners.full[i % 3][i / 3 % 3][i / 9];
    info = solid_info_of(solid_of_cells(&block));
    assert_int_equal(info.shells, 2);
    assert_true(info.volume == 18);
}

/* A prism over a triangle beside the edge from (0,0,0) to (0,0,1), between two directions. */
static void add_wedge(solid_facets *facets, double x, double y, double u, double v) {
    const double corner[3][2] = {{0, 0}, {x, y}, {u, v}};
    solid_add_prism(facets, corner, 3, 1);
}

static void wedges_round_an_edge_must_not_overlap(void **state) {
    (void)state;
    static solid_facets facets;
    facets = (solid_facets){0};
    add_wedge(&facets, 1, 0, 1, 1);
    add_wedge(&facets, 0, 2, -1, 1);
    add_wedge(&facets, -1, -1, 0, -1);
    const pir_solid_info info = solid_info_of(solid_of_facets(&facets));
    assert_int_equal(info.shells, 3);
    assert_int_equal(info.reflex_edges, 0);
    pir_solid *solid = NULL;
    static const double overlaps[3][4] = {{4, 2, -1, 3}, {3, 0, 3, 3}, {2, 2, 0, 3}};
    for (int i = 0; i < 3; i++) {
        pir_report report = {0};
        facets = (solid_facets){0};
        add_wedge(&facets, 1, 0, 1, 1);
        add_wedge(&facets, overlaps[i][0], overlaps[i][1], overlaps[i][2], overlaps[i][3]);
        const pir_status status = solid_make(&facets, NULL, &report, &solid);
        expect(status == PIR_ERR_NOT_CLOSED && strstr(report.text, "is on 4 facets"), "wedge %d: '%s'", i, report.text);
    }
}

static void cells_at_random_are_solids_and_so_are_their_sums(void **state) {
    (void)state;
    mpq_t volume, other;
    mpq_inits(volume, other, NULL);
    pir_solid *cube = solid_model_new("cube", 2);
    for (uint64_t i = 0; i < solid_cases(8); i++) {
        test_random random = test_random_case("again", i);
        cells a = {0}, b = {0};
        unsigned count = 1;
        a.full[0][0][0] = b.full[0][0][0] = true;
        for (int k = 1; k < 27; k++)
            count += a.full[k % 3][k / 3 % 3][k / 9] = test_random_below(&random, 5) < 1 + i % 4;
        for (int k = 1; k < 8; k++)
            b.full[k % 2][k / 2 % 2][k / 4] = test_random_below(&random, 2);
        pir_solid *p = solid_of_cells(&a), *q = solid_of_cells(&b);
        assert_int_equal(pir_solid_volume_exact(p, volume), PIR_OK);
        expect(mpq_cmp_ui(volume, count, 1) == 0, "case %llu: %g cells, not %u", (unsigned long long)i,
               mpq_get_d(volume), count);
        const pir_quat turn = i % 2 ? no_turn : (pir_quat){1, 0, test_random_between(&random, -2, 2), 3};
        pir_solid *pq = sum_of(p, q, turn, NULL), *qc = sum_of(q, cube, no_turn, NULL);
        pir_solid *first = sum_of(pq, cube, no_turn, NULL), *last = sum_of(p, qc, turn, NULL);
        pir_solid_volume_exact(first, volume);
        pir_solid_volume_exact(last, other);
        expect(mpq_equal(volume, other), "case %llu: %g and %g", (unsigned long long)i, mpq_get_d(volume),
               mpq_get_d(other));
        pir_solid *const all[] = {p, q, pq, qc, first, last};
        for (int k = 0; k < 6; k++)
            pir_solid_release(all[k]);
    }
    pir_solid_release(cube);
    mpq_clears(volume, other, NULL);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(facets_with_holes_are_read_again),
        cmocka_unit_test(facet_that_leads_to_no_hole_is_refused),
        cmocka_unit_test(cells_that_touch_along_an_edge_are_shells_of_their_own),
        cmocka_unit_test(cell_that_touches_others_at_every_corner_is_a_shell),
        cmocka_unit_test(wedges_round_an_edge_must_not_overlap),
        cmocka_unit_test(cells_at_random_are_solids_and_so_are_their_sums),
    };
    return cmocka_run_group_tests_name("sums as solids", tests, NULL, NULL);
}
