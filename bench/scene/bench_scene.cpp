// SPDX-License-Identifier: MIT
//
// Scenes beside other engines: recorded piles and rain of tumbling hulls, without a solver. Each frame poses are set,
// pairs found, states, depths and manifolds made, by one engine after the other. Each line: milliseconds a frame of the
// calling thread's time (mean, median, 99th percentile, worst), pairs that overlap in the last frame, and how many
// states are wrong in every 20th frame: against exact answers of all pairs of bodies whose spheres meet, each by the
// level `whole` of a pair made for it. All lines go to scene.csv.
//
//     bench_scene FOLDER [RECORDING]...
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <set>

#include "results.h"
#include "scene_peers.hpp"

namespace {

void check(pir_status status) {
    if (status != PIR_OK) {
        std::fprintf(stderr, "bench_scene: %s\n", pir_status_text(status));
        std::exit(2);
    }
}

class Ours : public ScenePeer {
  public:
    Ours(const Recording &recording, uint32_t threads)
        : name_(threads > 1 ? "ours, " + std::to_string(threads) + " threads" : "ours") {
        pir_scene_options options = pir_scene_options_default();
        options.threads = threads;
        check(pir_scene_create(&options, &scene_));
        for (const RecordedBody &body : recording.statics)
            add(body.polytope, body.pose, PIR_BODY_STATIC);
        statics_ = (uint32_t)recording.statics.size();
        for (size_t i = 0; i < recording.bodies.size(); i++)
            add(recording.bodies[i].polytope, recording.frames[0][i], PIR_BODY_MOVING);
    }
    ~Ours() override {
        pir_scene_destroy(scene_);
    }
    const char *name() const override {
        return name_.c_str();
    }
    void set(const std::vector<uint32_t> &moved, const std::vector<pir_pose> &poses) override {
        moves_.clear();
        for (uint32_t i : moved)
            moves_.push_back({statics_ + i, poses[i]});
        check(pir_scene_update(scene_, moves_.data(), moves_.size()));
        size_t count;
        const pir_scene_event *event = pir_scene_events(scene_, &count);
        for (size_t i = 0; i < count; i++) {
            BodyPair pair{event[i].body_p, event[i].body_q};
            if (event[i].kind == PIR_EVENT_BEGAN)
                began_.push_back(pair);
            else if (event[i].kind == PIR_EVENT_ENDED)
                ended_.push_back(pair);
        }
    }
    void overlapping(std::vector<BodyPair> *ret_pairs) override {
        contacts_.insert(began_.begin(), began_.end());
        for (const BodyPair &pair : ended_)
            contacts_.erase(pair);
        began_.clear();
        ended_.clear();
        ret_pairs->assign(contacts_.begin(), contacts_.end());
    }
    size_t bytes() const override {
        return pir_scene_get_statistics(scene_).peak;
    }

  private:
    void add(pir_polytope *polytope, const pir_pose &pose, pir_body_kind kind) {
        pir_body_options body = pir_body_options_default();
        uint32_t id;
        body.kind = kind;
        body.pose = pose;
        body.pieces = &polytope;
        body.piece_count = 1;
        check(pir_scene_add(scene_, &body, &id));
    }

    std::string name_;
    pir_scene *scene_ = nullptr;
    uint32_t statics_;
    std::vector<pir_scene_move> moves_;
    std::vector<BodyPair> began_, ended_;
    std::set<BodyPair> contacts_;
};

// --- exact answers ---

double radius_of(const pir_polytope *p) {
    double most = 0;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        pir_vec3 c = pir_polytope_vertex(p, v);
        most = std::max(most, std::sqrt(c.x * c.x + c.y * c.y + c.z * c.z));
    }
    return most * (1 + 1e-12);
}

struct Posed {
    pir_polytope *polytope;
    pir_pose pose;
    double radius;
};

bool spheres_meet(const Posed &p, const Posed &q) {
    pir_vec3 a = p.pose.translation, b = q.pose.translation;
    double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z, r = p.radius + q.radius;
    return x * x + y * y + z * z <= r * r * (1 + 1e-12);
}

// All pairs of bodies that share a point in a frame.
std::vector<BodyPair> exact_pairs(const Recording &recording, const std::vector<pir_pose> &poses) {
    std::vector<Posed> bodies;
    for (const RecordedBody &body : recording.statics)
        bodies.push_back({body.polytope, body.pose, radius_of(body.polytope)});
    for (size_t i = 0; i < poses.size(); i++)
        bodies.push_back({recording.bodies[i].polytope, poses[i], radius_of(recording.bodies[i].polytope)});
    pir_pair_options options = pir_pair_options_default();
    options.least = PIR_LEVEL_WHOLE;
    pir_workspace *workspace;
    check(pir_workspace_create(nullptr, &workspace));
    std::vector<BodyPair> found;
    for (uint32_t a = 0; a < bodies.size(); a++)
        for (uint32_t b = std::max(a + 1, (uint32_t)recording.statics.size()); b < bodies.size(); b++) {
            if (!spheres_meet(bodies[a], bodies[b]))
                continue;
            pir_pair *pair;
            pir_pair_input input = pir_pair_input_default();
            pir_query_result result;
            input.pose_p = bodies[a].pose;
            input.pose_q = bodies[b].pose;
            check(pir_pair_create(bodies[a].polytope, bodies[b].polytope, &options, &pair));
            check(pir_pair_overlap(pair, workspace, &input, &result));
            pir_pair_destroy(pair);
            if (result.state != PIR_OUTSIDE)
                found.push_back({a, b});
        }
    pir_workspace_destroy(workspace);
    return found;
}

// How many pairs are in one list alone.
size_t differences(std::vector<BodyPair> a, std::vector<BodyPair> b) {
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    std::vector<BodyPair> rest;
    std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(rest));
    return rest.size();
}

// --- runs ---

double now() {
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return (double)time.tv_sec * 1e3 + (double)time.tv_nsec * 1e-6;
}

double wall() {
    timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec * 1e3 + (double)time.tv_nsec * 1e-6;
}

struct Lane {
    std::unique_ptr<ScenePeer> peer;
    std::vector<double> times, walls;
    size_t wrong = 0, overlapping = 0;
};

void print(FILE *csv, const Recording &recording, Lane &lane, bool judged) {
    double sum = 0, elapsed = 0;
    for (double t : lane.times)
        sum += t;
    for (double t : lane.walls)
        elapsed += t;
    std::sort(lane.times.begin(), lane.times.end());
    size_t n = lane.times.size();
    double mean = sum / (double)n, median = lane.times[n / 2], p99 = lane.times[n * 99 / 100],
           worst = lane.times[n - 1];
    std::string wrong = judged ? std::to_string(lane.wrong) : "-";
    std::printf("%-24s %-26s %9.4f %9.4f %9.4f %9.4f %9.4f %8zu %8s %8.1f\n", recording.name.c_str(), lane.peer->name(),
                mean, median, p99, worst, elapsed / (double)n, lane.overlapping, wrong.c_str(),
                (double)lane.peer->bytes() / 1e6);
    std::fprintf(csv, "%s,\"%s\",%zu,%.5f,%.5f,%.5f,%.5f,%.5f,%zu,%s,%.2f\n", recording.name.c_str(), lane.peer->name(),
                 n, mean, median, p99, worst, elapsed / (double)n, lane.overlapping, wrong.c_str(),
                 (double)lane.peer->bytes() / 1e6);
}

// The bodies that stand elsewhere than in the frame before; all in the first.
std::vector<uint32_t> moved_in(const Recording &recording, size_t frame) {
    std::vector<uint32_t> moved;
    for (uint32_t i = 0; i < recording.bodies.size(); i++) {
        if (frame > 0) {
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

// A recording, by all engines in turn within each frame. The first frame, which makes everything, is not timed.
void replay(FILE *csv, const Recording &recording, bool peers, bool judged) {
    std::vector<Lane> lanes;
    auto join = [&lanes](std::unique_ptr<ScenePeer> peer) {
        if (peer)
            lanes.push_back({std::move(peer), {}, {}});
    };
    join(std::make_unique<Ours>(recording, 1));
    join(std::make_unique<Ours>(recording, 2));
#ifdef PIR_HAVE_BOX3D
    if (peers) {
        join(make_box3d_scene(recording, true));
        join(make_box3d_scene(recording, false));
    }
#endif
#ifdef PIR_HAVE_FCL
    if (peers)
        join(make_fcl_scene(recording));
#endif
#ifdef PIR_HAVE_BULLET
    if (peers)
        join(make_bullet_scene(recording));
#endif
    size_t frames = std::min<size_t>(recording.frames.size(), results_count((uint32_t)recording.frames.size()));
    for (size_t f = 0; f < frames; f++) {
        std::vector<uint32_t> moved = moved_in(recording, f);
        std::vector<BodyPair> exact;
        if (judged && f % 20 == 0)
            exact = exact_pairs(recording, recording.frames[f]);
        for (Lane &lane : lanes) {
            double begin = now(), begun = wall();
            lane.peer->set(moved, recording.frames[f]);
            if (f > 0) {
                lane.times.push_back(now() - begin);
                lane.walls.push_back(wall() - begun);
            }
            std::vector<BodyPair> pairs;
            lane.peer->overlapping(&pairs);
            lane.overlapping = pairs.size();
            if (judged && f % 20 == 0)
                lane.wrong += differences(exact, pairs);
        }
    }
    for (Lane &lane : lanes)
        print(csv, recording, lane, judged);
}

} // namespace

int main(int argc, char **argv) {
    if (argc < 2) {
        std::fprintf(stderr, "usage: bench_scene FOLDER [RECORDING]...\n");
        return 2;
    }
    struct results results = results_new(argv[1]);
    FILE *csv = results_open(&results, "scene.csv");
    std::fprintf(csv, "scene,engine,frames,mean_ms,median_ms,p99_ms,worst_ms,wall_ms,overlapping,wrong,peak_mb\n");
    std::printf("# %s; milliseconds a frame\n", results.machine);
    std::printf("%-24s %-26s %9s %9s %9s %9s %9s %8s %8s %8s\n", "scene", "engine", "mean", "median", "p99", "worst",
                "wall", "overlap", "wrong", "peak MB");
    bool smoke = results_count(100) < 100;
    for (int i = 2; i < argc; i++)
        replay(csv, *read_recording(argv[i]), true, true);
    replay(csv, *make_rain(100, 100, 121), true, true);
    if (!smoke) {
        replay(csv, *make_rain(1000, 1000, 121), true, true);
        replay(csv, *make_rain(10000, 10000, 31), false, false);
        replay(csv, *make_rain(10000, 10, 121), true, false);
    }
    results_close(csv, "scene.csv");
    return 0;
}
