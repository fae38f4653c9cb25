/* SPDX-License-Identifier: MIT */
/*
 * The same inputs give the same bits on every machine, with every compiler and instruction set, over thousands of
 * frames: hashes, against kept ones, of pairings, meshes, live meshes, serialised sums and answers of queries.
 * test_golden.c tells of single sums.
 *
 * The hashes of sums may change only when what a sum looks like is meant to change; those of answers also when the last
 * bits of a number are meant to, and that within a tolerance when a pairing is meant to stay behind for longer or
 * shorter. Inputs are made with +, −, ·, / and sqrt alone, and are the same whatever PIR_TEST_SEED says.
 */
#include "support/test.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/live_mesh.h>
#include <pirouette/query.h>

#include "support/bodies.h"
#include "support/meshes.h"

#define FRAMES 1000

/* Meshes are hashed in every so manieth frame. */
#define MESH_EVERY 25

static test_random fixed_random(uint64_t number) {
    return (test_random){{number, 0x9e3779b97f4a7c15u, 0xd1342543de82ef95u, 2}};
}

/* Tells of a hash that is not the kept one; returns 1 for it, so that one run tells of all. */
static int differs(const char *what, uint64_t hash, uint64_t kept) {
    if (hash != kept)
        print_error("%s: 0x%016" PRIx64 "u instead of 0x%016" PRIx64 "u\n", what, hash, kept);
    return hash != kept;
}

/* FNV-1a over the bits of doubles and of whole numbers, whatever the machine's order of bytes. */
static uint64_t hash_number(uint64_t hash, uint64_t bits) {
    for (int k = 0; k < 8; k++)
        hash = (hash ^ (bits >> (8 * k) & 0xff)) * 0x100000001b3u;
    return hash;
}

static uint64_t hash_double(uint64_t hash, double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return hash_number(hash, bits);
}

static uint64_t hash_vector(uint64_t hash, pir_vec3 v) {
    return hash_double(hash_double(hash_double(hash, v.x), v.y), v.z);
}

/* --- motions --- */

enum motion {
    STEADY = 0, /* equal steps about one axis, a new one every 100 frames */
    TO_AND_FRO, /* about one axis, forwards and backwards */
    TREMBLING,  /* about a new axis in every frame, by steps of all sizes */
    ALIGNED,    /* quarter and third turns, and small steps about axes of symmetry in between */
};

static pir_quat next_rotation(enum motion motion, test_random *random, int frame, pir_quat *step, pir_quat from) {
    pir_vec3 axis = test_random_direction(random);
    double size = 0.01;
    switch (motion) {
    case STEADY:
        if (frame % 100 == 0)
            *step = (pir_quat){axis.x * size, axis.y * size, axis.z * size, 1};
        break;
    case TO_AND_FRO:
        if (frame % 200 == 0)
            *step = (pir_quat){axis.x * size, axis.y * size, axis.z * size, 1};
        else if (frame % 9 == 0)
            *step = (pir_quat){-step->x, -step->y, -step->z, 1};
        break;
    case TREMBLING:
        size = test_random_scaled(random, -30, 0);
        *step = (pir_quat){axis.x * size, axis.y * size, axis.z * size, 1};
        break;
    default:
        *step = frame % 7 == 0   ? test_integer_rotation(random)
                : frame % 2 == 0 ? (pir_quat){0, 0, 0x1p-8, 1}
                                 : (pir_quat){0x1p-10, 0x1p-10, 0x1p-10, 1};
        return test_compose(*step, frame % 49 == 0 ? (pir_quat){0, 0, 0, 1} : from, 1);
    }
    return test_compose(*step, from, 1);
}

/* --- sums --- */

static uint64_t hash_mesh(uint64_t hash, pir_sum *sum) {
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_sum_mesh(sum, PIR_DOUBLE, &mesh), PIR_OK);
    hash = test_hash_mesh(hash, mesh);
    pir_mesh_destroy(mesh);
    return hash;
}

/* Slots may stand in any order: what they hold is hashed one by one, and added up. */
static uint64_t hash_live(uint64_t hash, pir_live_mesh *live) {
    uint32_t vertices = pir_live_mesh_vertex_slots(live), facets = pir_live_mesh_facet_slots(live);
    pir_vec3 *vertex = malloc((vertices + 1) * sizeof *vertex);
    float(*rounded)[3] = malloc((vertices + 1) * sizeof *rounded);
    pir_plane_equation *plane = malloc((facets + 1) * sizeof *plane);
    assert_true(vertex && rounded && plane);
    pir_live_mesh_vertices(live, vertex);
    pir_live_mesh_vertices_float(live, rounded);
    pir_live_mesh_planes(live, plane);
    uint64_t total = 0;
    for (uint32_t v = 0; v < vertices; v++) {
        uint32_t pair[2];
        if (!pir_live_mesh_vertex_pair(live, v, pair))
            continue;
        uint64_t one = hash_vector(hash_number(hash_number(hash, pair[0]), pair[1]), vertex[v]);
        total += hash_vector(one, (pir_vec3){(double)rounded[v][0], (double)rounded[v][1], (double)rounded[v][2]});
    }
    for (uint32_t f = 0; f < facets; f++) {
        pir_sum_pair pair;
        if (!pir_live_mesh_pair(live, f, &pair))
            continue;
        uint64_t one = hash_number(hash_number(hash_number(hash, (uint64_t)pair.kind), pair.p), pair.q);
        total += hash_double(hash_vector(one, plane[f].normal), plane[f].offset);
    }
    free(plane);
    free(rounded);
    free(vertex);
    return hash_number(hash, total);
}

static uint64_t hash_bytes(uint64_t hash, const pir_sum *sum) {
    size_t size = pir_sum_serialised_size(sum);
    uint8_t *bytes = malloc(size);
    assert_non_null(bytes);
    assert_int_equal(pir_sum_serialise(sum, bytes, size), PIR_OK);
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * 0x100000001b3u;
    free(bytes);
    return hash;
}

struct track {
    const char *name;
    test_body p, q;
    size_t most;
    enum motion motion;
    int difference;
    double tolerance;
    uint64_t kept;
};

static uint64_t hash_track(const struct track *track, uint64_t number) {
    test_random random = fixed_random(number);
    pir_polytope *p = test_random_polytope(&random, track->p, track->most);
    pir_polytope *q = test_random_polytope(&random, track->q, track->most);
    pir_sum_options options = {.size = sizeof options, .allocator = NULL, .difference = track->difference};
    pir_quat rotation = test_general_rotation(&random), step = {0, 0, 0, 1};
    pir_sum *sum = NULL;
    pir_live_mesh *live = NULL;
    assert_int_equal(pir_sum_create(p, q, rotation, &options, &sum), PIR_OK);
    assert_int_equal(pir_sum_set_tolerance(sum, track->tolerance), PIR_OK);
    assert_int_equal(pir_live_mesh_create(sum, &live), PIR_OK);
    uint64_t hash = TEST_HASH_START;
    for (int frame = 0; frame < FRAMES; frame++) {
        rotation = next_rotation(track->motion, &random, frame, &step, rotation);
        pir_method method = frame % 100 == 99 ? PIR_METHOD_CGM : frame % 3 ? PIR_METHOD_UPDATE : PIR_METHOD_AUTO;
        assert_int_equal(pir_sum_rotate(sum, rotation, method), PIR_OK);
        hash = test_hash_pairing(hash, sum);
        assert_int_equal(pir_live_mesh_refresh(live), PIR_OK);
        if (frame % MESH_EVERY == 0)
            hash = hash_live(hash_mesh(hash, sum), live);
        hash = hash_double(hash, pir_sum_shortfall_bound(sum));
    }
    hash = hash_bytes(hash, sum);
    pir_live_mesh_destroy(live);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return hash;
}

static void thousands_of_frames_keep_their_bits(void **state) {
    (void)state;
    static const struct track tracks[] = {
        {"spheres turn steadily", TEST_SPHERE, TEST_SPHERE, 60, STEADY, 0, 0, 0xfc0b076a2995c40fu},
        {"spheres to and fro, their difference", TEST_SPHERE, TEST_BALL, 40, TO_AND_FRO, 1, 0, 0x86373570b775765au},
        {"trembling spheres", TEST_SPHERE, TEST_SPHERE, 40, TREMBLING, 0, 0, 0x2e110d93d00ba31bu},
        {"aligned grids", TEST_GRID, TEST_GRID, 30, ALIGNED, 0, 0, 0x147a2583e36777c4u},
        {"aligned boxes", TEST_BOX, TEST_BOX, 8, ALIGNED, 1, 0, 0x4cdf84e854ae8737u},
        {"a prism about an octahedron", TEST_PRISM, TEST_OCTAHEDRON, 16, TREMBLING, 0, 0, 0x82bcb85fbedb9c9du},
        {"needles and far bodies", TEST_NEEDLE, TEST_FAR, 30, STEADY, 0, 0, 0xa27147b33841cc00u},
        {"bodies of all scales", TEST_SCALED, TEST_SCALED, 20, TREMBLING, 0, 0, 0xeb71fa20e9311595u},
        {"flat bodies", TEST_POLYGON, TEST_PRISM, 16, ALIGNED, 0, 0, 0x19208aa10baadae0u},
        {"spheres within a tolerance", TEST_SPHERE, TEST_SPHERE, 40, STEADY, 0, 0.02, 0xba3219a8a07f23b2u},
    };
    int different = 0;
    for (uint64_t i = 0; i < sizeof tracks / sizeof tracks[0]; i++)
        different += differs(tracks[i].name, hash_track(&tracks[i], 800 + i), tracks[i].kept);
    assert_int_equal(different, 0);
}

/* --- queries --- */

static uint64_t hash_result(uint64_t hash, const pir_query_result *r) {
    hash = hash_number(hash_number(hash, (uint64_t)r->state), (uint64_t)r->outcome);
    hash = hash_vector(hash_double(hash, r->distance), r->normal);
    hash = hash_vector(hash_vector(hash, r->point_p), r->point_q);
    hash = hash_number(hash_number(hash, (uint64_t)r->witness.p.kind), r->witness.p.index);
    return hash_number(hash_number(hash, (uint64_t)r->witness.q.kind), r->witness.q.index);
}

/* Distances and depths, with a cache that goes along; directions; a cast. */
static uint64_t hash_answers(uint64_t hash, pir_query *query, pir_vec3 translation, pir_vec3 direction,
                             pir_query_cache *cache) {
    pir_query_input input = pir_query_input_default();
    pir_query_result r;
    pir_impact cast;
    input.translation = translation;
    assert_int_equal(pir_query_signed_distance(query, &input, cache, &r), PIR_OK);
    hash = hash_result(hash, &r);
    assert_int_equal(pir_query_directional_depth(query, &input, direction, &r), PIR_OK);
    hash = hash_result(hash, &r);
    assert_int_equal(pir_query_cast(query, &input, direction, &cast), PIR_OK);
    hash = hash_number(hash_double(hash, cast.time), (uint64_t)cast.outcome);
    return hash_vector(hash, cast.normal);
}

static uint64_t hash_queries(test_body p_body, test_body q_body, enum motion motion, uint64_t number) {
    test_random random = fixed_random(number);
    pir_polytope *p = test_random_polytope(&random, p_body, 40), *q = test_random_polytope(&random, q_body, 40);
    pir_sum_options options = {.size = sizeof options, .allocator = NULL, .difference = true};
    pir_quat rotation = {0, 0, 0, 1}, step = rotation;
    pir_sum *sum = NULL;
    pir_query *query = NULL;
    pir_query_cache cache = {0};
    assert_int_equal(pir_sum_create(p, q, rotation, &options, &sum), PIR_OK);
    assert_int_equal(pir_query_create(sum, &query), PIR_OK);
    uint64_t hash = TEST_HASH_START;
    for (int frame = 0; frame < FRAMES; frame++) {
        rotation = next_rotation(motion, &random, frame, &step, rotation);
        assert_int_equal(pir_sum_rotate(sum, rotation, PIR_METHOD_AUTO), PIR_OK);
        pir_vec3 t = test_random_direction(&random), d = test_random_direction(&random);
        double size = 4 * test_random_unit(&random);
        // some on the grid, where bodies of integers touch
        t = frame % 3 == 0 ? (pir_vec3){frame % 5, frame % 7 - 3, frame % 4}
                           : (pir_vec3){t.x * size, t.y * size, t.z * size};
        hash = hash_answers(hash, query, t, d, &cache);
    }
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return hash;
}

static void answers_keep_their_bits(void **state) {
    (void)state;
    int different = 0;
    different += differs("spheres", hash_queries(TEST_SPHERE, TEST_SPHERE, STEADY, 20), 0x7fdd7013dba022cau);
    different += differs("boxes", hash_queries(TEST_BOX, TEST_BOX, ALIGNED, 21), 0xc9685125a9b10acbu);
    different += differs("grids", hash_queries(TEST_GRID, TEST_PRISM, TREMBLING, 22), 0xb26ca0b027b80db5u);
    assert_int_equal(different, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thousands_of_frames_keep_their_bits),
        cmocka_unit_test(answers_keep_their_bits),
    };
    return cmocka_run_group_tests_name("same bits", tests, NULL, NULL);
}
