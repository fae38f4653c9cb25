/* SPDX-License-Identifier: MIT */
/* Cubes in a scene: see scene_bodies.h. */
#include "support/test.h"

#include "scene/scene_bodies.h"
#include "support/bodies.h"
#include "support/meshes.h"

pir_polytope *scene_cube(double half) {
    test_points points = {.count = 8};
    for (int i = 0; i < 8; i++)
        points.at[i] = (pir_vec3){i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half};
    return test_polytope(&points);
}

pir_pose scene_at(double x, double y, double z) {
    return (pir_pose){{0, 0, 0, 1}, {x, y, z}};
}

uint32_t scene_add(pir_scene *scene, pir_polytope *piece, pir_pose pose, pir_body_kind kind) {
    pir_body_options body = pir_body_options_default();
    uint32_t id = UINT32_MAX;
    body.pieces = &piece;
    body.piece_count = 1;
    body.pose = pose;
    body.kind = kind;
    assert_int_equal(pir_scene_add(scene, &body, &id), PIR_OK);
    return id;
}
