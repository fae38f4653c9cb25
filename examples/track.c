/* SPDX-License-Identifier: MIT */
/*
 * Keeps the sum of two bodies while the first turns once about the z axis, and writes the last one.
 *
 *     track P.off Q.off SUM.off
 *
 * The sum is carried from frame to frame; what the frames cost shows in its counters.
 */
#include <math.h>
#include <stdio.h>

#include <pirouette/pirouette.h>

enum { STEPS = 3600, SHOW_EVERY = 600 };

/* Turns P once around. Every SHOW_EVERY frames prints the pairs of the sum, those looked at, and those repaired. */
static pir_status turn(pir_sum *sum) {
    const double pi = 3.14159265358979323846;
    pir_sum_statistics before = pir_sum_get_statistics(sum);
    printf("frame  ee pairs  looked at  repaired\n");
    for (int frame = 1; frame <= STEPS; frame++) {
        double half = pi * frame / STEPS;
        pir_status status = pir_sum_rotate(sum, (pir_quat){0, 0, sin(half), cos(half)}, PIR_METHOD_AUTO);
        if (status != PIR_OK)
            return status;
        if (frame % SHOW_EVERY == 0) {
            pir_sum_statistics now = pir_sum_get_statistics(sum);
            printf("%5d  %8u  %9.1f  %8.1f\n", frame, (unsigned)pir_sum_ee_count(sum),
                   (double)(now.checked - before.checked) / SHOW_EVERY,
                   (double)(now.repaired - before.repaired) / SHOW_EVERY);
            before = now;
        }
    }
    return PIR_OK;
}

int main(int argc, char **argv) {
    if (argc != 4) {
        fprintf(stderr, "usage: track P.off Q.off SUM.off\n");
        return 2;
    }
    pir_polytope *p = NULL, *q = NULL;
    pir_sum *sum = NULL;
    pir_mesh *mesh = NULL;
    pir_report report = {.status = PIR_OK};

    pir_status status = pir_polytope_read(argv[1], NULL, &report, NULL, &p);
    if (status == PIR_OK)
        status = pir_polytope_read(argv[2], NULL, &report, NULL, &q);
    if (status == PIR_OK)
        status = pir_sum_create(p, q, (pir_quat){0, 0, 0, 1}, NULL, &sum);
    if (status == PIR_OK)
        status = turn(sum);
    if (status == PIR_OK)
        status = pir_sum_mesh(sum, PIR_DOUBLE, &mesh);
    if (status == PIR_OK)
        status = pir_mesh_write(mesh, argv[3], 0, &report);

    /* A report is filled where a file is at fault; elsewhere the status says all. */
    if (status == PIR_OK)
        printf("%s: %u vertices, %u facets\n", argv[3], (unsigned)pir_mesh_vertex_count(mesh),
               (unsigned)pir_mesh_facet_count(mesh));
    else
        fprintf(stderr, "track: %s\n", report.status == status ? report.text : pir_status_text(status));
    pir_mesh_destroy(mesh);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return status == PIR_OK ? 0 : 2;
}
