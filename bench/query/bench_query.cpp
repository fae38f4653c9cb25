// SPDX-License-Identifier: MIT
//
// Placement queries beside FCL, Bullet and libccd, over the same poses: P turns by 1/500 of a turn a frame about an axis that changes every 50
// frames, and drifts. Each line gives the median and the fastest time of a query over 1000 poses in microseconds; ours with the sum at hand and
// the witness of the pose before, the same with an empty cache, and with the update of the sum. Then what was wrong: states and numbers
// against ours, which the property tests hold to exact arithmetic.
//
//     bench_query [CSV]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <pirouette/pirouette.h>
#include <pirouette/query.h>

#include "peers.hpp"

namespace {

constexpr int FRAMES = 1000;

struct Pose {
    pir_quat r;
    pir_vec3 t;
};

struct Body {
    std::string name;
    pir_polytope *polytope;
};

pir_polytope *from_points(const std::vector<pir_vec3> &points) {
    pir_polytope *p = nullptr;
    if (pir_polytope_create(points.data(), points.size(), nullptr, &p) != PIR_OK) {
        std::fprintf(stderr, "bench_query: cannot make a body\n");
        std::exit(2);
    }
    return p;
}

pir_polytope *shape(const char *name, double x = 1, double y = 1, double z = 1) {
    pir_polytope *p = nullptr;
    pir_report report;
    if (pir_shape_create(name, nullptr, &report, &p) != PIR_OK) {
        std::fprintf(stderr, "bench_query: %s\n", report.text);
        std::exit(2);
    }
    std::vector<pir_vec3> points;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        pir_vec3 c = pir_polytope_vertex(p, v);
        points.push_back({c.x * x, c.y * y, c.z * z});
    }
    pir_polytope_release(p);
    return from_points(points);
}

double size_of(const pir_polytope *p) {
    double most = 0;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        pir_vec3 c = pir_polytope_vertex(p, v);
        most = std::max(most, std::sqrt(c.x * c.x + c.y * c.y + c.z * c.z));
    }
    return most;
}

struct Random {
    uint64_t state;
    double unit() {
        state ^= state << 13, state ^= state >> 7, state ^= state << 17;
        return std::ldexp((double)(state >> 11), -52) - 1;
    }
    pir_vec3 direction() {
        for (;;) {
            pir_vec3 v{unit(), unit(), unit()};
            double n = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
            if (n > 0.1 && n <= 1)
                return {v.x / n, v.y / n, v.z / n};
        }
    }
};

pir_quat multiply(pir_quat a, pir_quat b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

// Rotations, and translations at a wished signed distance: along a drifting direction, as far as the exact directional query says.
std::vector<Pose> make_poses(pir_polytope *p, pir_polytope *q, double wish) {
    Random random{88172645463325252ull};
    std::vector<Pose> poses;
    pir_sum_options options = pir_sum_options_default();
    options.difference = 1;
    pir_sum *sum;
    pir_query *query;
    pir_quat r{0.1, 0.2, 0.3, 0.9};
    if (pir_sum_create(p, q, r, &options, &sum) != PIR_OK || pir_query_create(sum, &query) != PIR_OK)
        std::exit(2);
    pir_vec3 axis = random.direction(), out = random.direction(), drift = random.direction();
    double size = size_of(p) + size_of(q);
    for (int i = 0; i < FRAMES; i++) {
        if (i % 50 == 0)
            axis = random.direction(), drift = random.direction();
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
        pir_polytope_bounds(p, &low_p, &high_p), pir_polytope_bounds(q, &low_q, &high_q);
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

using clock_type = std::chrono::steady_clock;

struct Times {
    std::vector<double> ns;
    double median() {
        std::nth_element(ns.begin(), ns.begin() + (long)ns.size() / 2, ns.end());
        return ns[ns.size() / 2];
    }
    double fastest() {
        return *std::min_element(ns.begin(), ns.end());
    }
};

double clock_cost() {
    Times times;
    for (int i = 0; i < 10000; i++) {
        auto a = clock_type::now();
        auto b = clock_type::now();
        times.ns.push_back(std::chrono::duration<double, std::nano>(b - a).count());
    }
    return times.median();
}

struct Ours {
    Times warm, cold, frame;
    std::vector<pir_query_result> results;
    int failures = 0;
};

Ours run_ours(pir_polytope *p, pir_polytope *q, const std::vector<Pose> &poses, bool deep, double overhead) {
    Ours ours;
    pir_sum_options options = pir_sum_options_default();
    options.difference = 1;
    pir_sum *sum;
    pir_query *query, *fresh;
    if (pir_sum_create(p, q, poses[0].r, &options, &sum) != PIR_OK || pir_query_create(sum, &query) != PIR_OK ||
        pir_query_create(sum, &fresh) != PIR_OK)
        std::exit(2);
    auto ask = deep ? pir_query_penetration : pir_query_distance;
    pir_query_cache cache = {};
    for (int pass = 0; pass < 2; pass++)
        for (const Pose &pose : poses) {
            pir_query_input input = pir_query_input_default();
            input.translation = pose.t;
            pir_query_result result;
            auto a = clock_type::now();
            pir_sum_rotate(sum, pose.r, PIR_METHOD_AUTO);
            auto b = clock_type::now();
            pir_status status = ask(query, &input, &cache, &result);
            auto c = clock_type::now();
            if (pass == 0)
                continue;
            double update = std::chrono::duration<double, std::nano>(b - a).count() - overhead;
            double time = std::chrono::duration<double, std::nano>(c - b).count() - overhead;
            ours.warm.ns.push_back(time);
            ours.frame.ns.push_back(update + time);
            ours.results.push_back(result);
            ours.failures += status != PIR_OK || result.outcome == PIR_STEP_LIMIT;
        }
    // cold: a query object that has seen nothing, an empty cache
    for (size_t i = 0; i < poses.size(); i += 10) {
        pir_sum_rotate(sum, poses[i].r, PIR_METHOD_AUTO);
        pir_query_destroy(fresh);
        if (pir_query_create(sum, &fresh) != PIR_OK)
            std::exit(2);
        pir_query_input input = pir_query_input_default();
        input.translation = poses[i].t;
        pir_query_result result;
        auto a = clock_type::now();
        ask(fresh, &input, nullptr, &result);
        auto b = clock_type::now();
        ours.cold.ns.push_back(std::chrono::duration<double, std::nano>(b - a).count() - overhead);
    }
    pir_query_destroy(fresh);
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    return ours;
}

void run_set(FILE *csv, const char *set, const char *situation, pir_polytope *p, pir_polytope *q, double wish,
             double overhead) {
    std::vector<Pose> poses = make_poses(p, q, wish);
    bool deep = wish < 0;
    Ours ours = run_ours(p, q, poses, deep, overhead);
    double size = size_of(p) + size_of(q);
    auto line = [&](const char *who, double median, double fastest, double error, int wrong, int failed) {
        std::printf("%-14s %-9s %-16s %9.3f %9.3f  %9.2e %5d %5d\n", set, situation, who, median / 1e3, fastest / 1e3,
                    error, wrong, failed);
        if (csv)
            std::fprintf(csv, "%s,%s,%s,%.1f,%.1f,%.3e,%d,%d\n", set, situation, who, median, fastest, error, wrong,
                         failed);
    };
    line("ours warm", ours.warm.median(), ours.warm.fastest(), 0, 0, ours.failures);
    line("ours cold", ours.cold.median(), ours.cold.fastest(), 0, 0, 0);
    line("ours frame", ours.frame.median(), ours.frame.fastest(), 0, 0, 0);
    for (auto &peer : make_peers(p, q)) {
        Times times;
        double error = 0;
        int wrong = 0, failed = 0;
        for (size_t i = 0; i < poses.size(); i++) {
            PeerAnswer answer;
            peer->place(poses[i].r, poses[i].t);
            auto a = clock_type::now();
            answer = peer->ask(deep);
            auto b = clock_type::now();
            times.ns.push_back(std::chrono::duration<double, std::nano>(b - a).count() - overhead);
            failed += answer.failed;
            if (answer.failed)
                continue;
            const pir_query_result &right = ours.results[i];
            wrong += answer.overlaps != (right.state == PIR_INSIDE) && right.state != PIR_BOUNDARY;
            if (answer.has_distance)
                error = std::max(error, std::fabs(answer.distance - right.distance) / size);
        }
        line(peer->name(), times.median(), times.fastest(), error, wrong, failed);
    }
}

} // namespace

int main(int argc, char **argv) {
    FILE *csv = argc > 1 ? std::fopen(argv[1], "w") : nullptr;
    if (argc > 1 && !csv) {
        std::fprintf(stderr, "bench_query: cannot write %s\n", argv[1]);
        return 2;
    }
    double overhead = clock_cost();
    std::vector<Body> bodies = {{"cubes", shape("cube")},
                                {"icosahedra", shape("icosahedron")},
                                {"gs4", shape("gs4")},
                                {"ellipsoid960", shape("ellipse")},
                                {"flat 1e-6", shape("cube", 1, 1, 1e-6)},
                                {"needles 1:100", shape("cube", 1, 1, 100)},
                                {"cubes 1e-6", shape("cube", 1e-6, 1e-6, 1e-6)},
                                {"cubes 1e6", shape("cube", 1e6, 1e6, 1e6)}};
    std::vector<pir_vec3> away;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(bodies[0].polytope); v++) {
        pir_vec3 c = pir_polytope_vertex(bodies[0].polytope, v);
        away.push_back({c.x + 1e7, c.y + 1e7, c.z + 1e7});
    }
    std::printf("%-14s %-9s %-16s %9s %9s  %9s %5s %5s\n", "set", "poses", "who", "median us", "fastest", "error",
                "wrong", "fail");
    if (csv)
        std::fprintf(csv, "set,poses,who,median_ns,fastest_ns,largest_error,wrong_states,failures\n");
    for (Body &body : bodies) {
        run_set(csv, body.name.c_str(), "separated", body.polytope, body.polytope, 0.25, overhead);
        run_set(csv, body.name.c_str(), "near", body.polytope, body.polytope, 1e-7, overhead);
        run_set(csv, body.name.c_str(), "deep", body.polytope, body.polytope, -0.4, overhead);
    }
    // the standing body far away, P at its own origin brought there by the translation
    pir_polytope *far_cube = from_points(away);
    run_set(csv, "offset 1e7", "separated", bodies[0].polytope, far_cube, 0.25 * 1e-7, overhead);
    run_set(csv, "offset 1e7", "deep", bodies[0].polytope, far_cube, -0.4, overhead);
    pir_polytope_release(far_cube);
    for (Body &body : bodies)
        pir_polytope_release(body.polytope);
    if (csv)
        std::fclose(csv);
    return 0;
}
