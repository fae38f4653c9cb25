// SPDX-License-Identifier: MIT
// The engines that are measured beside ours: whichever of FCL, Bullet and libccd the build found.
#ifndef PIR_BENCH_PEERS_HPP
#define PIR_BENCH_PEERS_HPP

#include <memory>
#include <vector>

#include <pirouette/polytope.h>

struct PeerAnswer {
    bool overlaps = false, failed = false, has_distance = false;
    double distance = 0; // signed
};

class Peer {
  public:
    virtual ~Peer() = default;
    virtual const char *name() const = 0;
    virtual void place(pir_quat rotation, pir_vec3 translation) = 0;
    virtual PeerAnswer ask(bool deep) = 0;

    // The same where a peer may end the process instead of answering: that is a failure then. Costs a little more time.
    virtual PeerAnswer ask_guarded(bool deep) {
        return ask(deep);
    }
};

std::vector<std::unique_ptr<Peer>> make_peers(const pir_polytope *p, const pir_polytope *q);

// Each null where the build lacks it. `tolerance`, a length: the engine's own, by default as it comes.
std::unique_ptr<Peer> make_fcl(const pir_polytope *p, const pir_polytope *q, double tolerance = 1e-6);
std::unique_ptr<Peer> make_bullet(const pir_polytope *p, const pir_polytope *q);
std::unique_ptr<Peer> make_ccd(const pir_polytope *p, const pir_polytope *q, double tolerance = 1e-4);

#endif
