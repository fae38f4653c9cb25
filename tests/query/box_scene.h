/* SPDX-License-Identifier: MIT */
/* Boxes, scenes of two bodies with a query, and the checks that tests of single placements share. */
#ifndef PIR_TEST_BOX_SCENE_H
#define PIR_TEST_BOX_SCENE_H

#include "support/test.h"

#include <math.h>

#include <pirouette/query.h>

#include "query/query_of.h"
#include "support/bodies.h"

static const pir_quat still = {0, 0, 0, 1};

struct scene {
    pir_polytope *p, *q;
    pir_sum *sum;
    pir_query *query;
    pir_query_cache cache;
};

/* The box of full sides x, y, z about `at`. */
static inline pir_polytope *box(double x, double y, double z, pir_vec3 at) {
    return test_box_at(x / 2, y / 2, z / 2, at);
}

static inline pir_polytope *cube(double side) {
    return box(side, side, side, (pir_vec3){0, 0, 0});
}

/* Takes over the two polytopes. */
static inline struct scene make_scene(pir_polytope *p, pir_polytope *q, pir_quat rotation) {
    struct scene scene = {.p = p, .q = q};
    test_query_make(p, q, rotation, &scene.sum, &scene.query);
    return scene;
}

static inline void clear_scene(struct scene *scene) {
    test_query_free(scene->query, scene->sum);
    pir_polytope_release(scene->p);
    pir_polytope_release(scene->q);
}

static inline pir_query_input at(double x, double y, double z) {
    pir_query_input input = pir_query_input_default();
    input.translation = (pir_vec3){x, y, z};
    return input;
}

static inline pir_query_result ask_scene(struct scene *scene, double x, double y, double z) {
    pir_query_input input = at(x, y, z);
    pir_query_result r;
    assert_int_equal(pir_query_signed_distance(scene->query, &input, &scene->cache, &r), PIR_OK);
    // the answer's own invariant
    double dx = r.point_p.x - r.point_q.x - r.distance * r.normal.x,
           dy = r.point_p.y - r.point_q.y - r.distance * r.normal.y;
    double dz = r.point_p.z - r.point_q.z - r.distance * r.normal.z;
    double size =
        1 + fabs(x) + fabs(y) + fabs(z) + fabs(r.distance) + fabs(r.point_q.x) + fabs(r.point_q.y) + fabs(r.point_q.z);
    assert_true(sqrt(dx * dx + dy * dy + dz * dz) <= 1e-12 * size);
    assert_true(r.outcome != PIR_STEP_LIMIT);
    return r;
}

static inline void expect_answer(pir_query_result r, pir_state state, double distance, double size) {
    expect(r.state == state && fabs(r.distance - distance) <= 1e-12 * size, "state %d not %d, distance %.17g not %.17g",
           (int)r.state, (int)state, r.distance, distance);
}

#endif
