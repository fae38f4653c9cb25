// SPDX-License-Identifier: MIT
// What the trade of time for accuracy is measured on: a way of getting from a pose to a depth, and what it missed.
#ifndef PIR_BENCH_TRADE_HPP
#define PIR_BENCH_TRADE_HPP

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "scene.hpp"

// Two bodies, the poses of P, and the exact signed distances at these.
struct TradePair {
    std::string name;
    pir_polytope *p, *q;
    std::vector<Pose> poses;
    std::vector<double> exact;
    double size; // of both, which errors are relative to
};

// One setting of one way.
class Way {
  public:
    Way(std::string family, std::string setting) : family(std::move(family)), setting(std::move(setting)) {
    }
    virtual ~Way() = default;

    // Begins anew, before the first pose.
    virtual void restart() = 0;

    // Brings P to a pose: timed. The signed distance; NAN where there is none.
    virtual double frame(const Pose &pose) = 0;

    // The vertices of the difference as it is kept after a frame, not timed; empty where there is none.
    virtual std::vector<pir_vec3> kept() {
        return {};
    }

    const std::string family, setting;
};

using Ways = std::vector<std::unique_ptr<Way>>;

// Ours: tolerances, coordinates and regions of a sum; levels of a pair, and pairs of simplified bodies.
void add_sums(const TradePair &pair, Ways *ret_ways);
void add_pairs(const TradePair &pair, Ways *ret_ways);

// The engines that the build found, each with several of its own tolerances.
void add_peers(const TradePair &pair, Ways *ret_ways);

// What came of it. Errors are the greatest, relative to the size; NAN where there is nothing to compare.
struct Measured {
    std::string family, setting;
    bool ours;
    double ns;                        // a frame, the mean
    double depth, support, hausdorff; // errors
    size_t failed;                    // frames without an answer
};

// How far hulls differ: the greatest difference of their supports over many directions, and the Hausdorff distance.
double support_error(const std::vector<pir_vec3> &a, const std::vector<pir_vec3> &b);
double hausdorff(const std::vector<pir_vec3> &a, const std::vector<pir_vec3> &b);

// The inner polytope of at most so many vertices, a reference of the caller's.
pir_polytope *fewer_vertices(pir_polytope *p, uint32_t vertices);

// A scene's frames, and in place of the depth the part of the overlapping pairs that is wrong.
std::vector<Measured> measure_scene(std::string *ret_name);

// The vertices of the exact difference at a rotation.
std::vector<pir_vec3> exact_difference(const TradePair &pair, pir_quat r);

// Time against the error of depths as SVG, both on logarithmic axes, with the front of ours. `error` says what stands
// across.
void write_picture(FILE *file, const std::string &title, const char *error, const std::vector<Measured> &all);

// Ends the program with a message unless the call succeeded.
void trade_check(pir_status status);

#endif
