// SPDX-License-Identifier: MIT
#include "peers.hpp"

std::vector<std::unique_ptr<Peer>> make_peers(const pir_polytope *p, const pir_polytope *q) {
    std::vector<std::unique_ptr<Peer>> peers;
#ifdef PIR_HAVE_FCL
    peers.push_back(make_fcl(p, q));
#endif
#ifdef PIR_HAVE_BULLET
    peers.push_back(make_bullet(p, q));
#endif
#ifdef PIR_HAVE_CCD
    peers.push_back(make_ccd(p, q));
#endif
    return peers;
}
