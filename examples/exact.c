/* SPDX-License-Identifier: MIT */
/*
 * Prints the exact corners of a sum: a cube, turned by the quaternion (1, 2, 3, 4), added to a cube that stands.
 *
 * The length of the quaternion is no matter. Its rotation matrix is rational, here in multiples of 1/15, and so is
 * every coordinate that comes out.
 */
#include <stdio.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

static pir_status print_corners(const pir_mesh *mesh) {
    mpq_t corner[3];
    mpq_inits(corner[0], corner[1], corner[2], NULL);
    pir_status status = PIR_OK;
    for (uint32_t v = 0; status == PIR_OK && v < pir_mesh_vertex_count(mesh); v++) {
        status = pir_mesh_vertex_exact(mesh, v, corner);
        if (status == PIR_OK)
            gmp_printf("%Qd %Qd %Qd\n", corner[0], corner[1], corner[2]);
    }
    mpq_clears(corner[0], corner[1], corner[2], NULL);
    return status;
}

int main(void) {
    pir_polytope *cube = NULL;
    pir_sum *sum = NULL;
    pir_mesh *mesh = NULL;

    /* The cube with corners ±1. */
    pir_vec3 corners[8];
    for (int i = 0; i < 8; i++)
        corners[i] = (pir_vec3){i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1};

    pir_status status = pir_polytope_create(corners, 8, NULL, &cube);
    if (status == PIR_OK)
        status = pir_sum_create(cube, cube, (pir_quat){1, 2, 3, 4}, NULL, &sum);
    if (status == PIR_OK)
        status = pir_sum_mesh(sum, PIR_EXACT, &mesh);
    if (status == PIR_OK)
        status = print_corners(mesh);

    if (status != PIR_OK)
        fprintf(stderr, "exact: %s\n", pir_status_text(status));
    pir_mesh_destroy(mesh);
    pir_sum_destroy(sum);
    pir_polytope_release(cube);
    return status == PIR_OK ? 0 : 1;
}
