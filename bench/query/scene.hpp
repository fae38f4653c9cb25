// SPDX-License-Identifier: MIT
// What the query benchmarks share: bodies, poses, a clock, and the exact answers.
#ifndef PIR_BENCH_SCENE_HPP
#define PIR_BENCH_SCENE_HPP

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <pirouette/pirouette.h>
#include <pirouette/query.h>

struct Pose {
    pir_quat r;
    pir_vec3 t;
};

// The same numbers everywhere, from `first`, which is not 0.
struct Random {
    static uint64_t first;
    uint64_t state = first;
    double unit(); // from −1 to 1
    pir_vec3 direction();
};

// Bodies, or an end with a message.
pir_polytope *from_points(const std::vector<pir_vec3> &points);
pir_polytope *shape(const char *name, pir_vec3 scale = {1, 1, 1}, pir_vec3 offset = {0, 0, 0});

// The farthest vertex from the body's own middle.
double size_of(const pir_polytope *p);

// How many poses a set has: 1,000, or few where results_count says so.
int frames();

// Rotations of 1/500 of a turn each, about an axis that changes every 50 poses, and translations at a wished signed
// distance: along a drifting direction, as far as the exact directional query says.
std::vector<Pose> make_poses(pir_polytope *p, pir_polytope *q, double wish);

struct Times {
    std::vector<double> ns;
    double median();
    double mean() const;
    double fastest() const;
};

using clock_type = std::chrono::steady_clock;

// What the clock itself takes.
double clock_cost();

template <class Work> double nanoseconds(double overhead, Work &&work) {
    auto from = clock_type::now();
    work();
    auto to = clock_type::now();
    return std::chrono::duration<double, std::nano>(to - from).count() - overhead;
}

// In CPU time of the thread, which looking at takes half a microsecond: for work that takes far longer.
double cpu_now();

template <class Work> double cpu_nanoseconds(Work &&work) {
    double from = cpu_now();
    work();
    return cpu_now() - from;
}

// The state and signed distance at a pose, from the exact hull of all pairwise sums, in rationals; rounded once.
struct Exact {
    pir_state state;
    double distance;
};
std::vector<Exact> exact_answers(pir_polytope *p, pir_polytope *q, const std::vector<Pose> &poses);

// Many translations at one rotation: a line each for states, depths and distances, per translation.
void run_batches(FILE *csv, const char *set, pir_polytope *p);

#endif
