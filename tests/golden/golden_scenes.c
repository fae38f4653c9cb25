/* SPDX-License-Identifier: MIT */
/* Golden histories of scenes: events with all their numbers, snapshots, and what shapes and rays meet. */
#include <math.h>
#include <stdlib.h>

#include <pirouette/scene_file.h>
#include <pirouette/scene_query.h>

#include "golden/golden.h"
#include "support/bodies.h"
#include "support/meshes.h"

#define BODIES  14
#define UPDATES 10
#define NEAR    4

static pir_vec3 somewhere(test_random *random) {
    double x = test_random_unit(random), y = test_random_unit(random), z = test_random_unit(random);
    return (pir_vec3){2 * x, 2 * y, 2 * z};
}

static uint64_t hash_of_events(uint64_t hash, const pir_scene *scene) {
    size_t count;
    const pir_scene_event *events = pir_scene_events(scene, &count);
    hash = golden_number(hash, count);
    for (size_t i = 0; i < count; i++) {
        const pir_scene_event *e = &events[i];
        const pir_witness *w = &e->witness;
        const uint32_t whole[11] = {e->kind,   e->body_p,  e->body_q, e->piece_p, e->piece_q,      (uint32_t)e->sensor,
                                    w->p.kind, w->p.index, w->q.kind, w->q.index, e->contact_count};
        for (int k = 0; k < 11; k++)
            hash = golden_number(hash, whole[k]);
        hash = golden_double(golden_vector(golden_double(hash, e->distance), e->normal), e->approach);
        hash = golden_contacts(hash, e->contacts, e->contact_count);
    }
    return hash;
}

static uint64_t hash_of_queries(uint64_t hash, pir_scene *scene, pir_polytope *shape, test_random *random) {
    pir_scene_shape asked = pir_scene_shape_default(shape);
    pir_scene_near near[NEAR];
    pir_impact impact;
    size_t count;
    asked.pose.translation = somewhere(random);
    golden_require(pir_scene_nearest(scene, &asked, HUGE_VAL, NEAR, near, &count), "pir_scene_nearest");
    for (size_t i = 0; i < count; i++)
        hash = golden_answer(golden_number(golden_number(hash, near[i].body_q), near[i].piece_q), &near[i].result);
    pir_vec3 from = somewhere(random), way = somewhere(random);
    golden_require(pir_scene_ray(scene, from, way, UINT32_MAX, &impact), "pir_scene_ray");
    hash = golden_vector(golden_double(golden_number(hash, impact.body), impact.time), impact.point);
    pir_motion motion = {way, from, 0};
    golden_require(pir_scene_cast(scene, &asked, &motion, 0x1p-20, &impact), "pir_scene_cast");
    return golden_vector(golden_double(golden_number(hash, impact.body), impact.time), impact.normal);
}

static uint64_t hash_of_snapshot(uint64_t hash, pir_scene *scene) {
    size_t size = pir_scene_serialised_size(scene);
    void *bytes = malloc(size);
    golden_require(bytes ? pir_scene_serialise(scene, bytes, size) : PIR_ERR_MEMORY, "pir_scene_serialise");
    hash = golden_bytes(hash, bytes, size);
    free(bytes);
    return hash;
}

uint64_t golden_scene(uint64_t number) {
    static const test_body kinds[6] = {TEST_SPHERE, TEST_BOX, TEST_OCTAHEDRON, TEST_POLYGON, TEST_PRISM, TEST_SEGMENT};
    test_random random = golden_random(3, number);
    pir_scene_options options = pir_scene_options_default();
    options.margin = number % 2 ? 0.0625 : 0;
    options.approach = true;
    options.threads = number % 4 == 0 ? 2 : 1;
    pir_scene *scene;
    golden_require(pir_scene_create(&options, &scene), "pir_scene_create");
    pir_scene_move moves[BODIES];
    pir_polytope *pieces[BODIES][2];
    for (uint32_t i = 0; i < BODIES; i++) {
        pir_body_options body = pir_body_options_default();
        for (int k = 0; k < 2; k++)
            pieces[i][k] = test_random_polytope(&random, kinds[test_random_below(&random, 6)], 16);
        body.kind = i == 0 ? PIR_BODY_STATIC : i == 1 ? PIR_BODY_KINEMATIC : PIR_BODY_MOVING;
        body.pieces = pieces[i];
        body.piece_count = 1 + i % 5 / 4;
        body.pose.translation = somewhere(&random);
        body.sensor = i == 3;
        body.radius = i == 4 ? 0.25 : 0;
        golden_require(pir_scene_add(scene, &body, &moves[i].body), "pir_scene_add");
        moves[i].pose = body.pose;
    }
    uint64_t hash = TEST_HASH_START;
    for (int update = 0; update < UPDATES; update++) {
        golden_require(pir_scene_update(scene, moves + 1, update == 0 ? 0 : BODIES - 1), "pir_scene_update");
        hash = hash_of_queries(hash_of_events(hash, scene), scene, pieces[0][1], &random);
        for (uint32_t i = 1; i < BODIES; i++) {
            pir_vec3 velocity = test_random_direction(&random), spin = test_random_direction(&random);
            if (test_random_below(&random, 3) > 0)
                moves[i].pose = pir_pose_integrate(moves[i].pose, velocity, spin, 0.0625);
        }
    }
    hash = hash_of_snapshot(hash, scene);
    pir_scene_destroy(scene);
    for (uint32_t i = 0; i < BODIES; i++)
        for (int k = 0; k < 2; k++)
            pir_polytope_release(pieces[i][k]);
    return hash;
}
