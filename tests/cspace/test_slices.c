/* SPDX-License-Identifier: MIT */
/*
 * Files of slices: what is read is what a sum made at the rotation holds; half-spaces hold the difference; files that
 * were damaged are refused by name.
 */
#include "cspace/slice_scene.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include <hdf5.h>

#include "support/bodies.h"
#include "support/memory.h"

/* --- reading --- */

static void expect_slice(pir_cspace *cspace, const struct slice_scene *scene, pir_cspace_place place) {
    pir_report report = {0};
    pir_slice slice;
    pir_sum *fresh = NULL, *read = NULL;
    const pir_sum_options options = {.size = sizeof options, .allocator = NULL, .difference = true};
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
    struct slice_scene scene;
    char path[SLICE_PATH];
    pir_cspace *cspace = NULL;
    pir_report report = {0};
    pir_cspace_options options = slice_short_units();
    test_random random = test_random_case("slices read", 0);
    slice_scene_make(&scene, 50);
    slice_path("read.h5", path);
    slice_make_file(&scene, path, &options);
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
    pir_cspace_destroy(cspace);
    unlink(path);
    slice_scene_finish(&scene);
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
    struct slice_scene scene;
    char path[SLICE_PATH];
    pir_cspace *cspace = NULL;
    pir_cspace_options options = slice_short_units();
    options.planes = options.vertices = true;
    slice_scene_make(&scene, 30);
    slice_path("planes.h5", path);
    slice_make_file(&scene, path, &options);
    assert_int_equal(pir_cspace_open(path, NULL, NULL, &cspace), PIR_OK);
    assert_true(pir_cspace_get_info(cspace).has_planes && pir_cspace_get_info(cspace).has_vertices);
    for (uint32_t k = 0; k < 2; k++)
        for (uint32_t l = 0; l < 3; l++)
            for (uint64_t i = 0; i < 30; i += 3)
                expect_half_spaces(cspace, (pir_cspace_place){k, l, i});
    pir_cspace_destroy(cspace);
    unlink(path);
    slice_scene_finish(&scene);
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
    pir_cspace_destroy(cspace);
    expect(status == PIR_OK || report.text[0] != '\0', "status %d", (int)status);
    assert_true(status != PIR_ERR_ARGUMENT);
    return status == PIR_OK;
}

static void damaged_files_are_refused_or_read(void **state) {
    (void)state;
    struct slice_scene scene;
    char path[SLICE_PATH];
    pir_cspace_options options = slice_short_units();
    test_random random = test_random_case("damage", 0);
    const char *text = getenv("PIR_TEST_ROUNDS");
    unsigned rounds = text ? (unsigned)strtoul(text, NULL, 10) : 1;
    slice_scene_make(&scene, 20);
    slice_path("damaged.h5", path);
    slice_make_file(&scene, path, &options);
    size_t size;
    uint8_t *bytes = slice_read_whole(path, &size);
    assert_true(read_everything(path));
    slice_write_whole(path, bytes, size / 2);
    assert_false(read_everything(path));
    for (unsigned i = 0; i < 150 * rounds; i++) {
        uint32_t at = test_random_below(&random, (uint32_t)size), length = 1 + test_random_below(&random, 8);
        uint8_t before[8];
        for (uint32_t j = 0; j < length && at + j < size; j++) {
            before[j] = bytes[at + j];
            bytes[at + j] = (uint8_t)(i % 3 == 0 ? 0xff : test_random_bits(&random));
        }
        slice_write_whole(path, bytes, size);
        (void)read_everything(path);
        // nothing of a file that was refused stays open
        assert_int_equal(H5Fget_obj_count((hid_t)H5F_OBJ_ALL, H5F_OBJ_ALL), 0);
        for (uint32_t j = 0; j < length && at + j < size; j++)
            bytes[at + j] = before[j];
    }
    free(bytes);
    unlink(path);
    slice_scene_finish(&scene);
}

/* --- memory --- */

/* Makes and reads a file in memory that fails at a request; whether it failed. */
static bool try_job(const struct slice_scene *scene, const char *path, test_memory *memory) {
    const pir_allocator a = test_allocator(memory);
    pir_cspace_options options = slice_short_units();
    pir_cspace_job *job = NULL;
    pir_cspace *cspace = NULL;
    pir_slice slice;
    pir_report report = {0};
    options.allocator = &a;
    options.planes = true;
    pir_status status = pir_cspace_job_create(&scene->bodies, scene->grid, path, &options, &report, &job);
    if (status == PIR_OK)
        status = pir_cspace_job_run(job, &report);
    if (status == PIR_OK)
        status = pir_cspace_job_assemble(job, &report);
    pir_cspace_job_destroy(job);
    if (status == PIR_OK)
        status = pir_cspace_open(path, &a, &report, &cspace);
    if (status == PIR_OK)
        status = pir_cspace_slice(cspace, (pir_cspace_place){1, 0, 3}, &report, &slice);
    pir_cspace_destroy(cspace);
    // a request that fails is told, never passed over
    const bool failed = memory->requests >= memory->fail_at;
    expect(failed ? status == PIR_ERR_MEMORY || status == PIR_ERR_FILE : status == PIR_OK,
           "status %d after %llu requests: %s", (int)status, (unsigned long long)memory->requests, report.text);
    return status != PIR_OK;
}

static void memory_runs_out_anywhere(void **state) {
    (void)state;
    struct slice_scene scene;
    char path[SLICE_PATH], part[SLICE_PATH + 16];
    slice_scene_make(&scene, 4);
    scene.bodies.obstacle_count = 1;
    slice_path("memory.h5", path);
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
    slice_scene_finish(&scene);
}

/* A call on a file, in memory that fails at a request. */
typedef pir_status file_call(const char *path, const pir_allocator *allocator);

static pir_status check_it(const char *path, const pir_allocator *allocator) {
    return pir_cspace_check(path, allocator, NULL);
}

static pir_status seal_it(const char *path, const pir_allocator *allocator) {
    return pir_cspace_seal(path, allocator, NULL);
}

static pir_status sum_of_it(const char *path, const pir_allocator *allocator) {
    pir_cspace *cspace = NULL;
    pir_sum *sum = NULL;
    pir_status status = pir_cspace_open(path, allocator, NULL, &cspace);
    if (status == PIR_OK)
        status = pir_cspace_sum(cspace, (pir_cspace_place){0, 0, 2}, NULL, &sum);
    pir_sum_destroy(sum);
    pir_cspace_destroy(cspace);
    return status;
}

static void memory_that_runs_out_is_told_by_each_call_on_a_file(void **state) {
    (void)state;
    static file_call *const calls[] = {check_it, seal_it, sum_of_it};
    struct slice_scene scene;
    char path[SLICE_PATH], as_it_was[SLICE_PATH];
    pir_cspace_options options = slice_short_units();
    slice_scene_make(&scene, 4);
    slice_path("told.h5", path);
    slice_path("as it was.h5", as_it_was);
    slice_make_file(&scene, path, &options);
    slice_make_file(&scene, as_it_was, &options);
    for (size_t call = 0; call < sizeof calls / sizeof *calls; call++) {
        bool failed = true;
        for (uint64_t n = 1; failed; n++) {
            test_memory memory = {.fail_at = n};
            const pir_allocator a = test_allocator(&memory);
            pir_status status = calls[call](path, &a);
            failed = memory.requests >= n;
            expect(status == (failed ? PIR_ERR_MEMORY : PIR_OK), "call %zu, request %llu: status %d", call,
                   (unsigned long long)n, (int)status);
            expect(memory.blocks == 0 && !memory.wrong_size && !memory.overrun, "call %zu, request %llu: %zu blocks",
                   call, (unsigned long long)n, memory.blocks);
        }
        slice_expect_same_files(path, as_it_was);
    }
    unlink(path);
    unlink(as_it_was);
    slice_scene_finish(&scene);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slices_are_those_of_fresh_sums),
        cmocka_unit_test(half_spaces_hold_the_difference),
        cmocka_unit_test(damaged_files_are_refused_or_read),
        cmocka_unit_test(memory_runs_out_anywhere),
        cmocka_unit_test(memory_that_runs_out_is_told_by_each_call_on_a_file),
    };
    return cmocka_run_group_tests(tests, slice_make_folder, slice_remove_folder);
}
