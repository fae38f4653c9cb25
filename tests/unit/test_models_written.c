/* SPDX-License-Identifier: MIT */
/*
 * OBJ, STL and PLY hold every double: bodies of all sizes come back bit for bit. How a file is laid out, an independent
 * reader looks at in tests/cli/test_formats.py.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "support/bodies.h"
#include "support/random.h"
#include "support/solid_sums.h"

static const char *const formats[] = {"off", "obj", "stl", "ply"};

/* The mesh in memory, in that format. */
static char *written(const pir_mesh *mesh, const char *format, size_t *ret_size) {
    char *bytes = NULL;
    pir_report report = {0};
    FILE *stream = open_memstream(&bytes, ret_size);
    assert_non_null(stream);
    pir_status status = pir_mesh_write_stream(mesh, stream, "body", format, 0, &report);
    expect(status == PIR_OK, "%s: %s", format, report.text);
    fclose(stream);
    return bytes;
}

static int compare_points(const void *a, const void *b) {
    return memcmp(a, b, sizeof(pir_vec3));
}

/* The vertices in an order of their own; minus zero is zero. */
static pir_vec3 *sorted_vertices(const pir_polytope *p) {
    const uint32_t count = pir_polytope_vertex_count(p);
    pir_vec3 *points = calloc(count, sizeof *points);
    assert_non_null(points);
    for (uint32_t v = 0; v < count; v++) {
        const pir_vec3 at = pir_polytope_vertex(p, v);
        points[v] = (pir_vec3){at.x + 0.0, at.y + 0.0, at.z + 0.0};
    }
    qsort(points, count, sizeof *points, compare_points);
    return points;
}

static void expect_same_vertices(const pir_polytope *p, const pir_polytope *back, const char *format) {
    expect(pir_polytope_vertex_count(p) == pir_polytope_vertex_count(back) &&
               pir_polytope_edge_count(p) == pir_polytope_edge_count(back) &&
               pir_polytope_facet_count(p) == pir_polytope_facet_count(back),
           "%s: %u vertices come back as %u", format, pir_polytope_vertex_count(p), pir_polytope_vertex_count(back));
    pir_vec3 *before = sorted_vertices(p), *after = sorted_vertices(back);
    expect(memcmp(before, after, pir_polytope_vertex_count(p) * sizeof *before) == 0, "%s: other vertices", format);
    free(before);
    free(after);
}

/* Writes the body in each format from `first` on and reads it back. */
static void expect_round_trip(const pir_polytope *p, size_t first) {
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_mesh_from_polytope(p, &mesh), PIR_OK);
    for (size_t i = first; i < sizeof formats / sizeof *formats; i++) {
        size_t size = 0;
        char *bytes = written(mesh, formats[i], &size);
        pir_polytope *back = NULL;
        pir_surface surface;
        pir_report report = {0};
        const pir_file_bytes file = {bytes, size, "body", formats[i]};
        pir_status status = pir_polytope_read_bytes(&file, NULL, &report, &surface, &back);
        expect(status == PIR_OK, "%s: %s", formats[i], report.text);
        // facets of what has any close, as the file has them
        expect(surface.form == (pir_polytope_dimension(p) > 1 ? PIR_SURFACE_CLOSED : PIR_SURFACE_POINTS), "%s",
               formats[i]);
        expect_same_vertices(p, back, formats[i]);
        pir_polytope_release(back);
        free(bytes);
    }
    pir_mesh_destroy(mesh);
}

static void doubles_of_every_size_come_back(void **state) {
    (void)state;
    // where exponents are far apart the integers are long, so most bodies have near ones
    static const int ranges[][2] = {{-3, 3}, {-1074, -1020}, {1000, 1023}, {-140, -120}, {120, 130}, {-60, 60}};
    for (uint64_t number = 0; number < 600; number++) {
        test_random random = test_random_case("models written", number);
        const int *range = ranges[number % (sizeof ranges / sizeof *ranges)];
        pir_vec3 points[20];
        const size_t count = 1 + test_random_below(&random, 20);
        for (size_t i = 0; i < count; i++)
            points[i] = (pir_vec3){test_random_scaled(&random, range[0], range[1]),
                                   test_random_scaled(&random, range[0], range[1]),
                                   test_random_below(&random, 4) ? test_random_scaled(&random, range[0], range[1]) : 0};
        pir_polytope *p = test_hull(points, count);
        // STL has no place for what has no facets
        if (pir_polytope_facet_count(p) > 0)
            expect_round_trip(p, 0);
        pir_polytope_release(p);
    }
}

static void the_least_and_the_greatest_doubles_come_back(void **state) {
    (void)state;
    static const pir_vec3 least[] = {{0, 0, 0}, {5e-324, 0, 0}, {-0.0, 1e-323, 0}, {0, 0, 2.2250738585072009e-308}};
    static const pir_vec3 greatest[] = {
        {-1.7976931348623157e308, 0, 0}, {1.7976931348623157e308, 0, 0}, {0, 3.4028235677973366e38, 0}, {0, 0, 0.1}};
    pir_polytope *p = test_hull(least, 4);
    expect_round_trip(p, 0);
    pir_polytope_release(p);
    p = test_hull(greatest, 4);
    expect_round_trip(p, 0);
    pir_polytope_release(p);
}

/* More corners than a list of PLY with a byte for its size has room for. */
static void a_facet_of_a_thousand_corners_comes_back(void **state) {
    (void)state;
    pir_polytope *p = NULL;
    assert_int_equal(pir_shape_create("prism?sides=1000", NULL, NULL, &p), PIR_OK);
    expect_round_trip(p, 0);
    pir_polytope_release(p);
}

static void stl_is_binary_where_floats_hold_every_coordinate(void **state) {
    (void)state;
    const pir_vec3 floats[] = {{0, 0, 0}, {0.1f, 0, 0}, {0, 0x1.fffffep127, 0}, {0, 0, 0x1p-149}};
    for (int far = 0; far < 4; far++) {
        static const double others[] = {0x1p-149, 0x1p-150, 0.1, 0x1.ffffff8p127};
        pir_vec3 points[4];
        memcpy(points, floats, sizeof points);
        points[3].z = others[far];
        pir_polytope *p = test_hull(points, 4);
        pir_mesh *mesh = NULL;
        assert_int_equal(pir_mesh_from_polytope(p, &mesh), PIR_OK);
        size_t size;
        char *bytes = written(mesh, "stl", &size);
        assert_int_equal(strncmp(bytes, "solid", 5) == 0, far > 0);
        assert_int_equal(size == 80 + 4 + 4 * 50, far == 0);
        free(bytes);
        pir_mesh_destroy(mesh);
        pir_polytope_release(p);
    }
}

static void refused_as_stl(const pir_mesh *mesh, const char *says) {
    char *bytes = NULL;
    size_t size = 0;
    pir_report report = {0};
    FILE *stream = open_memstream(&bytes, &size);
    assert_int_equal(pir_mesh_write_stream(mesh, stream, "body", "stl", 0, &report), PIR_ERR_ARGUMENT);
    fclose(stream);
    assert_int_equal(size, 0);
    expect(strstr(report.text, says) != NULL, "%s", report.text);
    free(bytes);
}

static void a_segment_and_a_point_are_vertices_of_obj_and_ply(void **state) {
    (void)state;
    static const pir_vec3 ends[] = {{1, 2, 3}, {0.1, 1e300, -4}};
    for (size_t count = 1; count <= 2; count++) {
        pir_polytope *p = test_hull(ends, count);
        pir_mesh *mesh = NULL;
        assert_int_equal(pir_mesh_from_polytope(p, &mesh), PIR_OK);
        refused_as_stl(mesh, count == 1 ? "a point has none" : "a segment has none");
        for (size_t i = 1; i < 4; i += 2) {
            size_t size;
            char *bytes = written(mesh, formats[i], &size);
            const pir_file_bytes file = {bytes, size, "body", formats[i]};
            pir_polytope *back = NULL;
            assert_int_equal(pir_polytope_read_bytes(&file, NULL, NULL, NULL, &back), PIR_OK);
            expect_same_vertices(p, back, formats[i]);
            pir_polytope_release(back);
            free(bytes);
        }
        pir_mesh_destroy(mesh);
        pir_polytope_release(p);
    }
}

/* A square frame, each side of its hole a facet of its own; its sum with a small cube has two facets with a hole. */
static pir_mesh *sum_with_holes(void) {
    pir_vec3 points[16];
    uint32_t corners[64], starts[17], at = 0;
    for (uint32_t i = 0; i < 16; i++) {
        static const double place[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        const double size = i & 4 ? 4 : 8, low = i & 4 ? 2 : 0;
        points[i] = (pir_vec3){low + size * place[i & 3][0], low + size * place[i & 3][1], i & 8 ? 1 : 0};
    }
    // i & 3: round the frame, i & 4: of the hole, i & 8: above
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t j = (i + 1) & 3, facets[4][4] = {{i, j, j | 8, i | 8},
                                                        {j | 4, i | 4, i | 12, j | 12},
                                                        {i | 8, j | 8, j | 12, i | 12},
                                                        {j, i, i | 4, j | 4}};
        memcpy(corners + at, facets, sizeof facets);
        at += 16;
    }
    for (uint32_t f = 0; f <= 16; f++)
        starts[f] = 4 * f;
    const pir_solid_facets facets = {
        .points = points, .point_count = 16, .starts = starts, .corners = corners, .facet_count = 16};
    pir_solid *frame = NULL, *cube = NULL;
    pir_polytope *p = NULL;
    pir_mesh *mesh = NULL;
    pir_solid_sum_info info;
    pir_report report = {0};
    expect(pir_solid_create(&facets, NULL, &report, &frame) == PIR_OK, "%s", report.text);
    assert_int_equal(pir_shape_create("cube", NULL, NULL, &p), PIR_OK);
    assert_int_equal(pir_solid_from_polytope(p, NULL, &cube), PIR_OK);
    assert_int_equal(solid_sum_mesh(frame, cube, (pir_quat){0, 0, 0, 1}, NULL, &info, &mesh), PIR_OK);
    assert_int_equal(info.holes, 2);
    pir_solid_release(frame);
    pir_solid_release(cube);
    pir_polytope_release(p);
    return mesh;
}

/* Triangles about a corner would cover the hole. Polygons with slits do not. */
static void holes_of_a_solid_are_no_triangles(void **state) {
    (void)state;
    pir_mesh *mesh = sum_with_holes();
    refused_as_stl(mesh, "facets of a sum of solids may have holes");
    for (size_t i = 0; i < 4; i++) {
        pir_solid *back = NULL;
        pir_solid_info info;
        pir_report report = {0};
        size_t size;
        if (strcmp(formats[i], "stl") == 0)
            continue;
        char *bytes = written(mesh, formats[i], &size);
        const pir_file_bytes file = {bytes, size, "body", formats[i]};
        pir_status status = pir_solid_read_bytes(&file, NULL, &report, &back);
        expect(status == PIR_OK, "%s: %s", formats[i], report.text);
        pir_solid_describe(back, &info);
        assert_int_equal(info.genus, 1);
        pir_solid_release(back);
        free(bytes);
    }
    pir_mesh_destroy(mesh);
}

static void a_full_disk_is_told_in_every_format(void **state) {
    (void)state;
    pir_polytope *p = NULL;
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_shape_create("gs4", NULL, NULL, &p), PIR_OK);
    assert_int_equal(pir_mesh_from_polytope(p, &mesh), PIR_OK);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        FILE *full = fopen("/dev/full", "wb");
        if (!full)
            skip();
        pir_report report = {0};
        assert_int_equal(pir_mesh_write_stream(mesh, full, "body", formats[i], 0, &report), PIR_ERR_FILE);
        expect(strstr(report.text, "No space left") != NULL, "%s", report.text);
        fclose(full);
    }
    pir_mesh_destroy(mesh);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(doubles_of_every_size_come_back),
        cmocka_unit_test(the_least_and_the_greatest_doubles_come_back),
        cmocka_unit_test(a_facet_of_a_thousand_corners_comes_back),
        cmocka_unit_test(stl_is_binary_where_floats_hold_every_coordinate),
        cmocka_unit_test(a_segment_and_a_point_are_vertices_of_obj_and_ply),
        cmocka_unit_test(holes_of_a_solid_are_no_triangles),
        cmocka_unit_test(a_full_disk_is_told_in_every_format),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
