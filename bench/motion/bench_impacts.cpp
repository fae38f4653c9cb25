// SPDX-License-Identifier: MIT
//
// First contacts of ways, hinges and screws beside the continuous collision of FCL and Bullet: impacts.csv has for each
// motion, of bodies of 20 points and of boxes that stand on a grid, and for each engine how many of the motions it
// tells a contact of; how many contacts it tells early, with the bodies still apart; late, with an overlap at or before
// the time; how many it misses; and what a call takes.
//
// Each answer is judged by exact states on the engine's own path: at the told time, and at 256 times of the motion. Up
// to a thousandth of the bodies' size all is taken for contact, for Bullet stops where it is no nearer than that.
//
//     bench_impacts FOLDER
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include <pirouette/impact.h>
#include <pirouette/pose.h>

#include "ccd_peers.hpp"
#include "results.h"

namespace {

const double PI = 3.14159265358979323846;
const int SAMPLES = 256;
const double TOLERANCE = 1e-3;

void check(pir_status status) {
    if (status != PIR_OK) {
        std::fprintf(stderr, "bench_impacts: %s\n", pir_status_text(status));
        std::exit(2);
    }
}

pir_vec3 scaled(pir_vec3 v, double by) {
    return {v.x * by, v.y * by, v.z * by};
}

Pose turned(const Course &course, double half, double part) {
    const double s = std::sin(half);
    return {{s * course.axis.x, s * course.axis.y, s * course.axis.z, std::cos(half)}, scaled(course.way, part)};
}

bool goes(const Course &course) {
    return course.way.x != 0 || course.way.y != 0 || course.way.z != 0;
}

class Ours : public CcdPeer {
  public:
    Ours(pir_polytope *p, pir_polytope *q) {
        check(pir_pair_create(p, q, nullptr, &pair_));
        check(pir_workspace_create(nullptr, &workspace_));
    }
    ~Ours() override {
        pir_pair_destroy(pair_);
        pir_workspace_destroy(workspace_);
    }
    Ours(const Ours &) = delete;
    Ours &operator=(const Ours &) = delete;

    const char *name() const override {
        return "pirouette";
    }
    CcdAnswer ask(const Course &course) override {
        pir_pair_input input = pir_pair_input_default();
        input.pose_q = {course.q.r, course.q.t};
        const pir_exact_motion motion = {{0, 0, 0}, course.axis, course.degrees, course.way};
        pir_exact_impact impact;
        CcdAnswer answer;
        answer.failed = pir_pair_impact(pair_, workspace_, &input, &motion, &impact) != PIR_OK;
        answer.hits = !answer.failed && impact.impact.outcome == PIR_CAST_HIT;
        answer.time = answer.failed ? 1 : impact.impact.time;
        return answer;
    }
    Pose pose_at(const Course &course, double time) const override {
        const double end = course.degrees * PI / 360;
        return turned(course, time * end, course.degrees == 0 ? time : std::tan(time * end) / std::tan(end));
    }

    // Exact states, of poses in doubles: how far the bodies are apart, or minus how deep they overlap.
    double gap(const Course &course, Pose p) {
        pir_pair_input input = pir_pair_input_default();
        input.pose_p = {p.r, p.t};
        input.pose_q = {course.q.r, course.q.t};
        pir_query_result result;
        check(pir_pair_signed_distance(pair_, workspace_, &input, &result));
        return result.distance;
    }

  private:
    pir_pair *pair_ = nullptr;
    pir_workspace *workspace_ = nullptr;
};

struct Tally {
    int hits = 0, early = 0, late = 0, missed = 0, failed = 0;
    Times times;
};

// One answer. `size`, a length: that of both bodies.
void judge(const CcdPeer &peer, const CcdAnswer &answer, const Course &course, Ours &states, double size,
           Tally &tally) {
    if (answer.failed) {
        tally.failed++;
        return;
    }
    const double slack = TOLERANCE * size, until = answer.hits ? answer.time : 1;
    bool deep = false;
    for (int i = 1; i <= SAMPLES && (double)i / SAMPLES <= until && !deep; i++)
        deep = states.gap(course, peer.pose_at(course, (double)i / SAMPLES)) < -slack;
    tally.hits += answer.hits;
    if (!answer.hits) {
        tally.missed += deep;
        return;
    }
    const double gap = states.gap(course, peer.pose_at(course, answer.time));
    if (deep || gap < -slack)
        tally.late++;
    else
        tally.early += gap > slack;
}

double half_step(Random &random, int size) {
    return 0.5 * std::round(2 * size * random.unit());
}

// A motion towards Q or past it, which starts apart from it.
Course make_course(Random &random, const std::string &motion, bool on_grid) {
    Course course{};
    const pir_vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const pir_vec3 at = random.direction(), q = random.direction();
    course.axis = on_grid ? axes[(int)(1.5 * (random.unit() + 1)) % 3] : random.direction();
    const double away = motion == "way" ? 3 : 2.2;
    course.q = {{q.x, q.y, q.z, random.unit()}, {away * at.x + (motion == "way" ? 0 : 2), away * at.y, away * at.z}};
    const int steps = motion == "way" ? 4 : 2;
    if (on_grid)
        course.q = {{0, 0, 0, 1}, {half_step(random, steps), half_step(random, steps), half_step(random, steps)}};
    // Bullet cuts turns at 45 degrees
    if (motion != "way")
        course.degrees = on_grid ? 44 : 24 + 20 * random.unit();
    if (motion == "way")
        course.way = on_grid ? pir_vec3{2 * course.q.t.x, course.q.t.y, 2 * course.q.t.z}
                             : pir_vec3{5 * at.x + random.unit(), 5 * at.y + random.unit(), 5 * at.z + random.unit()};
    if (motion == "screw")
        course.way = scaled(course.axis, on_grid ? half_step(random, 4) : 3 * random.unit());
    return course;
}

// A body whose origin, about which it turns, is at its end.
pir_polytope *arm(int count) {
    Random random;
    std::vector<pir_vec3> points;
    for (int i = 0; i < count; i++) {
        const pir_vec3 v = random.direction();
        points.push_back({v.x + 2, v.y, v.z});
    }
    return from_points(points);
}

void measure(FILE *csv, const char *bodies, pir_polytope *p, pir_polytope *q, bool on_grid, double overhead) {
    Ours ours(p, q), states(p, q);
    std::vector<std::unique_ptr<CcdPeer>> peers;
#ifdef PIR_HAVE_FCL
    peers.push_back(make_fcl_ccd(p, q, 0));
    peers.push_back(make_fcl_ccd(p, q, 10));
#endif
#ifdef PIR_HAVE_BULLET
    peers.push_back(make_bullet_ccd(p, q));
#endif
    std::vector<CcdPeer *> all{&ours};
    for (auto &peer : peers)
        all.push_back(peer.get());
    const double size = size_of(p) + size_of(q);
    const int count = (int)results_count(2000);
    for (const char *motion : {"way", "hinge", "screw"}) {
        Random random;
        std::vector<Tally> tallies(all.size());
        for (int done = 0; done < count;) {
            const Course course = make_course(random, motion, on_grid);
            if (states.gap(course, {{0, 0, 0, 1}, {0, 0, 0}}) < 0.01 * size || (course.degrees == 0 && !goes(course)))
                continue;
            done++;
            for (size_t k = 0; k < all.size(); k++) {
                CcdAnswer answer;
                tallies[k].times.ns.push_back(nanoseconds(overhead, [&] { answer = all[k]->ask(course); }));
                judge(*all[k], answer, course, states, size, tallies[k]);
            }
        }
        for (size_t k = 0; k < all.size(); k++) {
            Tally &t = tallies[k];
            std::printf("%-9s %-10s %-14s %6d hits %5d early %5d late %5d missed %5d failed %9.0f ns\n", motion, bodies,
                        all[k]->name(), t.hits, t.early, t.late, t.missed, t.failed, t.times.median());
            std::fprintf(csv, "%s,%s,\"%s\",%d,%d,%d,%d,%d,%d,%.1f,%.1f\n", motion, bodies, all[k]->name(), count,
                         t.hits, t.early, t.late, t.missed, t.failed, t.times.median(), t.times.fastest());
        }
    }
}

} // namespace

Pose CcdPeer::pose_at(const Course &course, double time) const {
    return turned(course, time * course.degrees * PI / 360, time);
}

int main(int argc, char **argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: bench_impacts FOLDER\n");
        return 2;
    }
    results where = results_new(argv[1]);
    const double overhead = clock_cost();
    FILE *csv = results_open(&where, "impacts.csv");
    std::fprintf(csv, "motion,bodies,engine,motions,hits,early,late,missed,failed,median_ns,fastest_ns\n");
    pir_polytope *hull = arm(20), *box = shape("cube", {0.5, 0.5, 0.5}, {1, 0, 0}), *cube = shape("cube");
    measure(csv, "20 points", hull, hull, false, overhead);
    measure(csv, "boxes", box, cube, true, overhead);
    results_close(csv, "impacts.csv");
    pir_polytope_release(hull);
    pir_polytope_release(box);
    pir_polytope_release(cube);
    std::printf("results in %s\n", where.folder);
    return 0;
}
