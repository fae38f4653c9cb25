/* SPDX-License-Identifier: MIT */
/*
 * Files of slices: what is read is what a sum made at the rotation holds; half-spaces hold the difference; one thread
 * and two, one run and two that resume, give the same bytes; files that were damaged are refused by name.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <pirouette/cspace.h>
#include <pirouette/shape.h>

#include "support/bodies.h"
#include "support/memory.h"

#define PATH_SIZE 256

static char folder[PATH_SIZE];

static void path_of(const char *name, char path[PATH_SIZE]) {
    int length = snprintf(path, PATH_SIZE, "%s/%s", folder, name);
    assert_true(length > 0 && length < PATH_SIZE);
}

static int make_folder(void **state) {
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/pirouette-slices-XXXXXX", base ? base : "/tmp");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state) {
    (void)state;
    return rmdir(folder);
}

/* --- scenes --- */

/* A robot of two pieces and three obstacles, of all dimensions. */
struct scene {
    pir_polytope *robot[2], *obstacle[3];
    pir_cspace_bodies bodies;
    pir_grid *grid;
};

static void scene_make(struct scene *scene, uint64_t steps) {
    test_random random = test_random_case("slices", 0);
    const test_points triangle = {3, {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}};
    scene->robot[0] = test_sphere(&random, 20);
    scene->robot[1] = test_random_polytope(&random, TEST_SEGMENT, 4);
    scene->obstacle[0] = test_random_polytope(&random, TEST_BOX, 8);
    scene->obstacle[1] = test_sphere(&random, 30);
    scene->obstacle[2] = test_polytope(&triangle);
    scene->bodies = (pir_cspace_bodies){scene->robot, 2, scene->obstacle, 3};
    assert_int_equal(pir_grid_axis((pir_vec3){1, 2, 3}, steps, NULL, &scene->grid), PIR_OK);
}

static void scene_finish(struct scene *scene) {
    for (int i = 0; i < 2; i++)
        pir_polytope_release(scene->robot[i]);
    for (int i = 0; i < 3; i++)
        pir_polytope_release(scene->obstacle[i]);
    pir_grid_destroy(scene->grid);
}

static pir_cspace_options short_units(void) {
    pir_cspace_options options = pir_cspace_options_default();
    options.slices_per_unit = 20;
    options.slices_per_key = 8;
    return options;
}

static void make_file(const struct scene *scene, const char *path, const pir_cspace_options *options) {
    pir_report report = {0};
    pir_cspace_job *job = NULL;
    expect(pir_cspace_job_create(&scene->bodies, scene->grid, path, options, &report, &job) == PIR_OK, "%s",
           report.text);
    expect(pir_cspace_job_run(job, &report) == PIR_OK, "%s", report.text);
    expect(pir_cspace_job_assemble(job, &report) == PIR_OK, "%s", report.text);
    pir_cspace_job_destroy(job);
}

static uint8_t *read_whole(const char *path, size_t *ret_size) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *ret_size = (size_t)ftell(file);
    rewind(file);
    uint8_t *bytes = malloc(*ret_size);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *ret_size, file), *ret_size);
    fclose(file);
    return bytes;
}

static void expect_same_files(const char *a, const char *b) {
    size_t sizes[2];
    uint8_t *bytes[2] = {read_whole(a, &sizes[0]), read_whole(b, &sizes[1])};
    expect(sizes[0] == sizes[1] && memcmp(bytes[0], bytes[1], sizes[0]) == 0, "%s and %s", a, b);
    free(bytes[0]);
    free(bytes[1]);
}

/* --- reading --- */

static void expect_slice(pir_cspace *cspace, const struct scene *scene, pir_cspace_place place) {
    pir_report report = {0};
    pir_slice slice;
    pir_sum *fresh = NULL, *read = NULL;
    const pir_sum_options options = {NULL, 1};
    expect(pir_cspace_slice(cspace, place, &report, &slice) == PIR_OK, "%s", report.text);
    assert_int_equal(pir_sum_create(scene->robot[place.robot], scene->obstacle[place.obstacle],
                                    pir_grid_rotation(scene->grid, place.slice), &options, &fresh),
                     PIR_OK);
    uint32_t(*ee)[2] = malloc((pir_sum_ee_count(fresh) + 1) * sizeof *ee);
    assert_non_null(ee);
    pir_sum_ee(fresh, ee);
    assert_int_equal(slice.fv_count, pir_polytope_facet_count(pir_sum_p(fresh)));
    assert_int_equal(slice.vf_count, pir_polytope_facet_count(pir_sum_q(fresh)));
    assert_int_equal(slice.ee_count, pir_sum_ee_count(fresh));
    assert_memory_equal(slice.fv, pir_sum_fv(fresh), slice.fv_count * sizeof *slice.fv);
    assert_memory_equal(slice.vf, pir_sum_vf(fresh), slice.vf_count * sizeof *slice.vf);
    assert_memory_equal(slice.ee, ee, slice.ee_count * sizeof *ee);
    expect(pir_cspace_sum(cspace, place, &report, &read) == PIR_OK, "%s", report.text);
    assert_true(pir_sum_same_pairing(fresh, read));
    free(ee);
    pir_sum_destroy(read);
    pir_sum_destroy(fresh);
}

static void slices_are_those_of_fresh_sums(void **state) {
    (void)state;
    struct scene scene;
    char path[PATH_SIZE];
    pir_cspace *cspace = NULL;
    pir_report report = {0};
    pir_cspace_options options = short_units();
    test_random random = test_random_case("slices read", 0);
    scene_make(&scene, 50);
    path_of("read.h5", path);
    make_file(&scene, path, &options);
    expect(pir_cspace_open(path, NULL, &report, &cspace) == PIR_OK, "%s", report.text);
    pir_cspace_info info = pir_cspace_get_info(cspace);
    assert_int_equal(info.robot_count, 2);
    assert_int_equal(info.obstacle_count, 3);
    assert_int_equal(info.grid.count, 50);
    assert_int_equal(pir_grid_get_info(pir_cspace_grid(cspace)).kind, PIR_GRID_AXIS);
    assert_int_equal(pir_polytope_dimension(pir_cspace_robot(cspace, 1)), 1);
    assert_int_equal(pir_polytope_dimension(pir_cspace_obstacle(cspace, 2)), 2);
    for (uint32_t k = 0; k < 2; k++)
        for (uint32_t l = 0; l < 3; l++)
            for (uint64_t i = 0; i < 50; i++)
                expect_slice(cspace, &scene, (pir_cspace_place){k, l, i});
    for (int i = 0; i < 100; i++)
        expect_slice(cspace, &scene,
                     (pir_cspace_place){test_random_below(&random, 2), test_random_below(&random, 3),
                                        test_random_below(&random, 50)});
    pir_slice slice;
    assert_int_equal(pir_cspace_slice(cspace, (pir_cspace_place){0, 0, 50}, &report, &slice), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cspace_slice(cspace, (pir_cspace_place){2, 0, 0}, &report, &slice), PIR_ERR_ARGUMENT);
    pir_cspace_close(cspace);
    unlink(path);
    scene_finish(&scene);
}

/* Each half-space holds all vertices of the mesh, and one of them is near its plane. */
static void expect_half_spaces(pir_cspace *cspace, pir_cspace_place place) {
    const pir_halfspace *plane;
    uint32_t count;
    pir_mesh *mesh = NULL;
    pir_report report = {0};
    expect(pir_cspace_mesh(cspace, place, PIR_DOUBLE, &report, &mesh) == PIR_OK, "%s", report.text);
    expect(pir_cspace_planes(cspace, place, &report, &plane, &count) == PIR_OK, "%s", report.text);
    const pir_vec3 *vertex = pir_mesh_vertices(mesh);
    for (uint32_t i = 0; i < count; i++) {
        double most = -HUGE_VAL;
        for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++)
            most = fmax(most, plane[i].normal.x * vertex[v].x + plane[i].normal.y * vertex[v].y +
                                  plane[i].normal.z * vertex[v].z);
        expect(most <= plane[i].offset && plane[i].offset - most < 1e-6, "slice %u, plane %u: %g",
               (unsigned)place.slice, i, plane[i].offset - most);
    }
    pir_mesh_destroy(mesh);
}

static void half_spaces_hold_the_difference(void **state) {
    (void)state;
    struct scene scene;
    char path[PATH_SIZE];
    pir_cspace *cspace = NULL;
    pir_cspace_options options = short_units();
    options.planes = options.vertices = 1;
    scene_make(&scene, 30);
    path_of("planes.h5", path);
    make_file(&scene, path, &options);
    assert_int_equal(pir_cspace_open(path, NULL, NULL, &cspace), PIR_OK);
    assert_true(pir_cspace_get_info(cspace).has_planes && pir_cspace_get_info(cspace).has_vertices);
    for (uint32_t k = 0; k < 2; k++)
        for (uint32_t l = 0; l < 3; l++)
            for (uint64_t i = 0; i < 30; i += 3)
                expect_half_spaces(cspace, (pir_cspace_place){k, l, i});
    pir_cspace_close(cspace);
    unlink(path);
    scene_finish(&scene);
}

/* --- runs --- */

static void threads_make_the_same_file(void **state) {
    (void)state;
    struct scene scene;
    char one[PATH_SIZE], two[PATH_SIZE];
    pir_cspace_options options = short_units();
    scene_make(&scene, 130);
    path_of("one.h5", one);
    path_of("two.h5", two);
    make_file(&scene, one, &options);
    options.threads = 3;
    make_file(&scene, two, &options);
    expect_same_files(one, two);
    unlink(one);
    unlink(two);
    scene_finish(&scene);
}

/* Ends a run once so many slices of it are done. */
static int stop_at(void *context, const pir_cspace_progress *progress) {
    const uint64_t *most = context;
    assert_true(progress->done <= progress->total && progress->resumed <= progress->done);
    return progress->done - progress->resumed < *most;
}

/* Makes the file in runs that each end early, the part cut by some bytes after each. */
static void make_in_runs(const struct scene *scene, const char *path, pir_cspace_options options, test_random *random) {
    uint64_t most = 100;
    pir_report report = {0};
    char part[PATH_SIZE + 16];
    snprintf(part, sizeof part, "%s.part0", path);
    options.progress = stop_at;
    options.context = &most;
    for (int run = 0;; run++) {
        pir_cspace_job *job = NULL;
        options.resume = run > 0;
        expect(pir_cspace_job_create(&scene->bodies, scene->grid, path, &options, &report, &job) == PIR_OK, "%s",
               report.text);
        expect(pir_cspace_job_run(job, &report) == PIR_OK, "%s", report.text);
        pir_status status = pir_cspace_job_assemble(job, &report);
        pir_cspace_job_destroy(job);
        if (status == PIR_OK)
            return;
        assert_int_equal(status, PIR_ERR_EMPTY);
        assert_int_not_equal(access(path, F_OK), 0);
        size_t size;
        free(read_whole(part, &size));
        assert_int_equal(truncate(part, (off_t)(size - test_random_below(random, 300))), 0);
    }
}

static void runs_that_resume_make_the_same_file(void **state) {
    (void)state;
    struct scene scene;
    char one[PATH_SIZE], many[PATH_SIZE];
    pir_cspace_options options = short_units();
    test_random random = test_random_case("resume", 0);
    scene_make(&scene, 130);
    path_of("one.h5", one);
    path_of("many.h5", many);
    make_file(&scene, one, &options);
    for (int round = 0; round < 5; round++) {
        make_in_runs(&scene, many, options, &random);
        expect_same_files(one, many);
        unlink(many);
    }
    unlink(one);
    scene_finish(&scene);
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
    struct scene scene;
    char one[PATH_SIZE], shared[PATH_SIZE];
    pir_report report = {0};
    pir_cspace_options options = short_units();
    scene_make(&scene, 90);
    path_of("one.h5", one);
    path_of("shared.h5", shared);
    make_file(&scene, one, &options);
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
    expect_same_files(one, shared);
    unlink(one);
    unlink(shared);
    scene_finish(&scene);
}

static void parts_of_another_job_are_refused(void **state) {
    (void)state;
    struct scene scene, other;
    char path[PATH_SIZE], part[PATH_SIZE + 16];
    pir_report report = {0};
    pir_cspace_job *job = NULL;
    pir_cspace_options options = short_units();
    scene_make(&scene, 30);
    scene_make(&other, 31);
    path_of("other.h5", path);
    snprintf(part, sizeof part, "%s.part0", path);
    assert_int_equal(pir_cspace_job_create(&scene.bodies, scene.grid, path, &options, &report, &job), PIR_OK);
    assert_int_equal(pir_cspace_job_run(job, &report), PIR_OK);
    pir_cspace_job_destroy(job);
    options.resume = 1;
    job = NULL;
    assert_int_equal(pir_cspace_job_create(&other.bodies, other.grid, path, &options, &report, &job), PIR_ERR_FORMAT);
    expect(strstr(report.text, "other.h5.part0") != NULL, "%s", report.text);
    assert_null(job);
    unlink(part);
    scene_finish(&scene);
    scene_finish(&other);
}

static void what_cannot_be_a_job_is_refused(void **state) {
    (void)state;
    struct scene scene;
    pir_report report = {0};
    pir_cspace_job *job = NULL;
    pir_cspace_estimate estimate;
    scene_make(&scene, 10);
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
    scene_finish(&scene);
}

/* --- damage --- */

/* Opens the file and reads every slice; 1 when all were taken, and the report tells where it was not. */
static int read_everything(const char *path) {
    pir_report report = {0};
    pir_cspace *cspace = NULL;
    pir_status status = pir_cspace_open(path, NULL, &report, &cspace);
    if (status == PIR_OK) {
        pir_cspace_info info = pir_cspace_get_info(cspace);
        for (uint64_t i = 0; status == PIR_OK && i < info.grid.count * info.robot_count * info.obstacle_count; i++) {
            pir_slice slice;
            pir_cspace_place place = {(uint32_t)(i / info.grid.count / info.obstacle_count),
                                      (uint32_t)(i / info.grid.count % info.obstacle_count), i % info.grid.count};
            status = pir_cspace_slice(cspace, place, &report, &slice);
        }
    }
    pir_cspace_close(cspace);
    expect(status == PIR_OK || report.text[0] != '\0', "status %d", (int)status);
    assert_true(status != PIR_ERR_ARGUMENT);
    return status == PIR_OK;
}

static void write_whole(const char *path, const uint8_t *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void damaged_files_are_refused_or_read(void **state) {
    (void)state;
    struct scene scene;
    char path[PATH_SIZE];
    pir_cspace_options options = short_units();
    test_random random = test_random_case("damage", 0);
    const char *text = getenv("PIR_TEST_ROUNDS");
    unsigned rounds = text ? (unsigned)strtoul(text, NULL, 10) : 1;
    scene_make(&scene, 20);
    path_of("damaged.h5", path);
    make_file(&scene, path, &options);
    size_t size;
    uint8_t *bytes = read_whole(path, &size);
    assert_true(read_everything(path));
    write_whole(path, bytes, size / 2);
    assert_false(read_everything(path));
    for (unsigned i = 0; i < 150 * rounds; i++) {
        uint32_t at = test_random_below(&random, (uint32_t)size), length = 1 + test_random_below(&random, 8);
        uint8_t before[8];
        for (uint32_t j = 0; j < length && at + j < size; j++) {
            before[j] = bytes[at + j];
            bytes[at + j] = (uint8_t)(i % 3 == 0 ? 0xff : test_random_bits(&random));
        }
        write_whole(path, bytes, size);
        (void)read_everything(path);
        for (uint32_t j = 0; j < length && at + j < size; j++)
            bytes[at + j] = before[j];
    }
    free(bytes);
    unlink(path);
    scene_finish(&scene);
}

/* --- memory --- */

/* Makes and reads a file in memory that fails at a request; whether it failed. */
static bool try_job(const struct scene *scene, const char *path, test_memory *memory) {
    const pir_allocator a = test_allocator(memory);
    pir_cspace_options options = short_units();
    pir_cspace_job *job = NULL;
    pir_cspace *cspace = NULL;
    pir_slice slice;
    options.allocator = &a;
    options.planes = 1;
    pir_status status = pir_cspace_job_create(&scene->bodies, scene->grid, path, &options, NULL, &job);
    if (status == PIR_OK)
        status = pir_cspace_job_run(job, NULL);
    if (status == PIR_OK)
        status = pir_cspace_job_assemble(job, NULL);
    pir_cspace_job_destroy(job);
    if (status == PIR_OK)
        status = pir_cspace_open(path, &a, NULL, &cspace);
    if (status == PIR_OK)
        status = pir_cspace_slice(cspace, (pir_cspace_place){1, 0, 3}, NULL, &slice);
    pir_cspace_close(cspace);
    assert_true(status == PIR_OK || memory->requests >= memory->fail_at);
    return status != PIR_OK;
}

static void memory_runs_out_anywhere(void **state) {
    (void)state;
    struct scene scene;
    char path[PATH_SIZE], part[PATH_SIZE + 16];
    scene_make(&scene, 4);
    scene.bodies.obstacle_count = 1;
    path_of("memory.h5", path);
    snprintf(part, sizeof part, "%s.part0", path);
    bool failed = true;
    for (uint64_t n = 1; failed; n++) {
        test_memory memory = {.fail_at = n};
        failed = try_job(&scene, path, &memory);
        expect(memory.blocks == 0 && !memory.wrong_size && !memory.overrun, "failure at request %llu: %zu blocks",
               (unsigned long long)n, memory.blocks);
        unlink(path);
        unlink(part);
    }
    scene_finish(&scene);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slices_are_those_of_fresh_sums),
        cmocka_unit_test(half_spaces_hold_the_difference),
        cmocka_unit_test(threads_make_the_same_file),
        cmocka_unit_test(runs_that_resume_make_the_same_file),
        cmocka_unit_test(parts_of_several_processes_make_the_same_file),
        cmocka_unit_test(parts_of_another_job_are_refused),
        cmocka_unit_test(what_cannot_be_a_job_is_refused),
        cmocka_unit_test(damaged_files_are_refused_or_read),
        cmocka_unit_test(memory_runs_out_anywhere),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
