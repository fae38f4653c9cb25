// SPDX-License-Identifier: MIT
//
// Pairs by need beside tracked sums and other engines, over the same poses, frame by frame in turn. The motion is run
// three times, everyone forgetting between, and a frame's time is the least of its three. Each line: median, mean, 99th
// percentile and worst in microseconds, and in how many frames the sign or the distance (by 1e-3 of the size) is wrong
// against ours, which the property tests hold to exact arithmetic.
//
// Motions named "both" move Q as well; whoever can only place one body is given P as Q sees it, made before.
// Pairs of different bodies have slivers: see pair_poses.hpp.
//
// Then what a cold pair's first answer takes, and many pairs at once, each turning. Lines go to pairs.csv, those of
// motions of both bodies and of different bodies to pairs_motions.csv.
//
// BODY leaves out all others but "all"; SEED, from 1 on, gives other bodies of points and other motions.
//
//     bench_pairs FOLDER [BODY [SEED]]
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>

#include "pair_peers.hpp"
#include "pair_poses.hpp"
#include "peers.hpp"
#include "results.h"

namespace {

constexpr int REPLAYS = 3;
constexpr double WRONG = 1e-3;

void check(pir_status status) {
    if (status != PIR_OK) {
        std::fprintf(stderr, "bench_pairs: %s\n", pir_status_text(status));
        std::exit(2);
    }
}

// Ours by need: with all numbers, or with a cutoff and a manifold.
class Pair : public PairPeer {
  public:
    Pair(pir_polytope *p, pir_polytope *q, bool contacts) : p_(p), q_(q), contacts_(contacts) {
        check(pir_workspace_create(nullptr, &workspace_));
        check(pir_pair_create(p, q, nullptr, &pair_));
        input_ = pir_pair_input_default();
        if (contacts)
            input_.cutoff = input_.margin = contact_cutoff(p, q);
    }
    ~Pair() override {
        pir_pair_destroy(pair_);
        pir_workspace_destroy(workspace_);
    }
    const char *name() const override {
        return contacts_ ? "ours manifold" : "ours pair";
    }
    bool has_manifold() const override {
        return contacts_;
    }
    void forget() override {
        pir_pair_statistics s = pir_pair_get_statistics(pair_);
        if (std::getenv("PIR_BENCH_STATISTICS"))
            std::printf(
                "#   %llu: certificate %llu facet %llu descent %llu surface %llu whole %llu; supports %llu begun "
                "%llu\n",
                (unsigned long long)s.queries, (unsigned long long)s.by_proof, (unsigned long long)s.by_walk,
                (unsigned long long)s.by_nearest, (unsigned long long)s.by_depth, (unsigned long long)s.by_whole,
                (unsigned long long)s.supports, (unsigned long long)s.begun);
        check(pir_pair_reset(pair_, p_, q_));
    }
    double ask(const Place &place) override {
        input_.pose_p = {place.p.r, place.p.t};
        input_.pose_q = {place.q.r, place.q.t};
        pir_query_result result;
        pir_pair_signed_distance(pair_, workspace_, &input_, &result);
        if (contacts_) {
            pir_contact contacts[32];
            size_t count;
            pir_pair_manifold(pair_, workspace_, &input_, &result, 32, contacts, &count);
        }
        return result.outcome == PIR_BEYOND_CUTOFF ? HUGE_VAL : result.distance;
    }

  private:
    pir_polytope *p_, *q_;
    bool contacts_;
    pir_pair_input input_;
    pir_workspace *workspace_ = nullptr;
    pir_pair *pair_ = nullptr;
};

// Ours as a tracked sum with a query.
class Whole : public PairPeer {
  public:
    Whole(pir_polytope *p, pir_polytope *q) {
        pir_sum_options options = pir_sum_options_default();
        options.difference = true;
        check(pir_sum_create(p, q, {0, 0, 0, 1}, &options, &sum_));
        check(pir_query_create(sum_, &query_));
    }
    ~Whole() override {
        pir_query_destroy(query_);
        pir_sum_destroy(sum_);
    }
    const char *name() const override {
        return "ours sum";
    }
    void forget() override {
        cache_ = {};
    }
    double ask(const Place &place) override {
        const Pose &pose = place.relative;
        pir_query_input input = pir_query_input_default();
        pir_query_result result;
        input.translation = pose.t;
        pir_sum_rotate(sum_, pose.r, PIR_METHOD_AUTO);
        pir_query_signed_distance(query_, &input, &cache_, &result);
        return result.distance;
    }

  private:
    pir_sum *sum_ = nullptr;
    pir_query *query_ = nullptr;
    pir_query_cache cache_ = {};
};

// An engine of the other query benchmarks: told whether to ask for a depth, which it could not know.
class Other : public PairPeer {
  public:
    explicit Other(std::unique_ptr<Peer> peer) : peer_(std::move(peer)) {
    }
    const char *name() const override {
        return peer_->name();
    }
    void forget() override {
    }
    double ask(const Place &place) override {
        const Pose &pose = place.relative;
        peer_->place(pose.r, pose.t);
        PeerAnswer answer = peer_->ask_guarded(false);
        if (answer.overlaps && answer.distance >= 0)
            answer = peer_->ask_guarded(true);
        return answer.failed ? NAN : answer.has_distance ? answer.distance : HUGE_VAL;
    }

  private:
    std::unique_ptr<Peer> peer_;
};

std::vector<std::unique_ptr<PairPeer>> everyone(pir_polytope *p, pir_polytope *q) {
    std::vector<std::unique_ptr<PairPeer>> all;
    all.push_back(std::make_unique<Pair>(p, q, false));
    all.push_back(std::make_unique<Pair>(p, q, true));
    all.push_back(std::make_unique<Whole>(p, q));
#ifdef PIR_HAVE_COAL
    all.push_back(make_coal(p, q, true));
    all.push_back(make_coal(p, q, false));
#endif
#ifdef PIR_HAVE_BOX3D
    for (bool scaled : {false, true})
        if (auto peer = make_box3d(p, q, scaled))
            all.push_back(std::move(peer));
#endif
#ifdef PIR_HAVE_BULLET
    all.push_back(std::make_unique<Other>(make_bullet(p, q)));
#endif
#ifdef PIR_HAVE_FCL
    all.push_back(std::make_unique<Other>(make_fcl(p, q)));
#endif
    return all;
}

struct Line {
    double median, mean, p99, worst;
};

Line line_of(std::vector<double> ns) {
    std::sort(ns.begin(), ns.end());
    double sum = 0;
    for (double t : ns)
        sum += t;
    return {ns[ns.size() / 2], sum / (double)ns.size(), ns[ns.size() * 99 / 100], ns.back()};
}

// What is apart by half of the cutoff or more may have no contact.
bool is_wrong(double answer, double right, double size, double optional) {
    if (right > optional)
        return answer < 0;
    if (std::isnan(answer) || answer == HUGE_VAL)
        return true;
    return (answer < 0) != (right < 0) ? std::fabs(answer - right) > 1e-9 * size
                                       : std::fabs(answer - right) > WRONG * size;
}

struct Bodies {
    const char *name;
    pir_polytope *p, *q;
};

void run(FILE *csv, const Bodies &bodies, const char *motion, int steps, const std::vector<Place> &places,
         double overhead) {
    pir_polytope *p = bodies.p, *q = bodies.q;
    auto all = everyone(p, q);
    std::vector<std::vector<double>> ns(all.size(), std::vector<double>(places.size(), HUGE_VAL));
    std::vector<int> wrong(all.size());
    std::vector<double> answers(all.size());
    double size = size_of(p) + size_of(q), optional = contact_cutoff(p, q) / 2;
    for (int replay = 0; replay < REPLAYS; replay++) {
        for (auto &peer : all)
            peer->forget();
        for (size_t i = 0; i < places.size(); i++) {
            // in an order that turns, so that no one always comes after the same
            for (size_t turn = 0; turn < all.size(); turn++) {
                size_t k = (turn + i + (size_t)replay) % all.size();
                double answer = 0;
                double time = nanoseconds(overhead, [&] { answer = all[k]->ask(places[i]); });
                ns[k][i] = std::min(ns[k][i], time);
                answers[k] = answer;
            }
            for (size_t k = 0; k < all.size() && replay == 0; k++)
                wrong[k] += is_wrong(answers[k], answers[0], size, all[k]->has_manifold() ? optional : HUGE_VAL);
        }
    }
    all[0]->forget();
    Line ours = line_of(ns[0]);
    for (size_t k = 0; k < all.size(); k++) {
        Line l = line_of(ns[k]);
        std::printf("%-18s %-13s %5d %-15s %8.3f %8.3f %8.3f %8.3f %5d   %5.2f %5.2f\n", bodies.name, motion, steps,
                    all[k]->name(), l.median / 1e3, l.mean / 1e3, l.p99 / 1e3, l.worst / 1e3, wrong[k],
                    ours.median / l.median, ours.mean / l.mean);
        std::fprintf(csv, "%s,%s,%d,%s,%.1f,%.1f,%.1f,%.1f,%d,%zu\n", bodies.name, motion, steps, all[k]->name(),
                     l.median, l.mean, l.p99, l.worst, wrong[k], places.size());
    }
}

// The motion with Q standing, then the same with both moving.
void run_both(FILE *standing, FILE *moving, const Bodies &bodies, int frames, int steps, double overhead) {
    const std::vector<Pose> poses = hovering(bodies.p, bodies.q, frames, steps);
    run(standing, bodies, "hovering", steps, q_stands(poses), overhead);
    run(moving, bodies, "hovering both", steps, both_move(poses, steps), overhead);
}

// Apart by three tenths of the way, deep by as much, and in no order, both moving.
void run_others(FILE *csv, const Bodies &bodies, int frames, double overhead) {
    auto both = [&](const char *motion, const std::vector<Pose> &poses) {
        run(csv, bodies, motion, 500, both_move(poses, 500), overhead);
    };
    both("apart both", away_from_contact(bodies.p, bodies.q, frames, 500, 0.3));
    both("deep both", away_from_contact(bodies.p, bodies.q, frames, 500, -0.3));
    both("teleport both", teleports(hovering(bodies.p, bodies.q, frames, 500)));
}

// The first answer of a pair that has just been made, in a workspace that is warm.
void run_cold(FILE *csv, const char *body, pir_polytope *p, pir_polytope *q, const std::vector<Pose> &poses,
              double overhead) {
    pir_workspace *workspace;
    check(pir_workspace_create(nullptr, &workspace));
    std::vector<double> made(poses.size(), HUGE_VAL), reset(poses.size(), HUGE_VAL);
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    pir_pair *kept;
    check(pir_pair_create(p, q, nullptr, &kept));
    for (int replay = 0; replay < REPLAYS; replay++)
        for (size_t i = 0; i < poses.size(); i++) {
            input.pose_p = {poses[i].r, poses[i].t};
            pir_pair *pair;
            made[i] = std::min(made[i], nanoseconds(overhead, [&] {
                                   check(pir_pair_create(p, q, nullptr, &pair));
                                   pir_pair_signed_distance(pair, workspace, &input, &result);
                               }));
            pir_pair_destroy(pair);
            reset[i] = std::min(reset[i], nanoseconds(overhead, [&] {
                                    check(pir_pair_reset(kept, p, q));
                                    pir_pair_signed_distance(kept, workspace, &input, &result);
                                }));
        }
    const std::vector<double> *rows[2] = {&made, &reset};
    const char *names[2] = {"ours created", "ours reset"};
    for (int k = 0; k < 2; k++) {
        Line l = line_of(*rows[k]);
        std::printf("%-18s %-13s %5d %-15s %8.3f %8.3f %8.3f %8.3f\n", body, "cold", 0, names[k], l.median / 1e3,
                    l.mean / 1e3, l.p99 / 1e3, l.worst / 1e3);
        std::fprintf(csv, "%s,cold,0,%s,%.1f,%.1f,%.1f,%.1f,0,%zu\n", body, names[k], l.median, l.mean, l.p99, l.worst,
                     poses.size());
    }
    pir_pair_destroy(kept);
    pir_workspace_destroy(workspace);
}

// `count` live pairs, each at its own place of the motion: the time of a pair and a frame.
void run_many(FILE *csv, const char *body, pir_polytope *p, pir_polytope *q, const std::vector<Pose> &poses,
              int count) {
    pir_workspace *workspace;
    check(pir_workspace_create(nullptr, &workspace));
    std::vector<pir_pair *> pairs((size_t)count);
    for (auto &pair : pairs)
        check(pir_pair_create(p, q, nullptr, &pair));
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    std::vector<double> ns;
    int frames = (int)results_count(count > 1000 ? 30 : 300);
    for (int frame = 0; frame < frames; frame++) {
        double time = nanoseconds(0, [&] {
            for (size_t i = 0; i < pairs.size(); i++) {
                const Pose &pose = poses[(i * 37 + (size_t)frame) % poses.size()];
                input.pose_p = {pose.r, pose.t};
                pir_pair_signed_distance(pairs[i], workspace, &input, &result);
            }
        });
        ns.push_back(time / count);
    }
    Line l = line_of(ns);
    std::printf("%-18s %-13s %5d %-15s %8.3f %8.3f %8.3f %8.3f   %.2f ms a frame\n", body, "many", count, "ours pair",
                l.median / 1e3, l.mean / 1e3, l.p99 / 1e3, l.worst / 1e3, l.median * count / 1e6);
    std::fprintf(csv, "%s,many,%d,ours pair,%.1f,%.1f,%.1f,%.1f,0,%d\n", body, count, l.median, l.mean, l.p99, l.worst,
                 frames);
    for (auto pair : pairs)
        pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
}

} // namespace

int main(int argc, char **argv) {
    if (argc < 2 || argc > 4) {
        std::fprintf(stderr, "usage: bench_pairs FOLDER [BODY [SEED]]\n");
        return 2;
    }
    const std::string only = argc > 2 ? argv[2] : "all";
    auto is_asked = [&](const char *name) { return only == "all" || only == name; };
    if (argc > 3)
        Random::first ^= std::strtoull(argv[3], nullptr, 10) * 0x9e3779b97f4a7c15ull;
    results where = results_new(argv[1]);
    FILE *csv = results_open(&where, "pairs.csv"), *motions = results_open(&where, "pairs_motions.csv");
    double overhead = clock_cost();
    int frames = (int)results_count(5000);
    struct {
        const char *name;
        pir_polytope *polytope;
    } bodies[] = {{"cube", shape("cube")},           {"icosahedron", shape("icosahedron")},
                  {"20 points", sphere_points(20)},  {"40 points", sphere_points(40)},
                  {"60 points", sphere_points(60)},  {"gs4", shape("gs4")},
                  {"ellipsoid960", shape("ellipse")}};
    std::printf("%-18s %-13s %5s %-15s %8s %8s %8s %8s %5s   %s\n", "body", "motion", "steps", "who", "median", "mean",
                "p99", "worst", "wrong", "ours by theirs");
    for (FILE *file : {csv, motions})
        std::fprintf(file, "body,motion,steps,who,median_ns,mean_ns,p99_ns,worst_ns,wrong,frames\n");
    for (auto &body : bodies) {
        pir_polytope *p = body.polytope;
        if (!is_asked(body.name))
            continue;
        for (int steps : {50, 500, 5000})
            run_both(csv, motions, {body.name, p, p}, frames, steps, overhead);
        run_others(motions, {body.name, p, p}, frames, overhead);
        run_cold(csv, body.name, p, p, hovering(p, p, frames, 7), overhead);
    }
    pir_polytope *sliver = sliver_points(100), *extreme = sphere_points(101);
    const Bodies pairs[] = {{"20 points and cube", bodies[2].polytope, bodies[0].polytope},
                            {"sliver and extreme", sliver, extreme},
                            {"sliver and cube", sliver, bodies[0].polytope}};
    for (const Bodies &pair : pairs) {
        if (!is_asked(pair.name))
            continue;
        run_both(motions, motions, pair, frames, 500, overhead);
        run_others(motions, pair, frames, overhead);
    }
    pir_polytope_release(sliver);
    pir_polytope_release(extreme);
    pir_polytope *cube = bodies[0].polytope, *twenty = bodies[2].polytope, *gs4 = bodies[5].polytope;
    if (is_asked("rest")) {
        run(csv, {"cube", cube, cube}, "spinning", 500, q_stands(spinning(cube, cube, frames, 500, 0)), overhead);
        run(csv, {"cube", cube, cube}, "sunken", 500, q_stands(spinning(cube, cube, frames, 500, 1e-3)), overhead);
        run(csv, {"gs4", gs4, gs4}, "aligned", 500, q_stands(aligned(gs4, gs4, frames, 0.98)), overhead);
    }
    if (is_asked("many"))
        for (int count : {10, 100, 1000, 10000})
            run_many(csv, "20 points", twenty, twenty, hovering(twenty, twenty, frames, 500), count);
    for (auto &body : bodies)
        pir_polytope_release(body.polytope);
    results_close(csv, "pairs.csv");
    results_close(motions, "pairs_motions.csv");
    std::printf("results in %s\n", where.folder);
    return 0;
}
