// SPDX-License-Identifier: MIT
// What is measured on motions: ours, and the continuous collision of the engines that the build found.
#ifndef PIR_BENCH_CCD_PEERS_HPP
#define PIR_BENCH_CCD_PEERS_HPP

#include <memory>

#include "scene.hpp"

// P turns about an axis through its origin, which is at the origin of the world, by less than 180 degrees, and goes
// `way` meanwhile, from time 0 to 1. Both at constant speed, but for ours, whose way goes as impact.h says.
struct Course {
    pir_vec3 axis; // of length 1
    double degrees;
    pir_vec3 way;
    Pose q;
};

struct CcdAnswer {
    bool hits = false, failed = false;
    double time = 1;
};

class CcdPeer {
  public:
    virtual ~CcdPeer() = default;
    virtual const char *name() const = 0;
    virtual CcdAnswer ask(const Course &course) = 0;
    // Where its own P is at a time.
    virtual Pose pose_at(const Course &course, double time) const;
};

// `samples`, where above 0: its solver that looks at that many times; else its conservative advancement.
std::unique_ptr<CcdPeer> make_fcl_ccd(const pir_polytope *p, const pir_polytope *q, int samples);

std::unique_ptr<CcdPeer> make_bullet_ccd(const pir_polytope *p, const pir_polytope *q);

#endif
