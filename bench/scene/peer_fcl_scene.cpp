// SPDX-License-Identifier: MIT
// FCL: its dynamic tree manager, with contacts by libccd.
#include <algorithm>
#include <map>

#include <fcl/fcl.h>

#include "fcl_convex.hpp"
#include "scene_peers.hpp"

namespace {

fcl::Transform3d transform(const pir_pose &pose) {
    const pir_quat &q = pose.rotation;
    fcl::Transform3d at = fcl::Transform3d::Identity();
    at.linear() = fcl::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
    at.translation() = fcl::Vector3d(pose.translation.x, pose.translation.y, pose.translation.z);
    return at;
}

struct Collected {
    size_t statics;
    std::vector<BodyPair> pairs;
};

uint32_t number(const fcl::CollisionObjectd *object) {
    return (uint32_t) reinterpret_cast<uintptr_t>(object->getUserData());
}

bool collide(fcl::CollisionObjectd *a, fcl::CollisionObjectd *b, void *data) {
    auto *collected = static_cast<Collected *>(data);
    if (number(a) < collected->statics && number(b) < collected->statics)
        return false;
    fcl::CollisionRequestd request(1, true);
    fcl::CollisionResultd result;
    request.gjk_solver_type = fcl::GJKSolverType::GST_LIBCCD;
    try {
        fcl::collide(a, b, request, result);
    } catch (const std::exception &) {
        // no answer of this pair
        return false;
    }
    if (result.isCollision())
        collected->pairs.push_back({std::min(number(a), number(b)), std::max(number(a), number(b))});
    return false;
}

class FclScene : public ScenePeer {
  public:
    explicit FclScene(const Recording &recording) : collected_{recording.statics.size(), {}} {
        std::map<const pir_polytope *, std::shared_ptr<fcl::Convexd>> shapes;
        for (const pir_polytope *p : recording.shapes)
            shapes[p] = fcl_convex(p);
        for (const RecordedBody &body : recording.statics)
            add(shapes[body.polytope], body.pose);
        for (size_t i = 0; i < recording.bodies.size(); i++)
            add(shapes[recording.bodies[i].polytope], recording.frames[0][i]);
        manager_.setup();
    }
    const char *name() const override {
        return "FCL";
    }
    void set(const std::vector<uint32_t> &moved, const std::vector<pir_pose> &poses) override {
        std::vector<fcl::CollisionObjectd *> updated;
        for (uint32_t i : moved) {
            fcl::CollisionObjectd *object = objects_[collected_.statics + i].get();
            object->setTransform(transform(poses[i]));
            object->computeAABB();
            updated.push_back(object);
        }
        manager_.update(updated);
        collected_.pairs.clear();
        manager_.collide(&collected_, collide);
    }
    void overlapping(std::vector<BodyPair> *ret_pairs) override {
        *ret_pairs = collected_.pairs;
    }

  private:
    void add(const std::shared_ptr<fcl::Convexd> &shape, const pir_pose &pose) {
        objects_.emplace_back(
            std::unique_ptr<fcl::CollisionObjectd>(new fcl::CollisionObjectd(shape, transform(pose))));
        objects_.back()->setUserData(reinterpret_cast<void *>(objects_.size() - 1));
        manager_.registerObject(objects_.back().get());
    }

    Collected collected_;
    std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
    fcl::DynamicAABBTreeCollisionManagerd manager_;
};

} // namespace

std::unique_ptr<ScenePeer> make_fcl_scene(const Recording &recording) {
    return std::unique_ptr<ScenePeer>(new FclScene(recording));
}
