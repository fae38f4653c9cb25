/* SPDX-License-Identifier: MIT */
/*
 * write_slices FILE.h5: the slices of a robot of two boxes, an L, among two walls, at 40 turns about z. For tests
 * of the command.
 */
#include <stdio.h>

#include <pirouette/cspace.h>

static int fail(const char *what) {
    fprintf(stderr, "write_slices: %s\n", what);
    return 1;
}

static pir_polytope *box(pir_vec3 low, pir_vec3 high) {
    pir_vec3 corners[8];
    pir_polytope *polytope = NULL;
    for (int k = 0; k < 8; k++)
        corners[k] = (pir_vec3){k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z};
    return pir_polytope_create(corners, 8, NULL, &polytope) == PIR_OK ? polytope : NULL;
}

static int write_file(pir_polytope *const pieces[4], const char *path) {
    const pir_cspace_bodies bodies = {pieces, 2, pieces + 2, 2};
    pir_cspace_options options = pir_cspace_options_default();
    options.slices_per_unit = 16;
    pir_grid *grid = NULL;
    pir_cspace_job *job = NULL;
    pir_report report = {0};
    if (pir_grid_axis((pir_vec3){0, 0, 1}, 40, NULL, &grid) != PIR_OK)
        return fail("no grid");
    pir_status status = pir_cspace_job_create(&bodies, grid, path, &options, &report, &job);
    if (status == PIR_OK)
        status = pir_cspace_job_run(job, &report);
    if (status == PIR_OK)
        status = pir_cspace_job_assemble(job, &report);
    pir_cspace_job_destroy(job);
    pir_grid_destroy(grid);
    return status == PIR_OK ? 0 : fail(report.text);
}

int main(int argc, char **argv) {
    if (argc != 2)
        return fail("usage: write_slices FILE.h5");
    pir_polytope *const pieces[4] = {
        box((pir_vec3){-1, -0.125, -0.25}, (pir_vec3){1, 0.125, 0.25}),
        box((pir_vec3){0.75, 0, -0.25}, (pir_vec3){1, 1, 0.25}),
        box((pir_vec3){-3, -0.125, -1}, (pir_vec3){-1, 0.125, 1}),
        box((pir_vec3){1, -0.125, -1}, (pir_vec3){3, 0.125, 1}),
    };
    int result = pieces[0] && pieces[1] && pieces[2] && pieces[3] ? write_file(pieces, argv[1]) : fail("no boxes");
    for (int k = 0; k < 4; k++)
        pir_polytope_release(pieces[k]);
    return result;
}
