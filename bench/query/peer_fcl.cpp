// SPDX-License-Identifier: MIT
// FCL: the signed distance of two convex bodies.
#include <csetjmp>
#include <csignal>

#include <fcl/fcl.h>

#include "fcl_convex.hpp"
#include "peers.hpp"

namespace {

// FCL asserts what degenerate poses break. Distributions build it with assertions on, which abort; this leaves the call
// instead, and whatever it held behind.
sigjmp_buf before_call;

void leave_call(int) {
    siglongjmp(before_call, 1);
}

class Fcl : public Peer {
  public:
    Fcl(const pir_polytope *p, const pir_polytope *q, double tolerance)
        : p_(fcl_convex(p)), q_(fcl_convex(q)), tolerance_(tolerance) {
    }
    const char *name() const override {
        return "FCL";
    }
    void place(pir_quat r, pir_vec3 t) override {
        pose_ = fcl::Transform3d::Identity();
        pose_.linear() = fcl::Quaterniond(r.w, r.x, r.y, r.z).toRotationMatrix();
        pose_.translation() = fcl::Vector3d(t.x, t.y, t.z);
    }
    PeerAnswer ask(bool) override {
        PeerAnswer answer;
        try {
            fcl::DistanceRequestd request(true, true);
            request.gjk_solver_type = fcl::GJKSolverType::GST_LIBCCD;
            request.distance_tolerance = tolerance_;
            fcl::DistanceResultd result;
            fcl::distance(p_.get(), pose_, q_.get(), fcl::Transform3d::Identity(), request, result);
            answer.distance = result.min_distance;
            answer.overlaps = result.min_distance < 0;
            answer.has_distance = true;
        } catch (const std::exception &) {
            answer.failed = true;
        }
        return answer;
    }

    PeerAnswer ask_guarded(bool deep) override {
        PeerAnswer answer;
        auto old = std::signal(SIGABRT, leave_call);
        if (sigsetjmp(before_call, 1) == 0)
            answer = ask(deep);
        else
            answer.failed = true;
        std::signal(SIGABRT, old);
        return answer;
    }

  private:
    std::shared_ptr<fcl::Convexd> p_, q_;
    double tolerance_;
    fcl::Transform3d pose_;
};

} // namespace

std::unique_ptr<Peer> make_fcl(const pir_polytope *p, const pir_polytope *q, double tolerance) {
    return std::unique_ptr<Peer>(new Fcl(p, q, tolerance)); // FCL asks for C++11
}
