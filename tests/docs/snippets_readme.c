/* SPDX-License-Identifier: MIT */
/*
 * The programs of README.md, run on the bodies it names. What the loops find is checked by what it means: pushed apart
 * by the depth, the bodies touch; by a little less, they overlap. Both loops see the same overlaps, the one with both
 * bodies moved through the world.
 *
 * Run in examples/models; writes sum.off into the folder that is given.
 */
#include <math.h>
#include <stdio.h>
#include <unistd.h>

#include <pirouette/baseline.h>
#include <pirouette/pirouette.h>

enum { POSES = 60 };

static int poses, pushed;
static double depth;
static pir_vec3 way;

/* The controller turns, and moves through the mug. */
static int next_pose(pir_quat *ret_rotation, pir_vec3 *ret_translation) {
    double half = 0.01 * poses;
    *ret_rotation = (pir_quat){0.6 * sin(half), 0, 0.8 * sin(half), cos(half)};
    *ret_translation = (pir_vec3){4.0 * poses - 120, 10, 20};
    return poses++ < POSES;
}

/* The same, at poses in the world, in which the mug moves as well. */
static int next_frame(pir_pose *ret_p, pir_pose *ret_q) {
    const double half = 0.02 * poses;
    *ret_q = (pir_pose){{0, sin(half), 0, cos(half)}, {3.0 * poses, -7, 0.5}};
    pir_pose relative = pir_pose_identity();
    const int more = next_pose(&relative.rotation, &relative.translation);
    *ret_p = pir_pose_compose(*ret_q, relative);
    return more;
}

static void push_apart(double by, pir_vec3 normal, pir_vec3 point) {
    depth = by;
    way = normal;
    pushed += isfinite(point.x) && isfinite(point.y) && isfinite(point.z);
}

/* The signed distance after P is moved by `part` of the depth that was found. */
static double after(pir_query *query, pir_query_input input, double part) {
    pir_query_result result;
    input.translation.x += part * depth * way.x;
    input.translation.y += part * depth * way.y;
    input.translation.z += part * depth * way.z;
    return pir_query_signed_distance(query, &input, NULL, &result) == PIR_OK ? result.distance : NAN;
}

static int query_loops(void) {
    pir_quat rotation;
    pir_sum *sum;
    pir_query *query;
    pir_query_input input = pir_query_input_default();
    pir_pair_input posed = pir_pair_input_default();
    pir_query_cache cache = {0};
    pir_query_result result = {.distance = NAN};

    /* snippet 1 */

    const int by_pair = pushed;
    poses = pushed = 0;

    /* snippet 2 */

    /* The last pose is apart; the deepest of the others was pushed. Ask once more in the middle of the way. */
    poses = POSES / 2;
    int checks = next_pose(&rotation, &input.translation) && pir_sum_rotate(sum, rotation, PIR_METHOD_WALK) == PIR_OK &&
                 pir_query_penetration(query, &input, NULL, &result) == PIR_OK;
    depth = -result.distance;
    way = result.normal;
    checks = checks && by_pair == pushed && pushed > 10 && pushed < POSES && depth > 1 &&
             fabs(after(query, input, 1)) < 1e-9 && after(query, input, 0.999) < 0 && after(query, input, 1.001) > 0;
    printf("%d of %d poses overlap, depth %g in the middle, then %g\n", pushed, POSES, depth, after(query, input, 1));
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return checks;
}

/* The tracked sum, which the file holds, is the hull of all sums of vertices. */
static int track(const char *folder) {
    pir_polytope *p, *q, *written = NULL;
    pir_sum *sum;
    pir_mesh *mesh, *hull = NULL;
    if (pir_polytope_read("gamepad.off", NULL, NULL, NULL, &p) != PIR_OK ||
        pir_polytope_read("mug.off", NULL, NULL, NULL, &q) != PIR_OK || chdir(folder) != 0)
        return 0;

    /* snippet 3 */

    pir_surface surface = {.points = 0};
    int checks = pir_polytope_read("sum.off", NULL, NULL, &surface, &written) == PIR_OK &&
                 pir_hull_sum(p, q, pir_sum_rotation(sum), NULL, PIR_DOUBLE, &hull) == PIR_OK &&
                 pir_mesh_equal(mesh, hull) && surface.points == pir_mesh_vertex_count(hull) &&
                 surface.facets == pir_mesh_facet_count(hull);
    pir_polytope_release(written);
    pir_mesh_destroy(hull);
    pir_mesh_destroy(mesh);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return checks;
}

int main(int argc, char **argv) {
    return argc == 2 && query_loops() && track(argv[1]) ? 0 : 1;
}
