/* SPDX-License-Identifier: MIT */
/*
 * A program of libpirouette-cspace outside the build: it makes the slices of a box and a box about an axis, where the
 * build has HDF5, and turns one of them into a sum.
 */
#include <stdio.h>
#include <string.h>

#include <pirouette/cspace.h>
#include <pirouette/pirouette.h>

static int fail(const char *what) {
    fprintf(stderr, "slices: %s\n", what);
    return 1;
}

/* The difference of two boxes that are not turned is a box. */
static int read_back(const char *path) {
    pir_cspace *slices = NULL;
    pir_mesh *mesh = NULL;
    if (pir_cspace_open(path, NULL, NULL, &slices) != PIR_OK)
        return fail("the file cannot be opened");
    pir_status status = pir_cspace_mesh(slices, (pir_cspace_place){0, 0, 0}, PIR_DOUBLE, NULL, &mesh);
    int result = status == PIR_OK && pir_mesh_facet_count(mesh) == 6 ? 0 : fail("the first slice is no box");
    pir_mesh_destroy(mesh);
    pir_cspace_destroy(slices);
    return result;
}

static int slice(pir_polytope *box, const pir_grid *grid, const char *path) {
    const pir_cspace_bodies bodies = {&box, 1, &box, 1};
    const pir_cspace_options options = pir_cspace_options_default();
    pir_cspace_job *job = NULL;
    pir_status status = pir_cspace_job_create(&bodies, grid, path, &options, NULL, &job);
    if (status == PIR_ERR_NOT_BUILT)
        return 0;
    if (status == PIR_OK)
        status = pir_cspace_job_run(job, NULL);
    if (status == PIR_OK)
        status = pir_cspace_job_assemble(job, NULL);
    pir_cspace_job_destroy(job);
    int result = status == PIR_OK ? read_back(path) : fail(pir_status_text(status));
    remove(path);
    return result;
}

int main(int argc, char **argv) {
    const char *path = argc > 1 ? argv[1] : "slices.h5";
    pir_vec3 corners[8];
    for (int i = 0; i < 8; i++)
        corners[i] = (pir_vec3){i & 1 ? 3.0 : 0.0, i & 2 ? 2.0 : 0.0, i & 4 ? 1.0 : 0.0};
    pir_polytope *box = NULL;
    pir_grid *grid = NULL;
    int result = 1;
    if (pir_polytope_create(corners, 8, NULL, &box) != PIR_OK || pir_grid_axis((pir_vec3){0, 0, 1}, 8, NULL, &grid))
        fail("no box, or no grid");
    else
        result = slice(box, grid, path);
    pir_grid_destroy(grid);
    pir_polytope_release(box);
    return result;
}
