/* SPDX-License-Identifier: MIT */
/* See slices.h. */
#include "extremes/slices.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const char *make_slices(slice_file *file, const pir_cspace_bodies *bodies, const pir_grid *grid) {
    pir_cspace_job *job = NULL;
    pir_status status = pir_cspace_job_create(bodies, grid, file->path, NULL, NULL, &job);
    if (status == PIR_ERR_NOT_BUILT)
        return NULL;
    if (status != PIR_OK)
        return "no job";
    int made = pir_cspace_job_run(job, NULL) == PIR_OK && pir_cspace_job_assemble(job, NULL) == PIR_OK;
    pir_cspace_job_destroy(job);
    if (!made)
        return "the job fails";
    return pir_cspace_open(file->path, NULL, NULL, &file->cspace) == PIR_OK ? NULL : "the file is refused";
}

const char *slice_file_make(slice_file *file, pir_polytope *p, pir_polytope *q, const pir_quat *rotations,
                            uint32_t count) {
    pir_cspace_bodies bodies = {&p, 1, &q, 1};
    const char *base = getenv("TMPDIR");
    pir_grid *grid = NULL;
    *file = (slice_file){.cspace = NULL};
    snprintf(file->folder, sizeof file->folder, "%s/pirouette-extremes-XXXXXX", base ? base : "/tmp");
    if (!mkdtemp(file->folder))
        return "no folder";
    snprintf(file->path, sizeof file->path, "%s/slices.h5", file->folder);
    if (pir_grid_list(rotations, count, 1, NULL, &grid) != PIR_OK)
        return "no grid";
    const char *wrong = make_slices(file, &bodies, grid);
    pir_grid_destroy(grid);
    return wrong;
}

void slice_file_free(slice_file *file) {
    pir_cspace_destroy(file->cspace);
    unlink(file->path);
    rmdir(file->folder);
}

const char *slice_file_check(slice_file *file, pir_quat rotation, pir_vec3 t, pir_state state) {
    pir_configuration is;
    if (!file->cspace)
        return NULL;
    if (pir_cspace_classify(file->cspace, &(pir_pose){rotation, t}, NULL, &is) != PIR_OK)
        return "a pose is refused";
    if (!is.on_grid)
        return "a rotation of the file is not found";
    return is.state == state ? NULL : "another state";
}
