/* SPDX-License-Identifier: MIT */
/* Golden histories of sums, of queries on them, and of pairs. */
#include <math.h>
#include <stdlib.h>

#include <pirouette/live_mesh.h>
#include <pirouette/pair.h>

#include "golden/golden.h"
#include "support/bodies.h"
#include "support/meshes.h"
#include "support/sum_bytes.h"

#define FRAMES      12
#define PAIR_FRAMES 40
#define CONTACTS    32

/* A motion of its own for each history: jumps, small turns about a steady axis, forwards and backwards, trembling. */
struct motion {
    pir_quat step;
    double size;
    uint32_t way;
};

static struct motion motion_of(test_random *random) {
    double size = 1;
    for (uint32_t k = test_random_below(random, 12); k > 0; k--)
        size /= 2;
    pir_vec3 axis = test_random_direction(random);
    uint32_t way = test_random_below(random, 4);
    return (struct motion){{axis.x * size, axis.y * size, axis.z * size, 1}, size, way};
}

static pir_quat next_of(struct motion *motion, test_random *random, pir_quat from) {
    pir_vec3 axis = test_random_direction(random);
    double size = motion->size;
    uint32_t jump = test_random_below(random, 8);
    pir_quat other = test_rotation(random);
    if (motion->way == 0 && jump == 0)
        return other;
    if (motion->way == 1)
        motion->step = (pir_quat){axis.x * size, axis.y * size, axis.z * size, 1};
    if (motion->way == 2 && jump < 3)
        motion->step = (pir_quat){-motion->step.x, -motion->step.y, -motion->step.z, 1};
    // quaternions at the ends of the doubles have no product
    double square = from.x * from.x + from.y * from.y + from.z * from.z + from.w * from.w;
    return square > 0x1p-100 && square < 0x1p100 ? test_compose(motion->step, from, 1) : motion->step;
}

/* --- sums --- */

static uint64_t hash_of_mesh(uint64_t hash, pir_sum *sum, pir_precision precision) {
    pir_mesh *mesh;
    golden_require(pir_sum_mesh(sum, precision, &mesh), "pir_sum_mesh");
    hash = test_hash_mesh(hash, mesh);
    pir_mesh_destroy(mesh);
    return hash;
}

static uint64_t hash_of_live(uint64_t hash, pir_live_mesh *live) {
    golden_require(pir_live_mesh_refresh(live), "pir_live_mesh_refresh");
    uint32_t slots = pir_live_mesh_vertex_slots(live);
    pir_vec3 *vertices = calloc(slots + 1, sizeof *vertices);
    float(*single)[3] = calloc(slots + 1, sizeof *single);
    if (!vertices || !single)
        golden_require(PIR_ERR_MEMORY, "calloc");
    pir_live_mesh_vertices(live, vertices);
    pir_live_mesh_vertices_float(live, single);
    for (uint32_t v = 0; v < slots; v++) {
        uint32_t pair[2];
        if (!pir_live_mesh_vertex_pair(live, v, pair))
            continue;
        hash = golden_vector(golden_number(hash, v), vertices[v]);
        for (int k = 0; k < 3; k++)
            hash = golden_double(hash, single[v][k]);
    }
    free(single);
    free(vertices);
    return hash;
}

/* A change that some histories make half-way. */
static void change(pir_sum *sum, uint64_t number, test_random *random) {
    pir_vec3 axis = test_random_direction(random);
    if (number % 5 == 1)
        golden_require(pir_sum_set_region(sum, axis, 0.75), "pir_sum_set_region");
    if (number % 5 == 2)
        golden_require(pir_sum_set_tolerance(sum, 0.0625), "pir_sum_set_tolerance");
    if (number % 5 == 3)
        golden_require(pir_sum_set_scale(sum, PIR_OPERAND_P, 1.5), "pir_sum_set_scale");
}

uint64_t golden_sum(uint64_t number) {
    static const pir_method methods[4] = {PIR_METHOD_AUTO, PIR_METHOD_UPDATE, PIR_METHOD_UPDATE, PIR_METHOD_WALK};
    test_random random = golden_random(0, number);
    test_pose pose;
    test_random_pose(&random, number % 3 == 0 ? 60 : 20, &pose);
    pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
    pir_sum_options options = pir_sum_options_default();
    options.difference = number % 2 != 0;
    pir_sum *sum;
    pir_live_mesh *live;
    pir_quat r = pose.rotation;
    golden_require(pir_sum_create(p, q, r, &options, &sum), "pir_sum_create");
    golden_require(pir_live_mesh_create(sum, &live), "pir_live_mesh_create");
    uint64_t hash = golden_polytope(golden_polytope(TEST_HASH_START, p), q);
    struct motion motion = motion_of(&random);
    for (int frame = 0; frame < FRAMES; frame++) {
        if (frame == FRAMES / 2)
            change(sum, number, &random);
        r = next_of(&motion, &random, r);
        pir_method method = frame == 9 ? PIR_METHOD_CGM : methods[(number + (uint64_t)frame) % 4];
        golden_require(pir_sum_rotate(sum, r, method), "pir_sum_rotate");
        hash = hash_of_live(test_hash_pairing(hash, sum), live);
        hash = golden_double(hash, pir_sum_shortfall_bound(sum));
    }
    hash = hash_of_mesh(hash_of_mesh(hash, sum, PIR_DOUBLE), sum, PIR_EXACT);
    test_bytes bytes = test_bytes_of(sum);
    hash = golden_bytes(hash, bytes.data, bytes.data ? bytes.size : 0);
    free(bytes.data);
    pir_live_mesh_destroy(live);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return hash;
}

/* --- queries and pairs --- */

/* Bodies of a size near 1, so that translations below meet them. */
static pir_polytope *body_of(test_random *random) {
    static const test_body kinds[8] = {TEST_SPHERE, TEST_SPHERE,  TEST_GRID,    TEST_BOX,
                                       TEST_PRISM,  TEST_POLYGON, TEST_SEGMENT, TEST_OCTAHEDRON};
    test_body kind = kinds[test_random_below(random, 8)];
    return test_random_polytope(random, kind, 30);
}

/* A place on a grid, where bodies of integers touch, or anywhere near. */
static pir_vec3 place_of(test_random *random) {
    double x = test_random_unit(random), y = test_random_unit(random), z = test_random_unit(random);
    if (test_random_below(random, 3) == 0)
        return (pir_vec3){rint(4 * x) / 2, rint(4 * y) / 2, rint(4 * z) / 2};
    return (pir_vec3){3 * x, 3 * y, 3 * z};
}

uint64_t golden_query(uint64_t number) {
    test_random random = golden_random(1, number);
    pir_polytope *p = body_of(&random), *q = body_of(&random);
    pir_quat r = test_rotation(&random);
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    pir_sum *sum;
    pir_query *query;
    pir_query_cache cache = {0};
    golden_require(pir_sum_create(p, q, r, &options, &sum), "pir_sum_create");
    golden_require(pir_query_create(sum, &query), "pir_query_create");
    uint64_t hash = TEST_HASH_START;
    struct motion motion = motion_of(&random);
    for (int frame = 0; frame < FRAMES; frame++) {
        pir_query_input input = pir_query_input_default();
        pir_query_result answer = {0}, along = {0};
        pir_impact cast = {0};
        pir_contact contacts[CONTACTS];
        pir_vec3 at[4];
        double depths[4], distances[4];
        size_t count = 0;
        r = next_of(&motion, &random, r);
        golden_require(pir_sum_rotate(sum, r, PIR_METHOD_AUTO), "pir_sum_rotate");
        for (int k = 0; k < 4; k++)
            at[k] = place_of(&random);
        input.translation = at[0];
        input.margin = 0.125;
        input.cutoff = HUGE_VAL;
        golden_require(pir_query_signed_distance(query, &input, &cache, &answer), "pir_query_signed_distance");
        hash = golden_answer(hash, &answer);
        pir_query_manifold(query, &input, &answer, CONTACTS, contacts, &count);
        hash = golden_contacts(hash, contacts, count < CONTACTS ? count : CONTACTS);
        pir_vec3 direction = test_random_direction(&random);
        golden_require(pir_query_directional_depth(query, &input, direction, &along), "pir_query_directional_depth");
        hash = golden_double(golden_number(hash, along.outcome), along.distance);
        golden_require(pir_query_cast(query, &input, at[1], &cast), "pir_query_cast");
        hash = golden_vector(golden_double(golden_number(hash, cast.outcome), cast.time), cast.normal);
        golden_require(pir_query_batch_depths(query, at, 4, depths, NULL), "pir_query_batch_depths");
        golden_require(pir_query_batch_distances(query, at, 4, distances, NULL), "pir_query_batch_distances");
        for (int k = 0; k < 4; k++)
            hash = golden_double(golden_double(hash, depths[k]), distances[k]);
    }
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return hash;
}

uint64_t golden_pair(uint64_t number) {
    test_random random = golden_random(2, number);
    pir_polytope *p = body_of(&random), *q = body_of(&random);
    pir_pair *pair;
    pir_workspace *workspace;
    golden_require(pir_workspace_create(NULL, &workspace), "pir_workspace_create");
    golden_require(pir_pair_create(p, q, NULL, &pair), "pir_pair_create");
    uint64_t hash = TEST_HASH_START;
    struct motion motion = motion_of(&random);
    pir_pair_input input = pir_pair_input_default();
    input.cutoff = number % 3 == 0 ? 0.5 : HUGE_VAL;
    input.margin = 0.125;
    input.radius_p = number % 4 == 0 ? 0.25 : 0;
    input.pose_p.rotation = test_rotation(&random);
    if (number % 2)
        input.pose_q.rotation = test_integer_rotation(&random);
    for (int frame = 0; frame < PAIR_FRAMES; frame++) {
        pir_query_result answer = {0};
        pir_contact contacts[CONTACTS];
        size_t count = 0;
        pir_vec3 way = place_of(&random);
        pir_vec3 *at = &input.pose_p.translation;
        // small ways now and then, which what is kept survives
        double part = frame % 4 == 0 ? 1 : motion.size / 8;
        *at = frame % 4 == 0 ? way : (pir_vec3){at->x + part * way.x, at->y + part * way.y, at->z + part * way.z};
        input.pose_p.rotation = next_of(&motion, &random, input.pose_p.rotation);
        pir_status status = pir_pair_signed_distance(pair, workspace, &input, &answer);
        hash = golden_number(hash, (uint64_t)status);
        if (status != PIR_OK)
            continue;
        hash = golden_answer(hash, &answer);
        hash = golden_number(hash,
                             (uint64_t)pir_pair_manifold(pair, workspace, &input, &answer, CONTACTS, contacts, &count));
        hash = golden_contacts(hash, contacts, count < CONTACTS ? count : CONTACTS);
    }
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return hash;
}
