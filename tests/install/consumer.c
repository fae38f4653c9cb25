/* SPDX-License-Identifier: MIT */
/*
 * A program outside the build: it sees only what an installation gives, through pkg-config. It adds a box to itself,
 * turned by nothing and then by a quarter turn, where the sum is again a box, and reads a corner of the result exactly.
 */
#include <stdio.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

static int fail(const char *what) {
    fprintf(stderr, "consumer: %s\n", what);
    return 1;
}

/* The mesh of the sum must be a box, by its counts and by the exact z of its corners. */
static int check_mesh(pir_sum *sum) {
    pir_mesh *mesh = NULL;
    if (pir_sum_mesh(sum, PIR_EXACT, &mesh) != PIR_OK)
        return fail("no mesh of the sum");
    int is_box = pir_mesh_vertex_count(mesh) == 8 && pir_mesh_edge_count(mesh) == 12 && pir_mesh_facet_count(mesh) == 6;

    /* Every corner's exact z is 0 or 2. */
    mpq_t corner[3];
    mpq_inits(corner[0], corner[1], corner[2], NULL);
    for (uint32_t v = 0; is_box && v < pir_mesh_vertex_count(mesh); v++) {
        is_box = pir_mesh_vertex_exact(mesh, v, corner) == PIR_OK &&
                 (mpq_sgn(corner[2]) == 0 || mpq_cmp_si(corner[2], 2, 1) == 0);
    }
    mpq_clears(corner[0], corner[1], corner[2], NULL);
    pir_mesh_destroy(mesh);
    return is_box ? 0 : fail("the sum of aligned boxes is not a box of height 2");
}

int main(void) {
    if (strcmp(pir_version(), PIR_VERSION_STRING) != 0)
        return fail("headers and library are of different versions");

    /* The box [0, 3] x [0, 2] x [0, 1]. */
    pir_vec3 corners[8];
    for (int i = 0; i < 8; i++)
        corners[i] = (pir_vec3){i & 1 ? 3.0 : 0.0, i & 2 ? 2.0 : 0.0, i & 4 ? 1.0 : 0.0};
    pir_polytope *box = NULL;
    if (pir_polytope_create(corners, 8, NULL, &box) != PIR_OK)
        return fail("no box");

    /* Not turned, then a quarter turn about z. */
    pir_sum *sum = NULL;
    int result = 1;
    if (pir_sum_create(box, box, (pir_quat){0, 0, 0, 1}, NULL, &sum) != PIR_OK)
        fail("no sum");
    else if (check_mesh(sum) == 0 && pir_sum_rotate(sum, (pir_quat){0, 0, 1, 1}, PIR_METHOD_UPDATE) == PIR_OK)
        result = check_mesh(sum);
    pir_sum_destroy(sum);
    pir_polytope_release(box);
    if (result == 0)
        printf("pirouette %s is installed and works\n", pir_version());
    return result;
}
