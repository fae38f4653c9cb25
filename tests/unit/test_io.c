/* SPDX-License-Identifier: MIT */
/*
 * Models and meshes to and from files: what must read reads exactly, what must not says what, where and why.
 *
 * Files are written to a directory of the test's own, which is gone at the end.
 */
#include <float.h>
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

#include "off_texts.h"

/* --- the directory --- */

struct directory {
    char path[80];
    char file[160];
};

static int make_directory(void **state) {
    const char *parent = getenv("TMPDIR");
    struct directory *directory = calloc(1, sizeof *directory);
    if (!directory)
        return -1;
    if (!parent || strlen(parent) > 32)
        parent = ".";
    snprintf(directory->path, sizeof directory->path, "%s/pirouette-io-XXXXXX", parent);
    *state = directory;
    return mkdtemp(directory->path) ? 0 : -1;
}

/* Fails when a test left anything behind. */
static int remove_directory(void **state) {
    struct directory *directory = *state;
    int left = rmdir(directory->path);
    free(directory);
    return left;
}

/* The path of `name` in the directory, until the next call. */
static const char *path_of(void **state, const char *name) {
    struct directory *directory = *state;
    snprintf(directory->file, sizeof directory->file, "%s/%s", directory->path, name);
    return directory->file;
}

static void put_file(const char *path, const void *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* A file's bytes as a string to be freed. */
static char *get_file(const char *path) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    long size = ftell(file);
    rewind(file);
    char *text = calloc((size_t)size + 1, 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)size, file), size);
    fclose(file);
    return text;
}

/* --- what reads --- */

static void test_plain_models_of_every_dimension(void **state) {
    (void)state;
    expect_counts(must_read(CUBE), 8, 12, 6);
    expect_counts(must_read("OFF 4 0 0 0 0 0 1 0 0 0 1 0 0 0 1"), 4, 6, 4);
    expect_counts(must_read("OFF\n3 2 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n"), 3, 3, 2);
    expect_counts(must_read("OFF\n2 0 0\n0 0 0\n1 2 3\n"), 2, 1, 0);
    expect_counts(must_read("OFF\n1 0 0\n1 2 3\n"), 1, 0, 0);
}

static void test_comments_blank_lines_and_line_ends(void **state) {
    (void)state;
    expect_counts(
        must_read(
            "\xEF\xBB\xBF# made by hand\r\n\r\nOFF # header\r\n4 4 6\r\n0 0 0 # origin\r\n1 0 0#x\r\n\r\n0 1 0\r\n"
            "# between\r\n0 0 1\r\n3 0 2 1\r\n3 0 1 3\r\n3 1 2 3\r\n3 2 0 3 # last\r\n# end"),
        4, 6, 4);
    expect_counts(must_read("OFF\r4 0 0\r0 0 0#a\r1 0 0\r0 1 0\r0 0 1\r"), 4, 6, 4);
}

static void test_facets_with_colours_and_on_two_lines(void **state) {
    (void)state;
    expect_counts(must_read(TETRAHEDRON "3 0 2 1 255 0 0\n3 0 1\n3 0.5 0.5 0.5 1.0\n3 1 2 3 7\n3 2 0 3"), 4, 6, 4);
}

static void test_facets_counted_from_one_or_listed_inside_out(void **state) {
    (void)state;
    expect_counts(must_read(TETRAHEDRON "3 1 3 2\n3 1 2 4\n3 2 3 4\n3 3 1 4\n"), 4, 6, 4);
    expect_counts(must_read(TETRAHEDRON "3 0 1 2\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"), 4, 6, 4);
}

static void test_edge_count_left_out(void **state) {
    (void)state;
    expect_counts(must_read("OFF\n4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"), 4, 6, 4);
    expect_counts(must_read("OFF\n4 0\n6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"), 4, 6, 4);
}

static void test_numbers_in_all_their_forms(void **state) {
    (void)state;
    pir_polytope *p =
        must_read("OFF\n4 0 0\n+1 -0 .5\n1e3 5. 1E-3\n-1e-400 1/2 -6/-4\n0.1 10000000000000000000000 2/4\n");
    const pir_vec3 expected[4] = {{1, 0, 0.5}, {1000, 5, 0.001}, {0, 0.5, 1.5}, {0.1, 1e22, 0.5}};
    for (uint32_t v = 0; v < 4; v++) {
        pir_vec3 vertex = pir_polytope_vertex(p, v);
        assert_true(vertex.x == expected[v].x && vertex.y == expected[v].y && vertex.z == expected[v].z);
    }
    pir_polytope_release(p);
}

/* Writes the polytope's mesh to `path`. */
static void write_mesh(const pir_polytope *polytope, const char *path, int exact) {
    pir_mesh *mesh = NULL;
    pir_report report = {PIR_OK, ""};
    assert_int_equal(pir_mesh_from_polytope(polytope, &mesh), PIR_OK);
    if (pir_mesh_write(mesh, path, exact, &report) != PIR_OK)
        fail_msg("%s", report.text);
    pir_mesh_destroy(mesh);
}

/* --- round trips --- */

static void test_rationals_and_long_integers_stay_exact(void **state) {
    const char *const coordinates[4][3] = {{"1/3", "-2/7", "0"},
                                           {"9007199254740993", "1", "5/123456789012345678901234567890"},
                                           {"0", "123456789012345678901234567891", "0"},
                                           {"-1", "1/10", "7"}};
    char text[512] = "OFF\n4 0 0\n";
    for (int v = 0; v < 4; v++)
        for (int axis = 0; axis < 3; axis++)
            strcat(strcat(text, coordinates[v][axis]), axis < 2 ? " " : "\n");
    pir_polytope *p = must_read(text);
    const char *path = path_of(state, "exact.off");
    write_mesh(p, path, 1);
    pir_polytope_release(p);
    pir_report report = {PIR_OK, ""};
    assert_int_equal(pir_polytope_read(path, NULL, &report, NULL, &p), PIR_OK);
    remove(path);
    mpq_t vertex[3], expected;
    mpq_inits(vertex[0], vertex[1], vertex[2], expected, NULL);
    for (uint32_t v = 0; v < 4; v++) {
        pir_polytope_vertex_exact(p, v, vertex);
        for (int axis = 0; axis < 3; axis++) {
            mpq_set_str(expected, coordinates[v][axis], 10);
            mpq_canonicalize(expected);
            assert_true(mpq_equal(vertex[axis], expected));
        }
    }
    mpq_clears(vertex[0], vertex[1], vertex[2], expected, NULL);
    pir_polytope_release(p);
}

static pir_polytope *awkward_doubles(void) {
    const pir_vec3 points[5] = {{0.1, 0.2, 0.30000000000000004},
                                {1.0 / 3, -DBL_MAX / 4, 5e-324},
                                {1e22, 123456789.123456789, -DBL_MIN},
                                {-7, 2.2250738585072011e-308, 1e-5},
                                {3, DBL_MAX, 9007199254740993.0}};
    pir_polytope *p = NULL;
    assert_int_equal(pir_polytope_create(points, 5, NULL, &p), PIR_OK);
    return p;
}

/* The polytope written and read back has the same mesh, bit for bit. */
static void expect_same_after_off(void **state, const pir_polytope *p, int exact) {
    const char *path = path_of(state, "trip.off");
    write_mesh(p, path, exact);
    pir_polytope *q = NULL;
    pir_report report = {PIR_OK, ""};
    if (pir_polytope_read(path, NULL, &report, NULL, &q) != PIR_OK)
        fail_msg("%s", report.text);
    remove(path);
    pir_mesh *a = NULL, *b = NULL;
    assert_int_equal(pir_mesh_from_polytope(p, &a), PIR_OK);
    assert_int_equal(pir_mesh_from_polytope(q, &b), PIR_OK);
    assert_int_equal(pir_mesh_equal(a, b), 1);
    pir_mesh_destroy(a);
    pir_mesh_destroy(b);
    pir_polytope_release(q);
}

static void test_doubles_read_back_as_themselves(void **state) {
    pir_polytope *p = awkward_doubles();
    expect_same_after_off(state, p, 0);
    expect_same_after_off(state, p, 1);
    pir_polytope_release(p);
}

static void test_decimal_comma_of_a_locale_stays_out(void **state) {
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8", "de_DE", "fr_FR"};
    bool set = false;
    for (size_t i = 0; i < sizeof names / sizeof *names && !set; i++)
        set = setlocale(LC_NUMERIC, names[i]) && strcmp(localeconv()->decimal_point, ",") == 0;
    if (!set)
        skip(); // no such locale on this machine
    pir_polytope *p = awkward_doubles();
    expect_same_after_off(state, p, 0);
    const char *path = path_of(state, "comma.svg");
    write_mesh(p, path, 0);
    char *with_comma = get_file(path);
    setlocale(LC_NUMERIC, "C");
    write_mesh(p, path, 0);
    char *plain = get_file(path);
    remove(path);
    assert_string_equal(with_comma, plain);
    free(with_comma);
    free(plain);
    pir_polytope_release(p);
}

/* --- files --- */

static void expect_file_refusal(const char *path, pir_status status, const char *what) {
    pir_polytope *polytope = NULL;
    pir_report report = {PIR_OK, ""};
    assert_int_equal(pir_polytope_read(path, NULL, &report, NULL, &polytope), status);
    if (!strstr(report.text, what))
        fail_msg("'%s' does not say '%s'", report.text, what);
    assert_null(polytope);
}

static void test_files_that_cannot_be_read(void **state) {
    expect_file_refusal(path_of(state, "missing.off"), PIR_ERR_FILE, "missing.off: cannot open: No such file");
    expect_file_refusal(path_of(state, "missing.obj"), PIR_ERR_FILE, "missing.obj: cannot open: No such file");
    expect_file_refusal(path_of(state, "model.xyz"), PIR_ERR_ARGUMENT,
                        "model.xyz: the name ends in none of .off .obj .stl .ply");
    expect_file_refusal(path_of(state, "model.svg"), PIR_ERR_ARGUMENT, "written, not read");
    const char *path = path_of(state, "nothing.off");
    put_file(path, "", 0);
    expect_file_refusal(path, PIR_ERR_EMPTY, "nothing.off: the file is empty");
    remove(path);
    // A directory whose name ends as a model's does.
    path = path_of(state, "d.off");
    assert_int_equal(mkdir(path, 0700), 0);
    expect_file_refusal(path, PIR_ERR_FILE, "d.off: cannot read: Is a directory");
    rmdir(path);
}

/* A pipe has no size: what comes is read piece by piece until its end. */
static void test_pipes_are_read_to_their_end(void **state) {
    const char *path = path_of(state, "pipe.off");
    assert_int_equal(mkfifo(path, 0600), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        FILE *file = fopen(path, "w");
        fputs("OFF\n4 0 0\n0 0 0\n1 0 0\n0 1 0\n", file);
        for (int line = 0; line < 20000; line++)
            fprintf(file, "# line %d\n", line);
        fputs("0 0 7\n", file);
        _exit(fclose(file) ? 1 : 0);
    }
    pir_polytope *p = NULL;
    pir_report report = {PIR_OK, ""};
    pir_status status = pir_polytope_read(path, NULL, &report, NULL, &p);
    int how;
    assert_int_equal(waitpid(child, &how, 0), child);
    remove(path);
    assert_true(status == PIR_OK && WIFEXITED(how) && WEXITSTATUS(how) == 0);
    assert_int_equal(pir_polytope_vertex_count(p), 4);
    assert_true(pir_polytope_vertex(p, 3).z == 7);
    pir_polytope_release(p);
}

static void test_long_path_leaves_room_for_the_reason(void **state) {
    (void)state;
    char path[600];
    memset(path, 'a', sizeof path);
    strcpy(path + sizeof path - 5, ".off");
    expect_file_refusal(path, PIR_ERR_FILE, "a.off: cannot open: File name too long");
}

static size_t count_of(const char *text, const char *word) {
    size_t count = 0;
    for (; (text = strstr(text, word)) != NULL; text++)
        count++;
    return count;
}

/* The picture of a body: so many paths, and numbers all. */
static void expect_picture(void **state, const char *off, size_t paths, const char *title) {
    pir_polytope *p = must_read(off);
    const char *path = path_of(state, "picture.svg");
    write_mesh(p, path, 0);
    pir_polytope_release(p);
    char *svg = get_file(path);
    remove(path);
    assert_int_equal(count_of(svg, "<path"), paths);
    assert_non_null(strstr(svg, title));
    assert_null(strstr(svg, "nan"));
    assert_null(strstr(svg, "inf"));
    assert_int_equal(strcmp(svg + strlen(svg) - 7, "</svg>\n"), 0);
    free(svg);
}

static void test_pictures_show_the_facets_that_face_the_viewer(void **state) {
    expect_picture(state, CUBE, 3, "8 vertices, 12 edges, 6 facets");
    expect_picture(state, "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", 1, "3 vertices, 3 edges, 2 facets");
    expect_picture(state, "OFF\n2 0 0\n0 0 0\n1 2 3\n", 1, "2 vertices");
    expect_picture(state, "OFF\n1 0 0\n1e300 2 3\n", 0, "1 vertices");
    expect_picture(state, "OFF\n4 0 0\n-1.7e308 0 0\n1.7e308 0 0\n0 1.7e308 0\n0 0 1.7e308\n", 2, "4 vertices");
    expect_picture(state, "OFF\n4 0 0\n0 0 0\n5e-324 0 0\n0 5e-324 0\n0 0 5e-324\n", 1, "4 vertices");
}

static void test_obj_stl_and_ply_that_are_wrong(void **state) {
    static const struct {
        const char *name, *text;
    } broken[] = {
        {"a.ply", "ply\nformat ascii 1.0\nelement vertex 3000000000\nend_header\n"},
        {"b.stl", "not an STL file"},
        {"c.ply", "garbage"},
    };
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
        const char *path = path_of(state, broken[i].name);
        put_file(path, broken[i].text, strlen(broken[i].text));
        pir_polytope *p = NULL;
        pir_report report = {PIR_OK, ""};
        pir_status status = pir_polytope_read(path, NULL, &report, NULL, &p);
        assert_true(status == PIR_ERR_FORMAT || status == PIR_ERR_EMPTY);
        assert_non_null(strstr(report.text, broken[i].name));
        assert_null(p);
        remove(path);
    }
}

static void test_missing_arguments(void **state) {
    (void)state;
    pir_polytope *p = NULL;
    pir_report report = {PIR_OK, ""};
    assert_int_equal(pir_polytope_read(NULL, NULL, &report, NULL, &p), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_read("a.off", NULL, NULL, NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_read_bytes(&(pir_file_bytes){NULL, 5, NULL, "off"}, NULL, &report, NULL, &p),
                     PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_read_bytes(&(pir_file_bytes){"OFF", 3, NULL, "off"}, NULL, NULL, NULL, NULL),
                     PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_read_bytes(&(pir_file_bytes){"OFF", 3, NULL, "off"}, NULL, NULL, NULL, &p),
                     PIR_ERR_FORMAT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plain_models_of_every_dimension),
        cmocka_unit_test(test_comments_blank_lines_and_line_ends),
        cmocka_unit_test(test_facets_with_colours_and_on_two_lines),
        cmocka_unit_test(test_facets_counted_from_one_or_listed_inside_out),
        cmocka_unit_test(test_edge_count_left_out),
        cmocka_unit_test(test_numbers_in_all_their_forms),
        cmocka_unit_test(test_rationals_and_long_integers_stay_exact),
        cmocka_unit_test(test_doubles_read_back_as_themselves),
        cmocka_unit_test(test_decimal_comma_of_a_locale_stays_out),
        cmocka_unit_test(test_files_that_cannot_be_read),
        cmocka_unit_test(test_pipes_are_read_to_their_end),
        cmocka_unit_test(test_long_path_leaves_room_for_the_reason),
        cmocka_unit_test(test_pictures_show_the_facets_that_face_the_viewer),
        cmocka_unit_test(test_obj_stl_and_ply_that_are_wrong),
        cmocka_unit_test(test_missing_arguments),
    };
    return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
