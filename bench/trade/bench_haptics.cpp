// SPDX-License-Identifier: MIT
//
// A haptic loop: gs4 in a hand about the mug, one turn a second, in and out of contact, asked a thousand times a second
// for ten minutes. A frame brings P to its pose and asks for the signed distance and the contact manifold: of a pair by
// need, and of a tracked sum with a query. Five runs of each, for a machine that does other things as well: the best is
// the one whose worst frame is the least. haptics.csv has a line for each run, in nanoseconds of wall time; a last run
// is in CPU time of the thread, which leaves out what else the machine does, and is half a microsecond longer.
//
//     bench_haptics FOLDER MODELS
#include <algorithm>
#include <cstdlib>
#include <string>

#include "pair_poses.hpp"
#include "results.h"

namespace {

constexpr int RUNS = 5;
constexpr int STEPS = 1000; // to a turn
constexpr int FRAMES = 600000;
constexpr size_t CONTACTS = 32;

void check(pir_status status) {
    if (status == PIR_OK)
        return;
    std::fprintf(stderr, "bench_haptics: %s\n", pir_status_text(status));
    std::exit(2);
}

class ByNeed {
  public:
    static constexpr const char *NAME = "pair by need";

    ByNeed(pir_polytope *p, pir_polytope *q) {
        check(pir_workspace_create(nullptr, &workspace_));
        check(pir_pair_create(p, q, nullptr, &pair_));
    }
    ~ByNeed() {
        pir_pair_destroy(pair_);
        pir_workspace_destroy(workspace_);
    }
    void frame(const Pose &pose) {
        pir_query_result result;
        pir_contact contacts[CONTACTS];
        size_t count;
        input_.pose_p = {pose.r, pose.t};
        check(pir_pair_signed_distance(pair_, workspace_, &input_, &result));
        check(pir_pair_manifold(pair_, workspace_, &input_, &result, CONTACTS, contacts, &count));
    }

  private:
    pir_workspace *workspace_ = nullptr;
    pir_pair *pair_ = nullptr;
    pir_pair_input input_ = pir_pair_input_default();
};

class Tracked {
  public:
    static constexpr const char *NAME = "tracked sum";

    Tracked(pir_polytope *p, pir_polytope *q) {
        pir_sum_options options = pir_sum_options_default();
        options.difference = true;
        check(pir_sum_create(p, q, {0, 0, 0, 1}, &options, &sum_));
        check(pir_query_create(sum_, &query_));
        input_ = pir_query_input_default();
    }
    ~Tracked() {
        pir_query_destroy(query_);
        pir_sum_destroy(sum_);
    }
    void frame(const Pose &pose) {
        pir_query_result result;
        pir_contact contacts[CONTACTS];
        size_t count;
        input_.translation = pose.t;
        check(pir_sum_rotate(sum_, pose.r, PIR_METHOD_AUTO));
        check(pir_query_signed_distance(query_, &input_, &cache_, &result));
        check(pir_query_manifold(query_, &input_, &result, CONTACTS, contacts, &count));
    }

  private:
    pir_sum *sum_ = nullptr;
    pir_query *query_ = nullptr;
    pir_query_cache cache_ = {};
    pir_query_input input_;
};

struct Run {
    double median, mean, p99, p999, worst;
};

template <class Loop>
Run run(pir_polytope *p, pir_polytope *q, const std::vector<Pose> &poses, bool cpu, std::vector<double> *ns) {
    Loop loop(p, q);
    // a loop that has begun, with its memory
    for (size_t i = 0; i < poses.size() && i < 2000; i++)
        loop.frame(poses[i]);
    ns->clear();
    for (const Pose &pose : poses)
        ns->push_back(cpu ? cpu_nanoseconds([&] { loop.frame(pose); }) : nanoseconds(0, [&] { loop.frame(pose); }));
    double sum = 0;
    for (double t : *ns)
        sum += t;
    std::sort(ns->begin(), ns->end());
    size_t n = ns->size();
    return {(*ns)[n / 2], sum / (double)n, (*ns)[n * 99 / 100], (*ns)[n * 999 / 1000], ns->back()};
}

void print(FILE *csv, const char *way, const char *name, size_t frames, const Run &r) {
    std::fprintf(csv, "%s,%s,%zu,%.0f,%.0f,%.0f,%.0f,%.0f\n", way, name, frames, r.median, r.mean, r.p99, r.p999,
                 r.worst);
    std::printf("%-14s %-4s %8.2f %8.2f %8.2f %8.2f %8.2f\n", way, name, r.median / 1e3, r.mean / 1e3, r.p99 / 1e3,
                r.p999 / 1e3, r.worst / 1e3);
}

template <class Loop> void run_all(FILE *csv, pir_polytope *p, pir_polytope *q, const std::vector<Pose> &poses) {
    std::vector<double> ns;
    Run best = {};
    ns.reserve(poses.size());
    for (uint32_t i = 0; i < results_count(RUNS); i++) {
        Run now = run<Loop>(p, q, poses, false, &ns);
        best = i == 0 || now.worst < best.worst ? now : best;
        print(csv, Loop::NAME, std::to_string(i).c_str(), poses.size(), now);
    }
    print(csv, Loop::NAME, "best", poses.size(), best);
    print(csv, Loop::NAME, "cpu", poses.size(), run<Loop>(p, q, poses, true, &ns));
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: bench_haptics FOLDER MODELS\n");
        return 2;
    }
    results where = results_new(argv[1]);
    FILE *csv = results_open(&where, "haptics.csv");
    pir_polytope *p = shape("gs4"), *q;
    pir_report report;
    if (pir_polytope_read((std::string(argv[2]) + "/mug.off").c_str(), nullptr, &report, nullptr, &q) != PIR_OK) {
        std::fprintf(stderr, "bench_haptics: %s\n", report.text);
        return 2;
    }
    std::vector<Pose> poses = hovering(p, q, (int)results_count(FRAMES), STEPS);
    std::fprintf(csv, "way,run,frames,median_ns,mean_ns,p99_ns,p999_ns,worst_ns\n");
    std::printf("us\n%-14s %-4s %8s %8s %8s %8s %8s\n", "way", "run", "median", "mean", "p99", "p99.9", "worst");
    run_all<ByNeed>(csv, p, q, poses);
    run_all<Tracked>(csv, p, q, poses);
    pir_polytope_release(q);
    pir_polytope_release(p);
    results_close(csv, "haptics.csv");
    return 0;
}
