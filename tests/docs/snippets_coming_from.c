/* SPDX-License-Identifier: MIT */
/*
 * The code of docs/coming-from.md: an answer at poses in the world does not change when both bodies are moved as one.
 */
#include <math.h>
#include <stdio.h>

#include <pirouette/pirouette.h>

/* snippet 1 */

static double off(pir_vec3 a, pir_vec3 b) {
    return fabs(a.x - b.x) + fabs(a.y - b.y) + fabs(a.z - b.z);
}

/* The pose after another motion of the whole world. */
static struct pose moved(struct pose world, struct pose body) {
    pir_vec3 t = rotate(world.rotation, body.translation);
    return (struct pose){
        multiply(world.rotation, body.rotation),
        {t.x + world.translation.x, t.y + world.translation.y, t.z + world.translation.z},
    };
}

/* Asks as the bodies stand, then with the world moved, and moves the first answer likewise. */
static int agrees(pir_sum *difference, pir_query *query, struct pose p, struct pose q, double expected) {
    const struct pose world = {{0.48, 0.6, 0, 0.64}, {3, -2, 5}};
    pir_query_result here, there;
    pir_query_cache cache = {0};
    if (ask(difference, query, p, q, &cache, &here) != PIR_OK ||
        ask(difference, query, moved(world, p), moved(world, q), &cache, &there) != PIR_OK)
        return 0;
    struct pose point = {{0, 0, 0, 1}, here.point_p};
    printf("distance %.9f and %.9f, %.9f expected\n", here.distance, there.distance, expected);
    return fabs(here.distance - expected) < 1e-12 && fabs(there.distance - expected) < 1e-12 &&
           off(there.normal, rotate(world.rotation, here.normal)) < 1e-9 &&
           off(there.point_p, moved(world, point).translation) < 1e-9 && here.normal.x > 0.999;
}

int main(void) {
    pir_polytope *cube = NULL;
    pir_sum *difference = NULL;
    pir_query *query = NULL;
    pir_sum_options options = pir_sum_options_default();
    options.difference = 1;
    int good = pir_shape_create("cube", NULL, NULL, &cube) == PIR_OK &&
               pir_sum_create(cube, cube, (pir_quat){0, 0, 0, 1}, &options, &difference) == PIR_OK &&
               pir_query_create(difference, &query) == PIR_OK;

    /* Cubes of edge 1, Q at the origin, P beside it along x, turned by 45 degrees about x: it stays as far. */
    struct pose q = {{0, 0, 0, 1}, {0, 0, 0}},
                p = {{sqrt(0.5 - sqrt(0.125)), 0, 0, sqrt(0.5 + sqrt(0.125))}, {1.25, 0.01, 0}};
    good = good && agrees(difference, query, p, q, 0.25);
    p.translation.x = 0.875;
    good = good && agrees(difference, query, p, q, -0.125);

    pir_query_destroy(query);
    pir_sum_destroy(difference);
    pir_polytope_release(cube);
    return good ? 0 : 1;
}
