/* SPDX-License-Identifier: MIT */
/*
 * Scenes of several threads, one each, whose bodies share polytopes: each is updated, asked, written and restored while
 * the others are, some with threads of their own, and gives what it gives alone. What a polytope keeps for pairs is
 * made while several ask for it.
 */
#include "support/test.h"

#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/scene_file.h>
#include <pirouette/scene_query.h>

#include "scene/crowd.h"
#include "support/bodies.h"
#include "support/hash.h"
#include "support/meshes.h"

#define SCENES 4
#define SHAPES 8
#define BODIES 40
#define FRAMES 10
#define BACK   4 /* the frame that the last ones are run again from */

struct shared {
    pir_polytope *shape[SHAPES];
    pthread_barrier_t start;
};

/* What one thread does; cmocka's checks belong to the main thread, so it counts what failed. */
struct life {
    struct shared *shared;
    uint32_t number, failed;
    uint64_t hash;
    bool alone;
    pir_scene *scene;
    pir_scene_move move[FRAMES][BODIES];
};

static void try(struct life *life, pir_status status) {
    life->failed += status != PIR_OK;
}

static pir_pose place(test_random *random) {
    double x = 2 * test_random_unit(random), y = 2 * test_random_unit(random), z = 2 * test_random_unit(random);
    pir_quat turn = {test_random_unit(random), 0, 0, 1};
    turn.y = test_random_unit(random);
    return (pir_pose){turn, {x, y, z}};
}

static void add_bodies(struct life *life, test_random *random) {
    for (uint32_t i = 0; i < BODIES; i++) {
        pir_body_options body = pir_body_options_default();
        uint32_t id;
        body.pose = place(random);
        body.pieces = &life->shared->shape[i % SHAPES];
        body.piece_count = 1;
        try(life, pir_scene_add(life->scene, &body, &id));
        for (uint32_t f = 0; f < FRAMES; f++) {
            pir_vec3 way = {0.2 * test_random_unit(random), 0, 0};
            way.z = 0.2 * test_random_unit(random);
            life->move[f][i].body = id;
            life->move[f][i].pose = pir_pose_integrate(f > 0 ? life->move[f - 1][i].pose : body.pose, way, way, 1);
        }
    }
}

/* What the queries of a scene say of a shape that the others use too. */
static uint64_t ask_scene(struct life *life, uint32_t frame) {
    pir_scene_shape shape = pir_scene_shape_default(life->shared->shape[frame % SHAPES]);
    pir_motion motion = {{3, 0.5, 0.25}, {0, 0, 0.5}, 0};
    pir_scene_hit hit[BODIES];
    pir_scene_near near[8];
    pir_impact ray, cast, impact;
    size_t hits = 0, nearest = 0, closest = 0;
    uint64_t hash = TEST_HASH_START;
    shape.pose.translation = (pir_vec3){-1.5, 0.25 * frame, 0};
    try(life, pir_scene_overlap(life->scene, &shape, BODIES, hit, &hits));
    for (size_t i = 0; i < hits; i++)
        hash = test_hash(hash, &hit[i].body, sizeof hit[i].body);
    try(life, pir_scene_nearest(life->scene, &shape, HUGE_VAL, 4, near, &nearest));
    for (size_t i = 0; i < nearest; i++)
        hash = test_hash(hash, &near[i].result.distance, sizeof near[i].result.distance);
    try(life, pir_scene_closest_pairs(life->scene, 0.5, 8, near, &closest));
    for (size_t i = 0; i < closest; i++)
        hash = test_hash(hash, &near[i].result.distance, sizeof near[i].result.distance);
    try(life, pir_scene_ray(life->scene, (pir_vec3){-4, 0.1, 0.2}, (pir_vec3){8, 0, 0}, UINT32_MAX, &ray));
    try(life, pir_scene_cast(life->scene, &shape, &motion, 1e-6, &cast));
    try(life, pir_scene_time_of_impact(life->scene, life->move[0][frame].body, &motion, 1e-6, &impact));
    const double times[3] = {ray.time, cast.time, impact.time};
    const uint32_t met[3] = {ray.body, cast.body, impact.body};
    return test_hash(test_hash(hash, times, sizeof times), met, sizeof met);
}

static uint64_t run_life(struct life *life, uint32_t from, uint64_t hash) {
    for (uint32_t f = from; f < FRAMES; f++) {
        try(life, pir_scene_update(life->scene, life->move[f], BODIES));
        uint64_t told = ask_scene(life, f);
        hash = test_hash(crowd_hash_events(hash, life->scene), &told, sizeof told);
    }
    return hash;
}

static void *live(void *data) {
    struct life *life = data;
    test_random random = test_random_case("threads of scenes", life->number);
    pir_scene_options options = pir_scene_options_default();
    options.margin = 0.05;
    options.threads = life->alone ? 1 : 1 + life->number % 3;
    if (!life->alone)
        pthread_barrier_wait(&life->shared->start);
    try(life, pir_scene_create(&options, &life->scene));
    add_bodies(life, &random);
    for (uint32_t f = 0; f < BACK; f++)
        try(life, pir_scene_update(life->scene, life->move[f], BODIES));
    size_t size = pir_scene_serialised_size(life->scene);
    void *bytes = malloc(size);
    if (!bytes) {
        life->failed++;
        return NULL;
    }
    try(life, pir_scene_serialise(life->scene, bytes, size));
    life->hash = run_life(life, BACK, TEST_HASH_START);
    try(life, pir_scene_restore(life->scene, bytes, size, NULL));
    life->failed += run_life(life, BACK, TEST_HASH_START) != life->hash;
    life->failed += !pir_scene_is_valid(life->scene);
    free(bytes);
    pir_scene_destroy(life->scene);
    return NULL;
}

/* Polytopes that no pair has met yet. */
static void make_shapes(struct shared *shared) {
    static const test_body kinds[4] = {TEST_SPHERE, TEST_BOX, TEST_OCTAHEDRON, TEST_SPHERE};
    test_random random = test_random_case("shapes of scenes", 0);
    for (uint32_t i = 0; i < SHAPES; i++) {
        test_points points;
        test_body_points(&random, kinds[i % 4], 16, &points);
        for (size_t k = 0; k < points.count; k++) {
            pir_vec3 *x = &points.at[k];
            *x = (pir_vec3){0.5 * x->x, 0.5 * x->y, 0.5 * x->z};
        }
        shared->shape[i] = test_polytope(&points);
    }
}

static void release_shapes(struct shared *shared) {
    for (uint32_t i = 0; i < SHAPES; i++)
        pir_polytope_release(shared->shape[i]);
}

static void scenes_of_several_threads_share_polytopes(void **state) {
    (void)state;
    static struct life life[SCENES];
    struct shared shared;
    uint64_t alone[SCENES];
    pthread_t thread[SCENES];
    assert_int_equal(pthread_barrier_init(&shared.start, NULL, SCENES), 0);
    for (uint32_t i = 0; i < SCENES; i++) {
        make_shapes(&shared);
        life[i] = (struct life){.shared = &shared, .number = i, .alone = true};
        live(&life[i]);
        assert_int_equal(life[i].failed, 0);
        alone[i] = life[i].hash;
        release_shapes(&shared);
    }
    for (int round = 0; round < 3; round++) {
        make_shapes(&shared);
        for (uint32_t i = 0; i < SCENES; i++) {
            life[i] = (struct life){.shared = &shared, .number = i};
            assert_int_equal(pthread_create(&thread[i], NULL, live, &life[i]), 0);
        }
        for (uint32_t i = 0; i < SCENES; i++)
            assert_int_equal(pthread_join(thread[i], NULL), 0);
        for (uint32_t i = 0; i < SCENES; i++)
            expect(life[i].failed == 0 && life[i].hash == alone[i], "round %d, scene %u: %u failed", round, i,
                   life[i].failed);
        release_shapes(&shared);
    }
    pthread_barrier_destroy(&shared.start);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(scenes_of_several_threads_share_polytopes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
