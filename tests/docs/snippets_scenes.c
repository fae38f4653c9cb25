/* SPDX-License-Identifier: MIT */
/* The code of docs/scenes.md: a box falls on a slab, which it reaches after a known number of steps. */
#include <stdio.h>

#include <pirouette/pirouette.h>

static pir_polytope *block(double x, double y, double z) {
    pir_vec3 corner[8];
    pir_polytope *made = NULL;
    for (int i = 0; i < 8; i++)
        corner[i] = (pir_vec3){i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z};
    pir_polytope_create(corner, 8, NULL, &made);
    return made;
}

int main(void) {
    pir_polytope *slab = block(5, 5, 0.5), *box = block(0.5, 0.5, 0.5);
    int began = 0;
    if (!slab || !box)
        return 1;

    /* snippet 1 */

    pir_pose pose;
    pir_scene_pose(scene, box_body, &pose);
    size_t count;
    const pir_scene_event *event = pir_scene_events(scene, &count);
    // it falls through, for nothing holds it, and is still in the slab
    int good = began == 1 && count == 1 && event->kind == PIR_EVENT_PERSISTED && event->state == PIR_INSIDE &&
               event->body_p == floor_body && pose.translation.z < 1;
    pir_scene_destroy(scene);
    pir_polytope_release(box);
    pir_polytope_release(slab);
    return good ? 0 : 1;
}
