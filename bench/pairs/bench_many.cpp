// SPDX-License-Identifier: MIT
//
// How pairs, scenes and sums grow: with the facets of both bodies, the pairs that turn at once, the bodies of a scene
// that all move, and with the facets of a sum, up to 10^7. Each line of pairs_growth.csv: what grows and how
// many there are; nanoseconds for each of them, or for the whole sum, median, 99th percentile and worst of the frames,
// for facets of one answer by the clock, the least of three replays, else in CPU time; the bytes of all that is there,
// polytopes but of "pairs", where all share one; the exponents of time and bytes, by least squares over all sizes up to
// the row's.
//
// GROWS leaves out all others: facets, pairs, bodies, sums.
//
//     bench_many FOLDER [GROWS]
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include <pirouette/scene.h>

#include "pair_poses.hpp"
#include "results.h"

namespace {

constexpr double PI = 3.14159265358979323846;

void check(pir_status status) {
    if (status != PIR_OK) {
        std::fprintf(stderr, "bench_many: %s\n", pir_status_text(status));
        std::exit(2);
    }
}

// An allocator that counts what is there.
struct Counted {
    size_t bytes = 0;
    pir_allocator allocator{resize, this};

    static void *resize(void *context, void *block, size_t old_size, size_t new_size) {
        static_cast<Counted *>(context)->bytes += new_size - old_size;
        if (new_size > 0)
            return std::realloc(block, new_size);
        std::free(block);
        return nullptr;
    }
};

// In CPU time, for work that takes long: others may use the machine.
template <class Work> double cpu_nanoseconds(Work &&work) {
    const double from = cpu_now();
    work();
    return cpu_now() - from;
}

// The slope of y over x, both logarithms, by least squares.
double slope(const std::vector<double> &x, const std::vector<double> &y) {
    double mx = 0, my = 0, xy = 0, xx = 0, n = (double)x.size();
    for (size_t i = 0; i < x.size(); i++) {
        mx += x[i] / n;
        my += y[i] / n;
    }
    for (size_t i = 0; i < x.size(); i++) {
        xy += (x[i] - mx) * (y[i] - my);
        xx += (x[i] - mx) * (x[i] - mx);
    }
    return x.size() > 1 ? xy / xx : 0;
}

// The lines of one thing that grows.
class Growing {
  public:
    Growing(FILE *csv, const char *what) : csv_(csv), what_(what) {
    }
    // `ns`: of each frame; `each`: how many answers those are of; `whole`: whether time grows as that of a frame does.
    void add(double count, std::vector<double> ns, double each, bool whole, size_t bytes) {
        std::sort(ns.begin(), ns.end());
        const double median = ns[ns.size() / 2] / each, p99 = ns[ns.size() * 99 / 100] / each, worst = ns.back() / each;
        x_.push_back(std::log(count));
        time_.push_back(std::log(whole ? median * count : median));
        bytes_.push_back(std::log((double)bytes));
        const double by_time = slope(x_, time_), by_bytes = slope(x_, bytes_);
        std::fprintf(csv_, "%s,%.0f,%.1f,%.1f,%.1f,%zu,%.3f,%.3f\n", what_, count, median, p99, worst, bytes, by_time,
                     by_bytes);
        std::printf("%-16s %8.0f: %10.1f %10.1f %12.1f ns, %12zu bytes; exponents %.2f %.2f\n", what_, count, median,
                    p99, worst, bytes, by_time, by_bytes);
    }

  private:
    FILE *csv_;
    const char *what_;
    std::vector<double> x_, time_, bytes_;
};

// A geodesic sphere of radius 1 with memory of its own.
pir_polytope *sphere(int level, const pir_allocator *allocator) {
    pir_polytope *made = shape(("geodesic?level=" + std::to_string(level)).c_str()), *p = nullptr;
    std::vector<pir_vec3> points;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(made); v++)
        points.push_back(pir_polytope_vertex(made, v));
    pir_polytope_options with = pir_polytope_options_default();
    with.allocator = allocator;
    check(pir_polytope_create(points.data(), points.size(), &with, &p));
    pir_polytope_release(made);
    return p;
}

// Two spheres that hover within 5 % of their size about contact, both moving, at 500 frames to a turn.
std::vector<Place> hovering_spheres(const pir_polytope *p, int count) {
    Random random;
    std::vector<Pose> poses;
    pir_vec3 d = random.direction(), axis = random.direction();
    for (int i = 0; i < count; i++) {
        if (i % 50 == 0)
            axis = random.direction();
        const double along = axis.x * d.x + axis.y * d.y + axis.z * d.z, half = PI * i / 500;
        const double step = PI / 500, at = 2 * size_of(p) * (1 + 0.05 * std::sin(2 * PI * i / 200));
        // the direction drifts about the axis
        d = {d.x + step * (axis.x - along * d.x), d.y + step * (axis.y - along * d.y),
             d.z + step * (axis.z - along * d.z)};
        const double by = 1 / std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
        d = {d.x * by, d.y * by, d.z * by};
        poses.push_back({{0.6 * std::sin(half), 0.48 * std::sin(half), 0.64 * std::sin(half), std::cos(half)},
                         {at * d.x, at * d.y, at * d.z}});
    }
    return both_move(poses, 500);
}

void ask_facets(FILE *csv, bool jumps, double overhead) {
    Growing growing(csv, jumps ? "facets teleport" : "facets");
    static const int levels[] = {5, 10, 20, 40, 71};
    for (uint32_t k = 0; k < results_count(5); k++) {
        Counted counted;
        pir_polytope *p = sphere(levels[k], &counted.allocator);
        pir_pair_options with = pir_pair_options_default();
        with.allocator = &counted.allocator;
        pir_workspace *workspace;
        pir_pair *pair;
        check(pir_workspace_create(&counted.allocator, &workspace));
        check(pir_pair_create(p, p, &with, &pair));
        pir_pair_input input = pir_pair_input_default();
        pir_query_result result;
        const std::vector<Place> places = hovering_spheres(p, (int)results_count(5000));
        std::vector<double> ns(places.size(), HUGE_VAL);
        for (int replay = 0; replay < 3; replay++) {
            for (size_t i = 0; i < places.size(); i++) {
                const Place &at = places[jumps ? i * 1009 % places.size() : i];
                input.pose_p = {at.p.r, at.p.t};
                input.pose_q = {at.q.r, at.q.t};
                ns[i] = std::min(ns[i], nanoseconds(overhead, [&] {
                                     check(pir_pair_signed_distance(pair, workspace, &input, &result));
                                 }));
            }
            check(pir_pair_reset(pair, p, p));
        }
        growing.add(pir_polytope_facet_count(p), ns, 1, false, counted.bytes);
        pir_pair_destroy(pair);
        pir_workspace_destroy(workspace);
        pir_polytope_release(p);
    }
}

void ask_pairs(FILE *csv) {
    Growing growing(csv, "pairs");
    pir_polytope *p = sphere_points(20);
    const std::vector<Place> places = both_move(hovering(p, p, (int)results_count(5000), 500), 500);
    for (int count : {10, 100, 1000, 10000, 100000}) {
        Counted counted;
        pir_pair_options with = pir_pair_options_default();
        with.allocator = &counted.allocator;
        pir_workspace *workspace;
        check(pir_workspace_create(&counted.allocator, &workspace));
        std::vector<pir_pair *> pairs(results_count((uint32_t)count));
        for (auto &pair : pairs)
            check(pir_pair_create(p, p, &with, &pair));
        pir_pair_input input = pir_pair_input_default();
        pir_query_result result;
        std::vector<double> ns;
        for (uint32_t frame = 0; frame < results_count(count > 1000 ? 20 : 200); frame++)
            ns.push_back(cpu_nanoseconds([&] {
                for (size_t i = 0; i < pairs.size(); i++) {
                    const Place &at = places[(i * 37 + frame) % places.size()];
                    input.pose_p = {at.p.r, at.p.t};
                    input.pose_q = {at.q.r, at.q.t};
                    pir_pair_signed_distance(pairs[i], workspace, &input, &result);
                }
            }));
        growing.add(count, ns, (double)pairs.size(), true, counted.bytes);
        for (auto pair : pairs)
            pir_pair_destroy(pair);
        pir_workspace_destroy(workspace);
    }
    pir_polytope_release(p);
}

// Bodies at random in a box, as dense whatever their count is, each turning and going to and fro at its place.
class Swarm {
  public:
    Swarm(pir_polytope *p, size_t count) : at_(count), axis_(count), moves_(count) {
        const double half = std::cbrt((double)count) * 1.2;
        for (size_t i = 0; i < count; i++) {
            at_[i] = {half * random_.unit(), half * random_.unit(), half * random_.unit()};
            axis_[i] = random_.direction();
        }
        pir_scene_options options = pir_scene_options_default();
        check(pir_scene_create(&options, &scene_));
        for (size_t i = 0; i < count; i++) {
            pir_body_options body = pir_body_options_default();
            body.kind = PIR_BODY_MOVING;
            body.pose = pose(i, 0);
            body.pieces = &p;
            body.piece_count = 1;
            check(pir_scene_add(scene_, &body, &moves_[i].body));
        }
    }
    ~Swarm() {
        pir_scene_destroy(scene_);
    }
    void update(int frame) {
        for (size_t i = 0; i < moves_.size(); i++)
            moves_[i].pose = pose(i, frame);
        check(pir_scene_update(scene_, moves_.data(), moves_.size()));
    }
    size_t bytes() const {
        return pir_scene_get_statistics(scene_).peak;
    }

  private:
    pir_pose pose(size_t i, int frame) const {
        const double turn = PI * (frame + (double)(i % 500)) / 500, go = 0.1 * std::sin(4 * turn), s = std::sin(turn);
        const pir_vec3 a = axis_[i], at = at_[i];
        return {{a.x * s, a.y * s, a.z * s, std::cos(turn)}, {at.x + go * a.x, at.y + go * a.y, at.z + go * a.z}};
    }

    Random random_;
    std::vector<pir_vec3> at_, axis_;
    std::vector<pir_scene_move> moves_;
    pir_scene *scene_ = nullptr;
};

void ask_bodies(FILE *csv) {
    Growing growing(csv, "bodies");
    pir_polytope *p = sphere_points(20);
    for (int count : {100, 1000, 10000, 100000}) {
        const size_t bodies = results_count((uint32_t)count);
        Swarm swarm(p, bodies);
        std::vector<double> ns;
        swarm.update(1);
        for (uint32_t frame = 0; frame < results_count(count > 10000 ? 10 : 100); frame++)
            ns.push_back(cpu_nanoseconds([&] { swarm.update(2 + (int)frame); }));
        growing.add(count, ns, (double)bodies, true, swarm.bytes());
    }
    pir_polytope_release(p);
}

// The sum of a geodesic sphere and itself at some rotation, made anew and brought on by a 50,000th of a turn.
void ask_sums(FILE *csv) {
    Growing rebuilt(csv, "sums rebuilt"), updated(csv, "sums updated");
    static const int levels[] = {4, 12, 39, 126, 401};
    for (uint32_t k = 0; k < results_count(5); k++) {
        Counted counted;
        pir_polytope *p = sphere(levels[k], &counted.allocator);
        pir_sum_options options = pir_sum_options_default();
        options.allocator = &counted.allocator;
        pir_sum *sum;
        check(pir_sum_create(p, p, {0.1, 0.2, 0.3, 0.9}, &options, &sum));
        std::vector<double> times[2];
        const int frames = (int)results_count(k < 4 ? 20 : 5);
        for (int pass = 0; pass < 2; pass++)
            for (int i = 0; i < frames; i++) {
                const double half = PI * i / 50000, s = std::sin(half), c = std::cos(half);
                // (0.1, 0.2, 0.3, 0.9) turned about z
                const pir_quat at = {0.1 * c - 0.2 * s, 0.2 * c + 0.1 * s, 0.3 * c + 0.9 * s, 0.9 * c - 0.3 * s};
                const pir_method method = pass == 0 ? PIR_METHOD_WALK : PIR_METHOD_UPDATE;
                const double ns = cpu_nanoseconds([&] { check(pir_sum_rotate(sum, at, method)); });
                // the first updates after a rebuild check everything
                if (pass == 0 || i >= frames / 4)
                    times[pass].push_back(ns);
            }
        const double facets = 2.0 * pir_polytope_facet_count(p) + pir_sum_ee_count(sum);
        rebuilt.add(facets, times[0], 1, false, counted.bytes);
        updated.add(facets, times[1], 1, false, counted.bytes);
        pir_sum_destroy(sum);
        pir_polytope_release(p);
    }
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 2 && argc != 3) {
        std::fprintf(stderr, "usage: bench_many FOLDER [GROWS]\n");
        return 2;
    }
    const std::string only = argc > 2 ? argv[2] : "";
    auto is_asked = [&](const char *what) { return only.empty() || only == what; };
    results where = results_new(argv[1]);
    FILE *csv = results_open(&where, "pairs_growth.csv");
    std::fprintf(csv, "what,count,ns,p99_ns,worst_ns,bytes,time_exponent,bytes_exponent\n");
    for (bool jumps : {false, true})
        if (is_asked("facets"))
            ask_facets(csv, jumps, clock_cost());
    if (is_asked("pairs"))
        ask_pairs(csv);
    if (is_asked("bodies"))
        ask_bodies(csv);
    if (is_asked("sums"))
        ask_sums(csv);
    results_close(csv, "pairs_growth.csv");
    std::printf("results in %s\n", where.folder);
    return 0;
}
