/* SPDX-License-Identifier: MIT */
/*
 * Memory that runs out at every n-th request, for n = 1, 2, … until nothing fails, in the calls that no other test of
 * their part makes so: each says so, leaves its results untouched and its objects fit for the same call with memory,
 * and nothing leaks. Once one request fails, once all that follow do as well.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/pirouette.h>
#include <pirouette/scene_file.h>
#include <pirouette/scene_query.h>
#include <pirouette/simplify.h>
#include <pirouette/solid_query.h>

#include "support/bodies.h"
#include "support/memory.h"
#include "support/queries.h"
#include "support/solid_sums.h"

static const char l_shape[] =
    "OFF\n12 8 0\n0 0 0\n3 0 0\n3 1 0\n1 1 0\n1 3 0\n0 3 0\n0 0 1\n3 0 1\n3 1 1\n1 1 1\n1 3 1\n"
    "0 3 1\n6 5 4 3 2 1 0\n6 6 7 8 9 10 11\n4 0 1 7 6\n4 1 2 8 7\n4 2 3 9 8\n4 3 4 10 9\n"
    "4 4 5 11 10\n4 5 0 6 11\n";

/* One run of a course: its memory, and how far it has come. */
struct run {
    test_memory memory;
    pir_allocator allocator;
    pir_solid_options solid;
};

/* Makes what it takes with the run's allocator, asks, and gives all back; the status of the first call that failed. */
typedef pir_status course(struct run *run);

static pir_file_bytes file_of(const char *text) {
    return (pir_file_bytes){text, strlen(text), "text", "off"};
}

/* --- solids --- */

static pir_status ask_solids(pir_solid_query *query, pir_workspace *workspace) {
    const pir_motion motion = {{-8, -1, 0}, {0, 0, 1}, 1e-3};
    pir_pair_input input = pir_pair_input_default();
    pir_state state;
    pir_solid_depth depth;
    pir_solid_distance apart;
    pir_impact impact;
    input.pose_p.translation = (pir_vec3){1, 1, 0.5};
    pir_status status = pir_solid_query_overlap(query, workspace, &input, &state);
    if (status == PIR_OK)
        status = pir_solid_query_depth(query, workspace, &input, &depth);
    if (status == PIR_OK)
        status = pir_solid_query_directional_depth(query, workspace, &input, (pir_vec3){1, 0, 0}, &depth);
    if (status == PIR_OK) {
        assert_int_equal(state, PIR_INSIDE);
        input.pose_p = (pir_pose){{0, 0, 1, 2}, {6, 1, 0.5}};
        status = pir_solid_query_distance(query, workspace, &input, &apart);
    }
    if (status == PIR_OK)
        status = pir_solid_query_cast(query, workspace, &input, &motion, 1e-3, &impact);
    return status;
}

static pir_status solids(struct run *run) {
    const pir_file_bytes file = file_of(l_shape);
    pir_solid *solid = NULL;
    pir_pieces *pieces = NULL, *fewer = NULL;
    pir_polytope *piece = NULL;
    pir_solid_query *query = NULL;
    pir_workspace *workspace = NULL;
    pir_decompose_options decompose = pir_decompose_options_default();
    decompose.allocator = &run->allocator;
    pir_status status = pir_solid_read_bytes(&file, &run->solid, NULL, &solid);
    if (status == PIR_OK)
        status = pir_solid_decompose(solid, &decompose, NULL, &pieces);
    decompose.tolerance = 10;
    if (status == PIR_OK)
        status = pir_solid_decompose(solid, &decompose, NULL, &fewer);
    if (status == PIR_OK)
        status = pir_pieces_polytope(fewer, 0, &piece);
    if (status == PIR_OK)
        status = pir_workspace_create(&run->allocator, &workspace);
    if (status == PIR_OK)
        status = pir_solid_query_create(pieces, fewer, &run->allocator, &query);
    if (status == PIR_OK) {
        status = ask_solids(query, workspace);
        if (status != PIR_OK) {
            run->memory.fail_at = 0;
            assert_int_equal(ask_solids(query, workspace), PIR_OK);
        }
    }
    pir_solid_query_destroy(query);
    pir_workspace_destroy(workspace);
    pir_polytope_release(piece);
    pir_pieces_destroy(fewer);
    pir_pieces_destroy(pieces);
    pir_solid_release(solid);
    return status;
}

static pir_status open_solids(struct run *run) {
    const pir_file_bytes file = file_of(l_shape);
    pir_polytope *cube = NULL;
    pir_solid *p = NULL, *q = NULL;
    pir_mesh *mesh = NULL;
    pir_solid_sum_options options = pir_solid_sum_options_default();
    options.allocator = &run->allocator;
    options.open = options.difference = true;
    pir_status status = pir_solid_read_bytes(&file, &run->solid, NULL, &p);
    if (status == PIR_OK)
        status = pir_shape_create("box?x=2&y=2&z=2", &run->allocator, NULL, &cube);
    if (status == PIR_OK)
        status = pir_solid_from_polytope(cube, &run->solid, &q);
    if (status == PIR_OK)
        status = solid_sum_mesh(p, q, (pir_quat){0, 0, 0, 1}, &options, NULL, &mesh);
    pir_mesh_destroy(mesh);
    pir_solid_release(q);
    pir_solid_release(p);
    pir_polytope_release(cube);
    return status;
}

/* --- scenes --- */

struct stage {
    pir_polytope *round, *box;
    pir_coarse *coarse;
    pir_scene *scene;
};

static pir_status set_stage(struct run *run, struct stage *stage) {
    pir_scene_options options = pir_scene_options_default();
    options.allocator = &run->allocator;
    pir_status status = pir_shape_create("gs2", &run->allocator, NULL, &stage->round);
    if (status == PIR_OK)
        status = pir_shape_create("box?x=2&y=2&z=2", &run->allocator, NULL, &stage->box);
    if (status == PIR_OK)
        status = pir_coarse_create(stage->round, &stage->coarse);
    if (status == PIR_OK)
        status = pir_scene_create(&options, &stage->scene);
    for (uint32_t i = 0; i < 3 && status == PIR_OK; i++) {
        pir_body_options body = pir_body_options_default();
        uint32_t id;
        body.pieces = i == 1 ? &stage->box : &stage->round;
        body.coarse = i == 1 ? NULL : &stage->coarse;
        body.piece_count = 1;
        body.pose.translation = (pir_vec3){4.0 * i, 0.5 * i, 0};
        status = pir_scene_add(stage->scene, &body, &id);
    }
    return status;
}

static pir_status ask_stage(struct stage *stage) {
    const pir_motion motion = {{9, 0, 0}, {0, 0, 1}, 0};
    const double cutoffs[2] = {HUGE_VAL, 3};
    pir_scene_shape shape = pir_scene_shape_default(stage->round);
    pir_scene_distance told[3];
    pir_scene_near near[2];
    pir_scene_hit hits[3];
    pir_impact impact;
    size_t count = 0;
    pir_status status = PIR_OK;
    shape.coarse = stage->coarse;
    shape.pose.translation = (pir_vec3){-2, 0.25, 0};
    for (int k = 0; k < 2 && status == PIR_OK; k++)
        status = pir_scene_distances(stage->scene, &shape, cutoffs[k], (pir_accuracy){0, k ? 0.2 : 0}, 3, told, &count);
    if (status == PIR_OK)
        status = pir_scene_overlap(stage->scene, &shape, 3, hits, &count);
    if (status == PIR_OK)
        status = pir_scene_closest_pairs(stage->scene, HUGE_VAL, 2, near, &count);
    if (status == PIR_OK)
        status = pir_scene_cast(stage->scene, &shape, &motion, 1e-3, &impact);
    if (status == PIR_OK)
        status = pir_scene_time_of_impact(stage->scene, 0, &motion, 1e-3, &impact);
    return status;
}

static pir_status scenes(struct run *run) {
    struct stage stage = {0};
    pir_status status = set_stage(run, &stage);
    if (status == PIR_OK) {
        status = ask_stage(&stage);
        assert_true(pir_scene_is_valid(stage.scene));
        if (status != PIR_OK) {
            run->memory.fail_at = 0;
            assert_int_equal(ask_stage(&stage), PIR_OK);
        }
    }
    pir_scene_destroy(stage.scene);
    pir_coarse_release(stage.coarse);
    pir_polytope_release(stage.box);
    pir_polytope_release(stage.round);
    return status;
}

/* --- queries on a sum --- */

static pir_status ask_sum(pir_query *query) {
    pir_query_input input = pir_query_input_default();
    const pir_vec3 places[2] = {{0.25, 0.125, 0}, {9, 1, 0}};
    pir_status status = PIR_OK;
    for (int i = 0; i < 2; i++) {
        input.translation = places[i];
        const test_question question = {query, &input, NULL, {i ? -1 : 1, 0.1, 0.2}};
        test_answer answer;
        for (const test_query_kind *kind = test_query_kinds; status == PIR_OK && kind->name; kind++)
            status = kind->ask(&question, &answer);
    }
    return status;
}

static pir_status queries(struct run *run) {
    pir_polytope *p = NULL, *q = NULL;
    pir_sum *sum = NULL;
    pir_query *query = NULL;
    pir_sum_options options = pir_sum_options_default();
    options.allocator = &run->allocator;
    options.difference = true;
    pir_status status = pir_shape_create("dodecahedron", &run->allocator, NULL, &p);
    if (status == PIR_OK)
        status = pir_shape_create("cube", &run->allocator, NULL, &q);
    if (status == PIR_OK)
        status = pir_sum_create(p, q, (pir_quat){1, 2, 3, 4}, &options, &sum);
    if (status == PIR_OK)
        status = pir_query_create(sum, &query);
    if (status == PIR_OK) {
        status = ask_sum(query);
        if (status != PIR_OK) {
            run->memory.fail_at = 0;
            assert_int_equal(ask_sum(query), PIR_OK);
        }
    }
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return status;
}

/* --- all --- */

static void try_course(course *take, const char *name) {
    uint64_t requests = 0;
    for (int after = 0; after < 2; after++) {
        bool done = false;
        for (uint64_t n = 1; !done; n++) {
            struct run run = {.memory = {.fail_at = n, .fail_after = after}};
            run.allocator = test_allocator(&run.memory);
            run.solid = pir_solid_options_default();
            run.solid.allocator = &run.allocator;
            const pir_status status = take(&run);
            done = status == PIR_OK && run.memory.requests < n;
            expect(status == PIR_OK || status == PIR_ERR_MEMORY, "%s, request %llu: status %d", name,
                   (unsigned long long)n, (int)status);
            expect(run.memory.blocks == 0 && !run.memory.wrong_size && !run.memory.overrun,
                   "%s, request %llu: %zu blocks left", name, (unsigned long long)n, run.memory.blocks);
            requests = n;
        }
    }
    printf("# %s: %llu requests\n", name, (unsigned long long)requests);
    assert_true(requests > 20);
}

static void solids_survive(void **state) {
    (void)state;
    try_course(solids, "solids");
    try_course(open_solids, "open solids");
}

static void scenes_survive(void **state) {
    (void)state;
    try_course(scenes, "scenes");
}

static void queries_survive(void **state) {
    (void)state;
    try_course(queries, "queries");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(solids_survive), cmocka_unit_test(scenes_survive),
                                       cmocka_unit_test(queries_survive)};
    return cmocka_run_group_tests_name("faults", tests, NULL, NULL);
}
