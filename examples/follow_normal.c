/* SPDX-License-Identifier: MIT */
/*
 * Keeps only the part of a difference that the next answer needs: a cone about the last contact normal.
 *
 * One solid turns and slides inside another, so the least depth moves slowly from facet to facet, and the cone follows
 * it. Each line gives the depth in the cone, the angle from the cone's axis to the normal found, and how many pairs are
 * kept.
 * The cone's answer is the least depth of all as long as that has its normal in the cone. The example asks the whole
 * difference as well, and turns the cone there when the least depth has left it; a game would do so once in a while.
 */
#include <math.h>
#include <stdio.h>

#include <pirouette/pirouette.h>

enum { FRAMES = 40, SHOW_EVERY = 5 };

static const double HALF_ANGLE = 0.5; /* radians */

static double angle_between(pir_vec3 a, pir_vec3 b) { /* of unit vectors */
    return acos(fmin(1, a.x * b.x + a.y * b.y + a.z * b.z));
}

static pir_status follow(pir_sum *kept, pir_query *cone, pir_sum *all, pir_query *whole) {
    pir_query_cache cache = {0}, whole_cache = {0};
    pir_query_input input = pir_query_input_default();
    pir_query_result answer, truth;
    pir_vec3 axis = {0, 0, 0};
    pir_status status = PIR_OK;
    for (int frame = 0; status == PIR_OK && frame <= FRAMES; frame++) {
        double half = 0.01 * frame;
        pir_quat rotation = {0.3 * sin(half), sin(half), 0.2 * sin(half), cos(half)};
        input.translation = (pir_vec3){0.5 - 0.002 * frame, 0.3, 0.01 * frame};
        status = pir_sum_rotate(all, rotation, PIR_METHOD_AUTO);
        if (status == PIR_OK)
            status = pir_query_penetration(whole, &input, &whole_cache, &truth);

        /* The first axis comes from the whole difference, each later one from the cone's own answer. */
        if (status == PIR_OK && frame == 0)
            axis = truth.normal;
        if (status == PIR_OK)
            status = pir_sum_set_region(kept, axis, HALF_ANGLE);
        if (status == PIR_OK)
            status = pir_sum_rotate(kept, rotation, PIR_METHOD_AUTO);
        if (status == PIR_OK)
            status = pir_query_penetration(cone, &input, &cache, &answer);
        if (status != PIR_OK)
            break;
        /* The cone answers with the least depth in it, which is more than the least of all once that has left. */
        if (answer.distance < truth.distance) {
            printf("frame %2d: depth %.9f, outside the cone; the cone has %.9f\n", frame, -truth.distance,
                   -answer.distance);
            axis = truth.normal;
            continue;
        }
        if (frame % SHOW_EVERY == 0)
            printf("frame %2d: depth %.9f, %.4f from the axis, %u of %u edge pairs kept\n", frame, -answer.distance,
                   angle_between(axis, answer.normal), (unsigned)pir_sum_ee_count(kept),
                   (unsigned)pir_sum_ee_count(all));
        axis = answer.normal;
    }
    return status;
}

int main(void) {
    pir_polytope *p = NULL, *q = NULL;
    pir_sum *kept = NULL, *all = NULL;
    pir_query *cone = NULL, *whole = NULL;
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;

    pir_status status = pir_shape_create("icosahedron", NULL, NULL, &p);
    if (status == PIR_OK)
        status = pir_shape_create("icosahedron", NULL, NULL, &q);
    if (status == PIR_OK)
        status = pir_sum_create(p, q, (pir_quat){0, 0, 0, 1}, &options, &kept);
    if (status == PIR_OK)
        status = pir_sum_clone(kept, NULL, &all);
    if (status == PIR_OK)
        status = pir_query_create(kept, &cone);
    if (status == PIR_OK)
        status = pir_query_create(all, &whole);
    if (status == PIR_OK)
        status = follow(kept, cone, all, whole);

    if (status != PIR_OK)
        fprintf(stderr, "follow_normal: %s\n", pir_status_text(status));
    pir_query_destroy(whole);
    pir_query_destroy(cone);
    pir_sum_destroy(all);
    pir_sum_destroy(kept);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return status == PIR_OK ? 0 : 1;
}
