/* SPDX-License-Identifier: MIT */
/* The code of docs/gradients.md: a cube over another by its face is farther by as much as it rises. */
#include <math.h>

#include <pirouette/pirouette.h>

int main(void) {
    pir_polytope *p = NULL;
    pir_pair *pair = NULL;
    pir_workspace *workspace = NULL;
    const pir_vec3 v = {0, 0, 0.25}, w = {0, 0, 0};
    if (pir_shape_create("cube", NULL, NULL, &p) != PIR_OK || pir_workspace_create(NULL, &workspace) != PIR_OK ||
        pir_pair_create(p, p, NULL, &pair) != PIR_OK)
        return 1;

    /* snippet 1 */

    pir_gradient there = gradient;
    input.pose_p.translation = (pir_vec3){0, 0, 3};
    int good = pir_pair_gradient(pair, workspace, &input, &answer, &there, &curvature) == PIR_OK &&
               fabs(pir_wrench_along(there.p, v, w) - 0.25) < 1e-12 && fabs(change) <= 0.25 + 1e-12;
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(p);
    return good ? 0 : 1;
}
