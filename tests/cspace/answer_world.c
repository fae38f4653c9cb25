/* SPDX-License-Identifier: MIT */
/* See answer_world.h. */
#include "cspace/answer_world.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <pirouette/shape.h>

#include "support/bodies.h"
#include "support/vectors.h"

static void need(pir_status status) {
    if (status != PIR_OK) {
        fprintf(stderr, "a world to test in: %s\n", pir_status_text(status));
        abort();
    }
}

static pir_polytope *shape(const char *name, pir_vec3 offset) {
    pir_polytope *at_origin, *moved;
    need(pir_shape_create(name, NULL, NULL, &at_origin));
    test_points points = {.count = pir_polytope_vertex_count(at_origin)};
    for (uint32_t v = 0; v < points.count; v++)
        points.at[v] = test_add(pir_polytope_vertex(at_origin, v), offset, 1);
    need(pir_polytope_create(points.at, points.count, NULL, &moved));
    pir_polytope_release(at_origin);
    return moved;
}

static void put(pir_polytope **pieces, uint32_t *count, const char *name, pir_vec3 offset) {
    pieces[(*count)++] = shape(name, offset);
}

static void put_bodies(answer_world *world, int kind) {
    static const pir_vec3 at_origin = {0, 0, 0};
    pir_polytope **p = world->robot, **q = world->obstacle;
    uint32_t *n = &world->robot_count, *m = &world->obstacle_count;
    if (kind == 0) {
        put(p, n, "cube", at_origin);
        put(q, m, "cube", at_origin);
    } else if (kind == 1) {
        put(p, n, "dodecahedron", at_origin);
        put(q, m, "geodesic?level=2", (pir_vec3){0.2, 0, 0});
    } else if (kind == 2) {
        put(p, n, "icosahedron", (pir_vec3){3, 1, -2});
        put(q, m, "box?x=1&y=2&z=0.5", (pir_vec3){-20, 5, 7});
    } else if (kind == 3) {
        // an L and three walls
        put(p, n, "box?x=1.5&y=0.3&z=0.3", at_origin);
        put(p, n, "box?x=0.3&y=1&z=0.3", (pir_vec3){0.6, 0.5, 0});
        put(q, m, "box?x=1&y=0.2&z=3", (pir_vec3){-1.1, 0, 0});
        put(q, m, "box?x=1&y=0.2&z=3", (pir_vec3){1.1, 0, 0});
        put(q, m, "octahedron", (pir_vec3){0, 1.5, 0});
    } else {
        static const pir_vec3 sheet[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, rod[] = {{-1, 0, 0}, {1, 0.5, 0}};
        need(pir_polytope_create(sheet, 4, NULL, &p[(*n)++]));
        need(pir_polytope_create(rod, 2, NULL, &q[(*m)++]));
        put(q, m, "tetrahedron", (pir_vec3){2, 0, 0});
    }
}

void answer_world_init(answer_world *world, int kind, pir_grid *grid) {
    *world = (answer_world){.grid = grid};
    put_bodies(world, kind);
    need(pir_workspace_create(NULL, &world->workspace));
    for (uint32_t k = 0; k < world->robot_count; k++)
        for (uint32_t l = 0; l < world->obstacle_count; l++) {
            need(pir_pair_create(world->robot[k], world->obstacle[l], NULL, &world->pair[k][l]));
            double reach = pir_piece_ball_of(world->robot[k]).reach + pir_piece_ball_of(world->obstacle[l]).reach;
            world->size = fmax(world->size, reach);
        }
    const pir_answered_bodies bodies = {grid, world->robot, world->obstacle, world->robot_count, world->obstacle_count};
    need(pir_answers_init(&world->answers, &bodies, NULL));
}

void answer_world_finish(answer_world *world) {
    pir_answers_finish(&world->answers);
    for (uint32_t k = 0; k < world->robot_count; k++) {
        for (uint32_t l = 0; l < world->obstacle_count; l++)
            pir_pair_destroy(world->pair[k][l]);
        pir_polytope_release(world->robot[k]);
    }
    for (uint32_t l = 0; l < world->obstacle_count; l++)
        pir_polytope_release(world->obstacle[l]);
    pir_workspace_destroy(world->workspace);
    pir_grid_destroy(world->grid);
}

void answer_world_write(const answer_world *world, const char *path) {
    const pir_cspace_bodies bodies = {world->robot, world->robot_count, world->obstacle, world->obstacle_count};
    pir_cspace_options options = pir_cspace_options_default();
    options.slices_per_unit = 16;
    options.slices_per_key = 8;
    pir_cspace_job *job = NULL;
    need(pir_cspace_job_create(&bodies, world->grid, path, &options, NULL, &job));
    need(pir_cspace_job_run(job, NULL));
    need(pir_cspace_job_assemble(job, NULL));
    pir_cspace_job_destroy(job);
}

static pir_query_result ask_pair(answer_world *world, uint32_t k, uint32_t l, const pir_pose *pose) {
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    input.pose_p = *pose;
    need(pir_pair_signed_distance(world->pair[k][l], world->workspace, &input, &result));
    return result;
}

pir_pose answer_world_pose(answer_world *world, test_random *random) {
    pir_pose pose = {test_general_rotation(random), {0, 0, 0}};
    const uint32_t k = test_random_below(random, world->robot_count);
    const uint32_t l = test_random_below(random, world->obstacle_count);
    const pir_piece_ball p = pir_piece_ball_of(world->robot[k]), q = pir_piece_ball_of(world->obstacle[l]);
    // where the balls of two pieces meet
    pir_vec3 turned = test_turn(pose.rotation, p.centre, 1);
    pir_vec3 way = test_add(test_zero, test_random_direction(random),
                            (p.radius + q.radius) * cbrt(fabs(test_random_unit(random))));
    pose.translation = test_add(test_add(q.centre, turned, -1), way, 1);
    if (test_random_below(random, 2) == 0) {
        // towards the boundary, to a distance of up to a twentieth of the size
        pir_query_result result = ask_pair(world, k, l, &pose);
        double left = 0.05 * (p.radius + q.radius) * test_random_unit(random);
        pose.translation = test_add(pose.translation, result.normal, left - result.distance);
    }
    return pose;
}

pir_state answer_world_state(answer_world *world, const pir_pose *pose) {
    pir_state most = PIR_OUTSIDE;
    for (uint32_t k = 0; k < world->robot_count; k++)
        for (uint32_t l = 0; l < world->obstacle_count; l++) {
            pir_state state = ask_pair(world, k, l, pose).state;
            most = state > most ? state : most;
        }
    return most;
}

pir_state answer_world_sum_state(const answer_world *world, const pir_pose *pose) {
    const pir_sum_options options = {.size = sizeof options, .allocator = NULL, .difference = true};
    pir_state most = PIR_OUTSIDE;
    for (uint32_t k = 0; k < world->robot_count; k++)
        for (uint32_t l = 0; l < world->obstacle_count; l++) {
            pir_sum *sum;
            pir_query *query;
            pir_query_result result;
            pir_query_input input = pir_query_input_default();
            input.translation = pose->translation;
            need(pir_sum_create(world->robot[k], world->obstacle[l], pose->rotation, &options, &sum));
            need(pir_query_create(sum, &query));
            need(pir_query_overlap(query, &input, NULL, &result));
            most = result.state > most ? result.state : most;
            pir_query_destroy(query);
            pir_sum_destroy(sum);
        }
    return most;
}
