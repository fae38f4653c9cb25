/* SPDX-License-Identifier: MIT */
/* The code of docs/motion.md: a box turns on a box, against one, past one, and in a scene. */
#include <stdio.h>

#include <pirouette/pirouette.h>

int main(void) {
    pir_polytope *p = NULL, *q = NULL;
    if (pir_shape_create("cube", NULL, NULL, &p) != PIR_OK || pir_shape_create("cube", NULL, NULL, &q) != PIR_OK)
        return 1;

    /* snippet 1 */

    /* snippet 2 */

    if (contact.degrees[0] < 346 || state != PIR_OUTSIDE)
        return 1;

    pir_pair *pair = NULL;
    pir_workspace *workspace = NULL;
    if (pir_pair_create(p, q, NULL, &pair) != PIR_OK || pir_workspace_create(NULL, &workspace) != PIR_OK)
        return 1;

    /* snippet 3 */

    pir_scene *scene = NULL;
    pir_body_options body = pir_body_options_default();
    uint32_t wall, leaf;
    body.piece_count = 1;
    body.pieces = &q;
    if (pir_scene_create(NULL, &scene) != PIR_OK || pir_scene_add(scene, &body, &wall) != PIR_OK)
        return 1;
    body.pieces = &p;
    body.pose.translation = (pir_vec3){3, 0, 0};
    if (pir_scene_add(scene, &body, &leaf) != PIR_OK)
        return 1;

    /* snippet 4 */

    pir_scene_destroy(scene);
    if (stop.impact.outcome != PIR_CAST_MISS)
        return 1;

    /* snippet 5 */

    if (sweep.outcome != PIR_SWEEP_FREE)
        return 1;

    /* snippet 6 */

    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    if (hit.impact.outcome != PIR_CAST_HIT || !(hit.degrees > 10 && hit.degrees < 90))
        return 1;
    if (sweep.outcome != PIR_SWEEP_MEETS)
        return 1;
    pir_polytope_release(q);
    pir_polytope_release(p);
    // the last event is the quarter turn before the end
    return degrees[0] > 269.999 && degrees[1] < 270.001 && event.lost_count == 8 ? 0 : 1;
}
