// SPDX-License-Identifier: MIT
//
// Many poses of one pair: a loop of the caller's own over single calls, and a batch on one thread and on two.
//
// batch.csv has a line for each body with itself: a million poses that hover about contact, at 500 steps a turn. Ways
// take turns in five rounds; the figures are the medians, in nanoseconds a pose.
//
//     bench_batch FOLDER
#include <algorithm>
#include <cstdlib>
#include <string>

#include "pair_poses.hpp"
#include "results.h"

namespace {

constexpr int ROUNDS = 5;
constexpr int WAYS = 3;

void check(pir_status status) {
    if (status != PIR_OK) {
        std::fprintf(stderr, "bench_batch: %s\n", pir_status_text(status));
        std::exit(2);
    }
}

double median_of(std::vector<double> ns) {
    std::sort(ns.begin(), ns.end());
    return ns[ns.size() / 2];
}

struct Answers {
    std::vector<double> distance, normal;
    std::vector<uint8_t> state;

    explicit Answers(size_t count) : distance(count), normal(3 * count), state(count) {
    }
};

void loop(pir_pair *pair, pir_workspace *workspace, const std::vector<Pose> &poses, Answers *to) {
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    for (size_t i = 0; i < poses.size(); i++) {
        input.pose_p = {poses[i].r, poses[i].t};
        check(pir_pair_signed_distance(pair, workspace, &input, &result));
        to->distance[i] = result.distance;
        to->state[i] = (uint8_t)result.state;
        to->normal[3 * i] = result.normal.x;
        to->normal[3 * i + 1] = result.normal.y;
        to->normal[3 * i + 2] = result.normal.z;
    }
}

void ask(pir_pair_batch *batch, const std::vector<Pose> &poses, Answers *to) {
    pir_pair_batch_input input = pir_pair_batch_input_default();
    input.poses_p = {&poses[0].r.x, sizeof(Pose), &poses[0].t.x, sizeof(Pose), false};
    pir_pair_batch_arrays arrays = {};
    arrays.distance = to->distance.data();
    arrays.state = to->state.data();
    arrays.normal = reinterpret_cast<double(*)[3]>(to->normal.data());
    check(pir_pair_batch_signed_distance(batch, &input, poses.size(), &arrays, nullptr));
}

// Poses of a motion, again and again, as many as are wanted.
std::vector<Pose> many(pir_polytope *p, size_t count) {
    std::vector<Pose> some = hovering(p, p, (int)std::min<size_t>(count, 10000), 500), all;
    all.reserve(count);
    while (all.size() < count)
        all.push_back(some[all.size() % some.size()]);
    return all;
}

pir_pair_batch *batch_of(pir_polytope *p, uint32_t threads) {
    pir_pair_batch_options options = pir_pair_batch_options_default();
    pir_pair_batch *batch;
    options.threads = threads;
    check(pir_pair_batch_create(p, p, &options, &batch));
    return batch;
}

void run_body(FILE *csv, const char *name, pir_polytope *p) {
    const std::vector<Pose> poses = many(p, (size_t)results_count(1000000));
    Answers own(poses.size()), told(poses.size());
    std::vector<double> ns[WAYS];
    pir_workspace *workspace;
    pir_pair *pair;
    pir_pair_batch *batch[2] = {batch_of(p, 1), batch_of(p, 2)};
    check(pir_workspace_create(nullptr, &workspace));
    check(pir_pair_create(p, p, nullptr, &pair));
    for (int round = 0; round < ROUNDS; round++)
        for (int way = 0; way < WAYS; way++) {
            const double all = nanoseconds(0, [&] {
                if (way == 0)
                    loop(pair, workspace, poses, &own);
                else
                    ask(batch[way - 1], poses, &told);
            });
            ns[way].push_back(all / (double)poses.size());
            if (way > 0 && (told.distance != own.distance || told.normal != own.normal || told.state != own.state)) {
                std::fprintf(stderr, "bench_batch: a batch has other answers\n");
                std::exit(2);
            }
        }
    std::fprintf(csv, "%s,%zu,%.1f,%.1f,%.1f\n", name, poses.size(), median_of(ns[0]), median_of(ns[1]),
                 median_of(ns[2]));
    std::printf("%-28s %8.1f ns own loop, %8.1f batch, %8.1f on two threads\n", name, median_of(ns[0]),
                median_of(ns[1]), median_of(ns[2]));
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_pair_batch_destroy(batch[0]);
    pir_pair_batch_destroy(batch[1]);
    pir_polytope_release(p);
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: bench_batch FOLDER\n");
        return 2;
    }
    const results where = results_new(argv[1]);
    FILE *csv = results_open(&where, "batch.csv");
    std::fprintf(csv, "bodies,poses,loop_ns,batch_ns,two_threads_ns\n");
    run_body(csv, "two cubes", shape("cube"));
    run_body(csv, "two hulls of 60 vertices", sphere_points(60));
    run_body(csv, "two hulls of 500 vertices", sphere_points(500));
    results_close(csv, "batch.csv");
    return 0;
}
