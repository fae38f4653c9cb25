/* SPDX-License-Identifier: MIT */
/* The code of docs/meshes.md: a unit cube stands a little deep in a floor of triangles, alone and in a scene. */
#include <math.h>
#include <stdio.h>

#include <pirouette/pirouette.h>

int main(void) {
    pir_polytope *box = NULL;
    pir_workspace *workspace = NULL;
    pir_vec3 corner[8];
    for (int i = 0; i < 8; i++)
        corner[i] = (pir_vec3){i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5};
    if (pir_polytope_create(corner, 8, NULL, &box) != PIR_OK || pir_workspace_create(NULL, &workspace) != PIR_OK)
        return 1;

    /* snippet 1 */

    pir_body_options cube = pir_body_options_default();
    cube.pieces = &box;
    cube.piece_count = 1;
    cube.pose.translation = (pir_vec3){20, 30, 0.49};
    pir_scene_add(scene, &cube, &box_body);
    pir_scene_update(scene, NULL, 0);
    size_t count;
    const pir_scene_event *event = pir_scene_events(scene, &count);
    bool good = count > 0;
    for (size_t i = 0; i < count; i++)
        good &= event[i].state != PIR_OUTSIDE && event[i].body_p == ground_body && event[i].body_q == box_body;

    /* snippet 2 */

    good &= found.contacts == 4 && found.state == PIR_INSIDE;
    for (size_t i = 0; i < found.contacts; i++)
        good &= contacts[i].normal.z == 1 && fabs(contacts[i].distance + 0.01) < 1e-12;
    pir_scene_destroy(scene);
    pir_height_field_release(field);
    pir_workspace_destroy(workspace);
    pir_polytope_release(box);
    return good ? 0 : 1;
}
