/* SPDX-License-Identifier: MIT */
/*
 * The first program of docs/getting-started.md: a cube, turned by 45 degrees, has sunk into a plate.
 */
#include <math.h>
#include <stdio.h>

#include <pirouette/pirouette.h>

int main(void) {
    pir_polytope *cube = NULL, *plate = NULL;
    pir_workspace *workspace = NULL; /* scratch, one a thread */
    pir_pair *pair = NULL;
    pir_pair_input posed = pir_pair_input_default();
    pir_query_result answer;
    pir_contact contacts[8];
    size_t count = 0;

    pir_status status = pir_shape_create("cube", NULL, NULL, &cube);
    if (status == PIR_OK)
        status = pir_shape_create("box?x=4&y=4&z=0.5", NULL, NULL, &plate);
    if (status == PIR_OK)
        status = pir_workspace_create(NULL, &workspace);
    if (status == PIR_OK)
        status = pir_pair_create(cube, plate, NULL, &pair);

    posed.pose_p = (pir_pose){{0, 0, tan(3.14159265358979 / 8), 1}, {0.25, 0.5, 0.625}};
    if (status == PIR_OK)
        status = pir_pair_signed_distance(pair, workspace, &posed, &answer);
    if (status == PIR_OK)
        status = pir_pair_manifold(pair, workspace, &posed, &answer, 8, contacts, &count);

    if (status == PIR_OK) {
        printf("distance %.3f, out along %.0f %.0f %.0f\n", answer.distance, answer.normal.x, answer.normal.y,
               answer.normal.z);
        for (size_t i = 0; i < count && i < 8; i++)
            printf("contact %.3f %.3f %.3f\n", contacts[i].point_p.x, contacts[i].point_p.y, contacts[i].point_p.z);
    } else {
        fprintf(stderr, "first: %s\n", pir_status_text(status));
    }
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(cube);
    pir_polytope_release(plate);
    return status == PIR_OK ? 0 : 1;
}
