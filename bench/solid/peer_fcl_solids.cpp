// SPDX-License-Identifier: MIT
#include "fcl_solids.hpp"

#include <fcl/fcl.h>

namespace {

class Fcl : public FclSolids {
    using Tree = fcl::BVHModel<fcl::OBBRSSd>;

  public:
    Fcl(const Triangles &p, const Triangles &q)
        : p_(tree_of(p), fcl::Transform3d::Identity()), q_(tree_of(q), fcl::Transform3d::Identity()) {
    }
    bool meets(const pir_pose &pose) override {
        place(pose);
        fcl::CollisionResultd result;
        return fcl::collide(&p_, &q_, fcl::CollisionRequestd(1, false), result) > 0;
    }
    double distance(const pir_pose &pose) override {
        place(pose);
        fcl::DistanceResultd result;
        return fcl::distance(&p_, &q_, fcl::DistanceRequestd(true), result);
    }
    double depth(const pir_pose &pose) override {
        place(pose);
        fcl::CollisionResultd result;
        fcl::collide(&p_, &q_, fcl::CollisionRequestd(100000, true), result);
        double deepest = 0;
        for (size_t i = 0; i < result.numContacts(); i++)
            deepest = std::max(deepest, std::fabs(result.getContact(i).penetration_depth));
        return deepest;
    }

  private:
    static std::shared_ptr<Tree> tree_of(const Triangles &from) {
        std::vector<fcl::Vector3d> points;
        std::vector<fcl::Triangle> triangles;
        for (const auto &v : from.points)
            points.emplace_back(v[0], v[1], v[2]);
        for (const auto &t : from.corners)
            triangles.emplace_back(t[0], t[1], t[2]);
        auto tree = std::make_shared<Tree>();
        tree->beginModel((int)triangles.size(), (int)points.size());
        tree->addSubModel(points, triangles);
        tree->endModel();
        return tree;
    }
    void place(const pir_pose &pose) {
        fcl::Transform3d at = fcl::Transform3d::Identity();
        const pir_quat r = pose.rotation;
        at.linear() = fcl::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
        at.translation() = fcl::Vector3d(pose.translation.x, pose.translation.y, pose.translation.z);
        p_.setTransform(at);
        p_.computeAABB();
    }
    fcl::CollisionObjectd p_, q_;
};

} // namespace

std::unique_ptr<FclSolids> make_fcl_solids(const Triangles &p, const Triangles &q) {
    return std::unique_ptr<FclSolids>(new Fcl(p, q));
}
