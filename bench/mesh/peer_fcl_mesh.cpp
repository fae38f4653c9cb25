// SPDX-License-Identifier: MIT
#include "mesh_peers.hpp"

#include <fcl/fcl.h>

namespace {

class Fcl : public MeshPeer {
    using Tree = fcl::BVHModel<fcl::OBBRSSd>;

  public:
    Fcl(const Mesh &p, const Mesh &q) : p_(tree_of(p)), q_(tree_of(q)) {
    }
    double distance(const pir_pose &pose_p, const pir_pose &pose_q) override {
        fcl::DistanceResultd result;
        return fcl::distance(p_.get(), transform_of(pose_p), q_.get(), transform_of(pose_q),
                             fcl::DistanceRequestd(true), result);
    }

  private:
    static std::shared_ptr<Tree> tree_of(const Mesh &mesh) {
        std::vector<fcl::Vector3d> points;
        std::vector<fcl::Triangle> triangles;
        for (const pir_vec3 &v : mesh.points)
            points.emplace_back(v.x, v.y, v.z);
        for (size_t t = 0; t < mesh.corners.size(); t += 3)
            triangles.emplace_back(mesh.corners[t], mesh.corners[t + 1], mesh.corners[t + 2]);
        auto tree = std::make_shared<Tree>();
        tree->beginModel((int)triangles.size(), (int)points.size());
        tree->addSubModel(points, triangles);
        tree->endModel();
        return tree;
    }
    static fcl::Transform3d transform_of(const pir_pose &pose) {
        fcl::Transform3d at = fcl::Transform3d::Identity();
        const pir_quat r = pose.rotation;
        at.linear() = fcl::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
        at.translation() = fcl::Vector3d(pose.translation.x, pose.translation.y, pose.translation.z);
        return at;
    }
    std::shared_ptr<Tree> p_, q_;
};

} // namespace

std::unique_ptr<MeshPeer> make_fcl_meshes(const Mesh &p, const Mesh &q) {
    return std::unique_ptr<MeshPeer>(new Fcl(p, q));
}
