// SPDX-License-Identifier: MIT
// Ours by a pair: by its levels, and of simplified bodies; and the peers with tolerances of their own.
#include <algorithm>
#include <cstdio>

#include "pair_peers.hpp"
#include "peers.hpp"
#include "trade.hpp"

namespace {

// A pair of P and Q, or of bodies in place of them, to which it takes references.
class Pair : public Way {
  public:
    Pair(std::string family, std::string setting, pir_polytope *p, pir_polytope *q, pir_level least)
        : Way(std::move(family), std::move(setting)), p_(pir_polytope_retain(p)), q_(pir_polytope_retain(q)) {
        pir_pair_options options = pir_pair_options_default();
        options.least = least;
        trade_check(pir_workspace_create(nullptr, &workspace_));
        trade_check(pir_pair_create(p_, q_, &options, &pair_));
    }
    ~Pair() override {
        pir_pair_destroy(pair_);
        pir_workspace_destroy(workspace_);
        pir_polytope_release(q_);
        pir_polytope_release(p_);
    }
    void restart() override {
        trade_check(pir_pair_reset(pair_, p_, q_));
    }
    double frame(const Pose &pose) override {
        pir_query_result result;
        rotation_ = pose.r;
        input_.pose_p = {pose.r, pose.t};
        trade_check(pir_pair_signed_distance(pair_, workspace_, &input_, &result));
        return result.distance;
    }
    std::vector<pir_vec3> kept() override {
        TradePair own = {};
        own.p = p_;
        own.q = q_;
        return exact_difference(own, rotation_);
    }

  private:
    pir_polytope *p_, *q_;
    pir_workspace *workspace_ = nullptr;
    pir_pair *pair_ = nullptr;
    pir_pair_input input_ = pir_pair_input_default();
    pir_quat rotation_ = {0, 0, 0, 1};
};

// An engine of the query benchmarks.
class Engine : public Way {
  public:
    Engine(std::unique_ptr<Peer> peer, std::string setting)
        : Way(peer->name(), std::move(setting)), peer_(std::move(peer)) {
    }
    void restart() override {
    }
    double frame(const Pose &pose) override {
        peer_->place(pose.r, pose.t);
        PeerAnswer answer = peer_->ask_guarded(true);
        return answer.failed || !answer.has_distance ? NAN : answer.distance;
    }

  private:
    std::unique_ptr<Peer> peer_;
};

// One of the pair benchmarks.
class PairEngine : public Way {
  public:
    PairEngine(std::unique_ptr<PairPeer> peer, std::string setting)
        : Way(peer->name(), std::move(setting)), peer_(std::move(peer)) {
    }
    void restart() override {
        peer_->forget();
    }
    double frame(const Pose &pose) override {
        double distance = peer_->ask({pose, {{0, 0, 0, 1}, {0, 0, 0}}, pose});
        return distance == HUGE_VAL ? NAN : distance;
    }

  private:
    std::unique_ptr<PairPeer> peer_;
};

} // namespace

pir_polytope *fewer_vertices(pir_polytope *p, uint32_t vertices) {
    if (pir_polytope_vertex_count(p) <= vertices)
        return pir_polytope_retain(p);
    pir_simplify_options options = pir_simplify_options_default();
    pir_simplified simplified;
    options.vertices = vertices;
    trade_check(pir_polytope_simplify(p, &options, &simplified));
    pir_polytope *inner = pir_polytope_retain(simplified.inner);
    pir_simplified_release(&simplified);
    return inner;
}

void add_pairs(const TradePair &pair, Ways *ret_ways) {
    ret_ways->push_back(std::make_unique<Pair>("level", "by need", pair.p, pair.q, PIR_LEVEL_NONE));
    ret_ways->push_back(std::make_unique<Pair>("level", "whole", pair.p, pair.q, PIR_LEVEL_WHOLE));
    uint32_t most = std::max(pir_polytope_vertex_count(pair.p), pir_polytope_vertex_count(pair.q));
    for (uint32_t vertices : {128u, 64u, 32u, 16u, 8u}) {
        if (vertices >= most)
            continue;
        pir_polytope *p = fewer_vertices(pair.p, vertices), *q = fewer_vertices(pair.q, vertices);
        ret_ways->push_back(std::make_unique<Pair>("simplified", std::to_string(vertices), p, q, PIR_LEVEL_NONE));
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

void add_peers(const TradePair &pair, Ways *ret_ways) {
    char setting[32] = "";
    (void)pair;
    (void)ret_ways;
    for (double tolerance : {1e-1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-12}) {
        std::snprintf(setting, sizeof setting, "%g", tolerance);
#ifdef PIR_HAVE_FCL
        ret_ways->push_back(std::make_unique<Engine>(make_fcl(pair.p, pair.q, tolerance * pair.size), setting));
#endif
#ifdef PIR_HAVE_CCD
        ret_ways->push_back(std::make_unique<Engine>(make_ccd(pair.p, pair.q, tolerance * pair.size), setting));
#endif
#ifdef PIR_HAVE_COAL
        ret_ways->push_back(
            std::make_unique<PairEngine>(make_coal(pair.p, pair.q, true, tolerance * pair.size), setting));
#endif
    }
    // these have none to set
#ifdef PIR_HAVE_BULLET
    ret_ways->push_back(std::make_unique<Engine>(make_bullet(pair.p, pair.q), "built in"));
#endif
#ifdef PIR_HAVE_BOX3D
    for (bool scaled : {false, true})
        if (auto peer = make_box3d(pair.p, pair.q, scaled))
            ret_ways->push_back(std::make_unique<PairEngine>(std::move(peer), "built in"));
#endif
}
