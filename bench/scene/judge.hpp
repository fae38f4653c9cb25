// SPDX-License-Identifier: MIT
// Exact answers: of all pairs of bodies whose spheres meet, each by the level `whole` of a pair made for it.
#ifndef BENCH_SCENE_JUDGE_HPP
#define BENCH_SCENE_JUDGE_HPP

#include "scene_peers.hpp"

// All pairs of bodies that share a point in a frame.
std::vector<BodyPair> exact_pairs(const Recording &recording, const std::vector<pir_pose> &poses);

// How many pairs are in one list alone.
size_t differences(std::vector<BodyPair> a, std::vector<BodyPair> b);

#endif
