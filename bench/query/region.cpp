// SPDX-License-Identifier: MIT
//
// A frame of a controller that knows where the bodies last stood out of each other: the region is set about the last
// witness' normal, the sum updated, the penetration asked for. By the half-angle of the region; beside FCL and Bullet,
// which keep nothing, over the same poses as in bench_query, "deep". `agree` is the part of the frames whose depth is
// the whole sum's.
//
// All lines go to query_region.csv.
//
//     bench_query_region FOLDER
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <pirouette/query.h>

#include "peers.hpp"
#include "results.h"
#include "scene.hpp"

namespace {

constexpr double WIDTHS[] = {180, 60, 30, 15};

struct Tracked {
    pir_sum *sum;
    pir_query *query;
    pir_query_cache cache;
    pir_vec3 axis;
    double half_angle;
    Times set, update, ask, frame;
    int agree;
};

void need(pir_status status) {
    if (status == PIR_OK)
        return;
    std::fprintf(stderr, "bench_query_region: %s\n", pir_status_text(status));
    std::exit(1);
}

double between(clock_type::time_point a, clock_type::time_point b, double overhead) {
    return std::chrono::duration<double, std::nano>(b - a).count() - overhead;
}

// One frame; returns the depth.
double run_frame(Tracked &t, const Pose &pose, double overhead) {
    pir_query_input input = pir_query_input_default();
    input.translation = pose.t;
    pir_query_result result;
    auto a = clock_type::now();
    need(pir_sum_set_region(t.sum, t.axis, t.half_angle));
    auto b = clock_type::now();
    need(pir_sum_rotate(t.sum, pose.r, PIR_METHOD_AUTO));
    auto c = clock_type::now();
    need(pir_query_penetration(t.query, &input, &t.cache, &result));
    auto d = clock_type::now();
    t.set.ns.push_back(between(a, b, overhead));
    t.update.ns.push_back(between(b, c, overhead));
    t.ask.ns.push_back(between(c, d, overhead));
    t.frame.ns.push_back(between(a, b, overhead) + between(b, c, overhead) + between(c, d, overhead));
    if (result.outcome == PIR_OVERLAPPING || result.outcome == PIR_NOT_SEPARATED)
        t.axis = result.normal;
    return -result.distance;
}

void run_set(FILE *csv, const char *set, pir_polytope *body, double overhead) {
    std::vector<Pose> poses = make_poses(body, body, -0.4);
    std::vector<Tracked> all;
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    for (double width : WIDTHS) {
        Tracked t = {};
        t.half_angle = width < 180 ? width * M_PI / 180 : 4;
        need(pir_sum_create(body, body, poses[0].r, &options, &t.sum));
        need(pir_query_create(t.sum, &t.query));
        pir_query_input input = pir_query_input_default();
        input.translation = poses[0].t;
        pir_query_result result;
        need(pir_query_penetration(t.query, &input, &t.cache, &result));
        t.axis = result.normal;
        all.push_back(t);
    }
    auto peers = make_peers(body, body);
    std::vector<Times> peer_times(peers.size());
    for (int pass = 0; pass < 2; pass++) {
        for (Tracked &t : all) {
            t.set = t.update = t.ask = t.frame = Times{};
            t.agree = 0;
        }
        for (const Pose &pose : poses) {
            double depth = 0;
            for (Tracked &t : all) {
                double mine = run_frame(t, pose, overhead);
                depth = t.half_angle > M_PI ? mine : depth;
                t.agree += std::fabs(mine - depth) <= 1e-9;
            }
            for (size_t k = 0; k < peers.size(); k++) {
                peers[k]->place(pose.r, pose.t);
                auto a = clock_type::now();
                peers[k]->ask(true);
                auto b = clock_type::now();
                if (pass > 0)
                    peer_times[k].ns.push_back(between(a, b, overhead));
            }
        }
    }
    for (size_t k = 0; k < all.size(); k++) {
        Tracked &t = all[k];
        double agree = (double)t.agree / (double)poses.size();
        std::printf("%-14s ours frame, region %3.0f  %8.3f  %8.3f %8.3f %8.3f  %5.3f\n", set, WIDTHS[k],
                    t.frame.median() / 1e3, t.set.median() / 1e3, t.update.median() / 1e3, t.ask.median() / 1e3, agree);
        std::fprintf(csv, "%s,ours frame region %.0f,%.1f,%.1f,%.1f,%.1f,%.4f\n", set, WIDTHS[k], t.frame.median(),
                     t.set.median(), t.update.median(), t.ask.median(), agree);
        pir_query_destroy(t.query);
        pir_sum_destroy(t.sum);
    }
    for (size_t k = 0; k < peers.size(); k++) {
        std::printf("%-14s %-22s  %8.3f\n", set, peers[k]->name(), peer_times[k].median() / 1e3);
        std::fprintf(csv, "%s,%s,%.1f,,,,\n", set, peers[k]->name(), peer_times[k].median());
    }
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: bench_query_region FOLDER\n");
        return 2;
    }
    results where = results_new(argv[1]);
    FILE *csv = results_open(&where, "query_region.csv");
    double overhead = clock_cost();
    std::printf("medians in us\n%-14s %-22s  %8s  %8s %8s %8s  %5s\n", "set", "who", "frame", "region", "update", "ask",
                "agree");
    std::fprintf(csv, "set,who,frame_ns,region_ns,update_ns,ask_ns,agree\n");
    struct {
        const char *name;
        pir_polytope *polytope;
    } bodies[] = {{"gs4", shape("gs4")}, {"ellipsoid960", shape("ellipse")}};
    for (auto &body : bodies) {
        run_set(csv, body.name, body.polytope, overhead);
        pir_polytope_release(body.polytope);
    }
    results_close(csv, "query_region.csv");
    std::printf("results in %s\n", where.folder);
    return 0;
}
