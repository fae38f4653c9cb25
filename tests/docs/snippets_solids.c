/* SPDX-License-Identifier: MIT */
/* The code of docs/solids.md: an L and a tetrahedron are added, and held against each other. */
#include <stdio.h>

#include <pirouette/pirouette.h>

int main(void) {
    /* an L of three unit squares, one high, and a unit cube */
    const pir_vec3 of_clamp[12] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0},
                                   {0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {1, 1, 1}, {1, 2, 1}, {0, 2, 1}};
    const uint32_t clamp_starts[9] = {0, 6, 12, 16, 20, 24, 28, 32, 36};
    const uint32_t clamp_corners[36] = {5, 4, 3, 2, 1, 0, 6, 7, 8,  9, 10, 11, 0,  1,  7, 6, 1, 2,
                                        8, 7, 2, 3, 9, 8, 3, 4, 10, 9, 4,  5,  11, 10, 5, 0, 6, 11};
    const pir_vec3 of_pin[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const uint32_t pin_starts[5] = {0, 3, 6, 9, 12}, pin_corners[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    const pir_solid_facets clamp = {of_clamp, 12, clamp_starts, clamp_corners, 8};
    const pir_solid_facets pin = {of_pin, 4, pin_starts, pin_corners, 4};
    pir_report report = {0};

    /* snippet 1 */

    printf("%u vertices, %u facets %s\n", (unsigned)pir_mesh_vertex_count(mesh), (unsigned)pir_mesh_facet_count(mesh),
           report.text);
    pir_pieces *pieces_p = NULL, *pieces_q = NULL;
    pir_solid_query *query = NULL;
    pir_workspace *workspace = NULL;
    pir_pair_input input = pir_pair_input_default();
    pir_state state = PIR_OUTSIDE;
    pir_solid_depth depth = {0};
    pir_workspace_create(NULL, &workspace);
    input.pose_p.translation.x = 0.5;

    /* snippet 2 */

    pir_solid_contacts *contacts = NULL;
    enum { most = 16 };
    pir_solid_contact contact[most];
    size_t count = 0;
    input.pose_p.translation.x = -2; /* side by side */

    /* snippet 3 */

    const bool touches = count > 0 && contact[0].distance == 0 && contact[0].normal.x == -1;
    const int good = pir_mesh_facet_count(mesh) > 8 && state == PIR_INSIDE && depth.depth > 0 && touches;
    pir_solid_contacts_destroy(contacts);
    pir_solid_query_destroy(query);
    pir_workspace_destroy(workspace);
    pir_pieces_destroy(pieces_q);
    pir_pieces_destroy(pieces_p);
    pir_mesh_destroy(mesh);
    pir_solid_sum_destroy(sum);
    pir_solid_release(q);
    pir_solid_release(p);
    return good ? 0 : 1;
}
