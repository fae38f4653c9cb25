// SPDX-License-Identifier: MIT
// Bullet in double precision: btContinuousConvexCollision on convex hulls without margin.
#include <BulletCollision/NarrowPhaseCollision/btContinuousConvexCollision.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include "../query/bullet_hull.hpp"
#include "ccd_peers.hpp"

namespace {

btTransform transform(const Pose &pose) {
    return btTransform(btQuaternion(pose.r.x, pose.r.y, pose.r.z, pose.r.w).normalized(),
                       btVector3(pose.t.x, pose.t.y, pose.t.z));
}

class BulletCcd : public CcdPeer {
  public:
    BulletCcd(const pir_polytope *p, const pir_polytope *q) : p_(bullet_hull(p)), q_(bullet_hull(q)) {
    }
    const char *name() const override {
        return "Bullet";
    }
    CcdAnswer ask(const Course &course) override {
        btVoronoiSimplexSolver simplex;
        btGjkEpaPenetrationDepthSolver depth;
        btContinuousConvexCollision collision(p_.get(), q_.get(), &simplex, &depth);
        const btTransform q = transform(course.q);
        btConvexCast::CastResult result;
        CcdAnswer answer;
        answer.hits =
            collision.calcTimeOfImpact(transform(pose_at(course, 0)), transform(pose_at(course, 1)), q, q, result);
        answer.time = answer.hits ? result.m_fraction : 1;
        return answer;
    }

  private:
    std::unique_ptr<btConvexHullShape> p_, q_;
};

} // namespace

std::unique_ptr<CcdPeer> make_bullet_ccd(const pir_polytope *p, const pir_polytope *q) {
    return std::make_unique<BulletCcd>(p, q);
}
