/* SPDX-License-Identifier: MIT */
/*
 * Bends the path of a bar around a post, by the gradient of the signed distance.
 *
 * The path is a row of poses. Its first and last stay; the others begin on the straight line between them, where the
 * bar runs through the post. Each step moves them against the gradient of
 *
 *     sum of the squared ways and turns from pose to pose  +  PUSH · sum of max(0, MARGIN − distance)²
 *
 * In the post the distance is minus the depth, and its gradient leads out the shortest way.
 */
#include <math.h>
#include <stdio.h>

#include <pirouette/pirouette.h>

enum { POSES = 13, STEPS = 800 };
#define MARGIN 0.1
#define PUSH   30.0
#define STEP   0.02

typedef struct bodies {
    pir_polytope *bar, *post;
    pir_pair *pair;
    pir_workspace *workspace;
} bodies;

static pir_vec3 add(pir_vec3 a, pir_vec3 b, double s) {
    return (pir_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

/* The turn from a to b as a rotation vector in the world, to second order: both are of length 1. */
static pir_vec3 turn_between(pir_quat a, pir_quat b) {
    const double w = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z, s = w < 0 ? -2 : 2;
    return (pir_vec3){s * (b.x * a.w - b.w * a.x - b.y * a.z + b.z * a.y),
                      s * (b.y * a.w - b.w * a.y - b.z * a.x + b.x * a.z),
                      s * (b.z * a.w - b.w * a.z - b.x * a.y + b.y * a.x)};
}

/* Adds the gradient of one pose's distance where the bar is nearer than the margin. */
static pir_status push_away(const bodies *b, pir_pose pose, pir_wrench *gradient, double *ret_distance) {
    pir_pair_input input = pir_pair_input_default();
    pir_query_result answer;
    pir_gradient by_pose;
    input.pose_p = pose;
    input.cutoff = 4 * MARGIN; /* farther away nothing is known, and nothing needed */
    pir_status status = pir_pair_gradient(b->pair, b->workspace, &input, &answer, &by_pose, NULL);
    if (status != PIR_OK)
        return status;
    const double more = fmax(0, MARGIN - answer.distance);
    gradient->force = add(gradient->force, by_pose.p.force, -PUSH * more);
    gradient->torque = add(gradient->torque, by_pose.p.torque, -PUSH * more);
    *ret_distance = answer.distance;
    return PIR_OK;
}

/* The gradient of the sum above to all poses, and the least distance of them. */
static pir_status descend(const bodies *b, const pir_pose path[POSES], pir_wrench gradient[POSES], double *ret_least) {
    *ret_least = HUGE_VAL;
    for (int i = 0; i + 1 < POSES; i++) {
        const pir_vec3 way = add(path[i + 1].translation, path[i].translation, -1);
        const pir_vec3 turn = turn_between(path[i].rotation, path[i + 1].rotation);
        gradient[i].force = add(gradient[i].force, way, -1);
        gradient[i].torque = add(gradient[i].torque, turn, -1);
        gradient[i + 1].force = add(gradient[i + 1].force, way, 1);
        gradient[i + 1].torque = add(gradient[i + 1].torque, turn, 1);
    }
    for (int i = 1; i + 1 < POSES; i++) {
        double distance;
        pir_status status = push_away(b, path[i], &gradient[i], &distance);
        if (status != PIR_OK)
            return status;
        *ret_least = fmin(*ret_least, distance);
    }
    return PIR_OK;
}

static pir_status run(const bodies *b) {
    pir_pose path[POSES];
    double least;
    for (int i = 0; i < POSES; i++) {
        path[i] = pir_pose_identity();
        path[i].translation = (pir_vec3){3.0 * i / (POSES - 1) - 1.5, 0.125, 0.0625};
    }
    path[POSES - 1].rotation = (pir_quat){0, 0, 0.28, 0.96}; /* the bar arrives turned by 33° */
    for (int step = 0; step <= STEPS; step++) {
        pir_wrench gradient[POSES] = {{{0, 0, 0}, {0, 0, 0}}};
        const pir_status status = descend(b, path, gradient, &least);
        if (status != PIR_OK)
            return status;
        if (step % (STEPS / 4) == 0)
            printf("step %d: least distance %+.6f\n", step, least);
        for (int i = 1; i + 1 < POSES && step < STEPS; i++)
            path[i] = pir_pose_integrate(path[i], gradient[i].force, gradient[i].torque, -STEP);
    }
    for (int i = 0; i < POSES; i++) {
        const pir_vec3 t = path[i].translation;
        const pir_quat q = path[i].rotation;
        printf("pose %d: %.17g %.17g %.17g turned %.17g %.17g %.17g %.17g\n", i, t.x, t.y, t.z, q.x, q.y, q.z, q.w);
    }
    return PIR_OK;
}

int main(void) {
    bodies b = {NULL, NULL, NULL, NULL};
    pir_status status = pir_shape_create("box?x=1.6&y=0.2&z=0.2", NULL, NULL, &b.bar);
    if (status == PIR_OK)
        status = pir_shape_create("box?x=0.4&y=0.4&z=4", NULL, NULL, &b.post);
    if (status == PIR_OK)
        status = pir_workspace_create(NULL, &b.workspace);
    if (status == PIR_OK)
        status = pir_pair_create(b.bar, b.post, NULL, &b.pair);
    if (status == PIR_OK)
        status = run(&b);
    if (status != PIR_OK)
        fprintf(stderr, "trajectory: %s\n", pir_status_text(status));
    pir_pair_destroy(b.pair);
    pir_workspace_destroy(b.workspace);
    pir_polytope_release(b.post);
    pir_polytope_release(b.bar);
    return status == PIR_OK ? 0 : 1;
}
