// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <numeric>

#include "results.h"

extern "C" {
#include "query/place_oracle.h"
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

uint64_t Random::first = 88172645463325252ull;

double Random::unit() {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
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

double Times::mean() const {
    return std::accumulate(ns.begin(), ns.end(), 0.0) / (double)ns.size();
}

double Times::fastest() const {
    return *std::min_element(ns.begin(), ns.end());
}

int frames() {
    return (int)results_count(1000);
}

double cpu_now() {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e9 * (double)now.tv_sec + (double)now.tv_nsec;
}

double clock_cost() {
    Times times;
    for (int i = 0; i < 10000; i++)
        times.ns.push_back(nanoseconds(0, [] {}));
    return times.median();
}

static pir_quat multiply(pir_quat a, pir_quat b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

std::vector<Pose> make_poses(pir_polytope *p, pir_polytope *q, double wish) {
    Random random;
    std::vector<Pose> poses;
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    pir_sum *sum;
    pir_query *query;
    pir_quat r{0.1, 0.2, 0.3, 0.9};
    if (pir_sum_create(p, q, r, &options, &sum) != PIR_OK || pir_query_create(sum, &query) != PIR_OK)
        std::exit(2);
    pir_vec3 axis = random.direction(), out = random.direction(), drift = random.direction();
    double size = size_of(p) + size_of(q);
    int count = frames();
    for (int i = 0; i < count; i++) {
        if (i % 50 == 0) {
            axis = random.direction();
            drift = random.direction();
        }
        double half = M_PI / 500, s = std::sin(half);
        r = multiply({axis.x * s, axis.y * s, axis.z * s, std::cos(half)}, r);
        double n = std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w);
        r = {r.x / n, r.y / n, r.z / n, r.w / n};
        out = {out.x + 0.01 * drift.x, out.y + 0.01 * drift.y, out.z + 0.01 * drift.z};
        n = std::sqrt(out.x * out.x + out.y * out.y + out.z * out.z);
        out = {out.x / n, out.y / n, out.z / n};
        pir_sum_rotate(sum, r, PIR_METHOD_AUTO);
        pir_query_input input = pir_query_input_default();
        pir_query_result result;
        // inside: a fraction of the way out from the middle; outside: the gap beyond it
        double at = 0;
        pir_vec3 low_p, high_p, low_q, high_q;
        pir_polytope_bounds(p, &low_p, &high_p);
        pir_polytope_bounds(q, &low_q, &high_q);
        pir_vec3 c{(low_q.x + high_q.x) / 2, (low_q.y + high_q.y) / 2, (low_q.z + high_q.z) / 2};
        if (pir_query_directional_depth(query, (input.translation = c, &input), out, &result) == PIR_OK &&
            result.outcome == PIR_OVERLAPPING)
            at = -result.distance;
        at = wish < 0 ? at * (1 + wish) : at + wish * size;
        poses.push_back({r, {c.x + at * out.x, c.y + at * out.y, c.z + at * out.z}});
    }
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    return poses;
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
