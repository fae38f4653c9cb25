// SPDX-License-Identifier: MIT
// What the benchmark asks of an engine: a recording's bodies brought to the poses of a frame, with pairs and contacts.
#ifndef BENCH_SCENE_PEERS_HPP
#define BENCH_SCENE_PEERS_HPP

#include <utility>

#include "recording.hpp"

// A body's number: statics first, as in the recording, then the others.
using BodyPair = std::pair<uint32_t, uint32_t>;

class ScenePeer {
  public:
    virtual ~ScenePeer() = default;
    virtual const char *name() const = 0;
    // Timed: all or the given bodies to their poses of the frame, pairs found, contacts made.
    virtual void set(const std::vector<uint32_t> &moved, const std::vector<pir_pose> &poses) = 0;
    // Not timed: the pairs of bodies that it now holds for overlapping, the lesser number first.
    virtual void overlapping(std::vector<BodyPair> *ret_pairs) = 0;
    // Bytes that it holds, where it tells; else 0.
    virtual size_t bytes() const {
        return 0;
    }
};

// NULL where the engine cannot hold the recording's bodies.
std::unique_ptr<ScenePeer> make_our_scene(const Recording &recording, uint32_t threads, double reuse);
std::unique_ptr<ScenePeer> make_bullet_scene(const Recording &recording);
std::unique_ptr<ScenePeer> make_fcl_scene(const Recording &recording);
std::unique_ptr<ScenePeer> make_box3d_scene(const Recording &recording, bool reuse);

#endif
