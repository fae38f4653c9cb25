// SPDX-License-Identifier: MIT
//
// Scenes beside other engines: recorded piles and rain of tumbling hulls, without a solver. Each frame poses are set,
// pairs found, states, depths and manifolds made. Engines take turns of ten frames, or of N: one that runs in a loop of
// its own finds most of its memory in the caches, which five others would have emptied. Each line: milliseconds a frame
// of the calling thread's time (mean, median, 99th percentile, worst), the mean of the clock's, our mean in parts of
// this one's, pairs that overlap in the last frame, and how many states are wrong in the frames that are judged
// (judge.hpp).
//
//     bench_scene FOLDER [--csv NAME] [--engines NAME,...] [--reuse LENGTH] [--frames FROM:TO] [--every N] [--turns N]
//                 [--rain N,...] [RECORDING]...
//
// Engines are ours, ours2 (two threads), ours+ and ours2+ (which may tell manifolds again of bodies that moved by at
// most LENGTH, 0.002), box3d, box3d+ (which may reuse manifolds), fcl, bullet; all without the option. Of a recording
// frames FROM to TO − 1 are run, all without the option; every 20th is judged, or every N-th, or with 0 none. Rain
// falls with each number of bodies, 100 to 10,000 without the option, and with 10 that move of the most of them; it
// does not with `none`. All lines go to scene.csv, growth of the mean with the number of bodies to scene_growth.csv;
// with --csv to NAME.csv and NAME_growth.csv.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>

#include "judge.hpp"
#include "results.h"

namespace {

double clock_of(clockid_t clock) {
    timespec time;
    clock_gettime(clock, &time);
    return (double)time.tv_sec * 1e3 + (double)time.tv_nsec * 1e-6;
}

// --- options ---

struct Options {
    std::vector<std::string> engines = {"ours", "ours2", "ours+", "ours2+", "box3d", "box3d+", "fcl", "bullet"};
    double reuse = 2e-3;
    std::string csv = "scene";
    std::vector<uint32_t> rain = {100, 300, 1000, 3000, 10000};
    std::vector<std::string> recordings;
    size_t from = 0, to = SIZE_MAX, every = 20, turns = 10;
};

[[noreturn]] void usage() {
    std::fprintf(stderr, "usage: bench_scene FOLDER [--csv NAME] [--engines NAME,...] [--reuse LENGTH] "
                         "[--frames FROM:TO] [--every N] [--turns N] [--rain N,...] [RECORDING]...\n");
    std::exit(2);
}

std::vector<std::string> split(const std::string &text, char at) {
    std::vector<std::string> parts;
    for (size_t begin = 0; begin <= text.size();) {
        size_t end = std::min(text.find(at, begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

size_t number(const std::string &text) {
    char *end;
    unsigned long value = std::strtoul(text.c_str(), &end, 10);
    if (text.empty() || *end || value > 1000000)
        usage();
    return value;
}

Options options_of(int argc, char **argv) {
    Options options;
    for (int i = 2; i < argc; i++) {
        std::string word = argv[i];
        if (word.rfind("--", 0) != 0) {
            options.recordings.push_back(word);
            continue;
        }
        if (++i == argc)
            usage();
        std::vector<std::string> parts = split(argv[i], word == "--frames" ? ':' : ',');
        if (word == "--engines") {
            options.engines = parts;
        } else if (word == "--csv") {
            options.csv = argv[i];
        } else if (word == "--reuse") {
            options.reuse = std::strtod(argv[i], nullptr);
        } else if (word == "--frames" && parts.size() == 2) {
            options.from = number(parts[0]);
            options.to = number(parts[1]);
        } else if (word == "--every") {
            options.every = number(argv[i]);
        } else if (word == "--turns") {
            options.turns = std::max<size_t>(number(argv[i]), 1);
        } else if (word == "--rain") {
            options.rain.clear();
            for (const std::string &part : parts[0] == "none" ? std::vector<std::string>() : parts)
                options.rain.push_back((uint32_t)std::max<size_t>(number(part), 1));
        } else {
            usage();
        }
    }
    return options;
}

// An engine of that name, or NULL where this build lacks it.
std::unique_ptr<ScenePeer> make(const std::string &name, const Recording &recording, double reuse) {
    if (name == "ours" || name == "ours+")
        return make_our_scene(recording, 1, name == "ours+" ? reuse : 0);
    if (name == "ours2" || name == "ours2+")
        return make_our_scene(recording, 2, name == "ours2+" ? reuse : 0);
#ifdef PIR_HAVE_BOX3D
    if (name == "box3d" || name == "box3d+")
        return make_box3d_scene(recording, name == "box3d+");
#endif
#ifdef PIR_HAVE_FCL
    if (name == "fcl")
        return make_fcl_scene(recording);
#endif
#ifdef PIR_HAVE_BULLET
    if (name == "bullet")
        return make_bullet_scene(recording);
#endif
    return nullptr;
}

// --- runs ---

struct Lane {
    std::unique_ptr<ScenePeer> peer;
    std::vector<double> times, walls;
    size_t wrong = 0, overlapping = 0;

    double mean() const {
        double sum = 0;
        for (double t : times)
            sum += t;
        return sum / (double)times.size();
    }
};

void print(FILE *csv, const Recording &recording, Lane &lane, double ours, size_t judged) {
    double elapsed = 0, mean = lane.mean();
    for (double t : lane.walls)
        elapsed += t;
    std::sort(lane.times.begin(), lane.times.end());
    size_t n = lane.times.size();
    double median = lane.times[n / 2], p99 = lane.times[n * 99 / 100], worst = lane.times[n - 1];
    elapsed /= (double)n;
    std::string wrong = judged > 0 ? std::to_string(lane.wrong) : "-";
    double megabytes = (double)lane.peer->bytes() / 1e6;
    std::printf("%-24s %-26s %9.4f %9.4f %9.4f %9.4f %9.4f %6.3f %8zu %6zu %6s %8.1f\n", recording.name.c_str(),
                lane.peer->name(), mean, median, p99, worst, elapsed, ours / mean, lane.overlapping, judged,
                wrong.c_str(), megabytes);
    std::fprintf(csv, "%s,\"%s\",%zu,%.5f,%.5f,%.5f,%.5f,%.5f,%.4f,%zu,%zu,%s,%.2f\n", recording.name.c_str(),
                 lane.peer->name(), n, mean, median, p99, worst, elapsed, ours / mean, lane.overlapping, judged,
                 wrong.c_str(), megabytes);
    std::fflush(stdout);
}

// The bodies that stand elsewhere than in the frame before; all in the first.
std::vector<uint32_t> moved_in(const Recording &recording, size_t frame, bool first) {
    std::vector<uint32_t> moved;
    for (uint32_t i = 0; i < recording.bodies.size(); i++) {
        if (!first) {
            const pir_pose &a = recording.frames[frame - 1][i], &b = recording.frames[frame][i];
            if (a.translation.x == b.translation.x && a.translation.y == b.translation.y &&
                a.translation.z == b.translation.z && a.rotation.x == b.rotation.x && a.rotation.y == b.rotation.y &&
                a.rotation.z == b.rotation.z && a.rotation.w == b.rotation.w)
                continue;
        }
        moved.push_back(i);
    }
    return moved;
}

// One engine's turn in a frame. The first frame, which makes everything, is not timed.
void turn(Lane &lane, const std::vector<uint32_t> &moved, const std::vector<pir_pose> &poses, bool timed) {
    double begin = clock_of(CLOCK_THREAD_CPUTIME_ID), begun = clock_of(CLOCK_MONOTONIC);
    lane.peer->set(moved, poses);
    if (timed) {
        lane.times.push_back(clock_of(CLOCK_THREAD_CPUTIME_ID) - begin);
        lane.walls.push_back(clock_of(CLOCK_MONOTONIC) - begun);
    }
}

// One engine's frame, held to the exact answers where there are such.
void run_frame(Lane &lane, const Recording &recording, size_t frame, size_t from, const std::vector<BodyPair> *exact) {
    turn(lane, moved_in(recording, frame, frame == from), recording.frames[frame], frame > from);
    std::vector<BodyPair> pairs;
    // asked in each frame: one that tells of changes alone must not fall behind
    lane.peer->overlapping(&pairs);
    lane.overlapping = pairs.size();
    if (exact)
        lane.wrong += differences(*exact, pairs);
}

using Means = std::map<std::string, double>;

// A recording, by all engines in turn; gives their means.
Means replay(FILE *csv, const Recording &recording, const Options &options) {
    std::vector<Lane> lanes;
    for (const std::string &name : options.engines)
        if (auto peer = make(name, recording, options.reuse))
            lanes.push_back({std::move(peer), {}, {}});
    size_t to = std::min(recording.frames.size(), options.to), judged = 0, from = options.from;
    to = from < to ? from + results_count((uint32_t)(to - from)) : 0;
    if (lanes.empty() || to < from + 2) {
        std::fprintf(stderr, "bench_scene: no engine or no frames\n");
        std::exit(2);
    }
    for (size_t first = from; first < to; first += options.turns) {
        const size_t end = std::min(first + options.turns, to);
        std::map<size_t, std::vector<BodyPair>> exact;
        for (size_t f = first; f < end && options.every > 0; f++)
            if (f % options.every == 0)
                exact[f] = exact_pairs(recording, recording.frames[f]);
        judged += exact.size();
        for (Lane &lane : lanes)
            for (size_t f = first; f < end; f++)
                run_frame(lane, recording, f, from, exact.count(f) ? &exact[f] : nullptr);
    }
    Means means;
    for (Lane &lane : lanes) {
        means[lane.peer->name()] = lane.mean();
        print(csv, recording, lane, lanes[0].mean(), judged);
    }
    return means;
}

// Where there are many bodies, they are not judged, and FCL and Bullet, which would take minutes, do not run.
Means rain(FILE *csv, uint32_t bodies, uint32_t moving, Options options) {
    auto slow = [](const std::string &name) { return name == "fcl" || name == "bullet"; };
    if (bodies > 1000) {
        options.engines.erase(std::remove_if(options.engines.begin(), options.engines.end(), slow),
                              options.engines.end());
        options.every = 0;
    }
    options.from = 0;
    options.to = SIZE_MAX;
    return replay(csv, *make_rain(bodies, moving, moving > 3000 ? 31 : 121), options);
}

// The power of n that an engine's time grows with, from the least to the greatest number of bodies.
void print_growth(FILE *csv, uint32_t few, uint32_t many, const Means &least, const Means &most) {
    for (const auto &[name, mean] : most) {
        double power = std::log(mean / least.at(name)) / std::log((double)many / few);
        std::printf("%s grows from %u to %u bodies as n^%.3f\n", name.c_str(), few, many, power);
        std::fprintf(csv, "\"%s\",%u,%u,%.5f,%.5f,%.4f\n", name.c_str(), few, many, least.at(name), mean, power);
    }
}

} // namespace

int main(int argc, char **argv) {
    if (argc < 2)
        usage();
    Options options = options_of(argc, argv);
    bool smoke = results_count(100) < 100;
    if (smoke)
        options.rain = {50, 100};
    struct results results = results_new(argv[1]);
    const std::string table = options.csv + ".csv", growths = options.csv + "_growth.csv";
    FILE *csv = results_open(&results, table.c_str());
    FILE *growth = options.rain.empty() ? nullptr : results_open(&results, growths.c_str());
    std::fprintf(csv, "scene,engine,frames,mean_ms,median_ms,p99_ms,worst_ms,wall_ms,ours_over,overlapping,judged,"
                      "wrong,peak_mb\n");
    if (growth)
        std::fprintf(growth, "engine,few,many,few_ms,many_ms,power\n");
    std::printf("# %s; milliseconds a frame\n", results.machine);
    std::printf("%-24s %-26s %9s %9s %9s %9s %9s %6s %8s %6s %6s %8s\n", "scene", "engine", "mean", "median", "p99",
                "worst", "wall", "ours/", "overlap", "judged", "wrong", "peak MB");
    for (const std::string &path : options.recordings)
        replay(csv, *read_recording(path), options);
    Means least;
    for (uint32_t bodies : options.rain) {
        Means means = rain(csv, bodies, bodies, options);
        if (bodies == options.rain.front())
            least = means;
        else if (bodies == options.rain.back())
            print_growth(growth, options.rain.front(), bodies, least, means);
    }
    if (!smoke && growth && options.rain.back() > 1000)
        rain(csv, options.rain.back(), 10, options);
    results_close(csv, table.c_str());
    if (growth)
        results_close(growth, growths.c_str());
    return 0;
}
