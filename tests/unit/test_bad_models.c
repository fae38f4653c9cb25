/* SPDX-License-Identifier: MIT */
/* OBJ, STL and PLY that are wrong: each is refused with a status and a line that says what, where and why. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <pirouette/pirouette.h>

#include "fuzz/model_files.h"

struct refusal {
    const char *text;
    pir_status status;
    const char *what; /* of the report */
};

/* Bytes of their own length, so that a byte read past the end is seen. */
static pir_status read_bytes(const void *bytes, size_t size, const char *format, pir_report *report,
                             pir_polytope **ret_polytope) {
    void *copy = malloc(size ? size : 1);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    pir_status status =
        pir_polytope_read_bytes(&(pir_file_bytes){copy, size, "m", format}, NULL, report, NULL, ret_polytope);
    free(copy);
    return status;
}

static void expect_refusal(const void *bytes, size_t size, const char *format, pir_status status, const char *what) {
    pir_polytope *polytope = NULL;
    pir_report report = {PIR_OK, ""};
    pir_status got = read_bytes(bytes, size, format, &report, &polytope);
    if (got != status || strncmp(report.text, what, strlen(what)) != 0)
        fail_msg("status %d, '%s', for '%s'", (int)got, report.text, what);
    assert_null(polytope);
}

static void expect_refusals(const char *format, const struct refusal *refusals, size_t count) {
    for (size_t i = 0; i < count; i++)
        expect_refusal(refusals[i].text, strlen(refusals[i].text), format, refusals[i].status, refusals[i].what);
}

#define EXPECT_REFUSALS(format, refusals) expect_refusals(format, refusals, sizeof(refusals) / sizeof *(refusals))

static void must_read(const char *text, const char *format, uint32_t vertices, uint32_t facets) {
    pir_polytope *polytope = NULL;
    pir_report report = {PIR_OK, ""};
    if (read_bytes(text, strlen(text), format, &report, &polytope) != PIR_OK)
        fail_msg("%s", report.text);
    assert_int_equal(pir_polytope_is_valid(polytope), 1);
    assert_int_equal(pir_polytope_vertex_count(polytope), vertices);
    assert_int_equal(pir_polytope_facet_count(polytope), facets);
    pir_polytope_release(polytope);
}

/* --- OBJ --- */

#define CORNERS "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"

static void test_obj_statements(void **state) {
    (void)state;
    must_read("648 216\nmtllib ../../secret\n" CORNERS
              "vt 0 0\nvn 0 0 1\nusemtl \xC3\xA9\ng a b\ns off\nf 1/1/1 2//1 3/1\nf -1 -2 -3",
              "obj", 4, 4);
    must_read("f 1 2 3 # before its points\nv 0 0 \\\n0 1\r\nv 1 0 0 .1 .2 .3\nv 0 1 0 .1 .2 .3 .4\n", "obj", 3, 2);
    must_read("\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "obj", 3, 2);
    static const struct refusal refusals[] = {
        {"", PIR_ERR_EMPTY, "m: the file is empty"},
        {"# nothing\n", PIR_ERR_EMPTY, "m: the file has no points"},
        {"v 1 2\n", PIR_ERR_FORMAT, "m:1: vertex 1 has 2 numbers, not 3, 4, 6 or 7"},
        {"v 1 2 3 4 5\n", PIR_ERR_FORMAT, "m:1: vertex 1 has 5 numbers"},
        {"v 1 2 3 4 5 6 7 8\n", PIR_ERR_FORMAT, "m:1: vertex 1 has more than 7 numbers"},
        {"v 1 2 3 0.5\n", PIR_ERR_FORMAT, "m:1: vertex 1 has weight 0.5; only 1 is read"},
        {CORNERS "v 1 x 3\n", PIR_ERR_FORMAT, "m:5: 'x' in vertex 5 is not a number"},
        {CORNERS "v 1 1/2 3\n", PIR_ERR_FORMAT, "m:5: '1/2' in vertex 5 is not a number"},
        {CORNERS "v 1 nan 3\n", PIR_ERR_NOT_FINITE, "m:5: 'nan' in vertex 5 is not a finite number"},
        {CORNERS "v 1 1e999 3\n", PIR_ERR_NOT_FINITE, "m:5: '1e999' is beyond the largest double"},
        {CORNERS "f 1 2\n", PIR_ERR_FORMAT, "m:5: the facet has 2 corners; three or more are needed"},
        {CORNERS "f\n", PIR_ERR_FORMAT, "m:5: the facet has 0 corners"},
        {CORNERS "f 1 2 5\n", PIR_ERR_FORMAT, "m:5: a facet has corner 5; there are 4 vertices, counted from 1"},
        {CORNERS "f 1 2 4294967297\n", PIR_ERR_FORMAT, "m:5: a facet has corner '4294967297', beyond all vertices"},
        {CORNERS "f 1 2 99999999999999999999999999\n", PIR_ERR_FORMAT, "m:5: a facet has corner '99999"},
        {CORNERS "f 1 2 -5\n", PIR_ERR_FORMAT, "m:5: a facet has corner '-5' after 4 vertices"},
        {CORNERS "f 0 1 2\n", PIR_ERR_FORMAT, "m:5: '0' is not a corner of a facet"},
        {CORNERS "f 1 2 3/\n", PIR_ERR_FORMAT, "m:5: '3/' is not a corner of a facet"},
        {CORNERS "f 1 2 3//\n", PIR_ERR_FORMAT, "m:5: '3//' is not a corner of a facet"},
        {CORNERS "f 1 2 3/1/1/1\n", PIR_ERR_FORMAT, "m:5: '3/1/1/1' is not a corner of a facet"},
        {CORNERS "f 1 2 3.0\n", PIR_ERR_FORMAT, "m:5: '3.0' is not a corner of a facet"},
        {CORNERS "call other.obj\n", PIR_ERR_FORMAT, "m:5: 'call' statements are not read"},
        {CORNERS "csh rm\n", PIR_ERR_FORMAT, "m:5: 'csh' statements are not read"},
        {CORNERS "curv 0 1 1 2\n", PIR_ERR_FORMAT, "m:5: 'curv' statements are not read"},
        {CORNERS "\x01\x02\n", PIR_ERR_FORMAT, "m:5: '\?\?' is not an OBJ statement"},
    };
    EXPECT_REFUSALS("obj", refusals);
}

/* --- STL --- */

#define FACET(words) "facet normal 0 0 1\nouter loop\nvertex 0 0 0\n" words "vertex 0 1 0\nendloop\nendfacet\n"

static void test_stl_text(void **state) {
    (void)state;
    must_read("solid any name at all\n" FACET("vertex 1 0 0\n") "endsolid", "stl", 3, 2);
    must_read("SOLID\r\nFacet Normal nan nan NAN outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet "
              "ENDSOLID x y\n"
              "solid second\nendsolid\n",
              "stl", 3, 2);
    static const struct refusal refusals[] = {
        {"not an STL file", PIR_ERR_FORMAT, "m: the file neither begins with 'solid' nor holds the 84 bytes"},
        {"solid\nendsolid\n", PIR_ERR_EMPTY, "m: the file has no points"},
        {"solid\n", PIR_ERR_FORMAT, "m:1: the file ends before 'endsolid'"},
        {"solid\n" FACET(""), PIR_ERR_FORMAT, "m:6: 'endloop' stands where 'vertex' is due"},
        {"solid\n" FACET("vertex 1 0 0\nvertex 2 0 0\n"), PIR_ERR_FORMAT,
         "m:7: 'vertex' stands where 'endloop' is due"},
        {"solid\n" FACET("vertex 1 0\n"), PIR_ERR_FORMAT, "m:6: 'vertex' in vertex 1 is not a number"},
        {"solid\n" FACET("vertex 1 0 inf\n"), PIR_ERR_NOT_FINITE, "m:5: 'inf' in vertex 1 is not a finite number"},
        {"solid\n" FACET("vertex 1 0 0\n"), PIR_ERR_FORMAT, "m:8: the file ends before 'endsolid'"},
        {"solid\n" FACET("vertex 1 0 0\n") "endsolid\nmore", PIR_ERR_FORMAT, "m:10: 'more' follows the last solid"},
        {"solid\nfacet normal 0 0 up\n", PIR_ERR_FORMAT, "m:2: 'up' in a normal is not a number"},
        {"solid\nfacet outer\n", PIR_ERR_FORMAT, "m:2: 'outer' stands where 'normal' is due"},
        {"solid\nvertex 0 0 0\n", PIR_ERR_FORMAT, "m:2: 'vertex' stands where 'facet' or 'endsolid' is due"},
    };
    EXPECT_REFUSALS("stl", refusals);
}

/* A cube as a file, to be freed. */
static struct file_bytes cube(enum model_form form) {
    pir_polytope *polytope = NULL;
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_shape_create("cube", NULL, NULL, &polytope), PIR_OK);
    assert_int_equal(pir_mesh_from_polytope(polytope, &mesh), PIR_OK);
    struct file_bytes file = model_file(mesh, form);
    pir_mesh_destroy(mesh);
    pir_polytope_release(polytope);
    return file;
}

static void test_stl_binary(void **state) {
    (void)state;
    struct file_bytes file = cube(MODEL_STL_BINARY);
    assert_int_equal(file.size, 84 + 12 * 50);
    expect_refusal(file.data, file.size - 1, "stl", PIR_ERR_FORMAT,
                   "m: 12 triangles are promised at byte 80 and take 684 bytes in all; the file has 683");
    expect_refusal(file.data, 84, "stl", PIR_ERR_FORMAT, "m: 12 triangles are promised");
    expect_refusal(file.data, 83, "stl", PIR_ERR_FORMAT, "m: the file neither begins");
    // the name of a binary file may look like text
    memcpy(file.data, "solid x", 7);
    pir_polytope *polytope = NULL;
    assert_int_equal(read_bytes(file.data, file.size, "stl", NULL, &polytope), PIR_OK);
    pir_polytope_release(polytope);
    // a normal may be anything, a corner may not
    memset(file.data + 84, 0xFF, 12);
    assert_int_equal(read_bytes(file.data, file.size, "stl", NULL, &polytope), PIR_OK);
    pir_polytope_release(polytope);
    memset(file.data + 84 + 3 * 50 + 12 + 12 + 4, 0xFF, 4);
    expect_refusal(file.data, file.size, "stl", PIR_ERR_NOT_FINITE,
                   "m: triangle 3, at byte 258, has a coordinate that is not a finite number");
    // more triangles than any file holds
    memcpy(file.data, "a model", 7);
    memset(file.data + 80, 0xFF, 4);
    expect_refusal(file.data, file.size, "stl", PIR_ERR_FORMAT, "m: 4294967295 triangles are promised");
    memset(file.data + 80, 0, 4);
    expect_refusal(file.data, 84, "stl", PIR_ERR_EMPTY, "m: the file has no points");
    free(file.data);
}

/* --- PLY --- */

#define XYZ      "property float x\nproperty float y\nproperty float z\n"
#define ASCII    "ply\nformat ascii 1.0\n"
#define VERTICES ASCII "element vertex 3\n" XYZ
#define FACES    VERTICES "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"

static void test_ply_headers(void **state) {
    (void)state;
    must_read(
        ASCII
        "comment x\nobj_info y\nelement camera 1\nproperty float fov\nproperty list uint float list\nelement vertex 3\n"
        "property uchar red\n" XYZ "end_header\n1.5 2 7 nan\n1 0 0 0\n2 1 0 0\n3 0 1 0",
        "ply", 3, 2);
    must_read(
        "ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty int x\r\nproperty int8 y\r\nproperty double z\r\n"
        "element face 0\r\nend_header\r\n1 2 3\r\n",
        "ply", 1, 0);
    static const struct refusal refusals[] = {
        {"garbage", PIR_ERR_FORMAT, "m:1: the file does not begin with a line 'ply'"},
        {"ply", PIR_ERR_FORMAT, "m:1: the file does not begin with a line 'ply'"},
        {"plyx\n", PIR_ERR_FORMAT, "m:1: the file does not begin with a line 'ply'"},
        {"ply\n", PIR_ERR_FORMAT, "m:1: the file ends before 'end_header'"},
        {VERTICES, PIR_ERR_FORMAT, "m:6: the file ends before 'end_header'"},
        {VERTICES "end_header", PIR_ERR_FORMAT, "m:7: 'end_header' is not followed by the end of a line as in line 1"},
        {VERTICES "end_header 0 0 0", PIR_ERR_FORMAT, "m:7: 'end_header' is not followed by the end of a line"},
        {VERTICES "end_header\r1 2 3\n", PIR_ERR_FORMAT, "m:7: 'end_header' is not followed by the end of a line"},
        {VERTICES "end_headerr\n", PIR_ERR_FORMAT, "m:7: 'end_headerr' is not a line of a PLY header"},
        {"ply\nelement vertex 1\n" XYZ "end_header\n1 2 3\n", PIR_ERR_FORMAT, "m:6: the header has no line 'format'"},
        {ASCII "format ascii 1.0\n", PIR_ERR_FORMAT, "m:3: the format is given twice"},
        {"ply\nformat utf8 1.0\n", PIR_ERR_FORMAT,
         "m:2: 'utf8' is not ascii, binary_little_endian or binary_big_endian"},
        {"ply\nformat ascii 1.1\n", PIR_ERR_FORMAT, "m:2: '1.1' is not version 1.0"},
        {"ply\nformat ascii\n", PIR_ERR_FORMAT, "m:2: the line ends before the version"},
        {"ply\nformat ascii 1.0 x\n", PIR_ERR_FORMAT, "m:2: 'x' is one word too many on this line"},
        {ASCII "element vertex\n", PIR_ERR_FORMAT, "m:3: the line ends before the number of elements"},
        {ASCII "element vertex -1\n", PIR_ERR_FORMAT, "m:3: '-1' is not a number of elements"},
        {ASCII "element vertex 3x\n", PIR_ERR_FORMAT, "m:3: '3x' is not a number of elements"},
        {VERTICES "element vertex 3\n", PIR_ERR_FORMAT, "m:7: element vertex is on line 3 already"},
        {ASCII "property float x\n", PIR_ERR_FORMAT, "m:3: a property stands before any element"},
        {VERTICES "property float x\n", PIR_ERR_FORMAT, "m:7: element vertex has property x already"},
        {VERTICES "property half w\n", PIR_ERR_FORMAT, "m:7: 'half' is not the type of a property"},
        {VERTICES "property list float int w\n", PIR_ERR_FORMAT, "m:7: the size of a list is no integer"},
        {ASCII "element vertex 1\nproperty list uchar float x\n", PIR_ERR_FORMAT,
         "m:4: property x of element vertex is a list"},
        {ASCII "element face 1\nproperty int vertex_index\n", PIR_ERR_FORMAT,
         "m:4: property vertex_index of element face is no list"},
        {ASCII "element face 1\nproperty list uchar float vertex_index\n", PIR_ERR_FORMAT,
         "m:4: the corners of faces are no integers"},
        {ASCII "element tristrips 1\n", PIR_ERR_FORMAT, "m:3: strips of triangles are not read"},
        {ASCII "element vertex 1\nproperty float x\nproperty float z\nend_header\n", PIR_ERR_FORMAT,
         "m:6: element vertex has no property y"},
        {VERTICES "element face 1\nproperty uchar a\nend_header\n", PIR_ERR_FORMAT,
         "m:9: element face has no list vertex_indices"},
        {ASCII "element stuff 1000000000\nelement vertex 1\n" XYZ "end_header\n", PIR_ERR_FORMAT,
         "m:3: element stuff has no properties"},
        {ASCII "end_header\n", PIR_ERR_EMPTY, "m:3: the file has no vertices"},
        {ASCII "element vertex 0\n" XYZ "end_header\n", PIR_ERR_EMPTY, "m:7: the file has no vertices"},
    };
    EXPECT_REFUSALS("ply", refusals);
}

static void test_ply_bodies(void **state) {
    (void)state;
    static const struct refusal refusals[] = {
        {VERTICES "end_header\n", PIR_ERR_FORMAT,
         "m:3: 3 elements vertex are promised; the 0 bytes that follow cannot hold them"},
        {ASCII "element vertex 3000000000\n" XYZ "end_header\n", PIR_ERR_FORMAT,
         "m:3: 3000000000 elements vertex are promised"},
        {ASCII "element vertex 99999999999999999999999\n" XYZ "end_header\n", PIR_ERR_FORMAT,
         "m:3: 18446744073709551615 elements"},
        {VERTICES "end_header\n0 0 0\n1 0\n0 1 0\n2 2 2\n", PIR_ERR_FORMAT,
         "m:9: vertex 1: the line ends before its last value"},
        {VERTICES "end_header\n0 0 0\n1 0 0 0\n0 1 0\n", PIR_ERR_FORMAT,
         "m:9: vertex 1: '0' is one value too many on its line"},
        {VERTICES "end_header\n0.000 0.000 0.000\n1 0 0\n", PIR_ERR_FORMAT, "m:9: vertex 2: the file ends before it"},
        {VERTICES "end_header\n0 0 0\n1 nan 0\n0 1 0\n", PIR_ERR_NOT_FINITE,
         "m:9: 'nan' in vertex 1 is not a finite number"},
        {VERTICES "end_header\n0 0 0\n1 x 0\n0 1 0\n", PIR_ERR_FORMAT, "m:9: 'x' in vertex 1 is not a number"},
        {FACES "3 0 1 2\n7\n", PIR_ERR_FORMAT, "m:14: '7' follows the last element"},
        {FACES "3 0 1 3\n", PIR_ERR_FORMAT, "m:13: face 0: it has corner 3; there are 3 vertices, counted from 0"},
        {FACES "3 0 1 -1\n", PIR_ERR_FORMAT, "m:13: face 0: '-1' is not a size or an index"},
        {FACES "2 0 1\n", PIR_ERR_FORMAT, "m:13: face 0: it has 2 corners; three or more are needed"},
        {FACES "4000000000 0 1 2\n", PIR_ERR_FORMAT, "m:13: face 0: list vertex_indices promises 4000000000 values"},
        {FACES "4 0 1 2\n", PIR_ERR_FORMAT, "m:13: face 0: the line ends before its last value"},
    };
    EXPECT_REFUSALS("ply", refusals);
    must_read(FACES "3 0 1 2", "ply", 3, 2);
}

static void test_ply_with_more_properties_than_there_is_room_for(void **state) {
    (void)state;
    char text[8192];
    size_t size = (size_t)snprintf(text, sizeof text, ASCII "element vertex 1\n" XYZ);
    for (int i = 0; i < 254; i++)
        size += (size_t)snprintf(text + size, sizeof text - size, "property float a%d\n", i);
    snprintf(text + size, sizeof text - size, "end_header\n");
    expect_refusal(text, strlen(text), "ply", PIR_ERR_LIMIT, "m:260: more than 256 properties");
}

static void test_ply_binary(void **state) {
    (void)state;
    static const char many[] =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list int int vertex_index\nend_header\n"
        "\0\0\0\0\0\0\0\0\0\0\0\0\xFF\xFF\xFF\x7F";
    expect_refusal(many, sizeof many - 1, "ply", PIR_ERR_FORMAT, "m: face 0, at byte");
    for (int form = MODEL_PLY_LITTLE; form <= MODEL_PLY_BIG; form++) {
        struct file_bytes file = cube((enum model_form)form);
        pir_polytope *polytope = NULL;
        assert_int_equal(read_bytes(file.data, file.size, "ply", NULL, &polytope), PIR_OK);
        assert_true(pir_polytope_volume(polytope) == 1);
        pir_polytope_release(polytope);
        // cut off anywhere, it is refused
        for (size_t size = 0; size < file.size; size++) {
            pir_report report = {PIR_OK, ""};
            assert_int_not_equal(read_bytes(file.data, size, "ply", &report, &polytope), PIR_OK);
            assert_memory_equal(report.text, "m", 1);
        }
        // and so it is with a byte too many
        file_append(&file, "", 1);
        expect_refusal(file.data, file.size, "ply", PIR_ERR_FORMAT,
                       "m: 1 bytes follow the last element, which ends at byte");
        free(file.data);
    }
}

static void test_formats_that_do_not_exist(void **state) {
    (void)state;
    expect_refusal("x", 1, "gltf", PIR_ERR_ARGUMENT, "m: 'gltf' is none of off obj stl ply");
    expect_refusal("x", 1, "svg", PIR_ERR_ARGUMENT, "m: 'svg' is none of off obj stl ply");
    pir_polytope *polytope = NULL;
    assert_int_equal(pir_polytope_read_bytes(NULL, NULL, NULL, NULL, &polytope), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_read_bytes(&(pir_file_bytes){"x", 1, "m", NULL}, NULL, NULL, NULL, &polytope),
                     PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_read_bytes(&(pir_file_bytes){NULL, 1, "m", "off"}, NULL, NULL, NULL, &polytope),
                     PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_read_bytes(&(pir_file_bytes){"x", 1, "m", "off"}, NULL, NULL, NULL, NULL),
                     PIR_ERR_ARGUMENT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_obj_statements), cmocka_unit_test(test_stl_text),
        cmocka_unit_test(test_stl_binary),     cmocka_unit_test(test_ply_headers),
        cmocka_unit_test(test_ply_bodies),     cmocka_unit_test(test_ply_with_more_properties_than_there_is_room_for),
        cmocka_unit_test(test_ply_binary),     cmocka_unit_test(test_formats_that_do_not_exist),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
