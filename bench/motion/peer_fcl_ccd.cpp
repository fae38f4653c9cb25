// SPDX-License-Identifier: MIT
// FCL: continuous collision of two convex bodies.
#include <string>

#include <fcl/fcl.h>
#include <fcl/math/motion/interp_motion.h>
#include <fcl/narrowphase/continuous_collision.h>

#include "../query/fcl_convex.hpp"
#include "ccd_peers.hpp"

namespace {

fcl::Transform3d transform(const Pose &pose) {
    fcl::Transform3d at = fcl::Transform3d::Identity();
    at.linear() = fcl::Quaterniond(pose.r.w, pose.r.x, pose.r.y, pose.r.z).normalized().toRotationMatrix();
    at.translation() = fcl::Vector3d(pose.t.x, pose.t.y, pose.t.z);
    return at;
}

class FclCcd : public CcdPeer {
  public:
    FclCcd(const pir_polytope *p, const pir_polytope *q, int samples)
        : p_(fcl_convex(p)), q_(fcl_convex(q)), samples_(samples) {
        p_->computeLocalAABB();
        q_->computeLocalAABB();
    }
    const char *name() const override {
        return samples_ > 0 ? "FCL, sampled" : "FCL";
    }
    CcdAnswer ask(const Course &course) override {
        CcdAnswer answer;
        try {
            const fcl::InterpMotion<double> moves(transform(pose_at(course, 0)), transform(pose_at(course, 1)));
            const fcl::InterpMotion<double> rests(transform(course.q), transform(course.q));
            fcl::ContinuousCollisionRequestd request;
            if (samples_ > 0) {
                request.num_max_iterations = (std::size_t)samples_;
            } else {
                request.num_max_iterations = 1000;
                request.ccd_solver_type = fcl::CCDC_CONSERVATIVE_ADVANCEMENT;
            }
            fcl::ContinuousCollisionResultd result;
            fcl::continuousCollide(p_.get(), &moves, q_.get(), &rests, request, result);
            answer.hits = result.is_collide;
            answer.time = result.time_of_contact;
        } catch (const std::exception &) {
            answer.failed = true;
        }
        return answer;
    }

  private:
    std::shared_ptr<fcl::Convexd> p_, q_;
    int samples_;
};

} // namespace

std::unique_ptr<CcdPeer> make_fcl_ccd(const pir_polytope *p, const pir_polytope *q, int samples) {
    return std::unique_ptr<CcdPeer>(new FclCcd(p, q, samples)); // FCL asks for C++11
}
