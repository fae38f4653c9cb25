/* SPDX-License-Identifier: MIT */
/*
 * Batches of solids and of meshes: each answer is that of a single call on an object of its own, bit for bit, on any
 * number of threads, in runs of any length; bad poses are told and leave the others alone; memory that fails.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "mesh/mesh_models.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/random.h"

enum { COUNT = 150 };

/* All that a batch tells of either kind of body; `first` and `second` are pieces or triangles. */
struct answers {
    uint8_t state[COUNT], status[COUNT];
    double distance[COUNT], normal[COUNT][3], point_p[COUNT][3], point_q[COUNT][3];
    uint32_t first[COUNT], second[COUNT];
};

static pir_solid_query_batch_arrays solid_arrays(struct answers *a) {
    return (pir_solid_query_batch_arrays){a->state,   a->status,  a->distance, a->normal,
                                          a->point_p, a->point_q, a->first,    a->second};
}

static pir_trimesh_pair_batch_arrays mesh_arrays_to(struct answers *a) {
    return (pir_trimesh_pair_batch_arrays){a->state,  a->status,  a->distance, a->first,
                                           a->second, a->point_p, a->point_q};
}

/* The convex pieces of an L. */
static pir_pieces *make_pieces(void) {
    static const pir_vec3 at[12] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0},
                                    {0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {1, 1, 1}, {1, 2, 1}, {0, 2, 1}};
    static const uint32_t corners[] = {5, 4, 3, 2, 1, 0, 6, 7, 8,  9, 10, 11, 0,  1,  7, 6, 1, 2,
                                       8, 7, 2, 3, 9, 8, 3, 4, 10, 9, 4,  5,  11, 10, 5, 0, 6, 11};
    static const uint32_t starts[] = {0, 6, 12, 16, 20, 24, 28, 32, 36};
    const pir_solid_facets facets = {at, 12, starts, corners, 8};
    pir_solid *solid = NULL;
    pir_pieces *pieces = NULL;
    assert_int_equal(pir_solid_create(&facets, NULL, NULL, &solid), PIR_OK);
    assert_int_equal(pir_solid_decompose(solid, NULL, NULL, &pieces), PIR_OK);
    pir_solid_release(solid);
    return pieces;
}

/* Poses about contact; three are bad where `bad` says so. */
static void make_poses(uint64_t number, double size, bool bad, pir_pose poses[COUNT]) {
    test_random random = test_random_case("body batch", number);
    for (int i = 0; i < COUNT; i++) {
        poses[i].rotation = test_general_rotation(&random);
        poses[i].translation = (pir_vec3){test_random_unit(&random) * size, test_random_unit(&random) * size,
                                          test_random_unit(&random) * size};
    }
    if (!bad)
        return;
    poses[7].translation.y = NAN;
    poses[70].rotation = (pir_quat){0, 0, 0, 0};
    poses[149].rotation.w = INFINITY;
}

static pir_pose_array array_of(const pir_pose *poses) {
    return (pir_pose_array){&poses->rotation.x, sizeof *poses, &poses->translation.x, sizeof *poses, false};
}

static bool same_vector(const double told[3], pir_vec3 v) {
    return told[0] == v.x && told[1] == v.y && told[2] == v.z;
}

static void expect_bad(const struct answers *a, int i, pir_status status) {
    expect(a->status[i] == status && a->state[i] == PIR_POSE_BAD && isnan(a->distance[i]) && isnan(a->point_p[i][0]) &&
               a->first[i] == 0 && a->second[i] == 0,
           "pose %d", i);
}

static void expect_summary(const pir_pair_batch_summary *summary) {
    assert_int_equal(summary->bad, 3);
    assert_int_equal(summary->first_bad, 7);
    assert_int_equal(summary->first_status, PIR_ERR_NOT_FINITE);
}

/* --- solids --- */

static pir_status one_solid(int call, const pir_pieces *pieces, const pir_pair_input *input, struct answers *a, int i) {
    pir_solid_query *query;
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_solid_query_create(pieces, pieces, NULL, &query), PIR_OK);
    pir_state state = PIR_OUTSIDE;
    pir_solid_distance distance = {0};
    pir_solid_depth depth = {0};
    const pir_status status = call == 0   ? pir_solid_query_overlap(query, workspace, input, &state)
                              : call == 1 ? pir_solid_query_distance(query, workspace, input, &distance)
                                          : pir_solid_query_depth(query, workspace, input, &depth);
    if (status != PIR_OK) {
        expect_bad(a, i, status);
    } else if (call == 0) {
        expect(a->state[i] == state && a->distance[i] == 0, "pose %d", i);
    } else if (call == 1) {
        const pir_query_result *is = &distance.result;
        expect(a->state[i] == is->state && a->distance[i] == is->distance && same_vector(a->normal[i], is->normal) &&
                   same_vector(a->point_p[i], is->point_p) && same_vector(a->point_q[i], is->point_q) &&
                   a->first[i] == distance.piece_p && a->second[i] == distance.piece_q,
               "pose %d", i);
    } else {
        expect(a->state[i] == depth.state && a->distance[i] == depth.depth && same_vector(a->normal[i], depth.normal) &&
                   same_vector(a->point_p[i], depth.point_p) && same_vector(a->point_q[i], depth.point_q) &&
                   a->first[i] == depth.facet[0].piece_p && a->second[i] == depth.facet[0].piece_q,
               "pose %d", i);
    }
    pir_solid_query_destroy(query);
    pir_workspace_destroy(workspace);
    return status;
}

typedef pir_status ask_solids(pir_solid_query_batch *, const pir_pair_batch_input *, size_t,
                              const pir_solid_query_batch_arrays *, pir_pair_batch_summary *);

static ask_solids *const solid_calls[3] = {pir_solid_query_batch_overlap, pir_solid_query_batch_distance,
                                           pir_solid_query_batch_depth};

static void solids_are_single_answers(void **state) {
    (void)state;
    static struct answers a;
    static pir_pose at_p[COUNT], at_q[COUNT];
    pir_pieces *pieces = make_pieces();
    for (uint32_t threads = 1; threads <= 3; threads++)
        for (int call = 0; call < 3; call++) {
            make_poses(threads, 1.5, true, at_p);
            make_poses(100 + threads, 0.5, false, at_q);
            pir_pair_batch_options options = pir_pair_batch_options_default();
            pir_pair_batch_input input = pir_pair_batch_input_default();
            pir_pair_batch_summary summary;
            pir_solid_query_batch *batch = NULL;
            options.threads = threads;
            options.run = threads == 2 ? 1 : 7 * (threads - 1);
            input.poses_p = array_of(at_p);
            input.poses_q = array_of(at_q);
            memset(&a, 0, sizeof a);
            const pir_solid_query_batch_arrays arrays = solid_arrays(&a);
            assert_int_equal(pir_solid_query_batch_create(pieces, pieces, &options, &batch), PIR_OK);
            assert_int_equal(solid_calls[call](batch, &input, COUNT, &arrays, &summary), PIR_OK);
            expect_summary(&summary);
            uint32_t states[3] = {0, 0, 0};
            for (int i = 0; i < COUNT; i++) {
                pir_pair_input one = pir_pair_input_default();
                one.pose_p = at_p[i];
                one.pose_q = at_q[i];
                if (one_solid(call, pieces, &one, &a, i) == PIR_OK)
                    states[a.state[i]]++;
            }
            assert_true(states[PIR_OUTSIDE] > 5 && states[PIR_INSIDE] > 5);
            pir_solid_query_batch_destroy(batch);
        }
    pir_pieces_destroy(pieces);
}

/* --- meshes --- */

static void meshes_are_single_answers(void **state) {
    (void)state;
    static struct answers a;
    static pir_pose at_p[COUNT], at_q[COUNT];
    mesh_arrays arrays = mesh_bumpy_sphere(1, 0.1);
    pir_trimesh *mesh = mesh_of(&arrays, NULL);
    for (uint32_t threads = 1; threads <= 3; threads++)
        for (int call = 0; call < 2; call++) {
            make_poses(200 + threads, 2, true, at_p);
            make_poses(300 + threads, 0.5, false, at_q);
            pir_pair_batch_options options = pir_pair_batch_options_default();
            pir_pair_batch_summary summary;
            pir_trimesh_pair_batch *batch = NULL;
            options.threads = threads;
            options.run = threads == 2 ? 1 : 7 * (threads - 1);
            const pir_trimesh_pair_batch_input input = {array_of(at_p), array_of(at_q)};
            const pir_trimesh_pair_batch_arrays to = mesh_arrays_to(&a);
            assert_int_equal(pir_trimesh_pair_batch_create(mesh, mesh, &options, &batch), PIR_OK);
            assert_int_equal((call ? pir_trimesh_pair_batch_farthest
                                   : pir_trimesh_pair_batch_nearest)(batch, &input, COUNT, &to, &summary),
                             PIR_OK);
            expect_summary(&summary);
            for (int i = 0; i < COUNT; i++) {
                pir_trimesh_pair *pair;
                pir_trimesh_distance is;
                assert_int_equal(pir_trimesh_pair_create(mesh, mesh, NULL, &pair), PIR_OK);
                const pir_status status =
                    (call ? pir_trimesh_pair_farthest : pir_trimesh_pair_nearest)(pair, at_p[i], at_q[i], &is);
                if (status != PIR_OK)
                    expect_bad(&a, i, status);
                else
                    expect(a.status[i] == PIR_OK && a.state[i] == is.state && a.distance[i] == is.distance &&
                               a.first[i] == is.triangle_p && a.second[i] == is.triangle_q &&
                               same_vector(a.point_p[i], is.point_p) && same_vector(a.point_q[i], is.point_q),
                           "pose %d", i);
                pir_trimesh_pair_destroy(pair);
            }
            pir_trimesh_pair_batch_destroy(batch);
        }
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&arrays);
}

/* --- refusals and memory --- */

static void what_is_no_batch_is_refused(void **state) {
    (void)state;
    static struct answers a;
    pir_pieces *pieces = make_pieces();
    mesh_arrays arrays = mesh_bumpy_sphere(0, 0);
    pir_trimesh *mesh = mesh_of(&arrays, NULL);
    pir_solid_query_batch *solids = NULL;
    pir_trimesh_pair_batch *meshes = NULL;
    pir_pair_batch_options options = pir_pair_batch_options_default();
    options.threads = 65;
    assert_int_equal(pir_solid_query_batch_create(pieces, pieces, &options, &solids), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_trimesh_pair_batch_create(mesh, mesh, &options, &meshes), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_query_batch_create(NULL, pieces, NULL, &solids), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_trimesh_pair_batch_create(mesh, NULL, NULL, &meshes), PIR_ERR_ARGUMENT);
    assert_true(!solids && !meshes);
    assert_int_equal(pir_solid_query_batch_create(pieces, pieces, NULL, &solids), PIR_OK);
    assert_int_equal(pir_trimesh_pair_batch_create(mesh, mesh, NULL, &meshes), PIR_OK);
    pir_pair_batch_input input = pir_pair_batch_input_default();
    pir_trimesh_pair_batch_input poses = {{0}, {0}};
    const pir_solid_query_batch_arrays to = solid_arrays(&a);
    const pir_trimesh_pair_batch_arrays mesh_to = mesh_arrays_to(&a);
    memset(&a, 7, sizeof a);
    input.radius_p = -1;
    assert_int_equal(pir_solid_query_batch_distance(solids, &input, COUNT, &to, NULL), PIR_ERR_ARGUMENT);
    input.radius_p = 0, input.cutoff = NAN;
    assert_int_equal(pir_solid_query_batch_distance(solids, &input, COUNT, &to, NULL), PIR_ERR_NOT_FINITE);
    poses.poses_q.translation_stride = 20;
    assert_int_equal(pir_trimesh_pair_batch_nearest(meshes, &poses, COUNT, &mesh_to, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_trimesh_pair_batch_nearest(meshes, NULL, COUNT, &mesh_to, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_query_batch_depth(NULL, &input, COUNT, &to, NULL), PIR_ERR_ARGUMENT);
    assert_true(a.state[0] == 7 && a.status[COUNT - 1] == 7);
    pir_solid_query_batch_destroy(solids);
    pir_solid_query_batch_destroy(NULL);
    pir_trimesh_pair_batch_destroy(meshes);
    pir_trimesh_pair_batch_destroy(NULL);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&arrays);
    pir_pieces_destroy(pieces);
}

static void memory_that_fails_leaves_nothing(void **state) {
    (void)state;
    static struct answers a;
    static pir_pose at[COUNT];
    pir_pieces *pieces = make_pieces();
    mesh_arrays arrays = mesh_bumpy_sphere(0, 0);
    pir_trimesh *mesh = mesh_of(&arrays, NULL);
    make_poses(400, 1.5, false, at);
    uint32_t failures = 0;
    for (uint64_t n = 1; n < 400; n++) {
        test_memory memory = {.fail_at = n};
        const pir_allocator allocator = test_allocator(&memory);
        pir_pair_batch_options options = pir_pair_batch_options_default();
        pir_pair_batch_input input = pir_pair_batch_input_default();
        pir_solid_query_batch *solids = NULL;
        pir_trimesh_pair_batch *meshes = NULL;
        options.allocator = &allocator;
        options.threads = 2;
        input.poses_p = array_of(at);
        const pir_trimesh_pair_batch_input poses = {array_of(at), {0}};
        const pir_solid_query_batch_arrays to = solid_arrays(&a);
        const pir_trimesh_pair_batch_arrays mesh_to = mesh_arrays_to(&a);
        pir_status status = pir_solid_query_batch_create(pieces, pieces, &options, &solids);
        if (status == PIR_OK)
            assert_int_equal(pir_solid_query_batch_depth(solids, &input, 20, &to, NULL), PIR_OK);
        pir_solid_query_batch_destroy(solids);
        if (status == PIR_OK)
            status = pir_trimesh_pair_batch_create(mesh, mesh, &options, &meshes);
        if (status == PIR_OK)
            assert_int_equal(pir_trimesh_pair_batch_nearest(meshes, &poses, 20, &mesh_to, NULL), PIR_OK);
        pir_trimesh_pair_batch_destroy(meshes);
        assert_true(status == PIR_OK || status == PIR_ERR_MEMORY);
        expect(memory.blocks == 0 && !memory.wrong_size, "request %u: %zu blocks", (unsigned)n, memory.blocks);
        failures += status != PIR_OK;
    }
    assert_true(failures > 10);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&arrays);
    pir_pieces_destroy(pieces);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solids_are_single_answers),
        cmocka_unit_test(meshes_are_single_answers),
        cmocka_unit_test(what_is_no_batch_is_refused),
        cmocka_unit_test(memory_that_fails_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
