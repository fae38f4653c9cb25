// SPDX-License-Identifier: MIT
//
// Placement queries beside FCL, Bullet and libccd, over the same poses: P turns by 1/500 of a turn a frame about an
// axis that changes every 50 frames, and drifts; or the poses of a degenerate set. Each line gives the median and the
// fastest time of a query in microseconds; ours with the sum at hand and the witness of the pose before, the same with
// an empty cache, and with the update of the sum. Then what was wrong: the largest error of a number relative to the
// bodies' size, states, numbers off by more than 1e-6 of it, failures. Wrong is what differs from the exact answer,
// ours being held to it as well; where bodies are too large for that at every pose, from ours, which the property tests
// hold to it.
//
// Last, many translations at one rotation, per translation, in CPU time. All lines go to query.csv.
//
//     bench_query FOLDER
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>

#include "peers.hpp"
#include "results.h"
#include "scene.hpp"

namespace {

// A number this far off, relative to the bodies' size, is wrong.
constexpr double WRONG = 1e-6;

// Up to as many pairs of vertices, poses are answered exactly.
constexpr uint32_t EXACT_PAIRS = 200;

enum Query { SEPARATION, DEPTH, SIGNED };

using Call = pir_status (*)(pir_query *, const pir_query_input *, pir_query_cache *, pir_query_result *);

Call call_of(Query query) {
    return query == DEPTH        ? pir_query_penetration
           : query == SEPARATION ? pir_query_distance
                                 : pir_query_signed_distance;
}

struct Ours {
    Times warm, cold, frame;
    std::vector<pir_query_result> warm_results, cold_results; // the cold ones at every tenth pose
    int failures = 0;
};

Ours run_ours(pir_polytope *p, pir_polytope *q, const std::vector<Pose> &poses, Query what, double overhead) {
    Ours ours;
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    pir_sum *sum;
    pir_query *query, *fresh;
    if (pir_sum_create(p, q, poses[0].r, &options, &sum) != PIR_OK || pir_query_create(sum, &query) != PIR_OK ||
        pir_query_create(sum, &fresh) != PIR_OK)
        std::exit(2);
    Call ask = call_of(what);
    pir_query_cache cache = {};
    for (int pass = 0; pass < 2; pass++)
        for (const Pose &pose : poses) {
            pir_query_input input = pir_query_input_default();
            input.translation = pose.t;
            pir_query_result result;
            pir_status status = PIR_OK;
            double update = nanoseconds(overhead, [&] { pir_sum_rotate(sum, pose.r, PIR_METHOD_AUTO); });
            double time = nanoseconds(overhead, [&] { status = ask(query, &input, &cache, &result); });
            if (pass == 0)
                continue;
            ours.warm.ns.push_back(time);
            ours.frame.ns.push_back(update + time);
            ours.warm_results.push_back(result);
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
        ours.cold.ns.push_back(nanoseconds(overhead, [&] { ask(fresh, &input, nullptr, &result); }));
        ours.cold_results.push_back(result);
    }
    pir_query_destroy(fresh);
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    return ours;
}

// What differs from the right answers.
struct Verdict {
    double error = 0;
    int wrong_states = 0, wrong_numbers = 0, failures = 0;

    void hear(double number, double right, double size) {
        double off = std::fabs(number - right) / size;
        error = std::max(error, off);
        wrong_numbers += !(off <= WRONG);
    }
};

Verdict judge(const std::vector<pir_query_result> &results, const std::vector<Exact> &right, size_t step, double size) {
    Verdict verdict;
    for (size_t i = 0; i < results.size(); i++) {
        verdict.wrong_states += results[i].state != right[i * step].state;
        verdict.hear(results[i].distance, right[i * step].distance, size);
    }
    return verdict;
}

// One set of poses of two bodies, with a name, and how it is run.
struct Set {
    const char *name, *situation;
    pir_polytope *p, *q;
    std::vector<Pose> poses;
    Query what;
    bool exactly, guarded; // held to exact answers; peers that may crash run in a process of their own
};

void print_line(FILE *csv, const Set &set, const char *who, Times times, const Verdict &v) {
    const char *reference = set.exactly ? "exact" : "ours";
    std::printf("%-14s %-9s %-16s %9.3f %9.3f  %9.2e %5d %5d %5d  %s\n", set.name, set.situation, who,
                times.median() / 1e3, times.fastest() / 1e3, v.error, v.wrong_states, v.wrong_numbers, v.failures,
                reference);
    std::fprintf(csv, "%s,%s,%s,%.1f,%.1f,%.1f,%.3e,%d,%d,%d,%s\n", set.name, set.situation, who, times.median(),
                 times.mean(), times.fastest(), v.error, v.wrong_states, v.failures, v.wrong_numbers, reference);
}

void run_peer(FILE *csv, const Set &set, Peer &peer, const std::vector<Exact> &right, double overhead) {
    const std::vector<Pose> &poses = set.poses;
    const double size = size_of(set.p) + size_of(set.q);
    Times times;
    Verdict verdict;
    for (size_t i = 0; i < poses.size(); i++) {
        PeerAnswer answer;
        bool inside = right[i].state == PIR_INSIDE;
        peer.place(poses[i].r, poses[i].t);
        times.ns.push_back(
            nanoseconds(overhead, [&] { answer = set.guarded ? peer.ask_guarded(inside) : peer.ask(inside); }));
        verdict.failures += answer.failed;
        if (answer.failed)
            continue;
        // peers have no word for touching
        verdict.wrong_states += answer.overlaps != inside && right[i].state != PIR_BOUNDARY;
        if (answer.has_distance)
            verdict.hear(answer.distance, right[i].distance, size);
    }
    print_line(csv, set, peer.name(), times, verdict);
}

void run_set(FILE *csv, double overhead, const Set &set) {
    Ours ours = run_ours(set.p, set.q, set.poses, set.what, overhead);
    double size = size_of(set.p) + size_of(set.q);
    std::vector<Exact> right;
    if (set.exactly)
        right = exact_answers(set.p, set.q, set.poses);
    else
        for (const pir_query_result &result : ours.warm_results)
            right.push_back({result.state, result.distance});
    Verdict warm = judge(ours.warm_results, right, 1, size), cold = judge(ours.cold_results, right, 10, size);
    warm.failures = ours.failures;
    print_line(csv, set, "ours warm", ours.warm, warm);
    print_line(csv, set, "ours cold", ours.cold, cold);
    print_line(csv, set, "ours frame", ours.frame, warm);
    for (auto &peer : make_peers(set.p, set.q))
        run_peer(csv, set, *peer, right, overhead);
}

void run_body(FILE *csv, const char *set, pir_polytope *p, pir_polytope *q, bool near, double overhead) {
    bool exactly = pir_polytope_vertex_count(p) * pir_polytope_vertex_count(q) <= EXACT_PAIRS;
    run_set(csv, overhead, {set, "separated", p, q, make_poses(p, q, 0.25), SEPARATION, exactly, false});
    if (near)
        run_set(csv, overhead, {set, "near", p, q, make_poses(p, q, 1e-7), SEPARATION, exactly, false});
    run_set(csv, overhead, {set, "deep", p, q, make_poses(p, q, -0.4), DEPTH, exactly, false});
}

// --- degenerate poses

// Gaps from none through tiny ones to a tenth, on either side.
double some_gap(Random &random) {
    double k = std::floor(20 * std::fabs(random.unit())), gap = k == 0 ? 0 : std::pow(10, -k) * 2;
    return random.unit() < 0 ? -gap : gap;
}

// Cubes of half side h with their faces exactly parallel.
std::vector<Pose> face_to_face(double h) {
    static const pir_quat turns[] = {{0, 0, 0, 1}, {0, 0, 1, 1}, {1, 0, 0, 1}, {1, 1, 1, 1}};
    Random random;
    std::vector<Pose> poses;
    for (int i = 0; i < frames(); i++) {
        double t[3] = {h * random.unit(), h * random.unit(), h * random.unit()};
        double out = 2 * h * (1 + some_gap(random));
        t[i % 3] = random.unit() < 0 ? -out : out;
        poses.push_back({turns[4 * i / frames()], {t[0], t[1], t[2]}});
    }
    return poses;
}

// An edge of P across one of Q: P turned by a quarter about (1, 1, 0), so that its edges along z come to lie across
// Q's.
std::vector<Pose> edge_to_edge(double h) {
    Random random;
    std::vector<Pose> poses;
    for (int i = 0; i < frames(); i++) {
        double at = 2 * h * (1 + some_gap(random));
        poses.push_back({{1, 1, 0, std::sqrt(2.0)}, {at, at, 0.5 * h * random.unit()}});
    }
    return poses;
}

// Centres together or nearly, at any rotation.
std::vector<Pose> concentric(int count) {
    Random random;
    std::vector<Pose> poses;
    for (int i = 0; i < count; i++) {
        double away = i % 4 == 0 ? 0 : std::pow(10, -3.0 * (i % 5));
        pir_vec3 d = random.direction();
        pir_quat r{random.unit(), random.unit(), random.unit(), random.unit()};
        poses.push_back({i == 0 ? pir_quat{0, 0, 0, 1} : r, {away * d.x, away * d.y, away * d.z}});
    }
    return poses;
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: bench_query FOLDER\n");
        return 2;
    }
    results where = results_new(argv[1]);
    FILE *csv = results_open(&where, "query.csv");
    double overhead = clock_cost();
    struct {
        std::string name;
        pir_polytope *polytope;
    } bodies[] = {{"cubes", shape("cube")},
                  {"icosahedra", shape("icosahedron")},
                  {"gs4", shape("gs4")},
                  {"ellipsoid960", shape("ellipse")},
                  {"flat 1e-6", shape("cube", {1, 1, 1e-6})},
                  {"needles 1:100", shape("cube", {1, 1, 100})},
                  {"cubes 1e-6", shape("cube", {1e-6, 1e-6, 1e-6})},
                  {"cubes 1e6", shape("cube", {1e6, 1e6, 1e6})}};
    std::printf("%-14s %-9s %-16s %9s %9s  %9s %5s %5s %5s  %s\n", "set", "poses", "who", "median us", "fastest",
                "error", "state", "wrong", "fail", "against");
    std::fprintf(
        csv,
        "set,poses,who,median_ns,mean_ns,fastest_ns,largest_error,wrong_states,failures,wrong_numbers,reference\n");
    // what comes first would pay for the processor's waking
    run_ours(bodies[0].polytope, bodies[0].polytope, make_poses(bodies[0].polytope, bodies[0].polytope, 0.25),
             SEPARATION, overhead);
    for (auto &body : bodies)
        run_body(csv, body.name.c_str(), body.polytope, body.polytope, true, overhead);
    // the standing body far away, P at its own origin brought there by the translation
    pir_polytope *far_cube = shape("cube", {1, 1, 1}, {1e7, 1e7, 1e7});
    run_body(csv, "offset 1e7", bodies[0].polytope, far_cube, true, overhead);
    pir_polytope_release(far_cube);
    pir_polytope *cube = bodies[0].polytope, *gs4 = bodies[2].polytope;
    pir_vec3 low, high;
    pir_polytope_bounds(cube, &low, &high);
    run_set(csv, overhead, {"cubes", "face-face", cube, cube, face_to_face(high.x), SIGNED, true, true});
    run_set(csv, overhead, {"cubes", "edge-edge", cube, cube, edge_to_edge(high.x), SIGNED, true, true});
    run_set(csv, overhead, {"cubes", "together", cube, cube, concentric(frames()), DEPTH, true, true});
    run_set(csv, overhead, {"gs4", "together", gs4, gs4, concentric((int)results_count(40)), DEPTH, true, true});
    run_batches(csv, "gs4", gs4);
    for (auto &body : bodies)
        pir_polytope_release(body.polytope);
    results_close(csv, "query.csv");
    std::printf("results in %s\n", where.folder);
    return 0;
}
