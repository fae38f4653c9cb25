// SPDX-License-Identifier: MIT
// box3d: b3CollideHulls with a kept cache, in floats, with a manifold; hulls of at most 128 edges. It looks for
// contacts up to 0.02 units and takes contacts for the same within 0.005, whatever the bodies' size is. So there are
// two of it: one with the bodies as they are, one with bodies scaled to where 0.02 is the cutoff of ours.
#include <box3d/box3d.h>
#include <box3d/collision.h>

#include "pair_peers.hpp"

namespace {

b3HullData *hull(const pir_polytope *p, double by) {
    std::vector<b3Vec3> points;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        pir_vec3 c = pir_polytope_vertex(p, v);
        points.push_back({(float)(by * c.x), (float)(by * c.y), (float)(by * c.z)});
    }
    return b3CreateHull(points.data(), (int)points.size(), (int)points.size());
}

class Box3d : public PairPeer {
  public:
    Box3d(const pir_polytope *p, const pir_polytope *q, bool scaled)
        : by_(scaled ? B3_SPECULATIVE_DISTANCE / contact_cutoff(p, q) : 1), p_(hull(p, by_)), q_(hull(q, by_)) {
        forget();
    }
    ~Box3d() override {
        b3DestroyHull(p_);
        b3DestroyHull(q_);
    }
    const char *name() const override {
        return by_ == 1 ? "box3d manifold" : "box3d scaled";
    }
    bool is_fit() const {
        return p_ && q_;
    }
    bool has_manifold() const override {
        return true;
    }
    void forget() override {
        cache_ = {};
    }
    double ask(const Place &place) override {
        // as its world does, in floats
        b3Transform at = b3InvMulTransforms(transform(place.q), transform(place.p));
        b3LocalManifoldPoint points[32];
        b3LocalManifold manifold = {};
        manifold.points = points;
        b3CollideHulls(&manifold, 32, q_, p_, at, &cache_);
        double least = HUGE_VAL;
        for (int i = 0; i < manifold.pointCount; i++)
            least = points[i].separation < least ? points[i].separation : least;
        return least / by_;
    }

  private:
    b3Transform transform(const Pose &pose) const {
        b3Transform at;
        at.p = {(float)(by_ * pose.t.x), (float)(by_ * pose.t.y), (float)(by_ * pose.t.z)};
        at.q.v = {(float)pose.r.x, (float)pose.r.y, (float)pose.r.z};
        at.q.s = (float)pose.r.w;
        return at;
    }

    double by_;
    b3HullData *p_, *q_;
    b3SATCache cache_;
};

} // namespace

std::unique_ptr<PairPeer> make_box3d(const pir_polytope *p, const pir_polytope *q, bool scaled) {
    if (pir_polytope_edge_count(p) > 128 || pir_polytope_edge_count(q) > 128)
        return nullptr;
    auto peer = std::make_unique<Box3d>(p, q, scaled);
    return peer->is_fit() ? std::move(peer) : nullptr;
}
