/* SPDX-License-Identifier: MIT */
/*
 * The code of docs/queries.md: a cube sinks into another as it turns about the vertical, so that the depth and the
 * contacts are known.
 */
#include <math.h>
#include <stdio.h>

#include <pirouette/pirouette.h>

enum { POSES = 20 };

static int poses;

/* Above Q at first, then 0.1 deep; turned about z by half a radian in all. */
static int next_pose(pir_quat *ret_rotation, pir_vec3 *ret_translation) {
    double half = 0.25 * poses / POSES;
    *ret_rotation = (pir_quat){0, 0, sin(half), cos(half)};
    *ret_translation = (pir_vec3){0, 0, 1.1 - 0.2 * poses / POSES};
    return poses++ < POSES;
}

int main(void) {
    pir_polytope *p = NULL, *q = NULL;
    pir_quat rotation = {0, 0, 0, 1};
    pir_sum *sum = NULL;
    pir_query *query = NULL;
    pir_query_result result = {.distance = NAN};
    pir_contact contacts[64];
    size_t count = 0;
    if (pir_shape_create("cube", NULL, NULL, &p) != PIR_OK || pir_shape_create("cube", NULL, NULL, &q) != PIR_OK)
        return 1;

    /* snippet 1 */

    int good = fabs(result.distance + 0.1 - 0.2 / POSES) < 1e-12;

    /* snippet 2 */

    good = good && result.normal.z == 1 && count == 8; /* an octagon: two squares across each other */

    /* snippet 3 */

    good = good && result.outcome == PIR_NOT_SEPARATED && fabs(result.distance + 0.1) < 1e-12;

    /* snippet 4 */

    good = good && result.outcome == PIR_OVERLAPPING && fabs(result.distance + 0.05) < 1e-12;

    /* snippet 5 */

    good = good && summary.bad == 0 && fabs(distance[0] - 1) < 1e-12 && gradient[0][2] == 1;
    pir_pair_batch_destroy(batch);

    /* snippet 6 */

    pir_query_input middle = pir_query_input_default();
    good = good && pir_query_penetration(asked, &middle, NULL, &result) == PIR_OK && fabs(result.distance + 1) < 1e-12;
    pir_query_destroy(asked);
    pir_sum_destroy(another);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    printf("depth %g, %u contacts\n", -result.distance, (unsigned)count);
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return good ? 0 : 1;
}
