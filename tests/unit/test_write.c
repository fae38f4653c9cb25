/* SPDX-License-Identifier: MIT */
/*
 * Where a mesh goes: through links, over files, into what is no file, and what is left when that fails.
 *
 * Everything is written to a directory of the test's own, which is gone at the end; the test is in that directory.
 */
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <pirouette/pirouette.h>

#include "support/test.h"

/* A user who may write nothing of root's. */
#define NOBODY 65534

/* Files of a failing test that are removed with the directory. */
static const char *const names[] = {"cube.off",     "CUBE.OFF",     "link.off", "far.off",
                                    "sub/near.off", "sub/back.off", "sub",      "fifo.off"};

struct place {
    char path[80];
    int before; /* the directory that the process was in */
    pir_mesh *cube;
};

static int enter_directory(void **state) {
    const char *parent = getenv("TMPDIR");
    struct place *place = calloc(1, sizeof *place);
    if (!place)
        return -1;
    pir_polytope *p = NULL;
    snprintf(place->path, sizeof place->path, "%s/pirouette-write-XXXXXX",
             parent && strlen(parent) < 32 ? parent : "/tmp");
    place->before = open(".", O_RDONLY);
    *state = place;
    if (place->before < 0 || !mkdtemp(place->path) || chdir(place->path) != 0 || chmod(".", 0777) != 0)
        return -1;
    if (pir_shape_create("cube", NULL, NULL, &p) != PIR_OK || pir_mesh_from_polytope(p, &place->cube) != PIR_OK)
        return -1;
    pir_polytope_release(p);
    return 0;
}

/* Fails when a test left anything but its own files behind. */
static int leave_directory(void **state) {
    struct place *place = *state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        remove(names[i]);
    int left = fchdir(place->before) != 0 || rmdir(place->path) != 0;
    close(place->before);
    pir_mesh_destroy(place->cube);
    free(place);
    return left;
}

static void put_file(const char *path, const char *text) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fputs(text, file) < 0, 0);
    assert_int_equal(fclose(file), 0);
}

static void expect_text(const char *path, const char *text) {
    char bytes[4096];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    bytes[fread(bytes, 1, sizeof bytes - 1, file)] = '\0';
    fclose(file);
    assert_string_equal(bytes, text);
}

/* The cube as OFF, as the stream has it. */
static const char *cube_text(void **state) {
    static char text[1024];
    struct place *place = *state;
    FILE *file = tmpfile();
    assert_non_null(file);
    assert_int_equal(pir_mesh_write_stream(place->cube, file, "cube", "off", 0, NULL), PIR_OK);
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    assert_int_equal(strncmp(text, "OFF\n8 6 12\n", 11), 0);
    return text;
}

static void must_write(void **state, const char *path) {
    struct place *place = *state;
    pir_report report = {PIR_OK, ""};
    pir_status status = pir_mesh_write(place->cube, path, 0, &report);
    expect(status == PIR_OK, "%s: %s", path, report.text);
}

static void must_refuse(void **state, const char *path, int exact, pir_status status, const char *why) {
    struct place *place = *state;
    pir_report report = {PIR_OK, ""};
    assert_int_equal(pir_mesh_write(place->cube, path, exact, &report), status);
    expect(strstr(report.text, why), "'%s' lacks '%s'", report.text, why);
}

static void test_a_file_is_replaced_and_nothing_is_left_beside_it(void **state) {
    const char *text = cube_text(state);
    put_file("CUBE.OFF", "old");
    must_write(state, "CUBE.OFF");
    expect_text("CUBE.OFF", text);
    // a name that another writer holds is passed over and left alone
    char other[64];
    snprintf(other, sizeof other, ".pirouette-%ld-0", (long)getpid());
    put_file(other, "other");
    must_write(state, "cube.off");
    expect_text("cube.off", text);
    expect_text(other, "other");
    remove(other);
}

static void test_what_cannot_be_written_says_why(void **state) {
    must_refuse(state, "none/cube.off", 0, PIR_ERR_FILE, "cube.off: cannot write: No such file");
    must_refuse(state, "cube.txt", 0, PIR_ERR_ARGUMENT, "cube.txt: the name does not end in");
    must_refuse(state, "cube.svg", 1, PIR_ERR_ARGUMENT, "only .off holds exact coordinates");
    assert_int_equal(mkdir("sub", 0777), 0);
    assert_int_equal(symlink("sub", "cube.off"), 0);
    must_refuse(state, "cube.off", 0, PIR_ERR_FILE, "cube.off: cannot write: Is a directory");
    // a path one byte too long for the system, and one that fits while the name beside it does not
    char path[4200];
    memset(path, 'a', sizeof path);
    strcpy(path + sizeof path - 5, ".off");
    must_refuse(state, path, 0, PIR_ERR_FILE, "cannot write: File name too long");
    for (size_t i = 0; i < sizeof path; i += 2)
        memcpy(path + i, "./", 2);
    strcpy(path + 4090, "a.off");
    must_refuse(state, path, 0, PIR_ERR_FILE, "cannot write: File name too long");
}

/* Links to links, from another folder, to what is not there yet: all stay, and what they lead to is written. */
static void test_links_stay_and_what_they_lead_to_is_written(void **state) {
    struct place *place = *state;
    struct stat about;
    char target[200];
    const char *text = cube_text(state);
    snprintf(target, sizeof target, "%s/far.off", place->path);
    assert_int_equal(mkdir("sub", 0777), 0);
    assert_int_equal(symlink("sub/near.off", "link.off"), 0);
    assert_int_equal(symlink("back.off", "sub/near.off"), 0);
    assert_int_equal(symlink(target, "sub/back.off"), 0);
    for (int time = 0; time < 2; time++) {
        must_write(state, "link.off");
        expect_text("far.off", text);
        put_file("far.off", "old");
    }
    assert_int_equal(lstat("link.off", &about) == 0 && S_ISLNK(about.st_mode), 1);
    assert_int_equal(lstat("sub/near.off", &about) == 0 && S_ISLNK(about.st_mode), 1);
    assert_int_equal(lstat("sub/back.off", &about) == 0 && S_ISLNK(about.st_mode), 1);
    assert_int_equal(lstat("far.off", &about) == 0 && S_ISREG(about.st_mode), 1);
}

static void test_links_in_a_circle_are_refused(void **state) {
    assert_int_equal(symlink("far.off", "link.off"), 0);
    assert_int_equal(symlink("link.off", "far.off"), 0);
    must_refuse(state, "link.off", 0, PIR_ERR_FILE, "link.off: cannot write: Too many levels of symbolic links");
}

static void test_a_replaced_file_keeps_its_permissions(void **state) {
    struct stat about;
    put_file("cube.off", "old");
    assert_int_equal(chmod("cube.off", 0640), 0);
    must_write(state, "cube.off");
    assert_int_equal(stat("cube.off", &about), 0);
    assert_int_equal(about.st_mode & 07777, 0640);
    // one that may not be written to is not replaced either, though its folder would allow that
    assert_int_equal(chmod("cube.off", 0444), 0);
    put_file("far.off", "");
    assert_int_equal(chmod("far.off", 0666), 0);
    pid_t child = fork();
    if (child == 0) {
        struct place *place = *state;
        bool other = geteuid() != 0 || setuid(NOBODY) == 0;
        bool refused = pir_mesh_write(place->cube, "cube.off", 0, NULL) == PIR_ERR_FILE;
        bool written = pir_mesh_write(place->cube, "far.off", 0, NULL) == PIR_OK;
        _exit(other && refused && written ? 0 : 1);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
}

static void test_a_fifo_is_written_to_and_stays(void **state) {
    struct stat about;
    char bytes[1024];
    const char *text = cube_text(state);
    assert_int_equal(mkfifo("fifo.off", 0666), 0);
    assert_int_equal(symlink("fifo.off", "link.off"), 0);
    int reader = open("fifo.off", O_RDONLY | O_NONBLOCK);
    assert_true(reader >= 0);
    const char *const paths[] = {"fifo.off", "link.off"};
    for (size_t i = 0; i < 2; i++) {
        must_write(state, paths[i]);
        ssize_t size = read(reader, bytes, sizeof bytes - 1);
        assert_true(size > 0);
        bytes[size] = '\0';
        assert_string_equal(bytes, text);
    }
    close(reader);
    assert_int_equal(lstat("fifo.off", &about) == 0 && S_ISFIFO(about.st_mode), 1);
}

/* A limit on the size of files stands for a disk that is full. */
static void test_a_full_disk_leaves_the_file_as_it_was(void **state) {
    struct rlimit before;
    put_file("cube.off", "old");
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &(struct rlimit){16, before.rlim_max}), 0);
    struct place *place = *state;
    pir_report report = {PIR_OK, ""};
    pir_status replaced = pir_mesh_write(place->cube, "cube.off", 0, &report);
    pir_status made = pir_mesh_write(place->cube, "far.off", 0, NULL);
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
    assert_int_equal(replaced, PIR_ERR_FILE);
    assert_int_equal(made, PIR_ERR_FILE);
    assert_string_equal(report.text, "cube.off: cannot write: File too large");
    expect_text("cube.off", "old");
    assert_int_not_equal(access("far.off", F_OK), 0);
}

static void test_streams_hold_what_files_do(void **state) {
    struct place *place = *state;
    const char *text = cube_text(state);
    must_write(state, "cube.off");
    expect_text("cube.off", text);
    pir_report report = {PIR_OK, ""};
    FILE *file = tmpfile();
    assert_non_null(file);
    assert_int_equal(pir_mesh_write_stream(place->cube, file, "a", "svg", 0, &report), PIR_OK);
    assert_true(ftell(file) > 500);
    const char *const formats[] = {"obj", "stl", "ply"};
    for (size_t i = 0; i < 3; i++) {
        rewind(file);
        pir_status status = pir_mesh_write_stream(place->cube, file, "a", formats[i], 0, &report);
        assert_true(status == PIR_OK && ftell(file) > 100);
        assert_int_equal(pir_mesh_write_stream(place->cube, file, "a", formats[i], 1, &report), PIR_ERR_ARGUMENT);
        assert_string_equal(report.text, "a: only .off holds exact coordinates");
    }
    const char *const unknown[] = {"", "offf", ".off", "of", "step"};
    for (size_t i = 0; i < 5; i++)
        assert_int_equal(pir_mesh_write_stream(place->cube, file, "a", unknown[i], 0, &report), PIR_ERR_ARGUMENT);
    assert_string_equal(report.text, "a: 'step' is none of off, obj, stl, ply and svg");
    assert_int_equal(pir_mesh_write_stream(NULL, file, "a", "off", 0, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_mesh_write_stream(place->cube, NULL, "a", "off", 0, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_mesh_write_stream(place->cube, file, NULL, "off", 0, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_mesh_write_stream(place->cube, file, "a", NULL, 0, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_mesh_write(place->cube, NULL, 0, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_mesh_write(NULL, "cube.off", 0, NULL), PIR_ERR_ARGUMENT);
    fclose(file);
    // a stream that cannot take it says so
    file = fopen("cube.off", "rb");
    assert_non_null(file);
    assert_int_equal(pir_mesh_write_stream(place->cube, file, "a", "off", 0, &report), PIR_ERR_FILE);
    assert_int_equal(strncmp(report.text, "a: cannot write: ", 17), 0);
    fclose(file);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, enter_directory, leave_directory)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_a_file_is_replaced_and_nothing_is_left_beside_it),
        TEST(test_what_cannot_be_written_says_why),
        TEST(test_links_stay_and_what_they_lead_to_is_written),
        TEST(test_links_in_a_circle_are_refused),
        TEST(test_a_replaced_file_keeps_its_permissions),
        TEST(test_a_fifo_is_written_to_and_stays),
        TEST(test_a_full_disk_leaves_the_file_as_it_was),
        TEST(test_streams_hold_what_files_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
