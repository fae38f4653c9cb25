// SPDX-License-Identifier: MIT
//
// Time against accuracy: what a frame takes, and the greatest error that it leaves, by every setting that trades one
// for the other. P turns by a 500th of a turn a frame, sunk into Q, and its signed distance is asked for: of a tracked
// sum with tolerances and regions, of a pair by need, of pairs of simplified bodies, of other engines by their own
// tolerances. All coordinates of the sum stand beside them: float, double, exact.
//
// A frame's time is the least of three runs, in which the ways take turns; a setting's is the mean over its frames,
// since a tolerance puts work off. Errors are the greatest, relative to the size of both bodies: of the depth, against
// the answers of the whole difference, which tests hold to rational arithmetic; of the support function over random
// directions, and the Hausdorff distance, of what is kept in some of the frames. Then a scene: the median time of a
// frame, and in place of the depth the part of the overlapping pairs that is wrong. trade.csv holds all, trade-NAME.svg
// a picture of each.
//
//     bench_trade FOLDER MODELS
#include <algorithm>
#include <cstdlib>

#include "pair_poses.hpp"
#include "results.h"
#include "trade.hpp"

namespace {

constexpr int RUNS = 3;

// Frames whose difference is compared.
constexpr size_t COMPARED = 3;

// A way with what has been seen of it.
struct Lane {
    std::unique_ptr<Way> way;
    std::vector<double> ns;
    Measured measured;
};

double greater(double so_far, double x) {
    return std::isnan(so_far) ? x : std::max(so_far, x);
}

void compare(const TradePair &pair, Lane &lane, const std::vector<pir_vec3> &exact) {
    std::vector<pir_vec3> kept = lane.way->kept();
    if (kept.empty())
        return;
    lane.measured.support = greater(lane.measured.support, support_error(kept, exact) / pair.size);
    lane.measured.hausdorff = greater(lane.measured.hausdorff, hausdorff(kept, exact) / pair.size);
}

std::vector<Measured> measure(const TradePair &pair, double overhead) {
    Ways ours, peers;
    std::vector<Lane> lanes;
    add_sums(pair, &ours);
    add_pairs(pair, &ours);
    add_peers(pair, &peers);
    for (Ways *ways : {&ours, &peers})
        for (auto &way : *ways) {
            Measured empty = {way->family, way->setting, ways == &ours, 0, NAN, NAN, NAN, 0};
            lanes.push_back({std::move(way), std::vector<double>(pair.poses.size(), HUGE_VAL), empty});
        }
    // where it only shows that tables are written, once
    size_t compared = results_count(RUNS + 1) > RUNS ? COMPARED : 1, every = pair.poses.size() / compared;
    for (int run = 0; run < RUNS; run++)
        for (Lane &lane : lanes) {
            lane.way->restart();
            for (size_t i = 0; i < pair.poses.size(); i++) {
                double distance = NAN;
                double time = nanoseconds(overhead, [&] { distance = lane.way->frame(pair.poses[i]); });
                lane.ns[i] = std::min(lane.ns[i], std::max(time, 1.0));
                if (run > 0)
                    continue;
                // an engine that does not converge may leave any number
                if (!(std::fabs(distance) < 10 * pair.size))
                    lane.measured.failed++;
                else
                    lane.measured.depth = greater(lane.measured.depth, std::fabs(distance - pair.exact[i]) / pair.size);
                if (i % every == every - 1)
                    compare(pair, lane, exact_difference(pair, pair.poses[i].r));
            }
        }
    std::vector<Measured> all;
    for (Lane &lane : lanes) {
        for (double ns : lane.ns)
            lane.measured.ns += ns / (double)lane.ns.size();
        all.push_back(lane.measured);
    }
    return all;
}

// The exact signed distances, by the whole difference.
std::vector<double> exact_distances(const TradePair &pair) {
    pir_pair_options options = pir_pair_options_default();
    pir_workspace *workspace;
    pir_pair *whole;
    std::vector<double> exact;
    options.least = PIR_LEVEL_WHOLE;
    trade_check(pir_workspace_create(nullptr, &workspace));
    trade_check(pir_pair_create(pair.p, pair.q, &options, &whole));
    for (const Pose &pose : pair.poses) {
        pir_pair_input input = pir_pair_input_default();
        pir_query_result result;
        input.pose_p = {pose.r, pose.t};
        trade_check(pir_pair_signed_distance(whole, workspace, &input, &result));
        exact.push_back(result.distance);
    }
    pir_pair_destroy(whole);
    pir_workspace_destroy(workspace);
    return exact;
}

pir_polytope *model(const std::string &folder, const char *name) {
    pir_polytope *p;
    pir_report report;
    if (pir_polytope_read((folder + "/" + name).c_str(), nullptr, &report, nullptr, &p) != PIR_OK) {
        std::fprintf(stderr, "bench_trade: %s\n", report.text);
        std::exit(2);
    }
    return p;
}

// A number, or nothing where there is none.
std::string figure(double x) {
    char text[32] = "";
    if (!std::isnan(x))
        std::snprintf(text, sizeof text, "%.3g", x);
    return text;
}

void write_all(FILE *csv, const results &where, const std::string &name, const char *error,
               const std::vector<Measured> &all) {
    for (const Measured &m : all) {
        std::printf("%-14s %-14s %-10s %10.3f %10s %10s %10s %4zu\n", name.c_str(), m.family.c_str(), m.setting.c_str(),
                    m.ns / 1e3, figure(m.depth).c_str(), figure(m.support).c_str(), figure(m.hausdorff).c_str(),
                    m.failed);
        std::fprintf(csv, "%s,%s,%s,%d,%.0f,%s,%s,%s,%zu\n", name.c_str(), m.family.c_str(), m.setting.c_str(), m.ours,
                     m.ns, figure(m.depth).c_str(), figure(m.support).c_str(), figure(m.hausdorff).c_str(), m.failed);
    }
    std::string file = "trade-" + name + ".svg";
    FILE *picture = results_open(&where, file.c_str());
    write_picture(picture, name, error, all);
    results_close(picture, file.c_str());
}

void run(FILE *csv, const results &where, const char *name, pir_polytope *p, pir_polytope *q, double overhead) {
    TradePair pair = {name, p, q, make_poses(p, q, -0.04), {}, size_of(p) + size_of(q)};
    pair.poses.resize(std::min<size_t>(pair.poses.size(), results_count(250)));
    pair.exact = exact_distances(pair);
    write_all(csv, where, name, "the greatest error of its depth, relative to the size", measure(pair, overhead));
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: bench_trade FOLDER MODELS\n");
        return 2;
    }
    results where = results_new(argv[1]);
    FILE *csv = results_open(&where, "trade.csv");
    double overhead = clock_cost();
    std::printf("%-14s %-14s %-10s %10s %10s %10s %10s %4s\n", "pair", "family", "setting", "us", "depth", "support",
                "Hausdorff", "none");
    std::fprintf(csv, "pair,family,setting,ours,frame_ns,depth,support,hausdorff,failed\n");
    pir_polytope *gamepad = model(argv[2], "gamepad.off"), *mug = model(argv[2], "mug.off"), *gs4 = shape("gs4"),
                 *ellipsoid = shape("ellipse"), *twenty = sphere_points(20);
    run(csv, where, "gamepad-mug", gamepad, mug, overhead);
    run(csv, where, "gs4-mug", gs4, mug, overhead);
    run(csv, where, "gs4", gs4, gs4, overhead);
    run(csv, where, "ellipsoid960", ellipsoid, ellipsoid, overhead);
    run(csv, where, "20-points", twenty, twenty, overhead);
    std::string scene;
    std::vector<Measured> all = measure_scene(&scene);
    write_all(csv, where, scene, "the part of the overlapping pairs that it gets wrong", all);
    for (pir_polytope *p : {gamepad, mug, gs4, ellipsoid, twenty})
        pir_polytope_release(p);
    results_close(csv, "trade.csv");
    return 0;
}
