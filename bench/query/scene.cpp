// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

extern "C" {
#include "../../tests/query/place_oracle.h"
}

pir_polytope *from_points(const std::vector<pir_vec3> &points) {
    pir_polytope *p = nullptr;
    if (pir_polytope_create(points.data(), points.size(), nullptr, &p) != PIR_OK) {
        std::fprintf(stderr, "bench_query: cannot make a body\n");
        std::exit(2);
    }
    return p;
}

pir_polytope *shape(const char *name, pir_vec3 scale, pir_vec3 offset) {
    pir_polytope *p = nullptr;
    pir_report report;
    if (pir_shape_create(name, nullptr, &report, &p) != PIR_OK) {
        std::fprintf(stderr, "bench_query: %s\n", report.text);
        std::exit(2);
    }
    std::vector<pir_vec3> points;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        pir_vec3 c = pir_polytope_vertex(p, v);
        points.push_back({c.x * scale.x + offset.x, c.y * scale.y + offset.y, c.z * scale.z + offset.z});
    }
    pir_polytope_release(p);
    return from_points(points);
}

double size_of(const pir_polytope *p) {
    pir_vec3 low, high;
    pir_polytope_bounds(p, &low, &high);
    double most = 0;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        pir_vec3 c = pir_polytope_vertex(p, v);
        most = std::max(most,
                        std::hypot(c.x - (low.x + high.x) / 2, c.y - (low.y + high.y) / 2, c.z - (low.z + high.z) / 2));
    }
    return most;
}

double Random::unit() {
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    return std::ldexp((double)(state >> 11), -52) - 1;
}

pir_vec3 Random::direction() {
    for (;;) {
        pir_vec3 v{unit(), unit(), unit()};
        double n = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
        if (n > 0.1 && n <= 1)
            return {v.x / n, v.y / n, v.z / n};
    }
}

double Times::median() {
    std::nth_element(ns.begin(), ns.begin() + (long)ns.size() / 2, ns.end());
    return ns[ns.size() / 2];
}

double Times::fastest() const {
    return *std::min_element(ns.begin(), ns.end());
}

double clock_cost() {
    Times times;
    for (int i = 0; i < 10000; i++)
        times.ns.push_back(nanoseconds(0, [] {}));
    return times.median();
}

std::vector<Exact> exact_answers(pir_polytope *p, pir_polytope *q, const std::vector<Pose> &poses) {
    std::vector<Exact> answers;
    for (const Pose &pose : poses) {
        place_oracle *oracle = place_oracle_make(p, q, pose.r);
        place_answer answer = place_oracle_ask(oracle, pose.t);
        place_oracle_free(oracle);
        answers.push_back({answer.state, answer.state == PIR_OUTSIDE  ? answer.distance
                                         : answer.state == PIR_INSIDE ? -answer.depth
                                                                      : 0});
    }
    return answers;
}
