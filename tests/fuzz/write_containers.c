/* SPDX-License-Identifier: MIT */
/* Writes small files of slices, to start fuzzing their reader from. Usage: write_containers FOLDER */
#include <stdio.h>

#include <pirouette/cspace.h>
#include <pirouette/shape.h>

#include "fuzz/input.h"

static void write_file(const char *path, const char *const shapes[2], pir_grid *grid, int planes) {
    pir_polytope *piece[2] = {NULL, NULL};
    pir_cspace_job *job = NULL;
    pir_report report = {0};
    pir_cspace_options options = pir_cspace_options_default();
    options.slices_per_unit = 4;
    options.slices_per_key = 2;
    options.planes = planes;
    for (int i = 0; i < 2; i++)
        fuzz_require(pir_shape_create(shapes[i], NULL, NULL, &piece[i]) == PIR_OK, "a shape is made");
    const pir_cspace_bodies bodies = {&piece[0], 1, &piece[1], 1};
    fuzz_require(pir_cspace_job_create(&bodies, grid, path, &options, &report, &job) == PIR_OK, report.text);
    fuzz_require(pir_cspace_job_run(job, &report) == PIR_OK, report.text);
    fuzz_require(pir_cspace_job_assemble(job, &report) == PIR_OK, report.text);
    pir_cspace_job_destroy(job);
    for (int i = 0; i < 2; i++)
        pir_polytope_release(piece[i]);
}

int main(int argc, char **argv) {
    static const pir_quat list[] = {{0, 0, 0, 1}, {0, 0, 1, 9}, {1, 0, 1, 9}};
    char path[4096];
    if (argc != 2) {
        fprintf(stderr, "usage: write_containers FOLDER\n");
        return 2;
    }
    pir_grid *grid = NULL;
    fuzz_require(pir_grid_axis((pir_vec3){1, 2, 3}, 9, NULL, &grid) == PIR_OK, "a grid is made");
    snprintf(path, sizeof path, "%s/axis.h5", argv[1]);
    write_file(path, (const char *const[]){"cube", "tetrahedron"}, grid, 0);
    pir_grid_destroy(grid);
    fuzz_require(pir_grid_list(list, 3, 0, NULL, &grid) == PIR_OK, "a grid is made");
    snprintf(path, sizeof path, "%s/list.h5", argv[1]);
    write_file(path, (const char *const[]){"tetrahedron", "cube"}, grid, 1);
    pir_grid_destroy(grid);
    return 0;
}
