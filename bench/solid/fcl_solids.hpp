// SPDX-License-Identifier: MIT
// FCL's trees of triangles: whether two surfaces meet, how far apart they are, and how deep contacts are.
#ifndef PIR_BENCH_FCL_SOLIDS_HPP
#define PIR_BENCH_FCL_SOLIDS_HPP

#include <memory>

#include <pirouette/base.h>
#include <pirouette/pose.h>

#include "triangles.hpp"

class FclSolids {
  public:
    virtual ~FclSolids() = default;
    virtual bool meets(const pir_pose &pose) = 0;
    virtual double distance(const pir_pose &pose) = 0;
    // The depth of the deepest of all contacts; 0 where there is none.
    virtual double depth(const pir_pose &pose) = 0;
};

std::unique_ptr<FclSolids> make_fcl_solids(const Triangles &p, const Triangles &q);

#endif
