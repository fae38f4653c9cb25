/* SPDX-License-Identifier: MIT */
/* The code of docs/cgm.md: the overlay's mesh is that of the tracked sum. */
#include <stdio.h>

#include <pirouette/pirouette.h>

int main(void) {
    const pir_quat rotation = {1, 2, 3, 4};
    pir_polytope *p = NULL, *q = NULL;
    pir_sum *tracked = NULL;
    pir_mesh *other = NULL;
    if (pir_shape_create("cone", NULL, NULL, &p) != PIR_OK || pir_shape_create("icosahedron", NULL, NULL, &q) != PIR_OK)
        return 1;

    /* snippet 1 */

    int good = pir_sum_create(p, q, rotation, NULL, &tracked) == PIR_OK &&
               pir_sum_mesh(tracked, PIR_EXACT, &other) == PIR_OK && pir_mesh_equal(mesh, other);
    printf("%u facets\n", (unsigned)pir_mesh_facet_count(mesh));
    pir_mesh_destroy(other);
    pir_mesh_destroy(mesh);
    pir_sum_destroy(tracked);
    pir_cgm_release(of_sum);
    pir_cgm_release(of_q);
    pir_cgm_release(of_p);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return good ? 0 : 1;
}
