/* SPDX-License-Identifier: MIT */
/* Gates: a body before a plate in four boxes with a rectangular window, and where it is to go. */
#ifndef PIR_TEST_GATES_H
#define PIR_TEST_GATES_H

#include "support/test.h"

#include <pirouette/pirouette.h>

static inline pir_solid *solid_of(const pir_vec3 *p, size_t points, const uint32_t *starts, const uint32_t *corners,
                                  size_t facets) {
    const pir_solid_facets made = {p, points, starts, corners, facets};
    pir_solid *solid = NULL;
    assert_int_equal(pir_solid_create(&made, NULL, NULL, &solid), PIR_OK);
    return solid;
}

/* A body as a box is, of corners that bits number; as a polytope as well where there is a place for it. */
static inline pir_solid *make_block(const pir_vec3 p[8], pir_polytope **ret_shape) {
    static const uint32_t sides[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    static const uint32_t starts[7] = {0, 4, 8, 12, 16, 20, 24};
    if (ret_shape)
        assert_int_equal(pir_polytope_create(p, 8, NULL, ret_shape), PIR_OK);
    return solid_of(p, 8, starts, sides, 6);
}

static inline pir_solid *make_box(pir_vec3 low, pir_vec3 high, pir_polytope **ret_shape) {
    pir_vec3 p[8];
    for (int i = 0; i < 8; i++)
        p[i] = (pir_vec3){i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
    return make_block(p, ret_shape);
}

/* A tetrahedron of four vertices, facets to the outside. */
static inline pir_solid *make_simplex(const pir_vec3 p[4]) {
    static const uint32_t sides[12] = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2}, starts[5] = {0, 3, 6, 9, 12};
    return solid_of(p, 4, starts, sides, 4);
}

/*
 * A plate about the plane z = 0 with a window along the axes, as polytopes as well where there is a place for them; the
 * robot, which is borrowed with the walls, goes from under it to over it.
 */
static inline pir_rigid_plan_input make_gate_of(double width, double length, double way, pir_solid **robot,
                                                pir_solid *wall[4], pir_polytope **ret_plate) {
    const double x = width / 2, y = length / 2;
    const pir_vec3 low[4] = {{-9, -9, -.5}, {x, -9, -.5}, {-x, -9, -.5}, {-x, y, -.5}},
                   high[4] = {{-x, 9, .5}, {9, 9, .5}, {x, -y, .5}, {x, 9, .5}};
    for (int i = 0; i < 4; i++)
        wall[i] = make_box(low[i], high[i], ret_plate ? &ret_plate[i] : NULL);
    return (pir_rigid_plan_input){.robot = (const pir_solid *const *)robot,
                                  .robot_count = 1,
                                  .obstacles = (const pir_solid *const *)wall,
                                  .obstacle_count = 4,
                                  .low = {-1, -1, -way - .5},
                                  .high = {1, 1, way + .5},
                                  .from = {{0, 0, 0, 1}, {0, 0, -way}},
                                  .to = {{.3, -.2, .1, -.9}, {0, 0, way}}};
}

#endif
