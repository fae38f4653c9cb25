/* SPDX-License-Identifier: MIT */
/*
 * Meshes and height fields as they are made: from arrays of any layout, from files, from hostile input; what is told of
 * them, and what their trees hold.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/mesh_models.h"
#include "support/memory.h"

static const double tetrahedron[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const uint32_t tetrahedron_faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

static pir_trimesh_arrays small(void) {
    return (pir_trimesh_arrays){
        .vertices = tetrahedron, .vertex_count = 4, .triangles = tetrahedron_faces[0], .triangle_count = 4};
}

static pir_trimesh_info info_of(const pir_trimesh *mesh) {
    pir_trimesh_info info;
    pir_trimesh_describe(mesh, &info);
    return info;
}

static void AClosedMeshIsTold(void **state) {
    (void)state;
    pir_trimesh_arrays arrays = small();
    pir_trimesh *mesh = NULL;
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &mesh), PIR_OK);
    pir_trimesh_info info = info_of(mesh);
    assert_true(info.closed && !info.two_sided && info.parts == 1 && info.degenerate == 0 && info.triangles == 4);
    assert_true(info.low.x == 0 && info.high.z == 1 && pir_trimesh_is_valid(mesh));
    pir_trimesh_release(pir_trimesh_retain(mesh));
    pir_trimesh_release(mesh);
    arrays.triangle_count = 3;
    pir_trimesh_options options = pir_trimesh_options_default();
    options.two_sided = true;
    assert_int_equal(pir_trimesh_create(&arrays, &options, NULL, &mesh), PIR_OK);
    assert_true(!info_of(mesh).closed && info_of(mesh).two_sided);
    pir_trimesh_release(mesh);
    pir_trimesh_release(NULL);
}

/* Vertices of floats with colours between them, triangles in structs with their materials. */
static void StridesAndFloatsAreRead(void **state) {
    (void)state;
    struct {
        float at[3], colour[2];
    } vertex[4];
    struct {
        uint32_t material, corner[3];
    } face[4];
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++) {
            vertex[i].at[k] = (float)tetrahedron[i][k] * 0.1f;
            face[i].corner[k] = tetrahedron_faces[i][k];
            face[i].material = 40 + (uint32_t)i;
        }
    pir_trimesh_arrays arrays = {.vertices = vertex,
                                 .vertex_type = PIR_NUMBERS_FLOAT,
                                 .vertex_stride = sizeof *vertex,
                                 .vertex_count = 4,
                                 .triangles = face[0].corner,
                                 .triangle_stride = sizeof *face,
                                 .triangle_count = 4,
                                 .materials = &face[0].material,
                                 .material_stride = sizeof *face};
    pir_trimesh *mesh = NULL;
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &mesh), PIR_OK);
    pir_triangle_corners corners;
    assert_int_equal(pir_trimesh_triangle(mesh, 2, &corners), PIR_OK);
    assert_int_equal(corners.material, 42);
    assert_true(corners.corner[0].x == (double)0.1f && corners.corner[2].z == (double)0.1f);
    assert_int_equal(pir_trimesh_triangle(mesh, 4, &corners), PIR_ERR_ARGUMENT);
    pir_trimesh_release(mesh);
}

/* A soup of the tetrahedron's triangles has vertices at one place: it is as closed as the tetrahedron. */
static void PointsAtOnePlaceAreOneVertex(void **state) {
    (void)state;
    mesh_arrays ball = mesh_bumpy_sphere(3, 0.1), two = {0};
    two.vertex = malloc(2 * ball.vertices * sizeof *two.vertex);
    two.triangle = malloc(2 * ball.triangles * sizeof *two.triangle);
    two.vertices = 2 * ball.vertices;
    two.triangles = 2 * ball.triangles;
    for (uint32_t v = 0; v < two.vertices; v++) {
        two.vertex[v] = ball.vertex[v % ball.vertices];
        two.vertex[v].x += v < ball.vertices ? 0 : 5;
    }
    for (uint32_t t = 0; t < two.triangles; t++)
        for (int k = 0; k < 3; k++)
            two.triangle[t][k] = ball.triangle[t % ball.triangles][k] + (t < ball.triangles ? 0 : ball.vertices);
    pir_trimesh *mesh = mesh_of(&two, NULL);
    pir_trimesh_info info = info_of(mesh);
    assert_true(info.closed);
    assert_int_equal(info.parts, 2);
    assert_true(pir_trimesh_is_valid(mesh));
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&two);
    mesh_arrays_clear(&ball);
}

/* Three corners on a line in tenths are none in doubles; what decides is whether they are exactly. */
static void TrianglesWithoutAnAreaAreLeftOut(void **state) {
    (void)state;
    const double at[6][3] = {{0, 0, 0},       {1, 1, 1},       {3, 3, 3},
                             {0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}, {0.1, 0.3, nextafter(0.1, 1)}};
    const uint32_t corners[5][3] = {{0, 1, 2}, {0, 0, 1}, {0, 3, 4}, {0, 3, 5}, {1, 2, 5}};
    pir_trimesh_arrays arrays = {.vertices = at, .vertex_count = 6, .triangles = corners[0], .triangle_count = 5};
    pir_trimesh *mesh = NULL;
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &mesh), PIR_OK);
    assert_int_equal(info_of(mesh).degenerate, 3);
    assert_true(pir_trimesh_is_valid(mesh));
    pir_trimesh_release(mesh);
    arrays.triangle_count = 3;
    pir_report report;
    assert_int_equal(pir_trimesh_create(&arrays, NULL, &report, &mesh), PIR_ERR_EMPTY);
    assert_string_equal(report.text, "none of the 3 triangles has an area");
}

static void expect_refused(pir_trimesh_arrays arrays, pir_status status, const char *words) {
    pir_trimesh *const before = (pir_trimesh *)&arrays;
    pir_trimesh *mesh = before;
    pir_report report = {0};
    pir_status got = pir_trimesh_create(&arrays, NULL, &report, &mesh);
    expect(got == status && strstr(report.text, words) != NULL && mesh == before, "%d: '%s' without '%s'", got,
           report.text, words);
}

static void WrongArraysAreRefusedByName(void **state) {
    (void)state;
    double at[4][3];
    uint32_t corners[4][3];
    memcpy(at, tetrahedron, sizeof at);
    memcpy(corners, tetrahedron_faces, sizeof corners);
    pir_trimesh_arrays arrays = small();
    arrays.vertices = at;
    arrays.triangles = corners[0];
    at[3][1] = NAN;
    expect_refused(arrays, PIR_ERR_NOT_FINITE, "triangle 1: vertex 3 is (0, nan, 1)");
    at[3][1] = 0x1p61;
    expect_refused(arrays, PIR_ERR_LIMIT, "triangle 1: vertex 3");
    at[3][1] = 0;
    corners[2][1] = 4;
    expect_refused(arrays, PIR_ERR_ARGUMENT, "triangle 2: corner 1 is vertex 4, and there are 4");
    corners[2][1] = UINT32_MAX;
    expect_refused(arrays, PIR_ERR_ARGUMENT, "triangle 2");
    corners[2][1] = 2;
    arrays.vertex_stride = 16;
    expect_refused(arrays, PIR_ERR_ARGUMENT, "stride of 16 bytes");
    arrays.vertex_stride = 0;
    arrays.triangle_count = 0;
    expect_refused(arrays, PIR_ERR_EMPTY, "no triangle");
    arrays.triangle_count = (size_t)1 << 30;
    expect_refused(arrays, PIR_ERR_LIMIT, "too many");
    arrays.triangle_count = 4;
    arrays.triangles = NULL;
    expect_refused(arrays, PIR_ERR_ARGUMENT, "no triangles");
}

/* What would make a tree deep or large: all in one plane, all at one point, all alike, sizes that halve. */
static void TreesOfHostileMeshesAreSmall(void **state) {
    (void)state;
    mesh_arrays meshes[4] = {mesh_plane(100), mesh_fan(100000), mesh_plane(100), mesh_plane(23)};
    for (uint32_t v = 0; v < meshes[2].vertices; v++)
        meshes[2].vertex[v] = meshes[2].vertex[v % 3];
    for (uint32_t v = 0; v < meshes[3].vertices; v++) {
        double scale = ldexp(1, -(int)(v / 3));
        pir_vec3 corner[3] = {{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}};
        meshes[3].vertex[v] = corner[v % 3];
    }
    for (int i = 0; i < 4; i++) {
        pir_trimesh *mesh = mesh_of(&meshes[i], NULL);
        pir_trimesh_info info = info_of(mesh);
        assert_true(pir_trimesh_is_valid(mesh));
        expect(info.tree_bytes <= 24 * (size_t)info.triangles + 128, "mesh %d: %zu bytes for %u triangles", i,
               info.tree_bytes, info.triangles);
        pir_trimesh_release(mesh);
        mesh_arrays_clear(&meshes[i]);
    }
    for (uint32_t level = 0; level < 7; level++) {
        mesh_arrays ball = mesh_bumpy_sphere(level, 0.1);
        pir_trimesh *mesh = mesh_of(&ball, NULL);
        pir_trimesh_info info = info_of(mesh);
        assert_true(pir_trimesh_is_valid(mesh) && info.closed);
        expect(info.tree_bytes <= 24 * (size_t)info.triangles + 128, "level %u: %zu bytes for %u triangles", level,
               info.tree_bytes, info.triangles);
        pir_trimesh_release(mesh);
        mesh_arrays_clear(&ball);
    }
}

/* --- files --- */

static pir_status read_text(const char *text, const char *format, pir_report *report, pir_trimesh **ret_mesh) {
    return pir_trimesh_read_bytes(&(pir_file_bytes){text, strlen(text), "test", format}, NULL, report, ret_mesh);
}

static double area_of(const pir_trimesh *mesh) {
    double area = 0;
    for (uint32_t t = 0; t < info_of(mesh).triangles; t++) {
        pir_triangle_corners c;
        assert_int_equal(pir_trimesh_triangle(mesh, t, &c), PIR_OK);
        double ux = c.corner[1].x - c.corner[0].x, uy = c.corner[1].y - c.corner[0].y;
        double vx = c.corner[2].x - c.corner[0].x, vy = c.corner[2].y - c.corner[0].y;
        area += 0.5 * (ux * vy - uy * vx);
    }
    return area;
}

/* A square, a comb that no fan cuts right, and a square with a hole that a slit joins to its rim. */
static void PolygonsAreCut(void **state) {
    (void)state;
    static const struct {
        const char *text;
        uint32_t triangles;
        double area;
    } cases[] = {
        {"OFF 4 1 0  0 0 0  2 0 0  2 2 0  0 2 0  4 0 1 2 3", 2, 4},
        {"OFF 8 1 0  0 0 0  4 0 0  4 3 0  3 3 0  3 1 0  1 1 0  1 3 0  0 3 0  8 0 1 2 3 4 5 6 7", 6, 8},
        {"OFF 8 1 0  0 0 0  4 0 0  4 3 0  3 3 0  3 1 0  1 1 0  1 3 0  0 3 0  8 7 6 5 4 3 2 1 0", 6, -8},
        {"OFF 8 1 0  0 0 0  3 0 0  3 3 0  0 3 0  1 1 0  1 2 0  2 2 0  2 1 0  10 0 1 2 3 0 4 5 6 7 4", 8, 8},
        {"OFF 5 1 0  0 0 0  1 0 0  2 0 0  2 2 0  0 2 0  5 0 1 2 3 4", 3, 4},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        pir_trimesh *mesh = NULL;
        pir_report report = {0};
        pir_status status = read_text(cases[i].text, "off", &report, &mesh);
        expect(status == PIR_OK, "case %zu: %s", i, report.text);
        assert_int_equal(info_of(mesh).triangles, cases[i].triangles);
        expect(area_of(mesh) == cases[i].area, "case %zu: area %g", i, area_of(mesh));
        pir_trimesh_release(mesh);
    }
}

static void FilesThatAreWrongAreRefused(void **state) {
    (void)state;
    pir_trimesh *mesh = NULL;
    pir_report report = {0};
    // a pentagram, and a square that crosses itself
    assert_int_equal(read_text("OFF\n5 1 0\n0 3 0 -2 -3 0 3 1 0 -3 1 0 2 -3 0\n5 0 1 2 3 4", "off", &report, &mesh),
                     PIR_ERR_FORMAT);
    assert_non_null(strstr(report.text, "test:4: a facet of 5 corners: it crosses itself"));
    assert_int_equal(read_text("OFF 3 0 0 0 0 0 1 0 0 0 1 0", "off", &report, &mesh), PIR_ERR_EMPTY);
    assert_int_equal(read_text("OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 3", "off", &report, &mesh), PIR_ERR_FORMAT);
    assert_int_equal(read_text("OFF 3 900000000 0 0 0 0 1 0 0 0 1 0 3 0 1 2", "off", &report, &mesh), PIR_ERR_FORMAT);
    assert_int_equal(read_text("OFF 3 1 0 0 0 0 1 0 0 2 0 0 3 0 1 2", "off", &report, &mesh), PIR_ERR_EMPTY);
    assert_non_null(strstr(report.text, "test: none of the 1 triangles has an area"));
    assert_int_equal(pir_trimesh_read("no such file.off", NULL, &report, &mesh), PIR_ERR_FILE);
    assert_int_equal(pir_trimesh_read(NULL, NULL, &report, &mesh), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_trimesh_read_bytes(NULL, NULL, &report, &mesh), PIR_ERR_ARGUMENT);
    assert_null(mesh);
}

static void FilesOfEveryFormatAreRead(void **state) {
    (void)state;
    const char *texts[3][2] = {
        {"obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
        {"stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                "endfacet\nendsolid x\n"},
        {"ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}};
    for (int i = 0; i < 3; i++) {
        pir_trimesh *mesh = NULL;
        pir_report report = {0};
        expect(read_text(texts[i][1], texts[i][0], &report, &mesh) == PIR_OK, "%s: %s", texts[i][0], report.text);
        assert_true(area_of(mesh) == 0.5 && !info_of(mesh).closed);
        pir_trimesh_release(mesh);
    }
}

/* --- height fields --- */

static void AHeightFieldHasHolesAndMaterials(void **state) {
    (void)state;
    const float heights[3 * 4] = {0, 1, 2, NAN, 0, 1, 5, 3, 0, 0, 0, 0};
    const uint32_t materials[2 * 3] = {10, 11, 12, 13, 14, 15};
    const uint8_t holes[2 * 3] = {0, 0, 1, 0, 0, 0};
    pir_height_samples samples = {.heights = heights,
                                  .type = PIR_NUMBERS_FLOAT,
                                  .columns = 4,
                                  .rows = 3,
                                  .step_x = 2,
                                  .step_y = 3,
                                  .materials = materials,
                                  .holes = holes};
    pir_height_field *field = NULL;
    pir_report report = {0};
    expect(pir_height_field_create(&samples, NULL, &report, &field) == PIR_OK, "%s", report.text);
    pir_height_info info;
    pir_height_field_describe(field, &info);
    assert_true(info.triangles == 10 && info.high.x == 6 && info.high.y == 6 && info.high.z == 5 && info.low.z == 0);
    pir_triangle_corners corners;
    assert_int_equal(pir_height_field_triangle(field, 2 * 4 + 1, &corners), PIR_OK);
    assert_int_equal(corners.material, 14);
    assert_true(corners.corner[1].x == 4 && corners.corner[1].y == 6 && corners.corner[2].x == 2);
    assert_int_equal(pir_height_field_triangle(field, 2 * 2, &corners), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_height_field_triangle(field, 2 * 6, &corners), PIR_ERR_ARGUMENT);
    pir_height_field_release(pir_height_field_retain(field));
    pir_height_field_release(field);
    samples.holes = NULL;
    assert_int_equal(pir_height_field_create(&samples, NULL, &report, &field), PIR_ERR_NOT_FINITE);
    assert_string_equal(report.text, "sample (3, 0) is nan");
    samples.step_x = 0;
    assert_int_equal(pir_height_field_create(&samples, NULL, &report, &field), PIR_ERR_ARGUMENT);
    samples.columns = 1;
    assert_int_equal(pir_height_field_create(&samples, NULL, &report, &field), PIR_ERR_ARGUMENT);
    samples.columns = 40000;
    assert_int_equal(pir_height_field_create(&samples, NULL, &report, &field), PIR_ERR_LIMIT);
}

/* A field of 64 × 64 cells of floats, with its tree, in 200 kB. */
static void AHeightFieldIsSmall(void **state) {
    (void)state;
    float heights[65 * 65] = {0};
    pir_height_samples samples = {
        .heights = heights, .type = PIR_NUMBERS_FLOAT, .columns = 65, .rows = 65, .step_x = 1, .step_y = 1};
    pir_height_options options = pir_height_options_default();
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    options.allocator = &allocator;
    pir_height_field *field = NULL;
    assert_int_equal(pir_height_field_create(&samples, &options, NULL, &field), PIR_OK);
    pir_height_info info;
    pir_height_field_describe(field, &info);
    assert_true(info.bytes == memory.bytes && memory.bytes < 30000 && info.tree_bytes < 3 * 64 * 64);
    pir_height_field_release(field);
    assert_int_equal(memory.blocks, 0);
}

/* --- memory --- */

/* Fails each request for memory in turn, until none is left. */
static void MemoryMayRunOutAtEveryRequest(void **state) {
    (void)state;
    mesh_arrays ball = mesh_bumpy_sphere(2, 0.1);
    const char *text = "OFF 8 1 0  0 0 0  4 0 0  4 3 0  3 3 0  3 1 0  1 1 0  1 3 0  0 3 0  8 0 1 2 3 4 5 6 7";
    float heights[9] = {0};
    pir_height_samples samples = {
        .heights = heights, .type = PIR_NUMBERS_FLOAT, .columns = 3, .rows = 3, .step_x = 1, .step_y = 1};
    for (int kind = 0; kind < 3; kind++) {
        pir_status status = PIR_ERR_MEMORY;
        for (uint64_t at = 1; status != PIR_OK; at++) {
            test_memory memory = {.fail_at = at};
            pir_allocator allocator = test_allocator(&memory);
            pir_trimesh_options options = {.size = sizeof options, .allocator = &allocator};
            pir_height_options height_options = {.size = sizeof height_options, .allocator = &allocator};
            pir_trimesh_arrays arrays = mesh_arrays_of(&ball);
            pir_trimesh *mesh = NULL;
            pir_height_field *field = NULL;
            if (kind == 0)
                status = pir_trimesh_create(&arrays, &options, NULL, &mesh);
            else if (kind == 1)
                status =
                    pir_trimesh_read_bytes(&(pir_file_bytes){text, strlen(text), NULL, "off"}, &options, NULL, &mesh);
            else
                status = pir_height_field_create(&samples, &height_options, NULL, &field);
            assert_true(status == PIR_OK || status == PIR_ERR_MEMORY);
            pir_trimesh_release(mesh);
            pir_height_field_release(field);
            assert_true(memory.blocks == 0 && !memory.wrong_size && !memory.overrun);
        }
    }
    mesh_arrays_clear(&ball);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(AClosedMeshIsTold),
        cmocka_unit_test(StridesAndFloatsAreRead),
        cmocka_unit_test(PointsAtOnePlaceAreOneVertex),
        cmocka_unit_test(TrianglesWithoutAnAreaAreLeftOut),
        cmocka_unit_test(WrongArraysAreRefusedByName),
        cmocka_unit_test(TreesOfHostileMeshesAreSmall),
        cmocka_unit_test(PolygonsAreCut),
        cmocka_unit_test(FilesThatAreWrongAreRefused),
        cmocka_unit_test(FilesOfEveryFormatAreRead),
        cmocka_unit_test(AHeightFieldHasHolesAndMaterials),
        cmocka_unit_test(AHeightFieldIsSmall),
        cmocka_unit_test(MemoryMayRunOutAtEveryRequest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
