/* SPDX-License-Identifier: MIT */
/* A scene to slice, and files of it. */
#include "cspace/slice_scene.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support/bodies.h"

static char folder[SLICE_PATH];

void slice_path(const char *name, char path[SLICE_PATH]) {
    int length = snprintf(path, SLICE_PATH, "%s/%s", folder, name);
    assert_true(length > 0 && length < SLICE_PATH);
}

int slice_make_folder(void **state) {
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/pirouette-slices-XXXXXX", base ? base : "/tmp");
    return mkdtemp(folder) ? 0 : -1;
}

int slice_remove_folder(void **state) {
    (void)state;
    return rmdir(folder);
}

/* --- scenes --- */

void slice_scene_make(struct slice_scene *scene, uint64_t steps) {
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

void slice_scene_finish(struct slice_scene *scene) {
    for (int i = 0; i < 2; i++)
        pir_polytope_release(scene->robot[i]);
    for (int i = 0; i < 3; i++)
        pir_polytope_release(scene->obstacle[i]);
    pir_grid_destroy(scene->grid);
}

pir_cspace_options slice_short_units(void) {
    pir_cspace_options options = pir_cspace_options_default();
    options.slices_per_unit = 20;
    options.slices_per_key = 8;
    return options;
}

void slice_make_file(const struct slice_scene *scene, const char *path, const pir_cspace_options *options) {
    pir_report report = {0};
    pir_cspace_job *job = NULL;
    expect(pir_cspace_job_create(&scene->bodies, scene->grid, path, options, &report, &job) == PIR_OK, "%s",
           report.text);
    expect(pir_cspace_job_run(job, &report) == PIR_OK, "%s", report.text);
    expect(pir_cspace_job_assemble(job, &report) == PIR_OK, "%s", report.text);
    pir_cspace_job_destroy(job);
}

uint8_t *slice_read_whole(const char *path, size_t *ret_size) {
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

void slice_write_whole(const char *path, const uint8_t *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

void slice_expect_same_files(const char *a, const char *b) {
    size_t sizes[2];
    uint8_t *bytes[2] = {slice_read_whole(a, &sizes[0]), slice_read_whole(b, &sizes[1])};
    expect(sizes[0] == sizes[1] && memcmp(bytes[0], bytes[1], sizes[0]) == 0, "%s and %s", a, b);
    free(bytes[0]);
    free(bytes[1]);
}
