/* SPDX-License-Identifier: MIT */
/*
 * Jobs that make slices: one thread and several, one process and several, one run and many that resume, make the same
 * bytes; what cannot be a job is refused.
 */
#include "cspace/slice_scene.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/random.h"

static void threads_make_the_same_file(void **state) {
    (void)state;
    struct slice_scene scene;
    char one[SLICE_PATH], two[SLICE_PATH];
    pir_cspace_options options = slice_short_units();
    slice_scene_make(&scene, 130);
    slice_path("one.h5", one);
    slice_path("two.h5", two);
    slice_make_file(&scene, one, &options);
    options.threads = 3;
    slice_make_file(&scene, two, &options);
    slice_expect_same_files(one, two);
    unlink(one);
    unlink(two);
    slice_scene_finish(&scene);
}

/* Ends a run once so many slices of it are done. */
static bool stop_at(void *context, const pir_cspace_progress *progress) {
    const uint64_t *most = context;
    assert_true(progress->done <= progress->total && progress->resumed <= progress->done);
    return progress->done - progress->resumed < *most;
}

/* Makes the file in runs that each end early, the part cut by some bytes after each. */
static void make_in_runs(const struct slice_scene *scene, const char *path, pir_cspace_options options,
                         test_random *random) {
    uint64_t most = 100;
    pir_report report = {0};
    char part[SLICE_PATH + 16];
    snprintf(part, sizeof part, "%s.part0", path);
    options.progress = stop_at;
    options.context = &most;
    for (int run = 0;; run++) {
        pir_cspace_job *job = NULL;
        options.resume = run > 0;
        expect(pir_cspace_job_create(&scene->bodies, scene->grid, path, &options, &report, &job) == PIR_OK, "%s",
               report.text);
        uint64_t left = pir_cspace_job_left(job);
        assert_true(run == 0 ? left == pir_cspace_job_units(job) : left < pir_cspace_job_units(job));
        expect(pir_cspace_job_run(job, &report) == PIR_OK, "%s", report.text);
        pir_status status = pir_cspace_job_assemble(job, &report);
        pir_cspace_job_destroy(job);
        if (status == PIR_OK)
            return;
        assert_int_equal(status, PIR_ERR_EMPTY);
        assert_int_not_equal(access(path, F_OK), 0);
        size_t size;
        free(slice_read_whole(part, &size));
        assert_int_equal(truncate(part, (off_t)(size - test_random_below(random, 300))), 0);
    }
}

static void runs_that_resume_make_the_same_file(void **state) {
    (void)state;
    struct slice_scene scene;
    char one[SLICE_PATH], many[SLICE_PATH];
    pir_cspace_options options = slice_short_units();
    test_random random = test_random_case("resume", 0);
    slice_scene_make(&scene, 130);
    slice_path("one.h5", one);
    slice_path("many.h5", many);
    slice_make_file(&scene, one, &options);
    for (int round = 0; round < 5; round++) {
        make_in_runs(&scene, many, options, &random);
        slice_expect_same_files(one, many);
        unlink(many);
    }
    unlink(one);
    slice_scene_finish(&scene);
}

/* What stands in the way: a file that is complete is not made again; any other is replaced, but not by resuming. */
static void a_file_that_is_complete_is_left_alone(void **state) {
    (void)state;
    struct slice_scene scene;
    char path[SLICE_PATH], part[SLICE_PATH + 16];
    struct stat before, after;
    pir_cspace_options options = slice_short_units();
    slice_scene_make(&scene, 30);
    slice_path("complete.h5", path);
    snprintf(part, sizeof part, "%s.part7", path);
    slice_make_file(&scene, path, &options);
    size_t size;
    uint8_t *bytes = slice_read_whole(path, &size);
    options.resume = true;
    slice_write_whole(part, bytes, 100);
    assert_int_equal(stat(path, &before), 0);
    slice_make_file(&scene, path, &options);
    assert_int_equal(stat(path, &after), 0);
    assert_true(before.st_ino == after.st_ino);
    assert_int_not_equal(access(part, F_OK), 0);
    slice_write_whole(path, bytes, size / 2);
    pir_cspace_job *job = NULL;
    pir_report report = {0};
    assert_int_equal(pir_cspace_job_create(&scene.bodies, scene.grid, path, &options, &report, &job), PIR_ERR_FORMAT);
    assert_non_null(strstr(report.text, "of another job"));
    assert_int_equal(stat(path, &after), 0);
    assert_int_equal(after.st_size, size / 2);
    options.resume = false;
    slice_make_file(&scene, path, &options);
    size_t again;
    uint8_t *made = slice_read_whole(path, &again);
    assert_int_equal(again, size);
    assert_memory_equal(made, bytes, size);
    free(made);
    free(bytes);
    unlink(path);
    slice_scene_finish(&scene);
}

/* Deals units to the processes of a job by turns. */
struct dealt {
    uint64_t next, by;
};

static uint64_t deal(void *context) {
    struct dealt *dealt = context;
    uint64_t unit = dealt->next;
    dealt->next += dealt->by;
    return unit;
}

static void parts_of_several_processes_make_the_same_file(void **state) {
    (void)state;
    struct slice_scene scene;
    char one[SLICE_PATH], shared[SLICE_PATH];
    pir_report report = {0};
    pir_cspace_options options = slice_short_units();
    slice_scene_make(&scene, 90);
    slice_path("one.h5", one);
    slice_path("shared.h5", shared);
    slice_make_file(&scene, one, &options);
    pir_cspace_job *job[3] = {NULL};
    for (uint32_t i = 0; i < 3; i++) {
        struct dealt dealt = {i, 3};
        options.part = i;
        options.resume = i > 0;
        options.claim = deal;
        options.context = &dealt;
        assert_int_equal(pir_cspace_job_create(&scene.bodies, scene.grid, shared, &options, &report, &job[i]), PIR_OK);
        assert_int_equal(pir_cspace_job_assemble(job[i], &report), PIR_ERR_EMPTY);
        expect(pir_cspace_job_run(job[i], &report) == PIR_OK, "%s", report.text);
    }
    assert_int_equal(pir_cspace_job_assemble(job[0], &report), PIR_OK);
    assert_int_equal(pir_cspace_job_units(job[0]), 2 * 3 * 5);
    for (uint32_t i = 0; i < 3; i++)
        pir_cspace_job_destroy(job[i]);
    slice_expect_same_files(one, shared);
    unlink(one);
    unlink(shared);
    slice_scene_finish(&scene);
}

/* Two jobs of one process are kept apart as those of two are; what is left of a lock, or of a file half made, goes. */
static void a_file_is_that_of_one_job_at_a_time(void **state) {
    (void)state;
    struct slice_scene scene;
    char path[SLICE_PATH], lock[SLICE_PATH + 16], half[SLICE_PATH + 32];
    pir_report report = {0};
    pir_cspace_job *first = NULL, *second = NULL;
    pir_cspace_options options = slice_short_units();
    slice_scene_make(&scene, 30);
    slice_path("locked.h5", path);
    snprintf(lock, sizeof lock, "%s.lock", path);
    snprintf(half, sizeof half, "%s.assembling-1-2", path);
    slice_write_whole(lock, (const uint8_t *)"\x1b[2J", 4);
    slice_write_whole(half, (const uint8_t *)"half", 4);
    assert_int_equal(pir_cspace_job_create(&scene.bodies, scene.grid, path, &options, &report, &first), PIR_OK);
    assert_int_not_equal(access(half, F_OK), 0);
    for (int resume = 0; resume < 2; resume++) {
        options.resume = resume;
        assert_int_equal(pir_cspace_job_create(&scene.bodies, scene.grid, path, &options, &report, &second),
                         PIR_ERR_FILE);
        expect(strstr(report.text, "locked.h5: process ") && strstr(report.text, " is making it"), "%s", report.text);
        assert_null(second);
    }
    assert_int_equal(pir_cspace_job_run(first, &report), PIR_OK);
    assert_int_equal(pir_cspace_job_assemble(first, &report), PIR_OK);
    // the lock is that of the job, not of its run
    assert_int_equal(pir_cspace_job_create(&scene.bodies, scene.grid, path, &options, &report, &second), PIR_ERR_FILE);
    pir_cspace_job_destroy(first);
    assert_int_not_equal(access(lock, F_OK), 0);
    assert_int_equal(pir_cspace_job_create(&scene.bodies, scene.grid, path, &options, &report, &second), PIR_OK);
    assert_int_equal(pir_cspace_job_left(second), 0);
    pir_cspace_job_destroy(second);
    unlink(path);
    slice_scene_finish(&scene);
}

static void parts_of_another_job_are_refused(void **state) {
    (void)state;
    struct slice_scene scene, other;
    char path[SLICE_PATH], part[SLICE_PATH + 16];
    pir_report report = {0};
    pir_cspace_job *job = NULL;
    pir_cspace_options options = slice_short_units();
    slice_scene_make(&scene, 30);
    slice_scene_make(&other, 31);
    slice_path("other.h5", path);
    snprintf(part, sizeof part, "%s.part0", path);
    assert_int_equal(pir_cspace_job_create(&scene.bodies, scene.grid, path, &options, &report, &job), PIR_OK);
    assert_int_equal(pir_cspace_job_run(job, &report), PIR_OK);
    pir_cspace_job_destroy(job);
    options.resume = true;
    job = NULL;
    assert_int_equal(pir_cspace_job_create(&other.bodies, other.grid, path, &options, &report, &job), PIR_ERR_FORMAT);
    expect(strstr(report.text, "other.h5.part0") != NULL, "%s", report.text);
    assert_null(job);
    unlink(part);
    slice_scene_finish(&scene);
    slice_scene_finish(&other);
}

static void what_cannot_be_a_job_is_refused(void **state) {
    (void)state;
    struct slice_scene scene;
    pir_report report = {0};
    pir_cspace_job *job = NULL;
    pir_cspace_estimate estimate;
    slice_scene_make(&scene, 10);
    pir_cspace_options options = pir_cspace_options_default();
    pir_cspace_bodies none = scene.bodies;
    none.robot_count = 0;
    assert_int_equal(pir_cspace_job_create(&none, scene.grid, "x.h5", NULL, &report, &job), PIR_ERR_EMPTY);
    assert_int_equal(pir_cspace_job_create(&scene.bodies, NULL, "x.h5", NULL, &report, &job), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cspace_job_create(&scene.bodies, scene.grid, "/nowhere/x.h5", NULL, &report, &job),
                     PIR_ERR_FILE);
    options.threads = 0;
    assert_int_equal(pir_cspace_job_create(&scene.bodies, scene.grid, "x.h5", &options, &report, &job),
                     PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cspace_get_estimate(&none, scene.grid, NULL, &report, &estimate), PIR_ERR_EMPTY);
    assert_int_equal(pir_cspace_get_estimate(&scene.bodies, scene.grid, NULL, &report, &estimate), PIR_OK);
    assert_int_equal(estimate.slices, 60);
    assert_true(estimate.bytes > 0 && estimate.seconds > 0 && estimate.mean_turn > 0.6 && estimate.mean_turn < 0.7);
    slice_scene_finish(&scene);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_make_the_same_file),
        cmocka_unit_test(runs_that_resume_make_the_same_file),
        cmocka_unit_test(a_file_that_is_complete_is_left_alone),
        cmocka_unit_test(parts_of_several_processes_make_the_same_file),
        cmocka_unit_test(a_file_is_that_of_one_job_at_a_time),
        cmocka_unit_test(parts_of_another_job_are_refused),
        cmocka_unit_test(what_cannot_be_a_job_is_refused),
    };
    return cmocka_run_group_tests(tests, slice_make_folder, slice_remove_folder);
}
