/* SPDX-License-Identifier: MIT */
/*
 * Writes a file of slices about an axis by the library's calls alone, for tests of what reads such files.
 *
 *     write_axis_slices FILE.h5 STEPS X,Y,Z ROBOT_PIECE... -- OBSTACLE_PIECE...
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#define PIECES 16

struct bodies {
    pir_polytope *piece[2][PIECES]; /* of the robot, of the obstacles */
    uint32_t count[2];
};

static pir_status read_pieces(int argc, char **argv, struct bodies *bodies, pir_report *report) {
    int which = 0;
    for (int i = 0; i < argc; i++) {
        pir_polytope **to = &bodies->piece[which][bodies->count[which]];
        if (strcmp(argv[i], "--") == 0) {
            which = 1;
            continue;
        }
        pir_status status =
            bodies->count[which] == PIECES ? PIR_ERR_LIMIT : pir_polytope_read(argv[i], NULL, report, to);
        if (status != PIR_OK)
            return status;
        bodies->count[which]++;
    }
    return PIR_OK;
}

static pir_status write_slices(const char *path, const pir_grid *grid, const struct bodies *bodies,
                               pir_report *report) {
    const pir_cspace_bodies given = {bodies->piece[0], bodies->count[0], bodies->piece[1], bodies->count[1]};
    pir_cspace_job *job = NULL;
    pir_status status = pir_cspace_job_create(&given, grid, path, NULL, report, &job);
    if (status == PIR_OK)
        status = pir_cspace_job_run(job, report);
    if (status == PIR_OK)
        status = pir_cspace_job_assemble(job, report);
    pir_cspace_job_destroy(job);
    return status;
}

int main(int argc, char **argv) {
    struct bodies bodies = {.count = {0, 0}};
    pir_report report = {0};
    pir_grid *grid = NULL;
    pir_vec3 axis;
    if (argc < 6 || sscanf(argv[3], "%lf,%lf,%lf", &axis.x, &axis.y, &axis.z) != 3)
        return 2;
    pir_status status = pir_grid_axis(axis, strtoul(argv[2], NULL, 10), NULL, &grid);
    if (status == PIR_OK)
        status = read_pieces(argc - 4, argv + 4, &bodies, &report);
    if (status == PIR_OK)
        status = write_slices(argv[1], grid, &bodies, &report);
    if (status != PIR_OK)
        fprintf(stderr, "write_axis_slices: %s: %s\n", pir_status_text(status), report.text);
    for (int which = 0; which < 2; which++)
        for (uint32_t i = 0; i < bodies.count[which]; i++)
            pir_polytope_release(bodies.piece[which][i]);
    pir_grid_destroy(grid);
    return status == PIR_OK ? 0 : 1;
}
