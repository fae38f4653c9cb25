/* SPDX-License-Identifier: MIT */
#include "place.h"

#include <math.h>

const spot spot_least = {-3, -2, -0.2, -3.14}, spot_most = {3, 2, 0.2, 3.14};
const spot spot_start = {-2, 0, 0, 0}, spot_goal = {2, -0.3, 0, 1.5};

/* The box between two corners. */
static pir_status make_box(pir_vec3 a, pir_vec3 b, pir_polytope **ret_box) {
    pir_vec3 corner[8];
    for (int i = 0; i < 8; i++)
        corner[i] = (pir_vec3){i & 1 ? b.x : a.x, i & 2 ? b.y : a.y, i & 4 ? b.z : a.z};
    return pir_polytope_create(corner, 8, NULL, ret_box);
}

/* An L with a lid that slopes. */
static pir_status make_robot(pir_polytope **pieces) {
    const pir_vec3 lid[] = {{-1, -0.15, 0.2}, {-1, 0.15, 0.2}, {1, -0.15, 0.2}, {1, 0.15, 0.2}, {-0.8, 0, 0.5}};
    pir_status status = make_box((pir_vec3){-1, -0.15, -0.2}, (pir_vec3){1, 0.15, 0.2}, &pieces[0]);
    if (status == PIR_OK)
        status = make_box((pir_vec3){0.7, 0.15, -0.2}, (pir_vec3){1, 0.75, 0.2}, &pieces[1]);
    return status == PIR_OK ? pir_polytope_create(lid, 5, NULL, &pieces[2]) : status;
}

static pir_status make_obstacles(pir_polytope **obstacles) {
    pir_vec3 pillar[12];
    for (int i = 0; i < 6; i++)
        for (int top = 0; top < 2; top++)
            pillar[2 * i + top] = (pir_vec3){1.4 + 0.25 * cos(i * 3.14159265358979 / 3),
                                             1.2 + 0.25 * sin(i * 3.14159265358979 / 3), top ? 2 : -2};
    pir_status status = make_box((pir_vec3){-0.1, 0.4, -2}, (pir_vec3){0.1, 4, 2}, &obstacles[0]);
    if (status == PIR_OK)
        status = make_box((pir_vec3){-0.1, -4, -2}, (pir_vec3){0.1, -0.4, 2}, &obstacles[1]);
    return status == PIR_OK ? pir_polytope_create(pillar, 12, NULL, &obstacles[2]) : status;
}

/* Slices all pairs of pieces at steps of three degrees about the vertical axis, into a file. */
static pir_status slice(world *place, const char *file) {
    const pir_cspace_bodies bodies = {place->robot, ROBOT_PIECES, place->obstacle, OBSTACLES};
    pir_grid *grid = NULL;
    pir_cspace_job *job = NULL;
    pir_status status = pir_grid_axis((pir_vec3){0, 0, 1}, STEPS, NULL, &grid);
    if (status == PIR_OK)
        status = pir_cspace_job_create(&bodies, grid, file, NULL, &place->report, &job);
    if (status == PIR_OK)
        status = pir_cspace_job_run(job, &place->report);
    if (status == PIR_OK)
        status = pir_cspace_job_assemble(job, &place->report);
    pir_cspace_job_destroy(job);
    pir_grid_destroy(grid);
    return status;
}

int place_make(world *place, const char *file) {
    *place = (world){.error = NULL};
    pir_status status = make_robot(place->robot);
    if (status == PIR_OK)
        status = make_obstacles(place->obstacle);
    if (status == PIR_OK)
        status = slice(place, file);
    if (status == PIR_OK)
        status = pir_cspace_open(file, NULL, &place->report, &place->slices);
    if (status != PIR_OK)
        place->error = pir_status_text(status);
    return status == PIR_OK;
}

void place_clear(world *place) {
    pir_cspace_destroy(place->slices);
    for (int i = 0; i < ROBOT_PIECES; i++)
        pir_polytope_release(place->robot[i]);
    for (int i = 0; i < OBSTACLES; i++)
        pir_polytope_release(place->obstacle[i]);
}

pir_pose place_pose(const spot *at) {
    return (pir_pose){{0, 0, sin(at->turn / 2), cos(at->turn / 2)}, {at->x, at->y, at->z}};
}

int place_is_free(world *place, const spot *at) {
    const pir_pose pose = place_pose(at);
    pir_configuration answer;
    pir_status status = pir_cspace_classify(place->slices, &pose, &place->report, &answer);
    if (status != PIR_OK)
        place->error = pir_status_text(status);
    return status == PIR_OK && answer.verdict == PIR_VERDICT_FREE;
}

int place_may_go(world *place, const spot *from, const spot *to) {
    const pir_pose a = place_pose(from), b = place_pose(to);
    // single poses take less time, and tell most motions that are not free
    for (int i = 8; i > 0; i--) {
        const spot at = spot_between(from, to, i / 8.0);
        if (!place_is_free(place, &at))
            return 0;
    }
    pir_cspace_motion answer;
    pir_status status = pir_cspace_segment(place->slices, &a, &b, &place->report, &answer);
    if (status != PIR_OK)
        place->error = pir_status_text(status);
    return status == PIR_OK && answer.verdict == PIR_VERDICT_FREE;
}

double spot_distance(const spot *a, const spot *b) {
    double x = a->x - b->x, y = a->y - b->y, z = a->z - b->z, turn = a->turn - b->turn;
    return sqrt(x * x + y * y + z * z + turn * turn);
}

spot spot_between(const spot *a, const spot *b, double share) {
    return (spot){a->x + share * (b->x - a->x), a->y + share * (b->y - a->y), a->z + share * (b->z - a->z),
                  a->turn + share * (b->turn - a->turn)};
}

/* Whether some piece of the robot touches or overlaps an obstacle; −1 on failure. */
static int overlaps(pir_pair *(*pairs)[OBSTACLES], pir_workspace *workspace, const spot *at) {
    pir_pair_input input = pir_pair_input_default();
    pir_query_result answer;
    input.pose_p = place_pose(at);
    for (int i = 0; i < ROBOT_PIECES; i++)
        for (int k = 0; k < OBSTACLES; k++) {
            if (pir_pair_overlap(pairs[i][k], workspace, &input, &answer) != PIR_OK)
                return -1;
            if (answer.state != PIR_OUTSIDE)
                return 1;
        }
    return 0;
}

int place_check(world *place, const spot *path, int count, int points) {
    pir_pair *pairs[ROBOT_PIECES][OBSTACLES] = {{NULL}};
    pir_workspace *workspace = NULL;
    pir_status status = pir_workspace_create(NULL, &workspace);
    for (int i = 0; i < ROBOT_PIECES; i++)
        for (int k = 0; k < OBSTACLES && status == PIR_OK; k++)
            status = pir_pair_create(place->robot[i], place->obstacle[k], NULL, &pairs[i][k]);
    int found = status == PIR_OK ? 0 : -1;
    for (int n = 0; n < points && found >= 0; n++) {
        double at = (double)n / (points - 1) * (count - 1);
        int leg = (int)at < count - 1 ? (int)at : count - 2;
        const spot here = spot_between(&path[leg], &path[leg + 1], at - leg);
        int hit = overlaps(pairs, workspace, &here);
        found = hit < 0 ? -1 : found + hit;
    }
    for (int i = 0; i < ROBOT_PIECES; i++)
        for (int k = 0; k < OBSTACLES; k++)
            pir_pair_destroy(pairs[i][k]);
    pir_workspace_destroy(workspace);
    return found;
}
