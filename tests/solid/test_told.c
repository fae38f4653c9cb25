/* SPDX-License-Identifier: MIT */
/*
 * Counts that the pages show are those of the library: pieces of solids, merged facets, bytes of a pair. Each case
 * makes a line as it should stand in a page and looks for it there.
 *
 * Usage: test_told ROOT
 */
#include "support/test.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "solid/models.h"
#include "support/bodies.h"
#include "support/memory.h"

static const char *root;

static char *read_page(const char *page) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", root, page);
    FILE *file = fopen(path, "rb");
    expect(file != NULL, "%s", path);
    char *text = calloc(1, 1 << 20);
    assert_non_null(text);
    assert_in_range(fread(text, 1, (1 << 20) - 1, file), 1, (1 << 20) - 2);
    fclose(file);
    return text;
}

static void expect_told(const char *page, const char *format, ...) {
    char line[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    char *text = read_page(page);
    expect(strstr(text, line) != NULL, "%s has no `%s`", page, line);
    free(text);
}

static uint32_t pieces_by(const pir_solid *solid, const pir_decompose_options *options, double *ret_error) {
    pir_pieces *pieces = NULL;
    pir_decompose_info info;
    assert_int_equal(pir_solid_decompose(solid, options, &info, &pieces), PIR_OK);
    uint32_t count = pir_pieces_count(pieces);
    *ret_error = info.error;
    pir_pieces_destroy(pieces);
    return count;
}

static void pieces_of_models_are_as_many_as_the_page_says(void **state) {
    (void)state;
    static const char *const names[] = {"star5", "stella", "gear8", "frame", "mushroom", "cup", "spoon"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        pir_solid *solid = solid_model_new(names[i], 1);
        pir_solid_info info;
        pir_decompose_options options = pir_decompose_options_default();
        double error;
        pir_solid_describe(solid, &info);
        options.method = PIR_DECOMPOSE_FACETS;
        uint32_t by_facets = pieces_by(solid, &options, &error);
        options.method = PIR_DECOMPOSE_WALLS;
        uint32_t by_walls = pieces_by(solid, &options, &error);
        expect_told("docs/solids.md", "| %s | %u | %u | %u |\n", names[i], info.reflex_edges, by_facets, by_walls);
        pir_solid_release(solid);
    }
}

static void fewer_pieces_are_as_many_and_as_far_as_the_page_says(void **state) {
    (void)state;
    pir_solid *solid = solid_model_new("mushroom", 1);
    pir_decompose_options options = pir_decompose_options_default();
    double error;
    uint32_t count = pieces_by(solid, &options, &error);
    expect_told("docs/solids.md", "| exact | %u | %.2g |\n", count, error);
    static const double tolerances[] = {0.01, 0.05};
    for (int i = 0; i < 2; i++) {
        options.tolerance = tolerances[i];
        count = pieces_by(solid, &options, &error);
        expect_told("docs/solids.md", "| `--tolerance %g` | %u | %.2g |\n", tolerances[i], count, error);
    }
    options.tolerance = 0;
    options.pieces = 10;
    count = pieces_by(solid, &options, &error);
    expect_told("docs/solids.md", "| `--pieces 10` | %u | %.2g |\n", count, error);
    pir_solid_release(solid);
}

static void merged_facets_are_as_many_as_the_page_says(void **state) {
    (void)state;
    static const char *const bodies[][2] = {{"cube", "cube"},
                                            {"dodecahedron", "dodecahedron"},
                                            {"prism?sides=32", "prism of 32 sides"},
                                            {"prism?sides=128", "prism of 128 sides"}};
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
        pir_polytope *shape = NULL, *merged = NULL;
        test_points points;
        double size = 0;
        assert_int_equal(pir_shape_create(bodies[i][0], NULL, NULL, &shape), PIR_OK);
        points.count = pir_polytope_vertex_count(shape);
        for (uint32_t v = 0; v < points.count; v++)
            points.at[v] = pir_polytope_vertex(shape, v);
        test_bake(&points, (pir_quat){0.1, 0.2, 0.3, 0.9});
        for (uint32_t v = 0; v < points.count; v++)
            size = points.at[v].x > size ? points.at[v].x : size;
        const pir_polytope_options options = {sizeof options, NULL, 2e-14 * size};
        pir_polytope *hull = test_polytope(&points);
        assert_int_equal(pir_polytope_create(points.at, points.count, &options, &merged), PIR_OK);
        expect_told("docs/exactness.md", "| %s | %u | %u |\n", bodies[i][1], pir_polytope_facet_count(hull),
                    pir_polytope_facet_count(merged));
        pir_polytope_release(merged);
        pir_polytope_release(hull);
        pir_polytope_release(shape);
    }
}

static void a_pair_takes_as_many_bytes_as_the_pages_say(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_pair_options options = pir_pair_options_default();
    pir_polytope *body = NULL;
    pir_workspace *workspace = NULL;
    pir_pair *pair = NULL;
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    options.allocator = &allocator;
    assert_int_equal(pir_shape_create("gs4", NULL, NULL, &body), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_create(body, body, &options, &pair), PIR_OK);
    const size_t bytes = memory.bytes;
    input.pose_p = (pir_pose){{0.1, 0.2, 0.3, 1}, {0.3, 0.2, 0.1}};
    assert_int_equal(pir_pair_signed_distance(pair, workspace, &input, &result), PIR_OK);
    assert_true(memory.bytes > bytes);
    expect_told("README.md", "%zu bytes that hold", bytes);
    expect_told("docs/queries.md", "A pair takes %zu bytes, and %zu more", bytes, memory.bytes - bytes);
    expect_told("docs/coming-from.md", "It takes %zu bytes, and %zu more", bytes, memory.bytes - bytes);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(body);
    assert_true(memory.bytes == 0 && !memory.wrong_size);
}

int main(int argc, char **argv) {
    if (argc != 2)
        return 2;
    root = argv[1];
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pieces_of_models_are_as_many_as_the_page_says),
        cmocka_unit_test(fewer_pieces_are_as_many_and_as_far_as_the_page_says),
        cmocka_unit_test(merged_facets_are_as_many_as_the_page_says),
        cmocka_unit_test(a_pair_takes_as_many_bytes_as_the_pages_say),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
