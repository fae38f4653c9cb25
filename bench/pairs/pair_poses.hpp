// SPDX-License-Identifier: MIT
// Poses of the pair benchmarks: P hovers about contact with Q, or rests on it.
#ifndef PIR_BENCH_PAIR_POSES_HPP
#define PIR_BENCH_PAIR_POSES_HPP

#include "scene.hpp"

// `count` frames: P turns by 1/steps of a turn each, about an axis that changes every 50 frames; it comes from a
// direction that drifts, to within 5 % of the bodies' diameter of contact on either side.
std::vector<Pose> hovering(pir_polytope *p, pir_polytope *q, int count, int steps);

// A body that turns about z by 1/steps of a turn a frame, its lowest facet exactly on Q's highest or in it by `depth`.
std::vector<Pose> spinning(pir_polytope *p, pir_polytope *q, int count, int steps, double depth);

// Aligned with Q, at `away` of the way to contact along a direction that drifts.
std::vector<Pose> aligned(pir_polytope *p, pir_polytope *q, int count, double away);

// From apart by `away` of the way to contact, or deep where that is negative, else as hovering.
std::vector<Pose> away_from_contact(pir_polytope *p, pir_polytope *q, int count, int steps, double away);

// Frames in an order in which none is near the one before.
std::vector<Pose> teleports(const std::vector<Pose> &poses);

// Both bodies in the world, and P as Q sees it.
struct Place {
    Pose p, q, relative;
};

// Q stands at the origin.
std::vector<Place> q_stands(const std::vector<Pose> &poses);

// Q turns by 1/steps of a turn a frame, about an axis that changes every 50 frames, and goes its way; P as it did to Q.
std::vector<Place> both_move(const std::vector<Pose> &poses, int steps);

// The points of a body of `count` vertices on a sphere.
pir_polytope *sphere_points(int count);

// A flat body of long thin facets and nearly parallel edges: `count` points about a rim, in pairs 1e-4 apart.
pir_polytope *sliver_points(int count);

#endif
