// SPDX-License-Identifier: MIT
//
// Derivatives beside the signed distance alone: gradients.csv has for each body with itself, hovering, and spinning a
// little deep on itself, at 50 steps a turn, the time of a signed distance of a pair, of one with its gradient, and of
// one with its Hessian too, the three on pairs of their own in turns; then the time of an active set.
//
//     bench_gradients FOLDER
#include <algorithm>
#include <cstdlib>
#include <string>

#include <pirouette/gradient.h>

#include "pair_poses.hpp"
#include "results.h"

namespace {

void check(pir_status status) {
    if (status != PIR_OK) {
        std::fprintf(stderr, "bench_gradients: %s\n", pir_status_text(status));
        std::exit(2);
    }
}

struct Asked {
    pir_pair *pair = nullptr;
    pir_workspace *workspace = nullptr;
    std::vector<double> ns;

    explicit Asked(pir_polytope *p) {
        check(pir_workspace_create(nullptr, &workspace));
        check(pir_pair_create(p, p, nullptr, &pair));
    }
    ~Asked() {
        pir_pair_destroy(pair);
        pir_workspace_destroy(workspace);
    }
    Asked(const Asked &) = delete;
    Asked &operator=(const Asked &) = delete;

    double median() {
        std::sort(ns.begin(), ns.end());
        return ns[ns.size() / 2];
    }
    double fastest() const {
        return *std::min_element(ns.begin(), ns.end());
    }
    double mean() const {
        double sum = 0;
        for (double each : ns)
            sum += each;
        return sum / (double)ns.size();
    }
};

void run(FILE *csv, const char *body, const char *motion, pir_polytope *p, const std::vector<Pose> &poses,
         double overhead) {
    Asked alone(p), first(p), second(p), set(p);
    pir_query_result result;
    pir_gradient gradient;
    pir_curvature curvature;
    pir_active active[64];
    size_t count;
    // every other frame in the other order: the last one finds the caches warm
    for (size_t i = 0; i < poses.size(); i++) {
        pir_pair_input input = pir_pair_input_default();
        input.pose_p = {poses[i].r, poses[i].t};
        for (size_t k = 0; k < 3; k++)
            switch ((i + k) % 3) {
            case 0:
                alone.ns.push_back(nanoseconds(
                    overhead, [&] { pir_pair_signed_distance(alone.pair, alone.workspace, &input, &result); }));
                break;
            case 1:
                first.ns.push_back(nanoseconds(overhead, [&] {
                    pir_pair_gradient(first.pair, first.workspace, &input, &result, &gradient, nullptr);
                }));
                break;
            default:
                second.ns.push_back(nanoseconds(overhead, [&] {
                    pir_pair_gradient(second.pair, second.workspace, &input, &result, &gradient, &curvature);
                }));
            }
        if (i % 16 == 0)
            set.ns.push_back(nanoseconds(
                overhead, [&] { pir_pair_active(set.pair, set.workspace, &input, 0, 64, active, &count); }));
    }
    const struct {
        const char *name;
        Asked &asked;
    } all[] = {{"distance", alone}, {"gradient", first}, {"Hessian", second}, {"active set", set}};
    std::printf("%-13s %-9s", body, motion);
    for (const auto &each : all) {
        const double median = each.asked.median();
        std::printf(" %9.0f", median);
        std::fprintf(csv, "%s,%s,%s,%.1f,%.1f,%.1f,%zu\n", body, motion, each.name, median, each.asked.mean(),
                     each.asked.fastest(), each.asked.ns.size());
    }
    std::printf("\n");
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: bench_gradients FOLDER\n");
        return 2;
    }
    results where = results_new(argv[1]);
    const double overhead = clock_cost();
    const int frames = (int)results_count(5000);
    struct {
        const char *name;
        pir_polytope *polytope;
    } bodies[] = {{"cube", shape("cube")},
                  {"icosahedron", shape("icosahedron")},
                  {"20 points", sphere_points(20)},
                  {"60 points", sphere_points(60)},
                  {"gs4", shape("gs4")}};
    FILE *csv = results_open(&where, "gradients.csv");
    std::fprintf(csv, "body,motion,what,median_ns,mean_ns,fastest_ns,frames\n");
    std::printf("%-13s %-9s %9s %9s %9s %9s\n", "body", "motion", "distance", "gradient", "Hessian", "active");
    for (auto &body : bodies) {
        run(csv, body.name, "hovering", body.polytope, hovering(body.polytope, body.polytope, frames, 50), overhead);
        run(csv, body.name, "spinning", body.polytope, spinning(body.polytope, body.polytope, frames, 50, 0.01),
            overhead);
        pir_polytope_release(body.polytope);
    }
    results_close(csv, "gradients.csv");
    std::printf("results in %s\n", where.folder);
    return 0;
}
