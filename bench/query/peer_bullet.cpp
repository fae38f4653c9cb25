// SPDX-License-Identifier: MIT
// Bullet in double precision: btGjkEpaSolver2 on convex hulls without margin.
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include "bullet_hull.hpp"
#include "peers.hpp"

namespace {

class Bullet : public Peer {
  public:
    Bullet(const pir_polytope *p, const pir_polytope *q) : p_(bullet_hull(p)), q_(bullet_hull(q)) {
    }
    const char *name() const override {
        return "Bullet";
    }
    void place(pir_quat r, pir_vec3 t) override {
        pose_ = btTransform(btQuaternion(r.x, r.y, r.z, r.w), btVector3(t.x, t.y, t.z));
    }
    PeerAnswer ask(bool deep) override {
        PeerAnswer answer;
        btGjkEpaSolver2::sResults results;
        btVector3 guess = pose_.getOrigin();
        bool done =
            deep ? btGjkEpaSolver2::Penetration(p_.get(), pose_, q_.get(), btTransform::getIdentity(), guess, results)
                 : btGjkEpaSolver2::Distance(p_.get(), pose_, q_.get(), btTransform::getIdentity(), guess, results);
        answer.has_distance = done;
        answer.distance = results.distance;
        answer.overlaps = results.status == btGjkEpaSolver2::sResults::Penetrating;
        answer.failed = results.status == btGjkEpaSolver2::sResults::GJK_Failed ||
                        results.status == btGjkEpaSolver2::sResults::EPA_Failed;
        return answer;
    }

  private:
    std::unique_ptr<btConvexHullShape> p_, q_;
    btTransform pose_;
};

} // namespace

std::unique_ptr<Peer> make_bullet(const pir_polytope *p, const pir_polytope *q) {
    return std::make_unique<Bullet>(p, q);
}
