// SPDX-License-Identifier: MIT
// coal: GJK with EPA in doubles, with the guess of the frame before or with its default one.
#include <coal/narrowphase/narrowphase.h>
#include <coal/shape/convex.h>

#include <cstdlib>

#include "pair_peers.hpp"

// A build of coal's narrow phase alone lacks this part, which these queries do not call.
namespace coal {
class OBB;
template <typename BV> void fit(Vec3s *points, unsigned int count, BV &volume);
template <> __attribute__((weak)) void fit<OBB>(Vec3s *, unsigned int, OBB &) {
    std::abort();
}
} // namespace coal

namespace {

using Hull = coal::Convex<coal::Triangle>;

std::unique_ptr<Hull> hull(const pir_polytope *p) {
    auto points = std::make_shared<std::vector<coal::Vec3s>>();
    auto triangles = std::make_shared<std::vector<coal::Triangle>>();
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        pir_vec3 c = pir_polytope_vertex(p, v);
        points->emplace_back(c.x, c.y, c.z);
    }
    for (uint32_t f = 0; f < pir_polytope_facet_count(p); f++) {
        std::vector<uint32_t> corner(pir_polytope_facet_size(p, f));
        pir_polytope_facet(p, f, corner.data());
        for (size_t i = 2; i < corner.size(); i++)
            triangles->emplace_back(corner[0], corner[i - 1], corner[i]);
    }
    unsigned count = (unsigned)points->size(), faces = (unsigned)triangles->size();
    return std::make_unique<Hull>(points, count, triangles, faces);
}

class Coal : public PairPeer {
  public:
    Coal(const pir_polytope *p, const pir_polytope *q, bool warm, double tolerance)
        : p_(hull(p)), q_(hull(q)), warm_(warm), tolerance_(tolerance) {
        forget();
    }
    const char *name() const override {
        return warm_ ? "coal warm" : "coal cold";
    }
    void forget() override {
        solver_ = coal::GJKSolver();
        solver_.gjk_tolerance = solver_.epa_tolerance = tolerance_;
        solver_.gjk_initial_guess = warm_ ? coal::GJKInitialGuess::CachedGuess : coal::GJKInitialGuess::DefaultGuess;
    }
    double ask(const Place &place) override {
        coal::Vec3s p, q, n;
        return solver_.shapeDistance(*p_, transform(place.p), *q_, transform(place.q), true, p, q, n);
    }

  private:
    static coal::Transform3s transform(const Pose &pose) {
        return coal::Transform3s(coal::Quatf(pose.r.w, pose.r.x, pose.r.y, pose.r.z),
                                 coal::Vec3s(pose.t.x, pose.t.y, pose.t.z));
    }

    std::unique_ptr<Hull> p_, q_;
    bool warm_;
    double tolerance_;
    coal::GJKSolver solver_;
};

} // namespace

std::unique_ptr<PairPeer> make_coal(const pir_polytope *p, const pir_polytope *q, bool warm, double tolerance) {
    return std::make_unique<Coal>(p, q, warm, tolerance);
}
