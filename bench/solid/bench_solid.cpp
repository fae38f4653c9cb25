// SPDX-License-Identifier: MIT
//
// Whole sums of solids beside CGAL's Nef polyhedra and Manifold, in one thread.
//
// solids.csv has a line for each pair: what the sum is, the processor time of decomposition, of pair sums, of the rest
// (finding, clipping and glueing candidates) and of the whole call, the fastest of some; then that of each peer, which
// runs once where it takes a second, and how many times ours that is. Every peer runs in a process of its own, which
// is ended after LIMIT seconds: ">LIMIT" then, and the ratio is a lower bound. Bodies are prepared before the clock
// starts. A limit is that of the pairs that are given after it, the last one that of our own pairs as well. Of gears
// with more and more teeth it prints how time grows with candidates.
//
//     bench_solid FOLDER [--limit SECONDS | --pair NAME P.off Q.off]...
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "results.h"
#include "stages.h"
#include "triangles.hpp"

namespace {

struct Free {
    void operator()(solid_model *model) const {
        std::free(model);
    }
};
using Model = std::unique_ptr<solid_model, Free>;

struct Pair {
    std::string name;
    Model p, q;
    double limit = 0;
};

[[noreturn]] void fail(const std::string &what) {
    std::fprintf(stderr, "bench_solid: %s\n", what.c_str());
    std::exit(2);
}

// Facets of an OFF file: decimal numbers, comments with #.
Model read_off(const char *path) {
    std::ifstream file(path);
    std::stringstream words;
    for (std::string line; std::getline(file, line);)
        words << line.substr(0, line.find('#')) << '\n';
    std::string magic;
    uint32_t points = 0, facets = 0, edges = 0;
    Model model(static_cast<solid_model *>(std::calloc(1, sizeof(solid_model))));
    std::vector<pir_vec3> point;
    if (!(words >> magic >> points >> facets >> edges) || magic != "OFF" || facets > SOLID_MODEL_FACETS)
        fail(std::string(path) + " is no OFF file that fits");
    point.resize(points);
    for (pir_vec3 &v : point)
        words >> v.x >> v.y >> v.z;
    for (uint32_t f = 0; f < facets; f++) {
        uint32_t count = 0, corner = 0;
        words >> count;
        for (uint32_t i = 0; i < count && words >> corner; i++) {
            if (corner >= points || model->points == SOLID_MODEL_POINTS)
                fail(std::string(path) + " has corners that do not fit");
            model->point[model->points] = point[corner];
            model->corner[model->points] = model->points;
            model->points++;
        }
        model->start[f + 1] = model->points;
        std::string rest;
        std::getline(words, rest);
    }
    model->facets = facets;
    return model;
}

pir_solid *solid_of(const solid_model &model, const std::string &name) {
    const pir_solid_facets facets = {model.point, model.points, model.start, model.corner, model.facets};
    pir_report report = {};
    pir_solid *solid = nullptr;
    if (pir_solid_create(&facets, nullptr, &report, &solid) != PIR_OK)
        fail(name + ": " + report.text);
    return solid;
}

// --- peers ---

// In the child: the fastest of some runs, written after each.
[[noreturn]] void run_child(double (*sum)(const Triangles &, const Triangles &), const Pair &pair, int end) {
    const Triangles p = triangles_of(*pair.p), q = triangles_of(*pair.q);
    double best = sum(p, q), all = best;
    for (;;) {
        if (write(end, &best, sizeof best) != (ssize_t)sizeof best || best < 0 || all > 1)
            _exit(0);
        const double again = sum(p, q);
        best = std::min(best, again);
        all += std::max(again, 0.1);
    }
}

// Seconds of a peer's sum: negative when it fails, the limit when it was ended before its first run had come to an end.
double run_peer(double (*sum)(const Triangles &, const Triangles &), const Pair &pair) {
    int ends[2];
    if (pipe(ends) != 0)
        fail("no pipe");
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0)
        run_child(sum, pair, ends[1]);
    close(ends[1]);
    double seconds = -1, said = 0;
    struct pollfd wait = {ends[0], POLLIN, 0};
    if (child < 0 || poll(&wait, 1, (int)(pair.limit * 1000)) == 0)
        seconds = pair.limit;
    // what it says afterwards comes soon
    while (seconds != pair.limit && poll(&wait, 1, 2000) > 0 &&
           read(ends[0], &said, sizeof said) == (ssize_t)sizeof said)
        seconds = said;
    close(ends[0]);
    if (child > 0) {
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
    }
    return seconds;
}

std::string time_text(double seconds, double limit) {
    char text[32] = "failed";
    if (seconds >= limit)
        std::snprintf(text, sizeof text, ">%g", limit);
    else if (seconds >= 0)
        std::snprintf(text, sizeof text, "%.4f", seconds);
    return text;
}

std::string ratio_text(double seconds, double whole, double limit) {
    char text[32] = "";
    if (seconds >= 0)
        std::snprintf(text, sizeof text, "%s%.1f", seconds >= limit ? ">" : "", seconds / whole);
    return text;
}

// --- pairs ---

stages measure(const Pair &pair) {
    pir_solid *p = solid_of(*pair.p, pair.name), *q = solid_of(*pair.q, pair.name);
    stages best = stages_measure(p, q);
    double all = best.whole;
    for (uint32_t i = 1; i < results_count(9) && all < 2; i++) {
        const stages again = stages_measure(p, q);
        all += again.whole;
        best.decompose = std::min(best.decompose, again.decompose);
        best.pairs = std::min(best.pairs, again.pairs);
        best.whole = std::min(best.whole, again.whole);
    }
    pir_solid_release(p);
    pir_solid_release(q);
    return best;
}

// Measures a pair and writes its line.
stages run_pair(FILE *csv, const Pair &pair) {
    const stages ours = measure(pair);
    const pir_solid_sum_info &info = ours.info;
    const double rest = std::max(ours.whole - ours.decompose - ours.pairs, 0.0);
    std::string peers;
    for (int k = 0; k < 2; k++) {
        double (*const sum[2])(const Triangles &, const Triangles &) = {
#ifdef PIR_HAVE_NEF
            nef_sum,
#else
            nullptr,
#endif
#ifdef PIR_HAVE_MANIFOLD
            manifold_sum,
#else
            nullptr,
#endif
        };
        if (!sum[k]) {
            peers += ",,";
            continue;
        }
        const double seconds = run_peer(sum[k], pair);
        peers += "," + time_text(seconds, pair.limit) + "," + ratio_text(seconds, ours.whole, pair.limit);
    }
    std::fprintf(csv, "%s,%u,%u,%u,%u,%u,%llu,%.3f,%.3f,%.3f,%.3f%s\n", pair.name.c_str(), info.vertices, info.edges,
                 info.facets, info.pieces_p, info.pieces_q, (unsigned long long)info.candidates, 1e3 * ours.decompose,
                 1e3 * ours.pairs, 1e3 * rest, 1e3 * ours.whole, peers.c_str());
    std::fflush(csv);
    std::printf("%-22s %4u/%4u/%4u %3u x %3u %6llu  %8.2f %8.2f %8.2f %8.2f ms  %s\n", pair.name.c_str(), info.vertices,
                info.edges, info.facets, info.pieces_p, info.pieces_q, (unsigned long long)info.candidates,
                1e3 * ours.decompose, 1e3 * ours.pairs, 1e3 * rest, 1e3 * ours.whole, peers.c_str());
    std::fflush(stdout);
    return ours;
}

Pair pair_of(const char *p, const char *q, double divide_q, double limit) {
    const std::string over = divide_q == 1 ? "" : "/" + std::to_string((int)divide_q);
    return {std::string(p) + "+" + q + over, Model(solid_model_facets(p, 1)), Model(solid_model_facets(q, divide_q)),
            limit};
}

void run_all(FILE *csv, double limit) {
    static const struct {
        const char *p, *q;
        double divide_q;
    } pairs[] = {{"stella", "ball128", 1},   {"star5", "star5", 1},    {"cup", "ball32", 8},
                 {"spoon", "stella", 64},    {"cup", "star5", 8},      {"spoon", "spoon", 1},
                 {"mushroom", "cube", 1},    {"mushroom", "cube", 16}, {"mushroom", "ball128", 10},
                 {"mushroom", "stella", 50}, {"mushroom", "cup", 4},   {"gear8", "gear8", 1}};
    for (uint32_t i = 0; i < results_count(sizeof pairs / sizeof *pairs); i++)
        run_pair(csv, pair_of(pairs[i].p, pairs[i].q, pairs[i].divide_q, limit));
    stages first = {};
    for (int teeth = 8; teeth <= (results_count(64) < 64 ? 8 : 64); teeth *= 2) {
        const stages made = run_pair(csv, pair_of(("gear" + std::to_string(teeth)).c_str(), "star5", 1, limit));
        if (teeth == 8)
            first = made;
        else
            std::printf("  from 8 teeth on: time as candidates^%.2f\n",
                        std::log(made.whole / first.whole) /
                            std::log((double)made.info.candidates / (double)first.info.candidates));
    }
}

} // namespace

int main(int argc, char **argv) {
    double limit = results_count(100) < 100 ? 1 : 60;
    std::vector<Pair> given;
    if (argc < 2)
        fail("usage: bench_solid FOLDER [--limit SECONDS | --pair NAME P.off Q.off]...");
    for (int i = 2; i < argc;) {
        if (std::strcmp(argv[i], "--limit") == 0 && i + 1 < argc) {
            limit = std::atof(argv[i + 1]);
            i += 2;
        } else if (std::strcmp(argv[i], "--pair") == 0 && i + 3 < argc) {
            given.push_back({argv[i + 1], read_off(argv[i + 2]), read_off(argv[i + 3]), limit});
            i += 4;
        } else {
            fail(std::string("unknown argument ") + argv[i]);
        }
    }
    results where = results_new(argv[1]);
    FILE *csv = results_open(&where, "solids.csv");
    std::fprintf(csv, "pair,vertices,edges,facets,pieces_p,pieces_q,candidates,decompose_ms,pairs_ms,rest_ms,whole_ms,"
                      "nef_s,nef_times,manifold_s,manifold_times\n");
    std::printf("%s\n", where.machine);
    for (const Pair &pair : given)
        run_pair(csv, pair);
    run_all(csv, limit);
    results_close(csv, "solids.csv");
    return 0;
}
