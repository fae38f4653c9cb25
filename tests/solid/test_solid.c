/* SPDX-License-Identifier: MIT */
/* What solids are, and which are refused, with what in the report. */
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "solid/models.h"
#include "support/memory.h"
#include "support/solid_sums.h"

static const double l_shape[6][2] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};

static void add_box(solid_facets *facets, double low, double high, bool inwards) {
    const uint32_t first = facets->facets, from = facets->start[first];
    const double square[4][2] = {{low, low}, {high, low}, {high, high}, {low, high}};
    const uint32_t points = facets->points;
    solid_add_prism(facets, square, 4, high - low);
    for (uint32_t i = points; i < facets->points; i++)
        facets->point[i].z += low;
    for (uint32_t f = first; inwards && f < facets->facets; f++)
        for (uint32_t i = 0; i < 2; i++) {
            uint32_t *corner = facets->corner + from + 4 * (f - first), other = corner[i];
            corner[i] = corner[3 - i];
            corner[3 - i] = other;
        }
}

static void prism_has_its_reflex_edge_and_volume(void **state) {
    (void)state;
    static solid_facets facets;
    facets = (solid_facets){0};
    solid_add_prism(&facets, l_shape, 6, 1);
    pir_solid *solid = NULL;
    pir_solid_info info;
    assert_int_equal(solid_make(&facets, NULL, NULL, &solid), PIR_OK);
    pir_solid_describe(solid, &info);
    assert_int_equal(info.vertices, 12);
    assert_int_equal(info.edges, 18);
    assert_int_equal(info.merged_facets, 8);
    assert_int_equal(info.reflex_edges, 1);
    assert_int_equal(info.shells, 1);
    assert_int_equal(info.genus, 0);
    assert_true(info.volume == 5);
    assert_true(info.high.x == 3 && info.low.z == 0);
    pir_solid *same = pir_solid_retain(solid);
    pir_solid_release(solid);
    pir_solid_release(same);
}

static void cells_are_counted_once_coplanar_ones_are_merged(void **state) {
    (void)state;
    cells ring = {0};
    for (int x = 0; x < 3; x++)
        for (int y = 0; y < 3; y++)
            ring.full[x][y][0] = x != 1 || y != 1;
    const pir_solid_info info = solid_info_of(solid_of_cells(&ring));
    assert_int_equal(info.facets, 32);
    assert_int_equal(info.merged_vertices, 16);
    assert_int_equal(info.merged_edges, 24);
    assert_int_equal(info.merged_facets, 10);
    assert_int_equal(info.reflex_edges, 4);
    assert_int_equal(info.genus, 1);
    assert_true(info.volume == 8);
}

static void cavity_is_a_second_shell(void **state) {
    (void)state;
    static solid_facets facets;
    facets = (solid_facets){0};
    add_box(&facets, 0, 3, false);
    add_box(&facets, 1, 2, true);
    const pir_solid_info info = solid_info_of(solid_of_facets(&facets));
    assert_int_equal(info.shells, 2);
    assert_int_equal(info.reflex_edges, 12);
    assert_true(info.volume == 26);
}

static void polytope_becomes_a_solid_unless_it_is_flat(void **state) {
    (void)state;
    pir_polytope *cube = NULL, *flat = NULL;
    pir_solid *solid = NULL;
    const pir_vec3 square[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    assert_int_equal(pir_shape_create("cube", NULL, NULL, &cube), PIR_OK);
    assert_int_equal(pir_polytope_create(square, 4, NULL, &flat), PIR_OK);
    assert_int_equal(pir_solid_from_polytope(flat, NULL, &solid), PIR_ERR_EMPTY);
    assert_int_equal(pir_solid_from_polytope(cube, NULL, &solid), PIR_OK);
    const pir_solid_info info = solid_info_of(solid);
    assert_int_equal(info.facets, 6);
    assert_true(info.volume == pir_polytope_volume(cube));
    pir_polytope_release(flat);
    pir_polytope_release(cube);
}

/* --- refusals --- */

static void expect_refusal(const solid_facets *facets, pir_status status, const char *text) {
    pir_report report = {0};
    pir_solid *solid = NULL;
    assert_int_equal(solid_make(facets, NULL, &report, &solid), status);
    assert_null(solid);
    expect(strstr(report.text, text), "'%s' in '%s'", text, report.text);
}

static void open_surface_is_refused_with_its_edge(void **state) {
    (void)state;
    static solid_facets facets;
    facets = (solid_facets){0};
    add_box(&facets, 0, 1, false);
    facets.facets--;
    expect_refusal(&facets, PIR_ERR_NOT_CLOSED, "is on 1 facet");
}

static void facets_that_face_different_sides_are_refused(void **state) {
    (void)state;
    static solid_facets facets;
    facets = (solid_facets){0};
    add_box(&facets, 0, 1, false);
    const uint32_t other = facets.corner[0];
    facets.corner[0] = facets.corner[2];
    facets.corner[2] = other;
    expect_refusal(&facets, PIR_ERR_NOT_CLOSED, "the same way");
}

static void doubled_facet_is_refused(void **state) {
    (void)state;
    static solid_facets facets;
    facets = (solid_facets){0};
    add_box(&facets, 0, 1, false);
    add_box(&facets, 0, 1, false);
    expect_refusal(&facets, PIR_ERR_NOT_CLOSED, "is on 4 facets");
}

static void crossing_facets_are_refused(void **state) {
    (void)state;
    static solid_facets facets;
    facets = (solid_facets){0};
    add_box(&facets, 0, 2, false);
    add_box(&facets, 1, 3, false);
    expect_refusal(&facets, PIR_ERR_FORMAT, "meets itself");
}

static void facet_that_crosses_itself_is_refused(void **state) {
    (void)state;
    static solid_facets facets;
    static const double bow[5][2] = {{0, 0}, {2, 0}, {0, 2}, {2, 2}, {1, 4}};
    facets = (solid_facets){0};
    solid_add_prism(&facets, bow, 5, 1);
    pir_solid *solid = NULL;
    assert_int_equal(solid_make(&facets, NULL, NULL, &solid), PIR_ERR_FORMAT);
}

static void inside_out_is_refused(void **state) {
    (void)state;
    static solid_facets facets;
    facets = (solid_facets){0};
    add_box(&facets, 0, 1, true);
    expect_refusal(&facets, PIR_ERR_FORMAT, "inside out");
    facets = (solid_facets){0};
    add_box(&facets, 0, 3, false);
    add_box(&facets, 1, 2, false);
    expect_refusal(&facets, PIR_ERR_FORMAT, "within another");
}

static void facets_without_volume_or_plane_are_refused(void **state) {
    (void)state;
    static solid_facets facets;
    const pir_vec3 a = {0, 0, 0}, b = {1, 0, 0}, c = {0, 1, 0}, d = {0, 0, 1};
    facets = (solid_facets){0};
    solid_add_facet(&facets, (const pir_vec3[]){a, b, c}, 3);
    solid_add_facet(&facets, (const pir_vec3[]){c, b, a}, 3);
    expect_refusal(&facets, PIR_ERR_FORMAT, "folded onto");
    facets = (solid_facets){0};
    solid_add_facet(&facets, (const pir_vec3[]){a, b, {2, 0, 0}}, 3);
    expect_refusal(&facets, PIR_ERR_FORMAT, "no area");
    facets = (solid_facets){0};
    solid_add_facet(&facets, (const pir_vec3[]){a, b, c, d}, 4);
    expect_refusal(&facets, PIR_ERR_FORMAT, "not planar");
    facets = (solid_facets){0};
    expect_refusal(&facets, PIR_ERR_EMPTY, "no facets");
}

static void counts_beyond_the_limit_are_refused_before_anything_is_read(void **state) {
    (void)state;
    const size_t counts[] = {(size_t)1 << 30, SIZE_MAX / sizeof(pir_vec3) + 1, SIZE_MAX / 2, SIZE_MAX};
    const uint32_t starts[] = {0, 3}, corners[] = {0, 1, 2};
    const pir_vec3 points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (size_t i = 0; i < 2 * sizeof counts / sizeof *counts; i++) {
        const size_t many = counts[i / 2];
        const pir_solid_facets facets = {points, i % 2 ? many : 3, starts, corners, i % 2 ? 1 : many};
        pir_report report;
        pir_solid *solid = NULL;
        assert_int_equal(pir_solid_create(&facets, NULL, &report, &solid), PIR_ERR_LIMIT);
        assert_non_null(strstr(report.text, i % 2 ? "2^30 points or more" : "2^30 facets or more"));
        assert_null(solid);
    }
}

static void every_failing_request_and_a_low_limit_are_survived(void **state) {
    (void)state;
    static solid_facets facets;
    facets = (solid_facets){0};
    solid_add_prism(&facets, l_shape, 6, 1);
    for (uint64_t fail_at = 1, done = 0; !done; fail_at++) {
        test_memory memory = {.fail_at = fail_at};
        pir_allocator allocator = test_allocator(&memory);
        pir_solid_sum_options options = pir_solid_sum_options_default();
        options.allocator = &allocator;
        options.open = true;
        pir_decompose_options decompose = pir_decompose_options_default();
        decompose.allocator = &allocator;
        pir_solid_options of_solid = pir_solid_options_default();
        of_solid.allocator = &allocator;
        pir_solid *solid = NULL;
        pir_pieces *pieces = NULL;
        pir_mesh *mesh = NULL;
        pir_status status = solid_make(&facets, &of_solid, NULL, &solid);
        if (status == PIR_OK)
            status = pir_solid_decompose(solid, &decompose, NULL, &pieces);
        if (status == PIR_OK)
            status = solid_sum_mesh(solid, solid, (pir_quat){0, 0, 0, 1}, &options, NULL, &mesh);
        done = status == PIR_OK;
        expect(done || status == PIR_ERR_MEMORY, "request %llu: status %d", (unsigned long long)fail_at, (int)status);
        pir_mesh_destroy(mesh);
        pir_pieces_destroy(pieces);
        pir_solid_release(solid);
        expect(memory.blocks == 0 && !memory.wrong_size, "request %llu: %zu blocks left", (unsigned long long)fail_at,
               memory.blocks);
    }
    pir_solid_options low = pir_solid_options_default();
    pir_solid *solid = NULL;
    low.memory = 4096;
    assert_int_equal(solid_make(&facets, &low, NULL, &solid), PIR_ERR_LIMIT);
}

/* --- the limit --- */

/* What a sum holds: its own memory and GMP's. */
static size_t held, most_held;

static void hold(size_t old_size, size_t new_size) {
    held = held - old_size + new_size;
    most_held = held > most_held ? held : most_held;
}

static void *count_resize(void *context, void *block, size_t old_size, size_t new_size) {
    (void)context;
    hold(old_size, new_size);
    if (new_size > 0)
        return realloc(block, new_size);
    free(block);
    return NULL;
}

static void *count_new(size_t size) {
    hold(0, size);
    return malloc(size);
}

static void *count_again(void *block, size_t old_size, size_t new_size) {
    hold(old_size, new_size);
    return realloc(block, new_size);
}

static void count_free(void *block, size_t size) {
    hold(size, 0);
    free(block);
}

/* Beside what the limit counts there are the numbers of both solids on one scale, and one number in the making. */
static void sum_holds_no_more_than_its_limit_with_gmps_numbers(void **state) {
    (void)state;
    const size_t beside = 65536;
    const pir_allocator counting = {count_resize, NULL};
    pir_solid *p = solid_model_new("gear8", 1), *q = solid_model_new("star5", 1);
    pir_solid_sum_options options = pir_solid_sum_options_default();
    unsigned refused = 0, made = 0;
    assert_true(p && q);
    options.allocator = &counting;
    mp_set_memory_functions(count_new, count_again, count_free);
    for (options.memory = 16384; made == 0 && options.memory < (size_t)1 << 30; options.memory += options.memory / 4) {
        pir_mesh *mesh = NULL;
        held = most_held = 0;
        const pir_status status = solid_sum_mesh(p, q, (pir_quat){1, 2, 3, 4}, &options, NULL, &mesh);
        expect(status == PIR_OK || status == PIR_ERR_LIMIT, "%zu bytes: status %d", options.memory, (int)status);
        expect(status == PIR_OK || most_held <= options.memory + beside, "%zu bytes: %zu were held", options.memory,
               most_held);
        pir_mesh_destroy(mesh);
        expect(held == 0, "%zu bytes: %zu are left", options.memory, held);
        *(status == PIR_OK ? &made : &refused) += 1;
    }
    mp_set_memory_functions(NULL, NULL, NULL);
    printf("%u limits were too low\n", refused);
    assert_true(made == 1 && refused > 8);
    pir_solid_release(q);
    pir_solid_release(p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(prism_has_its_reflex_edge_and_volume),
        cmocka_unit_test(cells_are_counted_once_coplanar_ones_are_merged),
        cmocka_unit_test(cavity_is_a_second_shell),
        cmocka_unit_test(polytope_becomes_a_solid_unless_it_is_flat),
        cmocka_unit_test(open_surface_is_refused_with_its_edge),
        cmocka_unit_test(facets_that_face_different_sides_are_refused),
        cmocka_unit_test(doubled_facet_is_refused),
        cmocka_unit_test(crossing_facets_are_refused),
        cmocka_unit_test(facet_that_crosses_itself_is_refused),
        cmocka_unit_test(inside_out_is_refused),
        cmocka_unit_test(facets_without_volume_or_plane_are_refused),
        cmocka_unit_test(counts_beyond_the_limit_are_refused_before_anything_is_read),
        cmocka_unit_test(every_failing_request_and_a_low_limit_are_survived),
        cmocka_unit_test(sum_holds_no_more_than_its_limit_with_gmps_numbers),
    };
    return cmocka_run_group_tests_name("solids", tests, NULL, NULL);
}
