// SPDX-License-Identifier: MIT
// What is measured on pairs: ours, and the engines that the build found.
#ifndef PIR_BENCH_PAIR_PEERS_HPP
#define PIR_BENCH_PAIR_PEERS_HPP

#include <cmath>
#include <memory>
#include <vector>

#include "pair_poses.hpp"

class PairPeer {
  public:
    virtual ~PairPeer() = default;
    virtual const char *name() const = 0;

    // Forgets what it keeps from frame to frame.
    virtual void forget() = 0;

    // Places both and answers: the signed distance, or that of the deepest contact; HUGE_VAL for none.
    virtual double ask(const Place &place) = 0;

    // Whether it stops at 2 % of the size and gives contacts.
    virtual bool has_manifold() const {
        return false;
    }
};

// `tolerance`, a length: that of its GJK and EPA, by default as it comes.
std::unique_ptr<PairPeer> make_coal(const pir_polytope *p, const pir_polytope *q, bool warm, double tolerance = 1e-6);

// The distance up to which contacts are asked for: 2 % of the size.
inline double contact_cutoff(const pir_polytope *p, const pir_polytope *q) {
    return 0.02 * (size_of(p) + size_of(q));
}

// Null for hulls that it does not take. `scaled`: see peer_box3d.cpp.
std::unique_ptr<PairPeer> make_box3d(const pir_polytope *p, const pir_polytope *q, bool scaled);

#endif
