// SPDX-License-Identifier: MIT
// A polytope as Bullet's convex hull, without margin.
#ifndef BENCH_BULLET_HULL_HPP
#define BENCH_BULLET_HULL_HPP

#include <memory>

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <pirouette/pirouette.h>

inline std::unique_ptr<btConvexHullShape> bullet_hull(const pir_polytope *p) {
    auto shape = std::make_unique<btConvexHullShape>();
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        pir_vec3 c = pir_polytope_vertex(p, v);
        shape->addPoint(btVector3(c.x, c.y, c.z), false);
    }
    shape->setMargin(0);
    shape->recalcLocalAabb();
    return shape;
}

#endif
