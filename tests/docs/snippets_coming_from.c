/* SPDX-License-Identifier: MIT */
/*
 * The code of docs/coming-from.md: pair and sum agree at poses in the world, and an answer does not change when both
 * bodies are moved as one.
 */
#include <math.h>
#include <stdio.h>

#include <pirouette/pirouette.h>

/* snippet 1 */

/* snippet 2 */

static double off(pir_vec3 a, pir_vec3 b) {
    return fabs(a.x - b.x) + fabs(a.y - b.y) + fabs(a.z - b.z);
}

/* The points of an answer are as far apart as it says, the way that it says. */
static int holds(const pir_query_result *a) {
    const pir_vec3 q = a->point_q, n = a->normal;
    const double d = a->distance;
    return off(a->point_p, (pir_vec3){q.x + d * n.x, q.y + d * n.y, q.z + d * n.z}) < 1e-12;
}

static int same(const pir_query_result *a, const pir_query_result *b) {
    return fabs(a->distance - b->distance) < 1e-12 && off(a->normal, b->normal) < 1e-9 && a->state == b->state &&
           holds(a) && holds(b);
}

struct asked {
    pir_pair *pair;
    pir_workspace *workspace;
    pir_sum *difference;
    pir_query *query;
};

/* Asks as the bodies stand, then with the world moved, and moves the first answer likewise. */
static int agrees(const struct asked *of, pir_pose p, pir_pose q, double expected) {
    const pir_pose world = {{0.48, 0.6, 0, 0.64}, {3, -2, 5}};
    const pir_pose moved_p = pir_pose_compose(world, p), moved_q = pir_pose_compose(world, q);
    pir_query_result here, there, by_sum;
    pir_query_cache cache = {0};
    if (ask_pair(of->pair, of->workspace, p, q, &here) != PIR_OK ||
        ask_sum(of->difference, of->query, p, q, &cache, &by_sum) != PIR_OK || !same(&here, &by_sum))
        return 0;
    if (ask_pair(of->pair, of->workspace, moved_p, moved_q, &there) != PIR_OK ||
        ask_sum(of->difference, of->query, moved_p, moved_q, &cache, &by_sum) != PIR_OK || !same(&there, &by_sum))
        return 0;
    printf("distance %.9f and %.9f, %.9f expected\n", here.distance, there.distance, expected);
    return fabs(here.distance - expected) < 1e-12 && fabs(there.distance - expected) < 1e-12 &&
           off(there.normal, pir_pose_rotate(world, here.normal)) < 1e-9 && here.normal.x > 0.999;
}

int main(void) {
    pir_polytope *cube = NULL;
    struct asked of = {NULL, NULL, NULL, NULL};
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    int good = pir_shape_create("cube", NULL, NULL, &cube) == PIR_OK &&
               pir_workspace_create(NULL, &of.workspace) == PIR_OK &&
               pir_pair_create(cube, cube, NULL, &of.pair) == PIR_OK &&
               pir_sum_create(cube, cube, (pir_quat){0, 0, 0, 1}, &options, &of.difference) == PIR_OK &&
               pir_query_create(of.difference, &of.query) == PIR_OK;

    /* Cubes of edge 1, Q at the origin, P beside it along x, turned by 45 degrees about x: it stays as far. */
    const pir_pose q = pir_pose_identity();
    pir_pose p = {{sqrt(0.5 - sqrt(0.125)), 0, 0, sqrt(0.5 + sqrt(0.125))}, {1.25, 0.01, 0}};
    good = good && agrees(&of, p, q, 0.25);
    p.translation.x = 0.875;
    good = good && agrees(&of, p, q, -0.125);

    pir_query_destroy(of.query);
    pir_sum_destroy(of.difference);
    pir_pair_destroy(of.pair);
    pir_workspace_destroy(of.workspace);
    pir_polytope_release(cube);
    return good ? 0 : 1;
}
