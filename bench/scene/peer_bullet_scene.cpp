// SPDX-License-Identifier: MIT
// Bullet in double precision: its collision world alone, hulls without margin.
#include <algorithm>

#include <btBulletCollisionCommon.h>

#include "bullet_hull.hpp"
#include "scene_peers.hpp"

namespace {

btTransform transform(const pir_pose &pose) {
    const pir_quat &q = pose.rotation;
    const pir_vec3 &t = pose.translation;
    return btTransform(btQuaternion(q.x, q.y, q.z, q.w), btVector3(t.x, t.y, t.z));
}

class BulletScene : public ScenePeer {
  public:
    explicit BulletScene(const Recording &recording)
        : dispatcher_(&configuration_), world_(&dispatcher_, &broadphase_, &configuration_),
          statics_(recording.statics.size()) {
        for (const RecordedBody &body : recording.statics)
            add(body.polytope, body.pose, 2, 1);
        for (size_t i = 0; i < recording.bodies.size(); i++)
            add(recording.bodies[i].polytope, recording.frames[0][i], 1, 3);
        world_.setForceUpdateAllAabbs(false);
    }
    ~BulletScene() override {
        for (auto &body : bodies_)
            world_.removeCollisionObject(body.get());
    }
    const char *name() const override {
        return "Bullet";
    }
    void set(const std::vector<uint32_t> &moved, const std::vector<pir_pose> &poses) override {
        for (uint32_t i : moved) {
            bodies_[statics_ + i]->setWorldTransform(transform(poses[i]));
            world_.updateSingleAabb(bodies_[statics_ + i].get());
        }
        world_.performDiscreteCollisionDetection();
    }
    void overlapping(std::vector<BodyPair> *ret_pairs) override {
        for (int i = 0; i < dispatcher_.getNumManifolds(); i++) {
            const btPersistentManifold *manifold = dispatcher_.getManifoldByIndexInternal(i);
            bool overlaps = false;
            for (int k = 0; k < manifold->getNumContacts(); k++)
                overlaps = overlaps || manifold->getContactPoint(k).getDistance() <= 0;
            uint32_t a = (uint32_t)manifold->getBody0()->getUserIndex(),
                     b = (uint32_t)manifold->getBody1()->getUserIndex();
            if (overlaps)
                ret_pairs->push_back({std::min(a, b), std::max(a, b)});
        }
    }

  private:
    void add(const pir_polytope *p, const pir_pose &pose, int group, int mask) {
        shapes_.push_back(bullet_hull(p));
        bodies_.push_back(std::make_unique<btCollisionObject>());
        bodies_.back()->setCollisionShape(shapes_.back().get());
        bodies_.back()->setWorldTransform(transform(pose));
        bodies_.back()->setUserIndex((int)bodies_.size() - 1);
        world_.addCollisionObject(bodies_.back().get(), group, mask);
    }

    btDefaultCollisionConfiguration configuration_;
    btDbvtBroadphase broadphase_;
    btCollisionDispatcher dispatcher_;
    btCollisionWorld world_;
    size_t statics_;
    std::vector<std::unique_ptr<btConvexHullShape>> shapes_;
    std::vector<std::unique_ptr<btCollisionObject>> bodies_;
};

} // namespace

std::unique_ptr<ScenePeer> make_bullet_scene(const Recording &recording) {
    return std::make_unique<BulletScene>(recording);
}
