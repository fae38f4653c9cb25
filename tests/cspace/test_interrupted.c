/* SPDX-License-Identifier: MIT */
/*
 * Reads and writes that are interrupted by a signal or come back short: a job makes the same file, and a file is read
 * and checked as ever. This program has pread and pwrite of its own, which fail with EINTR every third time and else
 * transfer at most 1,000 bytes where that is asked for.
 */
#define _GNU_SOURCE
#include "cspace/slice_scene.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <unistd.h>

static bool disturbed;
static unsigned calls, interrupted;

/* The bytes to transfer of `size`; 0 for a call that is interrupted. */
static size_t let_through(size_t size) {
    if (!disturbed || size == 0)
        return size;
    if (++calls % 3 == 0) {
        interrupted++;
        errno = EINTR;
        return 0;
    }
    return size < 1000 ? size : 1000;
}

ssize_t pread(int descriptor, void *data, size_t size, off_t at) {
    size_t most = let_through(size);
    return most == 0 && size > 0 ? -1 : (ssize_t)syscall(SYS_pread64, descriptor, data, most, at);
}

ssize_t pwrite(int descriptor, const void *data, size_t size, off_t at) {
    size_t most = let_through(size);
    return most == 0 && size > 0 ? -1 : (ssize_t)syscall(SYS_pwrite64, descriptor, data, most, at);
}

static void a_job_that_signals_interrupt_makes_the_same_file(void **state) {
    (void)state;
    struct slice_scene scene;
    char calm[SLICE_PATH], rough[SLICE_PATH];
    pir_cspace_options options = slice_short_units();
    pir_report report = {0};
    pir_cspace *file = NULL;
    slice_scene_make(&scene, 130);
    slice_path("calm.h5", calm);
    slice_path("rough.h5", rough);
    options.planes = true;
    slice_make_file(&scene, calm, &options);
    disturbed = true;
    slice_make_file(&scene, rough, &options);
    // resumed where all is done: parts and the file are read
    options.resume = true;
    slice_make_file(&scene, rough, &options);
    expect(pir_cspace_check(rough, NULL, &report) == PIR_OK, "%s", report.text);
    expect(pir_cspace_open(rough, NULL, &report, &file) == PIR_OK, "%s", report.text);
    pir_cspace_destroy(file);
    disturbed = false;
    expect(interrupted > 20, "%u of %u calls", interrupted, calls);
    slice_expect_same_files(calm, rough);
    unlink(calm);
    unlink(rough);
    slice_scene_finish(&scene);
}

/* A run that ends early is read back, its parts in pieces, by the next. */
static void parts_are_read_in_pieces(void **state) {
    (void)state;
    struct slice_scene scene;
    char calm[SLICE_PATH], rough[SLICE_PATH];
    pir_cspace_options options = slice_short_units();
    pir_report report = {0};
    slice_scene_make(&scene, 60);
    slice_path("calm.h5", calm);
    slice_path("rough.h5", rough);
    slice_make_file(&scene, calm, &options);
    pir_cspace_job *job = NULL;
    assert_int_equal(pir_cspace_job_create(&scene.bodies, scene.grid, rough, &options, &report, &job), PIR_OK);
    assert_int_equal(pir_cspace_job_run(job, &report), PIR_OK);
    pir_cspace_job_destroy(job);
    disturbed = true;
    options.resume = true;
    assert_int_equal(pir_cspace_job_create(&scene.bodies, scene.grid, rough, &options, &report, &job), PIR_OK);
    assert_int_equal(pir_cspace_job_left(job), 0);
    expect(pir_cspace_job_assemble(job, &report) == PIR_OK, "%s", report.text);
    pir_cspace_job_destroy(job);
    disturbed = false;
    slice_expect_same_files(calm, rough);
    unlink(calm);
    unlink(rough);
    slice_scene_finish(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_job_that_signals_interrupt_makes_the_same_file),
        cmocka_unit_test(parts_are_read_in_pieces),
    };
    return cmocka_run_group_tests_name("slices, interrupted", tests, slice_make_folder, slice_remove_folder);
}
