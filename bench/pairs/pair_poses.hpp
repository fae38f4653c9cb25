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

// The points of a body of `count` vertices on a sphere.
pir_polytope *sphere_points(int count);

#endif
