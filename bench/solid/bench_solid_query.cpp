// SPDX-License-Identifier: MIT
//
// State, distance and depth of two solids beside FCL's trees of triangles, in one run.
//
// solid_query.csv has a line for each pair of bodies: the median and the mean time of a state and of a distance, ours
// and FCL's, and at how many poses FCL's state is another one. Both answer from nothing at every pose. A surface of
// triangles has no inside: where a body is in a cavity or swallowed whole FCL can tell neither from the other.
//
// solid_depth.csv has the depth of a body that turns inside another, about an axis that changes every 50 frames, asked
// of one query from frame to frame: the median, the mean and the 99th percentile, and the greatest and mean part by
// which the depth of the deepest of FCL's contacts is off.
//
//     bench_solid_query FOLDER
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <pirouette/solid_query.h>

#include "fcl_solids.hpp"
#include "results.h"

namespace {

struct Free {
    void operator()(solid_model *model) const {
        std::free(model);
    }
};

void check(pir_status status) {
    if (status != PIR_OK) {
        std::fprintf(stderr, "bench_solid_query: %s\n", pir_status_text(status));
        std::exit(2);
    }
}

class Ours {
  public:
    Ours(const solid_model &p, const solid_model &q) {
        pir_pieces *a = pieces_of(p), *b = pieces_of(q);
        check(pir_solid_query_create(a, b, nullptr, &query_));
        check(pir_workspace_create(nullptr, &workspace_));
        pir_pieces_destroy(a);
        pir_pieces_destroy(b);
    }
    ~Ours() {
        pir_solid_query_destroy(query_);
        pir_workspace_destroy(workspace_);
    }
    bool meets(const pir_pose &pose) {
        pir_pair_input input = pir_pair_input_default();
        input.pose_p = pose;
        pir_state state;
        check(pir_solid_query_overlap(query_, workspace_, &input, &state));
        return state != PIR_OUTSIDE;
    }
    double distance(const pir_pose &pose) {
        pir_pair_input input = pir_pair_input_default();
        input.pose_p = pose;
        pir_solid_distance answer;
        check(pir_solid_query_distance(query_, workspace_, &input, &answer));
        return answer.result.distance;
    }
    // 0 where the insides are apart.
    double depth(const pir_pose &pose) {
        pir_pair_input input = pir_pair_input_default();
        input.pose_p = pose;
        pir_solid_depth answer;
        check(pir_solid_query_depth(query_, workspace_, &input, &answer));
        return answer.depth;
    }

  private:
    static pir_pieces *pieces_of(const solid_model &model) {
        const pir_solid_facets facets = {model.point, model.points, model.start, model.corner, model.facets};
        pir_solid *solid;
        pir_pieces *pieces;
        check(pir_solid_create(&facets, nullptr, nullptr, &solid));
        check(pir_solid_decompose(solid, nullptr, nullptr, &pieces));
        pir_solid_release(solid);
        return pieces;
    }
    pir_solid_query *query_ = nullptr;
    pir_workspace *workspace_ = nullptr;
};

double reach_of(const solid_model &model) {
    double reach = 0;
    for (uint32_t i = 0; i < model.points; i++) {
        const pir_vec3 v = model.point[i];
        reach = std::max(reach, std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z));
    }
    return reach;
}

// Poses at which the origins are within a part of both bodies' reach of `middle`.
std::vector<pir_pose> random_poses(double spread, pir_vec3 middle, uint32_t count) {
    std::mt19937_64 random(20);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> place(-spread, spread);
    std::vector<pir_pose> poses(count);
    for (pir_pose &pose : poses) {
        pose.rotation = {normal(random), normal(random), normal(random), normal(random)};
        pose.translation = {middle.x + place(random), middle.y + place(random), middle.z + place(random)};
    }
    return poses;
}

struct Times {
    std::vector<double> us;
    double median() {
        std::sort(us.begin(), us.end());
        return us[us.size() / 2];
    }
    double late() {
        std::sort(us.begin(), us.end());
        return us[us.size() - 1 - us.size() / 100];
    }
    double mean() const {
        double sum = 0;
        for (double t : us)
            sum += t;
        return sum / (double)us.size();
    }
};

template <class Call> auto timed(Times &times, Call call) {
    const auto begun = std::chrono::steady_clock::now();
    const auto answer = call();
    times.us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begun).count());
    return answer;
}

struct Row {
    const char *name, *p, *q;
    double divide_p, spread;
    pir_vec3 middle;
};

void run(FILE *csv, const Row &row, uint32_t count) {
    const std::unique_ptr<solid_model, Free> p(solid_model_facets(row.p, row.divide_p)),
        q(solid_model_facets(row.q, 1));
    const double spread = row.spread > 0 ? row.spread : 0.6 * (reach_of(*p) + reach_of(*q));
    Ours ours(*p, *q);
    Times state, distance, fcl_state, fcl_distance;
    uint32_t meeting = 0, other = 0;
#ifdef PIR_HAVE_FCL
    const auto fcl = make_fcl_solids(triangles_of(*p), triangles_of(*q));
#endif
    for (const pir_pose &pose : random_poses(spread, row.middle, count)) {
        const bool meets = timed(state, [&] { return ours.meets(pose); });
        timed(distance, [&] { return ours.distance(pose); });
        meeting += meets;
#ifdef PIR_HAVE_FCL
        other += timed(fcl_state, [&] { return fcl->meets(pose); }) != meets;
        timed(fcl_distance, [&] { return fcl->distance(pose); });
#endif
    }
    const auto text = [](Times &times) {
        char cells[64] = ",";
        if (!times.us.empty())
            std::snprintf(cells, sizeof cells, "%.3f,%.3f", times.median(), times.mean());
        return std::string(cells);
    };
    const std::string line = text(state) + "," + text(fcl_state) + "," + text(distance) + "," + text(fcl_distance);
    std::fprintf(csv, "%s,%u,%u,%s,%u\n", row.name, count, meeting, line.c_str(), other);
    std::printf("%-28s %6u meet %6u  %s  %u\n", row.name, count, meeting, line.c_str(), other);
    std::fflush(stdout);
}

// --- depth ---

pir_vec3 middle_of(const solid_model &model) {
    pir_vec3 low = model.point[0], high = low;
    for (uint32_t i = 1; i < model.points; i++) {
        const pir_vec3 v = model.point[i];
        low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
        high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    return {(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2};
}

pir_quat product(pir_quat a, pir_quat b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

// Turns by a step a frame about the middle of P, which stays about the middle of Q.
class Turning {
  public:
    Turning(const solid_model &p, const solid_model &q, double steps)
        : p_(middle_of(p)), q_(middle_of(q)), half_(std::acos(-1.0) / steps) {
    }
    pir_pose next() {
        if (frame_++ % 50 == 0) {
            std::normal_distribution<double> normal;
            pir_vec3 a = {normal(random_), normal(random_), normal(random_)};
            const double length = std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z), part = std::sin(half_) / length;
            by_ = {a.x * part, a.y * part, a.z * part, std::cos(half_)};
            drift_ = {0.01 * half_ * normal(random_), 0.01 * half_ * normal(random_), 0.01 * half_ * normal(random_)};
        }
        at_ = product(by_, at_);
        q_ = {q_.x + drift_.x, q_.y + drift_.y, q_.z + drift_.z};
        const pir_vec3 turned = pir_pose_rotate(pir_pose{at_, {0, 0, 0}}, p_);
        return {at_, {q_.x - turned.x, q_.y - turned.y, q_.z - turned.z}};
    }

  private:
    std::mt19937_64 random_{20};
    pir_vec3 p_, q_, drift_{0, 0, 0};
    double half_;
    pir_quat by_{0, 0, 0, 1}, at_{0, 0, 0, 1};
    uint32_t frame_ = 0;
};

struct DepthRow {
    const char *name, *p, *q;
    uint32_t frames;
};

void run_depth(FILE *csv, const DepthRow &row, uint32_t steps, uint32_t count) {
    const std::unique_ptr<solid_model, Free> p(solid_model_facets(row.p, 1)), q(solid_model_facets(row.q, 1));
    Ours ours(*p, *q);
    Turning turning(*p, *q, steps);
    Times depth, fcl_depth;
    double off = 0, most_off = 0;
#ifdef PIR_HAVE_FCL
    const auto fcl = make_fcl_solids(triangles_of(*p), triangles_of(*q));
#endif
    for (uint32_t frame = 0; frame < count; frame++) {
        const pir_pose pose = turning.next();
        Times one;
        const double told = timed(one, [&] { return ours.depth(pose); });
        if (!(told > 0))
            continue;
        depth.us.push_back(one.us[0]);
#ifdef PIR_HAVE_FCL
        if (frame % 10 > 0)
            continue;
        const double other = timed(fcl_depth, [&] { return fcl->depth(pose); });
        const double part = std::fabs(other - told) / told;
        off += part;
        most_off = std::max(most_off, part);
#endif
    }
    if (depth.us.empty())
        return;
    char peer[96] = ",,,";
    if (!fcl_depth.us.empty())
        std::snprintf(peer, sizeof peer, "%.3f,%.3f,%.3g,%.3g", fcl_depth.median(), fcl_depth.mean(),
                      off / (double)fcl_depth.us.size(), most_off);
    char line[256];
    std::snprintf(line, sizeof line, "%s,%u,%zu,%.3f,%.3f,%.3f,%s", row.name, steps, depth.us.size(), depth.median(),
                  depth.mean(), depth.late(), peer);
    std::fprintf(csv, "%s\n", line);
    std::printf("%s\n", line);
    std::fflush(stdout);
}

void run_depths(const results &where) {
    static const DepthRow rows[] = {{"two L-shaped extrusions", "ell", "ell", 2000},
                                    {"clamp and frame", "clamp", "frame", 2000},
                                    {"gear8 and star5", "gear8", "star5", 1000},
                                    {"mushroom and cup", "mushroom", "cup", 50}};
    FILE *csv = results_open(&where, "solid_depth.csv");
    std::fprintf(csv, "bodies,steps,frames,depth_us,depth_mean_us,depth_p99_us,fcl_depth_us,fcl_depth_mean_us,"
                      "fcl_off_mean,fcl_off_most\n");
    for (const DepthRow &row : rows)
        for (const uint32_t steps : {500u, 5000u})
            run_depth(csv, row, steps, results_count(row.frames));
    results_close(csv, "solid_depth.csv");
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: bench_solid_query FOLDER\n");
        return 2;
    }
    static const Row rows[] = {{"gear8 and star5", "gear8", "star5", 1, 0, {0, 0, 0}},
                               {"clamp and frame", "clamp", "frame", 1, 0, {0, 0, 0}},
                               {"mushroom and cup", "mushroom", "cup", 1, 0, {0, 0, 0}},
                               {"spoon and cup", "spoon", "cup", 1, 0, {0, 0, 0}},
                               {"cube in a cavity", "cube", "case", 8, 0.75, {2, 2, 2}},
                               {"star swallowed by a ball", "star5", "ball128", 8, 0.25, {0, 0, 0}}};
    results where = results_new(argv[1]);
    FILE *csv = results_open(&where, "solid_query.csv");
    std::fprintf(csv, "bodies,poses,meeting,state_us,state_mean_us,fcl_state_us,fcl_state_mean_us,distance_us,"
                      "distance_mean_us,fcl_distance_us,fcl_distance_mean_us,fcl_other_states\n");
    std::printf("%s\n", where.machine);
    for (const Row &row : rows)
        run(csv, row, results_count(20000));
    results_close(csv, "solid_query.csv");
    run_depths(where);
    return 0;
}
